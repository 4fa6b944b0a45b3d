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
            (3, f"cut.stl: has {len(whole) - 30} bytes, but the 80 triangles", "cut.stl"), (3, "word.stl: cannot be read as an STL file", "word.stl"),
            (3, "empty.stl: no triangles", "empty.stl"), (3, "bad.obj:3: expected a number, found", "bad.obj"), (3, "flat.ply: has no triangle", "flat.ply"),
            (3, "a.png", "odd.obj"), (3, "none.obj", "none.obj"), (3, "none.stl", "none.stl"), (2, "a.fbx: must be a .ply, an .obj", "a.fbx"),
            (3, "kept: is there already", "good.stl", "--to", "kept"), (2, "did you mean --to", "good.stl", "--two", "x"),
            (2, "invalid choice: 'x'", "good.stl", "--up=x"), (3, "good.stl: File exists", "good.stl", "--to", "good.stl/x")):
        refused(tmp_path, code, message, *arguments)


def test_what_it_stands_on_is_named_where_it_lacks(tmp_path: Path, source: Path) -> None:
    (tmp_path / "a.stl").write_bytes(trimesh.creation.box().export(file_type="stl"))
    run = [sys.executable, "-c", "import sys; sys.modules['trimesh'] = None; from cistula.__main__ import main; sys.exit(main(['import', 'a.stl']))"]
    answer = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True)
    assert (answer.returncode, answer.stderr) == (2, "cistula import: STL files are read by trimesh, which is not there; pip install 'cistula[import]'\n")
    answer = subprocess.run([sys.executable, "-m", "cistula", "import", "a.stl"], cwd=tmp_path, env={"PYTHONPATH": str(source / "python")},
                            capture_output=True, text=True)
    assert answer.returncode == 2 and "the native module is not here" in answer.stderr
