"""regrade.py FRAME.exr GROUP FACTOR [REGRADED.exr]: oiiotool multiplies the layer of a light group in a frame.

REGRADED is the same frame rendered with that group's lamps so; without it the result is compared with the frame's own layers.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import clients

frame, group, factor = sys.argv[1], sys.argv[2], float(sys.argv[3])
oiiotool = pathlib.Path(sys.executable).with_name("oiiotool")
checks = clients.Checks("oiiotool")
with tempfile.TemporaryDirectory() as folder:
    made = f"{folder}/regraded.exr"
    own = ",".join(f"{c}=Combined_{group}.{c}" for c in "RGB")
    subprocess.run([oiiotool, frame, "--ch", "R,G,B", frame, "--ch", own, "--mulc", f"{factor - 1}", "--add", "-o", made], check=True)
    regraded = clients.layer(clients.read(made)[1], "")
_, channels = clients.read(frame)
whole = clients.layer(channels, "").astype(np.float64)
if len(sys.argv) > 4:
    wanted = clients.layer(clients.read(sys.argv[4])[1], "")
else:
    wanted = whole + (factor - 1) * clients.layer(channels, f"Combined_{group}").astype(np.float64)
# Values are rounded a few times on the way.
checks.near(regraded, wanted, 1e-6 * whole.max(), f"{pathlib.Path(frame).name}: Combined_{group} times {factor}, and all else as it was")
checks.finish()
