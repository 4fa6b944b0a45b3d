"""Cistula: an exact ray tracer; the same image, bit for bit, from the CPU and from the GPU.

>>> import cistula
>>> image = cistula.Scene.load("scenes/platonic.json").render(size=(1280, 720))
>>> image.save("platonic.exr"); image.preview("platonic.png")

docs/python.md tells more.
"""
from __future__ import annotations

from importlib.util import find_spec as _find_spec

if _find_spec("._core", __name__):
    from ._processor import require_main_interpreter, require_processor

    require_processor()
    require_main_interpreter()

    from ._core import CaseResult, ChannelDifference, Comparison, Hits, Image, backends, version as __version__
    from .comparison import compare, verify
    from .errors import ArgumentError, DeviceError, Error, FileError, FrameError, SceneError
    from .pixel import Light, Pixel, Ray, Surface
    from .scene import Scene, SceneBuilder, Settings
else:  # the folder of a checkout: `python3 -m cistula view` and `farm` need no module
    def _missing(name: str) -> object:
        if name not in __all__:
            raise AttributeError(name)
        raise ImportError(f"cistula.{name}: the native module is not here; `make wheel` or `make test` builds it")

    globals()["__getattr__"] = _missing

__all__ = ["ArgumentError", "CaseResult", "ChannelDifference", "Comparison", "DeviceError", "Error", "FileError", "FrameError",
           "Hits", "Image", "Light", "Pixel", "Ray", "Scene", "SceneBuilder", "SceneError", "Settings", "Surface", "__version__",
           "backends", "compare", "verify"]
