"""Makes a scene of a mesh: a scene file that people can read and change, with meshes and textures beside it."""
from __future__ import annotations

import itertools
import json
import math
import os
import re
import shutil
import sys
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from cistula.command import Parser, Refused, shown
from cistula.stl import read_solids

Array = npt.NDArray[Any]
CLAY = {"color": 0.7}
SIZE, FOV = (1280, 720), 40.0
FORWARD_AND_UP = {"y": ((0, 0, -1), (0, 1, 0)), "z": ((0, 1, 0), (0, 0, 1))}  # the ways that a front view and its top look


@dataclass
class Part:
    """Triangles of one material."""
    name: str
    vertices: Array  # N x 3
    triangles: Array  # M x 3
    uvs: Array | None = None  # N x 2, v = 0 is the top of a picture
    material: str = ""
    keys: dict[str, Any] | None = None  # of the material; None: the file says nothing of it
    map: str = ""  # the picture of its color, as the file names it
    normals: Array | None = None  # N x 3; zeros where the file has none

    def welded(self) -> Array:
        """Its triangles with one number for all vertices at a place."""
        places: Array = np.unique(self.vertices + 0.0, axis=0, return_inverse=True)[1].reshape(-1)[self.triangles]
        return places

    def is_closed(self) -> bool:
        """Whether each edge is that of two triangles."""
        corners = self.welded()
        edges = np.sort(np.concatenate([corners[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
        return bool(np.all(np.unique(edges, axis=0, return_counts=True)[1] == 2))

    def ply(self) -> bytes:
        """It as a binary PLY, in the vertices' own numbers: floats where those suffice."""
        columns, names = [self.vertices], ["x", "y", "z"]
        if self.uvs is not None:
            columns, names = [*columns, self.uvs * [1, -1] + [0, 1]], [*names, "u", "v"]
        if self.normals is not None:
            columns, names = [*columns, self.normals.astype("f4").astype(float)], [*names, "nx", "ny", "nz"]
        rows = np.hstack(columns)
        rows, inverse = np.unique(rows[self.triangles.reshape(-1)] + 0.0, axis=0, return_inverse=True)
        kind = "float" if np.array_equal(rows, rows.astype("f4"), equal_nan=True) else "double"
        faces = np.zeros(len(self.triangles), [("count", "u1"), ("corners", "<u4", 3)])
        faces["count"], faces["corners"] = 3, inverse.reshape(-1, 3)
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}", *(f"property {kind} {n}" for n in names),
                f"element face {len(faces)}", "property list uchar uint vertex_indices", "end_header", ""]
        return "\n".join(head).encode() + rows.astype("<f4" if kind == "float" else "<f8").tobytes() + faces.tobytes()


@dataclass
class Mesh:
    """What a file has."""
    parts: list[Part]
    warnings: list[str] = field(default_factory=list)
    files: list[str] = field(default_factory=list)

    def file_of(self, name: str) -> Path | None:
        """A picture beside the mesh, or beside one of its libraries."""
        names = (name, name.replace("\\", "/"))
        places = (Path(file).parent / n for file in self.files for n in names)
        return next((path for path in places if name and path.is_file()), None)


def read_stl(path: Path) -> Mesh:
    """Solids of an STL file. Raises Refused."""
    solids, remarks = read_solids(path)
    return Mesh([Part(name if len(solids) > 1 else path.stem, corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
                 for name, corners in solids], remarks)


def read_mesh(path: Path) -> Mesh:
    """What a PLY, OBJ or STL file has: parts of a material each. Raises Refused, cistula.Error."""
    kind = path.suffix.lower()
    if kind not in (".ply", ".obj", ".stl"):
        raise Refused(f"{shown(str(path))}: must be a .ply, an .obj or an .stl file; Blender and MeshLab export them")
    if kind == ".stl":
        return read_stl(path)
    from cistula import _core
    from cistula.scene import path_text
    found, remarks, files = _core.read_mesh(path_text("file", path))
    parts = [Part(path.stem if name == str(i) else name, vertices, triangles, uvs, material, keys, picture, normals)
             for i, (name, vertices, triangles, uvs, normals, keys, picture, material) in enumerate(found)]
    joined: dict[str, list[Part]] = {}
    for number, part in enumerate(parts):  # open parts of a material may close one another, as render has it
        joined.setdefault(str(number) if len(parts) == 1 or part.is_closed() else "open " + part.material, []).append(part)
    remarks = [re.sub(r"(?<=here: )'map_Kd'(, |$)|, 'map_Kd'", "", text) for text in remarks]  # here it has a meaning
    return Mesh([join(some) for some in joined.values()], [text for text in remarks if not text.endswith("here: ")], files)


def join(parts: list[Part]) -> Part:
    """Parts of a material as one, under the material's name."""
    first = parts[0]
    if len(parts) == 1:
        return first
    starts = np.cumsum([0] + [len(part.vertices) for part in parts])
    def stacked(of_parts: list[Array | None], columns: int) -> Array | None:
        if all(one is None for one in of_parts):
            return None
        return np.vstack([np.zeros((len(p.vertices), columns)) if one is None else one for p, one in zip(parts, of_parts)])

    uvs, normals = stacked([part.uvs for part in parts], 2), stacked([part.normals for part in parts], 3)
    return Part(first.material or first.name, np.vstack([part.vertices for part in parts]),
                np.vstack([part.triangles.astype(np.int64) + start for part, start in zip(parts, starts)]), uvs, first.material,
                first.keys, first.map, normals)


def unlike(name: str, others: dict[str, Any], fallback: str) -> str:
    """A name that none of the others has."""
    name = name or fallback
    return next(n for n in itertools.chain([name], (f"{name} {i}" for i in itertools.count(2))) if n not in others)


def file_name(name: str, suffix: str, others: dict[str, bytes]) -> str:
    """A name for a file, of plain characters, that no other has, small and large letters being alike."""
    plain = re.sub(r"[^\w.-]+", "_", name, flags=re.ASCII)[:60].strip("._") or "part"
    taken = {other.lower() for other in others}
    return next(n for i in itertools.count(1) if (n := plain + f"_{i}" * (i > 1) + suffix).lower() not in taken)


def surroundings(points: Array, up_axis: str) -> dict[str, Any]:
    """A camera that frames the points, from the front right and above, a light over its shoulder and a floor under them."""
    forward, up = (np.array(v, float) for v in FORWARD_AND_UP[up_axis])
    right = np.cross(forward, up)
    low, high = points.min(axis=0), points.max(axis=0)
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    away = np.array([0.5, -1, 0.5]) / math.sqrt(1.5) @ np.stack([right, forward, up])
    across = np.cross(up, away) / np.linalg.norm(np.cross(up, away))
    x, y, z = np.stack([across, np.cross(away, across), away]) @ (points - middle).T
    tangent = math.tan(math.radians(FOV / 2))
    distance = 1.25 * max(np.max(z + np.abs(x) / tangent), np.max(z + np.abs(y) * SIZE[0] / SIZE[1] / tangent))
    digits = 4 - math.floor(math.log10(radius))

    def rounded(point: Array) -> list[float]:
        return [round(float(p), digits) + 0.0 for p in point]
    ground = middle + up * ((low - middle) @ up - radius / 1000)  # so that nothing nearly touches it
    corners = [rounded(ground + 4 * radius * (a * right + b * forward)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return {"camera": {"position": rounded(middle + distance * away), "target": rounded(middle), "up": [int(u) for u in up], "fov": FOV},
            "floor": corners, "light": rounded(middle + radius * (np.array([-2, -3, 4]) @ np.stack([right, forward, up])))}


def scene_of(mesh: Mesh, source: str, up_axis: str) -> tuple[dict[str, Any], dict[str, bytes]]:
    """The scene, and the files that it names. Raises Refused."""
    used = np.vstack([part.vertices[part.triangles.reshape(-1)] for part in mesh.parts])
    used = used[np.isfinite(used).all(axis=1)]
    if not len(used) or not np.ptp(used, axis=0).any():
        raise Refused(f"{shown(source)}: has no triangle with an area", 3)
    size, reach = np.ptp(used, axis=0).max(), np.abs(used).max()
    if not (1e-29 <= size and reach <= 1e29):  # what a camera around it may say
        raise Refused(f"{shown(source)}: is {size:.3g} in size with coordinates up to {reach:.3g}; a scene takes sizes from 1e-29, "
                      "coordinates to 1e29: scale it", 3)
    around = surroundings(used, up_axis)
    files: dict[str, bytes] = {}
    textures: dict[str, Any] = {}
    materials: dict[str, Any] = {}
    objects: dict[str, Any] = {}
    names: dict[str, str] = {}  # of materials in the scene, by those in the file
    pictures: dict[Path, str] = {}
    floor = {"color": 0.5, "reflection": 0.1}
    for part in mesh.parts:
        name = names.get(part.material) or unlike(part.material, materials, "clay")
        if part.material not in names:
            keys: dict[str, Any] = dict(CLAY) if part.keys is None else {"color": 0.8, **part.keys}
            if "specular" not in keys:
                keys.pop("exponent", None)
            if picture := mesh.file_of(part.map):
                if picture not in pictures:
                    pictures[picture] = unlike(picture.stem, textures, "texture")
                    copy = file_name(picture.stem, picture.suffix.lower(), files)
                    files[copy] = picture.read_bytes()
                    textures[pictures[picture]] = {"file": copy}
                keys["texture"] = pictures[picture]
            names[part.material], materials[name] = name, keys
        if "texture" in materials[name] and part.uvs is None:
            part.uvs = np.zeros((len(part.vertices), 2))
        object_name = unlike(part.name, objects, "object")
        file = file_name(object_name, ".ply", files)
        files[file] = part.ply()
        objects[object_name] = {"name": object_name, "mesh": file, "material": name}
    ground, under = unlike("floor", materials, ""), unlike("floor", objects, "")
    scene: dict[str, Any] = {
        "$comment": f"Made of {Path(source).name} by cistula import; lengths are the file's.",
        "film": {"width": SIZE[0], "height": SIZE[1], "supersample": 2}, "depth": 8, "ambient": 0.3, "background": 0.1,
        "camera": around["camera"], "textures": textures, "materials": {**materials, ground: floor},
        "objects": [{"name": under, "quad": around["floor"], "material": ground}, *objects.values()],
        "lights": [{"position": around["light"], "color": 0.8}]}
    return {key: value for key, value in scene.items() if value != {}}, files


def text_of(scene: dict[str, Any]) -> str:
    """A scene as JSON, a line for each material, texture, object and light."""
    def lines(value: Any) -> str:
        if isinstance(value, list):
            return "[\n" + ",\n".join(" " * 8 + json.dumps(v, ensure_ascii=False) for v in value) + "\n    ]"
        inner = (f"{' ' * 8}{json.dumps(k, ensure_ascii=False)}: {json.dumps(v, ensure_ascii=False)}" for k, v in value.items())
        return "{\n" + ",\n".join(inner) + "\n    }"
    nested = ("textures", "materials", "objects", "lights")
    rows = (f"    {json.dumps(k)}: {lines(v) if k in nested else json.dumps(v, ensure_ascii=False)}" for k, v in scene.items())
    return "{\n" + ",\n".join(rows) + "\n}\n"


def checked(folder: Path, file: Path) -> list[str]:
    """Reads a scene in a folder that is yet to get its name; the warnings. Raises cistula.Error."""
    import cistula
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cistula.Scene.load(folder / file).warnings


def main(arguments: Sequence[str]) -> int:
    parser = Parser("import", description=__doc__, epilog="""examples:
  cistula import statue.obj                      makes statue/statue.json, its meshes and textures
  cistula import part.stl --to scenes/part
  render scenes/part/part.json -o part.exr --preview part.png

exit codes: 0 done, 2 command line or scene, 3 file""")
    add = parser.add_argument
    add("file", metavar="FILE", help="a PLY, an OBJ with its material libraries, or an STL")
    add("--to", metavar="DIR", help="the folder that is made; FILE's name, in the working directory")
    add("--up", choices=("y", "z"), help="the axis that is up; y for an OBJ, else z")
    add("-q", "--quiet", action="store_true", help="errors only")
    options = parser.parse(arguments)
    source = Path(options.file)
    folder = Path(options.to or source.stem)
    if os.path.lexists(folder):
        raise Refused(f"{shown(str(folder))}: is there already, and nothing is overwritten; remove it, or name another by --to", 3)
    try:
        import cistula
        cistula.Scene
    except ImportError as error:
        raise Refused(str(error)) from None
    name = Path(file_name(source.stem, ".json", {}))
    part = None
    try:
        mesh = read_mesh(source)
        scene, files = scene_of(mesh, str(source), options.up or ("y" if source.suffix.lower() == ".obj" else "z"))
        files[str(name)] = text_of(scene).encode()
        folder.absolute().parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=".", suffix=".part", dir=folder.absolute().parent))
        for file, data in files.items():
            (part / file).write_bytes(data)
        remarks = [text.replace(str(part), str(folder)) for text in mesh.warnings + checked(part, name)]
        umask = os.umask(0)
        os.umask(umask)
        part.chmod(0o777 & ~umask)
        part.rename(folder)
    except cistula.Error as error:
        raise Refused(str(error).replace(str(part), str(folder)), 2 if isinstance(error, cistula.SceneError) else 3) from None
    finally:
        if part:
            shutil.rmtree(part, ignore_errors=True)
    if not options.quiet:
        for text in remarks:
            print(f"cistula import: warning: {shown(text)}", file=sys.stderr)
        print(f"{shown(str(folder / name))}: {len(scene['objects']) - 1} meshes, {len(scene['materials']) - 1} materials, "
              f"{len(scene.get('textures', ()))} textures")
    return 0
