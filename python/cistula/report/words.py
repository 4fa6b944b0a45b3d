"""Numbers and settings as the report's page writes them."""
from __future__ import annotations

from math import floor, log10
from statistics import median
from typing import Any

from markupsafe import Markup

POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def plain(value: float, digits: int) -> str:
    """At most so many significant digits, without an exponent."""
    before = floor(log10(abs(value))) + 1 if value else 1
    text = f"{value:.{max(0, digits - before)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def number(value: float | str) -> str:
    """0.0012, 3.4·10⁻⁷; what JSON has no number for is there as its word."""
    if isinstance(value, str) or value is None:
        return value or "–"
    if value == 0 or 1e-3 <= abs(value) < 1e4:
        return plain(value, 4 if abs(value) >= 1000 else 3)
    exponent = floor(log10(abs(value)) + 1e-12)
    mantissa = plain(value / 10.0**exponent, 2)
    if mantissa == "10":
        mantissa, exponent = "1", exponent + 1
    return ("" if mantissa == "1" else mantissa + "·") + "10" + str(exponent).translate(POWERS)


def percent(share: float) -> str:
    return plain(100 * share, 2 if share < 0.1 else 3) + " %"


def milliseconds(value: float) -> str:
    return plain(value / 1000, 3) + " s" if value >= 1000 else plain(value, 3) + " ms"


def time(runs: list[float] | None) -> Markup:
    """The median, and the range in small print."""
    if not runs:
        return Markup("–")
    spread = f"<small>{milliseconds(min(runs))} to {milliseconds(max(runs))}</small>" if len(runs) > 1 else ""
    return Markup(milliseconds(median(runs)) + spread)


def setting(s: dict[str, Any]) -> str:
    if s["target_error"]:
        return f"target error {number(s['target_error'])}, {s['precision']}"
    cutoff = f"cutoff {number(s['cutoff'])}" if s["cutoff"] else "no cutoff"
    return f"{s['supersample']}×{s['supersample']} samples, depth {s['depth']}, {cutoff}, {s['precision']}"
