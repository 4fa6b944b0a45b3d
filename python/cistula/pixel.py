"""A pixel's ray trees as values."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .errors import ArgumentError

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Light:
    """What one light gives to a surface. `fate`: adds, behind, nothing or shadow."""

    name: str
    fate: str
    distance: float  # scene units
    angle: float  # between normal and light, degrees
    arrives: Vector  # the share that arrives, per channel
    through: tuple[str, ...]  # objects on the way that attenuate it
    adds: Vector  # radiance


@dataclass(frozen=True)
class Surface:
    """Where a ray ends. `crossing`: enters, leaves or sheet."""

    object: str
    material: str
    face: int
    crossing: str
    point: Vector
    normal: Vector  # unit, toward the viewer
    color: Vector  # texture included
    angle: float  # between ray and normal, degrees
    index_before: float
    index_beyond: float
    total: bool  # total internal reflection
    local: float  # shares: of local light, of the mirrored ray, of the transmitted ray
    mirrored: float
    through: Vector
    ambient_adds: Vector  # radiance
    lights: tuple[Light, ...]


@dataclass(frozen=True)
class Ray:
    """One ray of a tree.

    kind: primary, mirrored or transmitted. end: surface, light, background, pruned, cut or dropped. Radiances are those of
    one sample, in the scene's units.
    """

    parent: int  # index in the list of rays; -1: none
    kind: str
    end: str
    depth: int  # surfaces above it
    weight: Vector
    arriving: Vector  # the weight after absorption on the way
    origin: Vector
    direction: Vector
    distance: float  # infinity: the background
    surface: Surface | None
    light: str | None  # the visible light that it ends on
    adds: Vector  # by itself
    adds_below: Vector  # by all rays below it
    error: Vector  # bound on what its pruning or cutting took
    error_below: Vector


def _ray(parent: int, kind: str, end: str, depth: int, weight: Vector, arriving: Vector, origin: Vector, direction: Vector,
         distance: float, surface: Any, *others: Any) -> Ray:
    met = None
    if surface is not None:
        *fields, lights = surface
        fields.append(tuple(Light(*light) for light in lights))
        met = Surface(*fields)
    return Ray(parent, kind, end, depth, weight, arriving, origin, direction, distance, met, *others)


@dataclass(frozen=True)
class Pixel:
    """The ray trees of a pixel: what `render --pixel` tells."""

    x: int
    y: int
    radiance: Vector  # as in the image
    error: Vector  # proven bound on what truncation took
    samples: int  # k x k
    rays: tuple[Ray, ...] = field(repr=False)  # of the sample asked for, parents first
    flaws: str  # why it cannot be trusted; empty: it can
    _report: Any = field(repr=False, compare=False)

    def sample(self, number: int) -> tuple[Ray, ...]:
        """The rays of a sample, by its number row by row."""
        if not 0 <= number < self.samples:
            raise IndexError(f"sample={number}: must be 0 to {self.samples - 1}")
        return tuple(_ray(*values) for values in self._report.rays(number))

    def text(self, verbose: bool = False) -> str:
        """What `render --pixel` prints; verbose: all samples, nothing folded."""
        return str(self._report.text(verbose))

    def json(self) -> str:
        """What `render --pixel --json` writes."""
        return str(self._report.json())


def of_report(report: Any, x: int, y: int, sample: int | str) -> Pixel:
    if sample != "middle" and not (isinstance(sample, int) and 0 <= sample < report.samples):
        raise ArgumentError(f"sample={sample!r}: must be \"middle\" or 0 to {report.samples - 1}")
    number = report.middle if sample == "middle" else sample
    rays = tuple(_ray(*values) for values in report.rays(number))
    return Pixel(x, y, report.radiance, report.error, report.samples, rays, report.flaws, report)
