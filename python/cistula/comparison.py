"""How two pictures differ, and whether the renderer holds on this machine."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence

from . import _core
from .scene import keywords, path_text


def compare(a: str | os.PathLike[str] | _core.Image, b: str | os.PathLike[str] | _core.Image, *, fail: float | None = None,
            failpercent: float = 0, hardfail: float | None = None, allow_nonfinite: bool = False,
            layers: Sequence[str] | str | None = None) -> _core.Comparison:
    """Compares two pictures, each a file or an Image, as render-compare does.

    fail: a pixel fails if a channel differs by more; failpercent: the percentage of pixels that may; hardfail: no pixel may
    differ by more. Without them every bit counts. With them what is not finite fails, unless allow_nonfinite is true and both
    have it in the same places. layers: patterns with * and ? of the channels that count. The result is
    true where the pictures pass. Raises FileError, ArgumentError.
    """
    first, second = (one if isinstance(one, _core.Image) else path_text(name, one) for name, one in (("a", a), ("b", b)))
    names = [] if layers is None else layers.split(",") if isinstance(layers, str) else list(layers)
    return _core.compare(first, second, fail, failpercent, hardfail, allow_nonfinite, names)


def verify(quick: bool = False, *, cases: Sequence[str] | str = (), backend: str = "embree", precision: str | None = None,
           lanes: int | None = None, progress: Callable[[_core.CaseResult], object] | None = None) -> list[_core.CaseResult]:
    """Runs hard cases against closed forms on this machine, as render-verify does: `all(cistula.verify(quick=True))`.

    quick: fewer rays and smaller pictures, some two minutes; cases: names, their beginnings, or patterns with * and ?;
    backend: "embree", the CPU's intersectors, "cuda" or "all"; precision: "float" or "double", both by default; lanes: the most
    rays that are traced at once; progress: called with each result, and what it raises comes out here, as Ctrl-C does. Raises
    ArgumentError, DeviceError.
    """
    names = [cases] if isinstance(cases, str) else list(cases)
    return _core.verify(names, quick, backend, keywords({"precision": precision, "lanes": lanes}), progress)
