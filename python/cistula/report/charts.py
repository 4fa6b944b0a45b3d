"""Charts of the report as SVG that stands in a page, by matplotlib."""
from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Sequence
from typing import Any

import matplotlib
from markupsafe import Markup, escape
from matplotlib.axes import Axes as Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from .words import number

INK = "#010203"  # becomes the page's color of text
COLORS = ("#4a76dd", "#d9742b", "#2f9e6e", "#a95bb8", "#b08a1c", "#d0455a", "#7d8a9b")
STYLE: Any = {"svg.fonttype": "none", "svg.hashsalt": "cistula", "font.family": "DejaVu Sans", "font.size": 10, "axes.edgecolor": INK,
              "axes.labelcolor": INK, "text.color": INK, "xtick.color": INK, "ytick.color": INK, "axes.linewidth": 0.6, "axes.grid": True,
              "grid.color": COLORS[6], "grid.alpha": 0.3, "grid.linewidth": 0.5, "axes.axisbelow": True, "lines.linewidth": 1.5,
              "lines.markersize": 4.5, "legend.fontsize": 9.5, "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False}
WIDTH = 4.8  # inches of 72 units: at 390 pixels a unit is about one

Point = tuple[float, ...]  # x, y, and perhaps the least and the most y


class Drawing:
    """Axes one below the other, of such heights in inches, which share x. `words`: what it shows, for who does not see it."""

    def __init__(self, heights: Sequence[float], words: str) -> None:
        self._words = words
        with matplotlib.rc_context(STYLE):
            self._figure = Figure(figsize=(WIDTH, sum(heights)), layout="constrained")
            grid = self._figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=list(heights))
            self.axes: list[Axes] = list(grid[:, 0])

    def svg(self, legend: Axes | None = None) -> Markup:
        """The drawing, with the legend of these axes below."""
        file = io.StringIO()
        with matplotlib.rc_context(STYLE):
            if legend:
                self._figure.legend(*legend.get_legend_handles_labels(), loc="outside lower center", ncol=3, columnspacing=1)
            self._figure.savefig(file, format="svg", transparent=True, metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
        text = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>|\s+(?=\n)", "", file.getvalue(), flags=re.DOTALL)
        prefix = hashlib.sha256(text.encode() + self._words.encode()).hexdigest()[:6] + "-"  # names are one page's
        text = re.sub(r'<g id="[^"]*"', "<g", text).replace("xlink:href", "href").replace(INK, "currentColor")
        text = re.sub(r'( id="|url\(#|href="#)', r"\g<1>" + prefix, text.replace("'DejaVu Sans'", "system-ui"))
        head = f'<svg class="chart" role="img" aria-label="{escape(self._words)}" '
        return Markup(re.sub(r'.*?<svg [^>]*?(viewBox="[^"]*")[^>]*>', lambda m: head + m[1] + ">", text, count=1, flags=re.DOTALL))


def color(index: int) -> str:
    return COLORS[min(index, len(COLORS) - 1)]


def scale(axis: Any, values: Sequence[float], label: str, log: bool = True) -> None:
    """Scales an axis for values, by the logarithm, if they have any, with ticks at 1, 2 and 5 where they span little."""
    axis.set_label_text(label)
    if log and values and min(values) > 0:
        axis._set_axes_scale("log")
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if max(values) < 50 * min(values) else (1,), numticks=8))
        axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
        axis.set_minor_locator(NullLocator())
    elif 0 < len(values) <= 8:
        axis.set_major_locator(FixedLocator(sorted(set(values))))


def dots(axes: Axes, points: Sequence[Point], index: int, marker: str = "o", hollow: bool = False, **more: Any) -> None:
    x, y = [p[0] for p in points], [p[1] for p in points]
    axes.plot(x, y, marker=marker, color=color(index), markerfacecolor="none" if hollow else color(index), **{"linestyle": "none", **more})


def line(axes: Axes, points: Sequence[Point], index: int, marker: str = "o", hollow: bool = False, label: str = "") -> None:
    """Points joined, dotted where they are hollow, with bars where they have a range."""
    if points and len(points[0]) > 2:
        x, _, low, high = zip(*points)
        axes.vlines(x, low, high, colors=color(index), linewidth=1.2, alpha=0.6)
    dots(axes, points, index, marker, hollow, linestyle=":" if hollow else "-", label=label or "_")
