"""colors.py FRAME.SPACE.exr...: OpenImageIO and OpenColorIO convert frames of one scene by what their headers say.

With the ACES configuration that is built into OpenColorIO. SPACE is the name that --colorspace took; lin_ap1_scene, which is ACEScg, is
among them.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio

import clients

CONFIG = "ocio://default"
TARGET = "ACEScg"
VIEW = ("sRGB - Display", "ACES 2.0 - SDR 100 nits (Rec.709)")
ROUNDING = 2e-6  # of a matrix in float, of colors up to 2
oiiotool = pathlib.Path(sys.executable).with_name("oiiotool")


def pixels(image):
    if image.has_error:
        sys.exit(f"colors.py: {image.geterror()}")
    return np.asarray(image.get_pixels(oiio.FLOAT))[..., :3]


def by_oiiotool(*arguments):
    with tempfile.TemporaryDirectory() as folder:
        made = f"{folder}/made.exr"
        subprocess.run([oiiotool, "--colorconfig", CONFIG, *arguments, "-o", made], check=True)
        return clients.layer(clients.read(made)[1], "")


config = ocio.Config.CreateFromFile(CONFIG)
checks = clients.Checks(f"OpenImageIO {oiio.VERSION_STRING}, OpenColorIO {ocio.GetVersion()}")
paths = {path.suffixes[-2][1:]: path for path in map(pathlib.Path, sys.argv[1:])}
acescg = clients.layer(clients.read(paths["lin_ap1_scene"])[1], "")
for space, path in paths.items():
    read = oiio.ImageBuf(str(path))
    checks.holds(read.spec().get_string_attribute("oiio:ColorSpace") == space, f"{path.name}: is read as {space}")
    untouched = clients.layer(clients.read(path)[1], "")
    checks.holds(np.array_equal(pixels(read), untouched), f"{path.name}: OpenImageIO reads what OpenEXR reads")

    # No source space is named: the file's own counts.
    converted = pixels(oiio.ImageBufAlgo.colorconvert(read, "", TARGET, colorconfig=CONFIG))
    checks.near(converted, pixels(oiio.ImageBufAlgo.colorconvert(read, space, TARGET, colorconfig=CONFIG)), 0, f"{path.name}: to {TARGET} from what it says, and from {space}")
    if space != "lin_ap1_scene":
        checks.holds(np.abs(converted - untouched).max() > 1e-3, f"{path.name}: which changes it by {np.abs(converted - untouched).max():.3g}")
    by_ocio = untouched.copy()
    config.getProcessor(space, TARGET).getDefaultCPUProcessor().applyRGB(by_ocio)
    checks.near(converted, by_ocio, ROUNDING, f"{path.name}: OpenColorIO's own processor makes the same")
    checks.near(converted, acescg, ROUNDING, f"{path.name}: and it is what --colorspace lin_ap1_scene renders")
    checks.near(by_oiiotool(str(path), "--ch", "R,G,B,A", "--tocolorspace", TARGET), converted, 0, f"{path.name}: as oiiotool does")

    channels = ["--ch", "R,G,B"]
    checks.near(by_oiiotool(str(path), *channels, "--ociodisplay", *VIEW), by_oiiotool(str(path), *channels, f"--ociodisplay:from={space}", *VIEW), 0, f"{path.name}: through the view {VIEW[1]}")
checks.finish()
