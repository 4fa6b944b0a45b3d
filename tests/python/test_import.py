"""`cistula import`: PLY, OBJ and STL become scenes that render, with the file's materials; what is wrong is told, and leaves nothing."""
from __future__ import annotations

import contextlib
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import cistula
from cistula.__main__ import main

trimesh = pytest.importorskip("trimesh")

CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
MTL = """newmtl red
Kd 0.8 0.1 0.1
map_Kd -mm 0 1 tiles.png
newmtl glass
Kd 1 1 1
Ni 1.5
d 0.1
Tf 0.9 1 0.9
illum 7
Ks 0.5 0.5 0.5
Ns 80
"""


def bring(folder: Path, *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error of `cistula import` in a folder."""
    out, error = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = main(["import", *arguments])
    return code, out.getvalue(), error.getvalue()


def brought(folder: Path, *arguments: str) -> Path:
    """The scene file that is made, without a warning."""
    code, out, error = bring(folder, *arguments)
    assert (code, error) == (0, "")
    return folder / out.partition(": ")[0]


def refused(folder: Path, code: int, message: str, *arguments: str) -> None:
    before = sorted(os.listdir(folder))
    found, out, error = bring(folder, *arguments)
    assert (found, out, error.count("\n")) == (code, "", 1), error
    assert error.startswith("cistula import: ") and message in error, error
    assert sorted(os.listdir(folder)) == before


def cube(at: float, backward: bool = False, faces: slice = slice(None)) -> str:
    """A unit cube, or some of its faces, in an OBJ, moved along x; its corners counted from the front or from the back."""
    count = 8 * int(at)  # corners before it
    corners = "".join(f"v {x + 2 * at} {y} {z}\nvt {x} {y}\n" for x, y, z in CUBE)
    numbers = [[i - 8 if backward else i + 1 + count for i in face] for face in FACES[faces]]
    return corners + "".join("f " + " ".join(f"{i}/{i}" for i in face) + "\n" for face in numbers)


@pytest.mark.parametrize("name", ["ball.stl", "text.stl", "ball.ply", "ball.obj"])
def test_a_mesh_becomes_a_scene_that_frames_it(tmp_path: Path, programs: Path, name: str) -> None:
    ball = trimesh.creation.icosphere(subdivisions=2, radius=30)
    ball.apply_translation([1000, -200, 50])
    if name == "text.stl":
        (tmp_path / name).write_text(trimesh.exchange.stl.export_stl_ascii(ball))
    else:
        ball.export(tmp_path / name)
    file = brought(tmp_path, name, "--to", "made")
    scene = cistula.Scene.load(file)
    assert scene.objects == ["floor", name[:4]]
    image = scene.render(size=(160, 90), supersample=1, layers="id")
    seen = image.id == 2
    assert 0.1 < seen.mean() < 0.6
    assert not (seen[0].any() or seen[-1].any() or seen[:, 0].any() or seen[:, -1].any())
    assert np.ptp(image["R"][seen]) > 0.2  # lit from a side
    assert scene.intersect([1000, -200, 50], [0.3, 0.2, 1]).crossing[0] == 2  # from inside: it is closed
    subprocess.run([programs / "render", file, "-q", "--res", "160x90", "--supersample", "1", "-o", tmp_path / "a.exr"], check=True)
    assert cistula.compare(scene.render(size=(160, 90), supersample=1), tmp_path / "a.exr")


def test_an_obj_renders_as_it_does_itself(tmp_path: Path) -> None:
    """Its numbers are no floats, its polygon is not convex, its corners are counted backward."""
    text = "v 0 0 0\nv 4.1 0 0\nv 4.1 4 0.7\nv 2 1.3 0\nv 0 4 0.1\nf -5 -4 -3 -2 -1\n" + cube(1, True)
    (tmp_path / "odd.obj").write_text(text)
    file = brought(tmp_path, "odd.obj")
    direct = json.loads(file.read_text())
    assert [one["material"] for one in direct["objects"]] == ["floor", "clay"]
    direct["objects"][1]["mesh"] = str(tmp_path / "odd.obj")
    pictures = [scene.render(size=(64, 36)) for scene in (cistula.Scene.load(file), cistula.Scene.from_dict(direct))]
    assert np.array_equal(pictures[0].rgb(), pictures[1].rgb())


def test_normals_of_an_obj(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=1)
    lines = ["v " + " ".join(map(str, v)) for v in ball.vertices] + ["vn " + " ".join(map(str, v)) for v in ball.vertices]
    lines += ["f " + " ".join(f"{i + 1}//{i + 1}" for i in f) for f in ball.faces]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    scene = cistula.Scene.load(brought(tmp_path, "ball.obj"))
    assert "smooth" in scene.effects() and not scene.warnings


def test_materials_and_textures_of_an_obj(tmp_path: Path) -> None:
    Image.fromarray(np.array([[[255, 255, 255], [0, 0, 0]]], np.uint8)).save(tmp_path / "tiles.png")
    (tmp_path / "cubes.mtl").write_text(MTL)
    (tmp_path / "cubes.obj").write_text("mtllib cubes.mtl\no box\nusemtl red\n" + cube(0) + "o pane\nusemtl glass\n" + cube(1, True))
    code, out, error = bring(tmp_path, "cubes.obj")
    assert (code, out) == (0, "cubes/cubes.json: 2 meshes, 2 materials, 1 textures\n")
    assert error == "cistula import: warning: mesh cubes.obj: ignored what has no meaning here: '-mm'\n"
    text = json.loads((tmp_path / "cubes/cubes.json").read_text())
    assert text["materials"]["red"] == {"color": [0.8, 0.1, 0.1], "texture": "tiles"}
    assert text["materials"]["glass"] == {"color": 1, "specular": 0.5, "exponent": 80, "reflection": pytest.approx(0.1),
                                          "transmission": 0.9, "tint": [0.9, 1, 0.9], "index": 1.5, "fresnel": True}
    assert text["camera"]["up"] == [0, 1, 0]  # as OBJ files have it
    assert sorted(os.listdir(tmp_path / "cubes")) == ["box.ply", "cubes.json", "pane.ply", "tiles.png"]
    scene = cistula.Scene.load(tmp_path / "cubes/cubes.json")
    assert scene.objects == ["floor", "box", "pane"] and not scene.warnings
    hits = scene.intersect([[0.3, 0.5, 5], [0.8, 0.5, 5]], [0, 0, -1])
    assert hits.uv == pytest.approx(np.array([[0.3, 0.5], [0.8, 0.5]]))
    assert scene.transmittance([2.5, 0.5, -5], [2.5, 0.5, 5])[0] == pytest.approx((0.9 * np.array([0.9, 1, 0.9])) ** 2)


def test_open_groups_of_glass_close_one_another(tmp_path: Path) -> None:
    halves = "o front\nusemtl glass\n" + cube(0, faces=slice(3)) + "o back\n" + cube(0, True, slice(3, 6))
    (tmp_path / "a.mtl").write_text(MTL.replace("map_Kd -mm 0 1 tiles.png\n", ""))
    (tmp_path / "a.obj").write_text("mtllib a.mtl\n" + halves)
    scene = cistula.Scene.load(brought(tmp_path, "a.obj", "--up=z"))
    assert scene.objects == ["floor", "glass"]
    assert scene.intersect([0.5, 0.5, 0.5], [0, 0, 1]).crossing[0] == 2


def test_names_of_any_characters(tmp_path: Path) -> None:
    (tmp_path / "ä b.obj").write_text("o floor\n" + cube(0) + "o ../x\n" + cube(1) + "o FLOOR\n" + cube(2), encoding="utf-8")
    file = brought(tmp_path, "ä b.obj")
    assert cistula.Scene.load(file).objects == ["floor 2", "floor", "../x", "FLOOR"]
    assert sorted(os.listdir(file.parent)) == ["FLOOR_2.ply", "b.json", "floor.ply", "x.ply"]


def test_what_is_wrong_is_told_and_leaves_nothing(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=1)
    whole = ball.export(file_type="stl")
    (tmp_path / "cut.stl").write_bytes(whole[:-30])
    text = trimesh.exchange.stl.export_stl_ascii(ball)
    (tmp_path / "word.stl").write_text(text.replace("vertex", "vertex x", 1))
    (tmp_path / "empty.stl").write_text("solid a\nendsolid a\n")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 x 0\nf 1 2 3\n")
    (tmp_path / "flat.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n")
    (tmp_path / "odd.obj").write_text("mtllib odd.mtl\nusemtl red\n" + cube(0))
    (tmp_path / "odd.mtl").write_text("newmtl red\nmap_Kd a.png\n")
    (tmp_path / "a.png").write_text("no picture")
    (tmp_path / "kept").mkdir()
    (tmp_path / "good.stl").write_bytes(whole)
    for code, message, *arguments in (
            (3, f"cut.stl: has {len(whole) - 30} bytes, but the 80 triangles", "cut.stl"), (3, "word.stl:4: expected three numbers", "word.stl"),
            (3, "empty.stl: no triangles", "empty.stl"), (3, "bad.obj:3: expected a number, found", "bad.obj"), (3, "flat.ply: has no triangle", "flat.ply"),
            (3, "a.png", "odd.obj"), (3, "none.obj", "none.obj"), (3, "none.stl", "none.stl"), (2, "a.fbx: must be a .ply, an .obj", "a.fbx"),
            (3, "kept: is there already", "good.stl", "--to", "kept"), (2, "did you mean --to", "good.stl", "--two", "x"),
            (2, "invalid choice: 'x'", "good.stl", "--up=x"), (3, "good.stl: File exists", "good.stl", "--to", "good.stl/x")):
        refused(tmp_path, code, message, *arguments)


def test_without_the_native_module_it_says_so(tmp_path: Path, source: Path) -> None:
    (tmp_path / "a.stl").write_bytes(b"")
    answer = subprocess.run([sys.executable, "-m", "cistula", "import", "a.stl"], cwd=tmp_path, env={"PYTHONPATH": str(source / "python")},
                            capture_output=True, text=True)
    assert answer.returncode == 2 and "the native module is not here" in answer.stderr


def stl_text(name: bytes = b"part", end: bytes = b"endsolid part\n") -> bytes:
    """A unit cube."""
    corners = [[CUBE[i] for i in three] for a, b, c, d in FACES for three in ((a, b, c), (a, c, d))]
    facets = ["facet normal 0 0 1\n outer loop\n" + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in t) + " endloop\nendfacet\n" for t in corners]
    return b"solid " + name + b"\n" + "".join(facets).encode() + end


def stl_binary(head: bytes = b"made", count: int = 12) -> bytes:
    corners = np.array([[CUBE[i] for i in three] for a, b, c, d in FACES for three in ((a, b, c), (a, c, d))], "<f4").reshape(12, 9)
    rows = np.zeros(12, [("normal", "<f4", 3), ("corners", "<f4", 9), ("color", "<u2")])
    rows["corners"] = corners
    return head.ljust(80) + count.to_bytes(4, "little") + rows.tobytes()


@pytest.mark.parametrize("data,said", [
    (stl_text().replace(b"\n", b"\r"), ""), (stl_text().replace(b"\n", b"\r\n"), ""), (b"\xef\xbb\xbf" + stl_text(), ""),
    (stl_text(b"caf\xe9 \x85 facet"), ""), (stl_text(b"endsolid"), ""), (stl_text(b""), ""), (stl_text().upper(), ""),
    (stl_text(end=b""), "ends without"), (stl_text().replace(b"normal 0 0 1", b""), ""), (stl_text().replace(b"0 0 1\n outer", b"-1.#IND nan x outer"), ""),
    (stl_text().replace(b"vertex 1 1", b"\tVertex\t+1.0e0\t10E-1"), ""), (stl_text().replace(b"\n  vertex", b" vertex").replace(b"\nendfacet", b" endfacet"), ""),
    (stl_text().replace(b"endfacet", b"endfacet\ncolor 1 0 0"), "'color'"[1:-1]), (stl_text() + b"\x1a\0\0", ""), (stl_text().decode().encode("utf-16"), ""),
    (stl_binary(), ""), (stl_binary(b"solid made"), ""), (stl_binary() + b"\n", "ignored 1 bytes"), (stl_binary() + bytes(300), "ignored 300 bytes")])
def test_stl_of_other_programs(tmp_path: Path, data: bytes, said: str) -> None:
    (tmp_path / "a.stl").write_bytes(data)
    code, out, error = bring(tmp_path, "a.stl")
    assert code == 0 and (said in error if said else not error), error
    scene = cistula.Scene.load(tmp_path / "a/a.json")
    assert scene.objects == ["floor", "a"]
    rays = np.vstack([np.eye(3), -np.eye(3)])
    hits = scene.intersect([0.5, 0.5, 0.5], rays)
    assert hits.distance == pytest.approx(np.full(6, 0.5)) and (hits.crossing == 2).all()  # closed: all six faces are there


def test_solids_of_an_stl_are_objects(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(stl_text(b"one") + stl_text(b"none\nendsolid none\nsolid tw\xf6").replace(b"vertex 1", b"vertex 3"))
    assert cistula.Scene.load(brought(tmp_path, "a.stl")).objects == ["floor", "one", "tw\xf6"]


@pytest.mark.parametrize("data,message", [
    (b"", "has 0 bytes"), (b"solid", "no triangles"), (b"solid advice\nis rare\n", "no triangles"), (stl_binary(count=13), "the 13 triangles"),
    (stl_binary(count=0), "the 0 triangles"), (stl_binary(count=11), "the 11 triangles"), (stl_binary(count=2**32 - 1), "the 4294967295 triangles"),
    (stl_binary(b"solid a")[:-1], "it is cut off"), (stl_binary()[:84], "it is cut off"), (stl_binary(count=0)[:84], "no triangles"), (stl_binary()[:40], "has 40 bytes"),
    (stl_text()[:stl_text().rindex(b"endloop")], "cut off"), (stl_text().replace(b"vertex 1 1 0", b"vertex 1,0 1 0", 1), "found '1,0 1 0'"), (stl_text().replace(b"vertex 1 1 0", b"vertex 1_0 1 0", 1), "a.stl:"),
    (stl_text().replace(b"vertex 1 1 0", b"vertex 1 1", 1), "expected three numbers"), (stl_text().replace(b"  vertex 1 1 0\n", b"", 1), "has 2 vertices"),
    (stl_text().replace(b" endloop", b"  vertex 0 0 9\n endloop", 1), "a.stl:8: a loop has 4 vertices"), (stl_text().replace(b" endloop\n", b"", 1), "within another"),
    (stl_text().replace(b" outer loop\n", b"", 1), "outside of a loop")])
def test_stl_that_is_wrong_is_told_in_a_line(tmp_path: Path, data: bytes, message: str) -> None:
    (tmp_path / "a.stl").write_bytes(data)
    refused(tmp_path, 3, message, "a.stl")


@pytest.mark.parametrize("size,message", [("1e38", "a scene takes sizes"), ("1e-38", "a scene takes sizes"), ("1e300", "a scene takes sizes"), ("1e-320", "a scene takes sizes"),
                                          ("1e28", ""), ("1e-20", "")])
def test_sizes_that_no_scene_has_are_told_in_a_line(tmp_path: Path, size: str, message: str) -> None:
    (tmp_path / "a.obj").write_text("".join(f"v {x}{size[1:]} {y}{size[1:]} {z}{size[1:]}\n" for x, y, z in CUBE)
                                    + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in FACES))
    if message:
        refused(tmp_path, 3, message, "a.obj")
    else:
        assert bring(tmp_path, "a.obj")[0] == 0
