"""How two pictures differ."""
from __future__ import annotations

import os
from collections.abc import Sequence

from . import _core


def compare(a: str | os.PathLike[str] | _core.Image, b: str | os.PathLike[str] | _core.Image, *, fail: float | None = None,
            failpercent: float = 0, hardfail: float | None = None, layers: Sequence[str] | str | None = None) -> _core.Comparison:
    """Compares two pictures, each a file or an Image, as render-compare does.

    fail: a pixel fails if a channel differs by more; failpercent: the percentage of pixels that may; hardfail: no pixel may
    differ by more. Without them every bit counts. layers: patterns with * and ? of the channels that count. The result is
    true where the pictures pass. Raises FileError, ArgumentError.
    """
    first, second = (one if isinstance(one, _core.Image) else os.fspath(one) for one in (a, b))
    names = [] if layers is None else layers.split(",") if isinstance(layers, str) else list(layers)
    return _core.compare(first, second, fail, failpercent, hardfail, names)
