"""view.py config FILE.ocio: writes the ACES configuration for OpenColorIO 2.1 and later, which Debian 12 has.
view.py FRAME.exr FRAME.png FILE.ocio: the preview has the codes that OpenColorIO's own processor makes of the frame."""
import sys

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio

import clients

NAME, VIEW = "cg-config-v1.0.0_aces-v1.3_ocio-v2.1", ("sRGB - Display", "ACES 1.0 - SDR Video")
if sys.argv[1] == "config":
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(ocio.Config.CreateFromBuiltinConfig(NAME).serialize())
    sys.exit()

frame, preview, path = sys.argv[1:]
checks = clients.Checks(f"OpenColorIO {ocio.GetVersion()}")
config = ocio.Config.CreateFromFile(path)
view = ocio.DisplayViewTransform(src="Linear Rec.709 (sRGB)", display=VIEW[0], view=VIEW[1])
shown = clients.layer(clients.read(frame)[1], "").astype(np.float32)
config.getProcessor(view).getDefaultCPUProcessor().applyRGB(shown)
codes = oiio.ImageBuf(preview).get_pixels(oiio.UINT8)[..., :3]
wanted = np.rint(np.clip(shown, 0, 1) * 255).astype(int)
checks.near(codes, wanted, 1, f"--view \"{VIEW[1]}\": codes of the preview")
checks.near((codes != wanted).mean(), 0, 1e-3, "of which so many are not the same")
checks.finish()
