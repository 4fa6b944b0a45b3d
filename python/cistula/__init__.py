"""Cistula: an exact ray tracer; the same image, bit for bit, from the CPU and from the GPU.

>>> import cistula
>>> image = cistula.Scene.load("scenes/platonic.json").render(size=(1280, 720))
>>> image.save("platonic.exr"); image.preview("platonic.png")

docs/python.md tells more.
"""
from __future__ import annotations

from ._processor import require_processor

require_processor()

from ._core import CaseResult, ChannelDifference, Comparison, Hits, Image, backends, version as __version__  # noqa: E402
from .comparison import compare, verify  # noqa: E402
from .errors import ArgumentError, DeviceError, Error, FileError, FrameError, SceneError  # noqa: E402
from .pixel import Light, Pixel, Ray, Surface  # noqa: E402
from .scene import Scene, SceneBuilder, Settings  # noqa: E402

__all__ = ["ArgumentError", "CaseResult", "ChannelDifference", "Comparison", "DeviceError", "Error", "FileError", "FrameError", "Hits",
           "Image", "Light", "Pixel", "Ray", "Scene", "SceneBuilder", "SceneError", "Settings", "Surface", "__version__",
           "backends", "compare", "verify"]
