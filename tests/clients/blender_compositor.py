"""blender_compositor.py FRAME.exr DIMMED.exr OUT [PARTS.exr]: Blender's compositor mattes, adds up and regrades a frame of lamps.json.

DIMMED is the same frame rendered with the lamps of the group `key` at a quarter. What Blender makes is written under OUT. PARTS is FRAME
with each layer in a part of its own, which Blender opens in its place.
"""
import sys

import bpy

import clients
from compositor import Compositor

frame, dimmed, out, *parts = sys.argv[1:]
MATTES = {"CryptoObject": ["floor", "glass cube", "clay"], "CryptoMaterial": ["glass"], "CryptoLight": ["fill"]}
KEY = 0.25

blender = Compositor(frame, out, *parts)
channels, lights, passes = blender.channels, blender.lights, blender.passes
checks = clients.Checks(f"Blender {bpy.app.version_string}" + (", parts" if parts else ""))
wanted = {name[:-2] for name in channels if name.startswith("Combined_")}
checks.holds(blender.image.type == "MULTILAYER" and set(lights) == wanted, f"{blender.image.type} of {len(passes)} passes: {', '.join(passes)}")
blender.write("combined", passes["Combined"])
blender.write("added", blender.add_up([passes[name] for name in lights]))
blender.write("regraded", blender.regraded("key", KEY))
for kind, names in MATTES.items():
    for name in names:
        blender.write(f"{kind}_{name}".replace(" ", "_"), blender.matte(kind, name))

found = blender.render()
checks.near(found["combined"], clients.layer(channels, ""), 0, "Combined is R G B")
checks.near(found["added"], found["combined"], 1e-5, f"the sum of {len(lights)} layers Combined_ is Combined")
checks.near(found["regraded"], clients.layer(clients.read(dimmed)[1], ""), 1e-5, "with Combined_key at a quarter it is the frame whose lamps are")
for kind, names in MATTES.items():
    for name in names:
        own = found[f"{kind}_{name}".replace(" ", "_")][..., 0]
        expected = clients.matte(channels, kind, name)
        checks.holds(expected.max() == 1, f"{kind} {name}: covers {expected.mean():.2%} of the frame")
        checks.near(own, expected, 1e-6, f"{kind} {name}: Blender's matte is the coverage of its ranks")
checks.finish()
