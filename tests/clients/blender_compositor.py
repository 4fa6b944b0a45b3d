"""blender_compositor.py FRAME.exr DIMMED.exr OUT: Blender's compositor mattes, adds up and regrades a frame of lamps.json.

DIMMED is the same frame rendered with the lamps of the group `key` at a quarter. What Blender makes is written under OUT.
"""
import pathlib
import sys

import bpy
import numpy as np

import clients

frame, dimmed, out = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
MATTES = {"CryptoObject": ["floor", "glass cube", "clay"], "CryptoMaterial": ["glass"], "CryptoLight": ["fill"]}
KEY = 0.25

header, channels = clients.read(frame)
height, width = channels["R"].shape
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
scene.render.compositor_device = "CPU"
scene.use_nodes = True
nodes, links = scene.node_tree.nodes, scene.node_tree.links
nodes.clear()
image = bpy.data.images.load(str(frame))
source = nodes.new("CompositorNodeImage")
source.image = image

results = nodes.new("CompositorNodeOutputFile")
results.base_path = str(out)
results.format.file_format = "OPEN_EXR"
results.format.color_mode = "RGB"
results.format.color_depth = "32"
results.file_slots.clear()
made = []


def write(name, socket):
    results.file_slots.new(name + "_")
    links.new(socket, results.inputs[-1])
    made.append(name)


def mix(mode, first, second):
    node = nodes.new("CompositorNodeMixRGB")
    node.blend_type = mode
    for socket, value in zip(node.inputs[1:], (first, second)):
        if isinstance(value, float):
            socket.default_value = (value, value, value, 1)
        else:
            links.new(value, socket)
    return node.outputs[0]


def add_up(sockets):
    whole = sockets[0]
    for socket in sockets[1:]:
        whole = mix("ADD", whole, socket)
    return whole


checks = clients.Checks(f"Blender {bpy.app.version_string}")
passes = {socket.name: socket for socket in source.outputs if socket.enabled}
lights = [name for name in passes if name.startswith("Combined_")]
wanted = {name[:-2] for name in channels if name.startswith("Combined_")}
checks.holds(image.type == "MULTILAYER" and set(lights) == wanted, f"{image.type} of {len(passes)} passes: {', '.join(passes)}")
write("combined", passes["Combined"])
write("added", add_up([passes[name] for name in lights]))
regraded = [mix("MULTIPLY", passes[name], KEY) if name == "Combined_key" else passes[name] for name in lights]
write("regraded", add_up(regraded))
for kind, names in MATTES.items():
    for name in names:
        node = nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = image
        node.layer_name = kind
        node.matte_id = name
        write(f"{kind}_{name}".replace(" ", "_"), node.outputs["Matte"])
bpy.ops.render.render()

found = {name: clients.layer(clients.read(out / f"{name}_{scene.frame_current:04}.exr")[1], "") for name in made}
whole = clients.layer(channels, "")
checks.near(found["combined"], whole, 0, "Combined is R G B")
checks.near(found["added"], found["combined"], 1e-5, f"the sum of {len(lights)} layers Combined_ is Combined")
checks.near(found["regraded"], clients.layer(clients.read(dimmed)[1], ""), 1e-5, "with Combined_key at a quarter it is the frame whose lamps are")
for kind, names in MATTES.items():
    for name in names:
        own = found[f"{kind}_{name}".replace(" ", "_")][..., 0]
        expected = clients.matte(channels, kind, name)
        checks.holds(expected.max() == 1, f"{kind} {name}: covers {expected.mean():.2%} of the frame")
        checks.near(own, expected, 1e-6, f"{kind} {name}: Blender's matte is the coverage of its ranks")
checks.finish()
