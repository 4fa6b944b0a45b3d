"""regrade.py FRAME.exr DIMMED.exr: oiiotool dims the lamps of the group `key` in a frame of lamps.json to a quarter.

DIMMED is the same frame rendered with those lamps at a quarter.
"""
import pathlib
import subprocess
import sys
import tempfile

import clients

frame, dimmed = sys.argv[1:]
oiiotool = pathlib.Path(sys.executable).with_name("oiiotool")
checks = clients.Checks("oiiotool")
with tempfile.TemporaryDirectory() as folder:
    made = f"{folder}/regraded.exr"
    key = "R=Combined_key.R,G=Combined_key.G,B=Combined_key.B"
    subprocess.run([oiiotool, frame, "--ch", "R,G,B", frame, "--ch", key, "--mulc", "-0.75", "--add", "-o", made], check=True)
    regraded = clients.layer(clients.read(made)[1], "")
wanted = clients.layer(clients.read(dimmed)[1], "")
# Values up to 2, rounded a few times on the way.
checks.near(regraded, wanted, 2e-6, "less three quarters of Combined_key it is the frame whose lamps are at a quarter")
checks.finish()
