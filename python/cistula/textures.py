"""Textures that the library does not read itself, by the optional package OpenImageIO."""
from __future__ import annotations

from pathlib import PurePath

import numpy as np

from . import _core
from .errors import FileError

_SRGB = ("", "sRGB", "srgb_rec709_scene", "g22_rec709_scene", "Gamma2.2")
_LINEAR = ("", "linear", "lin_rec709", "lin_rec709_scene", "scene_linear")


def read_others(description: _core.Description) -> None:
    """Reads the textures of a description that are neither EXR nor .data, where this build leaves them to Python."""
    if _core.reads_all_pictures:
        return
    for name, file, colorspace in description.texture_files:
        if PurePath(file).suffix.lower() in (".exr", ".data", ".out"):
            continue
        try:
            import OpenImageIO as oiio
        except ImportError:
            raise FileError(f"{file}: textures other than EXR need the package OpenImageIO: pip install openimageio",
                            file) from None
        config = oiio.ImageSpec()
        config.attribute("oiio:UnassociatedAlpha", 1)
        picture = oiio.ImageInput.open(file, config)
        if picture is None:
            raise FileError(f"{file}: {oiio.geterror().strip()}", file)
        spec = picture.spec()
        kind = {"uint8": "uint8", "uint16": "uint16"}.get(str(spec.format), "float")
        said = spec.get_string_attribute("oiio:ColorSpace")
        if not colorspace and (spec.getattribute("ICCProfile") is not None or
                               said not in (_LINEAR if kind == "float" else _SRGB)):
            raise FileError(f"{file}: says of its colors what is not read here ({said or 'a profile'}); give the texture a "
                            "\"colorspace\"", file)
        texels = picture.read_image(kind)
        if texels is None:
            raise FileError(f"{file}: {picture.geterror().strip()}", file)
        description.set_texels(name, np.ascontiguousarray(texels))
