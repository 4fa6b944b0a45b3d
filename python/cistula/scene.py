"""Scenes: read, built of arrays, rendered, asked what their rays meet."""
from __future__ import annotations

import json
import math
import operator
import os
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _core, pixel, textures
from .errors import ArgumentError, SceneError

if TYPE_CHECKING:
    from typing_extensions import Unpack

Progress = Callable[[float], object]


class Settings(TypedDict, total=False):
    """How frames are rendered: the options of `render` by their names in suite.json, with their ranges; None or left out: as
    the scene says."""

    size: tuple[int, int] | str | None  # width and height of the full frame, in pixels
    crop: tuple[int, int, int, int] | str | None  # width, height, x, y of the pixels to render, from the top left
    supersample: int | None  # k: k x k samples a pixel
    depth: int | None  # surfaces shaded along a path
    cutoff: float | None  # radiance that dropping faint branches may cost a pixel
    target_error: float | None  # radiance by which a pixel may be wrong: samples and branches as needed
    max_samples: int | None  # with target_error: samples of a pixel
    effects: str | None  # "auto" or "all"
    threads: int | None  # all by default
    lanes: int | None  # rays that a CPU thread traces at once, at most
    bits: str | None  # "float" or "half"
    layers: Sequence[str] | str | None  # "Z", "id", "path", "light", "data", "cryptomatte", ...
    z_far: float | str | None  # the depth of nothing
    background: str | None  # "opaque" or "transparent"
    colorspace: str | None  # of R, G, B and error: "lin_ap1_scene", ...
    compression: str | None  # of the EXR
    dwa_level: float | None
    backend: str | None  # "embree" or "cuda"
    devices: Sequence[int] | str | None  # with backend="cuda": GPUs that share every frame


def _text(name: str, value: object) -> str:
    """A value as the table of keys reads it."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, Iterable):
        parts = [_text(name, part) for part in value]
        if name not in ("size", "crop"):
            return ",".join(parts)
        return "x".join(parts[:2]) + "".join("+" + part for part in parts[2:])
    raise ArgumentError(f"{name}={value!r}: must be a text, a number or several of them")


def keywords(settings: Mapping[str, object]) -> list[tuple[str, str]]:
    return [(name, _text(name, value)) for name, value in settings.items() if value is not None]


def _whole(name: str, value: object) -> int:
    try:
        return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentError(f"{name}={value!r}: must be a whole number", argument=name) from None


def path_text(name: str, path: str | os.PathLike[str], errors: str = "strict") -> str:
    """A file's name as the library takes it; errors: "surrogateescape" where its bytes need not be UTF-8. Raises ArgumentError for
    a zero byte, which would cut it, and for what has no bytes."""
    text = os.fsdecode(path)
    if "\0" in text:
        raise ArgumentError(f"{name}={text!r}: a zero byte is in the name; give the name of a file", argument=name)
    try:
        text.encode("utf-8", errors)
    except UnicodeEncodeError:
        raise ArgumentError(f"{name}={text!r}: the name is not UTF-8; give a name that is", argument=name) from None
    return text


def _points(name: str, values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    array = np.asarray(values)
    if array.dtype.kind not in "fiu" or array.shape[-1:] != (3,) or array.ndim > 2:
        raise ArgumentError(f"{name}: must be N x 3 numbers, not {array.dtype} of shape {array.shape}")
    return np.ascontiguousarray(np.atleast_2d(array), dtype=np.float64)


def _pairs(name: str, first: npt.ArrayLike, other: str, second: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    a, b = _points(name, first), _points(other, second)
    if len(a) != len(b) and 1 not in (len(a), len(b)):
        raise ArgumentError(f"{other}: has {len(b)} rows, {name} {len(a)}; must have as many, or one for all")
    n = len(b) if len(a) == 1 else len(a)
    return np.ascontiguousarray(np.broadcast_to(a, (n, 3))), np.ascontiguousarray(np.broadcast_to(b, (n, 3)))


def _plain(value: object, pointer: str) -> Any:
    """A scene's value with lists and numbers of Python for those of NumPy. Raises SceneError with the place."""
    if isinstance(value, (str, bool, int)) or value is None:
        return value
    if isinstance(value, np.ndarray):
        return _plain(value.tolist(), pointer)
    if isinstance(value, np.generic):
        return _plain(value.item(), pointer)
    if isinstance(value, float) and math.isfinite(value):
        return value
    if isinstance(value, Mapping) and all(isinstance(key, str) for key in value):
        return {key: _plain(part, pointer + "/" + key.replace("~", "~0").replace("/", "~1")) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part, f"{pointer}/{i}") for i, part in enumerate(value)]
    raise SceneError(f"dict: {pointer or '/'}: expected what JSON has, found {value!r}", "dict", pointer)


class _Film(Iterator[_core.Image]):
    """Frames, one after the other, of which several threads may take."""

    def __init__(self, run: _core.Frames, progress: Progress | None) -> None:
        self._run, self._progress, self._turn = run, progress, threading.RLock()

    def __next__(self) -> _core.Image:
        with self._turn:
            image = self._run.next(self._progress)
        if image is None:
            raise StopIteration
        return image


class Scene:
    """A compiled scene, immutable. Made by Scene.load, Scene.from_dict and SceneBuilder.

    Several threads may use one at the same time.
    """

    def __init__(self, description: _core.Description, precision: str | None, max_texture_gb: float | None) -> None:
        textures.read_others(description)
        self._core = _core.CompiledScene(description, keywords({"precision": precision, "max_texture_gb": max_texture_gb}))
        for warning in self._core.warnings:
            warnings.warn(warning, stacklevel=3)

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, precision: str | None = None, max_texture_gb: float | None = None) -> Scene:
        """Reads a scene file, JSON or the text input, and compiles it.

        precision: "float", "double" or "auto", the default: double where a part of the scene is too small for float.
        Raises SceneError with the place, FileError. Remarks are Python warnings.
        """
        return cls(_core.Description.read(path_text("path", path)), precision, max_texture_gb)

    @classmethod
    def from_dict(cls, scene: Mapping[str, object], *, folder: str | os.PathLike[str] = "", precision: str | None = None,
                  max_texture_gb: float | None = None) -> Scene:
        """Compiles a scene that is a dict as its JSON would be; arrays of NumPy may stand for lists.

        folder: what names of files in it are relative to. Raises SceneError, whose `pointer` is the place.
        """
        return SceneBuilder(scene, folder=folder).build(precision=precision, max_texture_gb=max_texture_gb)

    @property
    def source(self) -> str:
        """The file that it was read from, or "dict"."""
        return self._core.source

    @property
    def objects(self) -> list[str]:
        """The names of objects, by their numbers."""
        return self._core.objects

    @property
    def materials(self) -> list[str]:
        """The names of materials, by their numbers."""
        return self._core.materials

    @property
    def lights(self) -> list[str]:
        """The names of lights, by their numbers."""
        return self._core.lights

    @property
    def warnings(self) -> list[str]:
        """What may be wrong with the scene, and why its precision is double."""
        return self._core.warnings

    @property
    def precision(self) -> str:
        """ "float" or "double": what rays are traced in."""
        return self._core.precision

    @property
    def frames(self) -> int:
        """How many frames its film has."""
        return self._core.frames

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of its film in pixels."""
        return self._core.size

    @property
    def hash(self) -> str:
        """What tells it from other scenes: a hash of all that affects its images but camera and settings."""
        return self._core.hash(0)

    def effects(self) -> list[str]:
        """The effects that it calls for (docs/effects.md)."""
        return self._core.effects()

    def __repr__(self) -> str:
        return f"<cistula.Scene {self.source}: {len(self.objects)} objects, {len(self.lights)} lights, {self.precision}>"

    def render(self, *, frame: int = 0, progress: Progress | None = None, **settings: Unpack[Settings]) -> _core.Image:
        """Renders a frame: the picture that `render` writes, bit for bit.

        settings: see cistula.Settings. progress: called with the share that is done, 0 to 1, some 20 times a second; what it
        raises ends the render and comes out here, and so does Ctrl-C. What `render` warns of is a Python warning. Raises
        ArgumentError, DeviceError, FrameError.
        """
        image = _core.Frames(self._core, [_whole("frame", frame)], keywords(settings)).next(progress)
        assert image is not None
        return image

    def film(self, frames: Iterable[int] | None = None, *, progress: Progress | None = None,
             **settings: Unpack[Settings]) -> Iterator[_core.Image]:
        """Renders frames, all of the scene's by default, each when it is asked for: `for image in scene.film(range(300)):`.

        As render() otherwise; a GPU begins the next ones early.
        """
        numbers = [_whole("frames", number) for number in (range(self.frames) if frames is None else frames)]
        return _Film(_core.Frames(self._core, numbers, keywords(settings)), progress)

    def pixel(self, x: int, y: int, *, sample: int | str = "middle", frame: int = 0, size: tuple[int, int] | str | None = None,
              supersample: int | None = None, depth: int | None = None, cutoff: float | None = None) -> pixel.Pixel:
        """The ray trees of pixel (x, y), from the top left of the full frame; `rays` of the sample nearest to its center, or of
        the one of this number."""
        settings = {"size": size, "supersample": supersample, "depth": depth, "cutoff": cutoff}
        report = _core.PixelReport(self._core, _whole("x", x), _whole("y", y), _whole("frame", frame), keywords(settings))
        return pixel.of_report(report, x, y, sample)

    def intersect(self, origins: npt.ArrayLike, directions: npt.ArrayLike, *, threads: int | None = None,
                  backend: str | None = None, devices: Sequence[int] | str | None = None) -> _core.Hits:
        """What rays meet first.

        origins, directions: N x 3 numbers, or 3 for all rays, in scene units; directions have any length. float64 that lies
        in one piece is not copied. In any order the same bits. Visible lights are not met. Where a ray starts on a face,
        rounding decides whether it meets that: start it a little off. A ray from far outside of the scene is met as if it began
        where it enters the scene's bounds. Raises ArgumentError with the number of a ray that is not finite or has no direction.
        """
        given = keywords({"threads": threads, "backend": backend, "devices": devices})
        return self._core.intersect(*_pairs("origins", origins, "directions", directions), given)

    def transmittance(self, origins: npt.ArrayLike, targets: npt.ArrayLike, *, threads: int | None = None,
                      backend: str | None = None, devices: Sequence[int] | str | None = None) -> npt.NDArray[np.float64]:
        """The share of light, N x 3, that passes straight from points to others, as shadow rays go.

        origins, targets: N x 3 numbers, or 3 for all, in scene units.
        """
        given = keywords({"threads": threads, "backend": backend, "devices": devices})
        return self._core.transmittance(*_pairs("origins", origins, "targets", targets), given)


class SceneBuilder:
    """A scene of a dict, to which meshes and textures are added as arrays. Keeps copies of all that is given.

    >>> b = SceneBuilder({"materials": {"clay": {"color": 0.7}}, "lights": [{"position": [4, -4, 8]}]})
    >>> b.mesh("torus", vertices, triangles, material="clay")
    >>> scene = b.build()
    """

    def __init__(self, scene: Mapping[str, object], *, folder: str | os.PathLike[str] = "") -> None:
        self._scene: dict[str, Any] = _plain(scene, "")
        self._folder = path_text("folder", folder)
        self._meshes: dict[int, tuple[Any, Any, Any, Any]] = {}
        self._textures: dict[str, Any] = {}

    def mesh(self, name: str, vertices: npt.ArrayLike, triangles: npt.ArrayLike, uvs: npt.ArrayLike | None = None, *,
             material: str, normals: npt.ArrayLike | None = None, **keys: object) -> SceneBuilder:
        """Adds an object after those that there are, and returns the builder.

        vertices: N x 3 numbers in scene units; triangles: M x 3 whole numbers, indices of vertices; uvs: N x 2, v = 0 is the top
        of a texture; normals: N x 3, outward, of any length: the mesh is smooth. keys: what meshes have in scene files, such as
        center, scale, rotate and smooth.
        """
        corners = np.array(triangles)
        if corners.dtype.kind not in "iu" or corners.ndim != 2 or corners.shape[1] != 3:
            raise ArgumentError(f"triangles: must be M x 3 whole numbers, not {corners.dtype} of shape {corners.shape}")
        points = _points("vertices", np.array(vertices))
        if corners.size and not (0 <= corners.min() and corners.max() < len(points)):
            raise ArgumentError(f"triangles: must be 0 to {len(points) - 1}, the last of the vertices; "
                                f"they are {corners.min()} to {corners.max()}")
        places = None if uvs is None else np.array(uvs)
        if places is not None and (places.dtype.kind not in "fiu" or places.shape != (len(points), 2)):
            raise ArgumentError(f"uvs: must be {len(points)} x 2 numbers, one for each vertex, not {places.dtype} of shape {places.shape}")
        if places is not None:
            places = np.ascontiguousarray(places, dtype=np.float64)
        ways = None if normals is None else _points("normals", np.array(normals))
        if ways is not None and len(ways) != len(points):
            raise ArgumentError(f"normals: must be {len(points)} x 3 numbers, one for each vertex, not {len(ways)}")
        objects = self._scene.setdefault("objects", [])
        self._meshes[len(objects)] = (points, np.ascontiguousarray(corners, dtype=np.uint32), places, ways)
        objects.append({"name": name, "mesh": "array.ply", "material": material, **_plain(keys, f"/objects/{len(objects)}")})
        return self

    def texture(self, name: str, array: npt.ArrayLike, **keys: object) -> SceneBuilder:
        """Adds a texture, and returns the builder.

        array: H x W or H x W x C, row by row from the top left, of uint8 or uint16, whose largest is white and which are sRGB, or
        of floats, which are linear; the first three channels are red, green and blue, one is gray. keys: what textures have in
        scene files: colorspace, filter, repeat, strict.
        """
        texels = np.array(array)
        if texels.dtype.kind == "f":
            texels = texels.astype(np.float32)
        if texels.ndim not in (2, 3) or texels.dtype not in (np.uint8, np.uint16, np.float32):
            raise ArgumentError(f"array: must be H x W or H x W x C of uint8, uint16 or floats, not {texels.dtype} of shape "
                                f"{texels.shape}")
        self._textures[name] = np.ascontiguousarray(texels if texels.ndim == 3 else texels[..., None])
        self._scene.setdefault("textures", {})[name] = {"file": "array.exr", **_plain(keys, f"/textures/{name}")}
        return self

    def build(self, *, precision: str | None = None, max_texture_gb: float | None = None) -> Scene:
        """Compiles the scene, as Scene.from_dict does. The builder may be used on."""
        description = _core.Description.parse(json.dumps(self._scene), "dict", self._folder)
        for name, texels in self._textures.items():
            description.set_texels(name, texels)
        for number, mesh in self._meshes.items():
            description.set_mesh(number, *mesh)
        return Scene(description, precision, max_texture_gb)
