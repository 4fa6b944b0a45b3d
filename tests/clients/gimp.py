"""gimp.py FRAME.exr OUT.png: GIMP opens a frame as linear light. What it shows is written as a PNG of 16 bits, with the profile of that light."""
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

import clients

frame, out = sys.argv[1:]
SCRIPT = """(let* ((image (car (gimp-file-load RUN-NONINTERACTIVE "{0}" "{0}"))) (layer (car (gimp-image-get-active-layer image))))
  (file-png-save RUN-NONINTERACTIVE image layer "{1}" "{1}" 0 9 0 0 0 0 0))"""
version = subprocess.run(["gimp-console", "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
subprocess.run(["gimp-console", "-i", "-b", SCRIPT.format(frame, out), "-b", "(gimp-quit 0)"], capture_output=True, check=True)
checks = clients.Checks(f"GIMP {version}")
pixels = oiio.ImageBuf(out).get_pixels(oiio.FLOAT)[..., :3]
wanted = np.clip(oiio.ImageBuf(frame).get_pixels(oiio.FLOAT)[..., :3], 0, 1)
checks.near(pixels, wanted, 1 / 65535, f"{frame.rpartition('/')[2]}: opens, and its colors are the file's")
checks.finish()
