"""blender_grade.py FRAME.exr OUT OBJECT GROUP FACTOR: Blender's compositor mattes an object of any frame, and multiplies a light group.

It writes matte_0001.exr, and regraded_0001.exr, under OUT.
"""
import sys

import bpy
import numpy as np

import clients
from compositor import Compositor

frame, out, name, group, factor = sys.argv[1:]
blender = Compositor(frame, out)
blender.write("combined", blender.passes["Combined"])
blender.write("regraded", blender.regraded(group, float(factor)))
blender.write("matte", blender.matte("CryptoObject", name))
found = blender.render()

checks = clients.Checks(f"Blender {bpy.app.version_string}")
whole = clients.layer(blender.channels, "").astype(np.float64)
own = clients.layer(blender.channels, f"Combined_{group}").astype(np.float64)
checks.near(found["combined"], whole, 0, f"{frame}: Combined is R G B")
checks.near(found["regraded"], whole + (float(factor) - 1) * own, 1e-5 * whole.max(), f"{group} times {factor}")
expected = clients.matte(blender.channels, "CryptoObject", name)
checks.holds(expected.max() > 0.99, f"{name} covers {expected.mean():.2%} of the frame")
checks.near(found["matte"][..., 0], expected, 1e-6, f"the matte of {name} is the coverage of its ranks")
checks.finish()
