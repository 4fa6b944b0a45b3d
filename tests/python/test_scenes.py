"""Scenes of dicts and arrays, and what is said where they or arguments are wrong."""
from __future__ import annotations

import json
import os
import pickle
import sys
import threading
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import cistula
from cistula import _core
from cistula._processor import lacking

CUBE = {"name": "cube", "solid": "cube", "material": "clay"}
SCENE: dict[str, Any] = {"film": {"width": 32, "height": 24}, "materials": {"clay": {"color": [0.8, 0.5, 0.3]}}, "objects": [CUBE],
                         "lights": [{"position": [4, -5, 6]}]}
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [0, 1, -1], [0, 0, 1]], float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_a_dict_is_its_json(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(json.dumps(SCENE))
    ours = cistula.Scene.from_dict({**SCENE, "lights": [{"position": np.array([4, -5, 6])}]})
    assert ours.hash == cistula.Scene.load(tmp_path / "scene.json").hash
    assert (ours.objects, ours.materials, ours.size, ours.frames, ours.precision) == (["cube"], ["clay"], (32, 24), 1, "float")
    assert "diffuse" in ours.effects() and "clay" in repr(ours.materials)


def test_arrays_give_what_files_of_the_same_numbers_give(tmp_path: Path) -> None:
    lines = ["v " + " ".join(map(str, v)) for v in CORNERS] + ["f " + " ".join(str(i + 1) for i in f) for f in FACES]
    (tmp_path / "tetrahedron.obj").write_text("\n".join(lines))
    file = {**SCENE, "objects": [CUBE, {"name": "t", "mesh": "tetrahedron.obj", "material": "clay", "center": [3, 0, 0]}]}
    built = cistula.SceneBuilder(SCENE).mesh("t", CORNERS, FACES, material="clay", center=(3, 0, 0)).build()
    assert built.objects == ["cube", "t"]
    assert built.render().hash == cistula.Scene.from_dict(file, folder=tmp_path).render().hash


def test_meshes_with_normals_are_smooth() -> None:
    def with_keys(**keys: Any) -> cistula.Scene:
        return cistula.SceneBuilder(SCENE).mesh("t", CORNERS, FACES, material="clay", **keys).build()

    flat, smooth = with_keys(), with_keys(normals=CORNERS)
    assert "smooth" in smooth.effects() and "smooth" not in flat.effects()
    assert with_keys(normals=CORNERS, smooth=False).hash == flat.hash
    assert "smooth" in with_keys(smooth=150).effects()
    with pytest.raises(cistula.ArgumentError, match="normals: must be 4 x 3 numbers, one for each vertex, not 3"):
        with_keys(normals=CORNERS[:3])
    with pytest.raises(cistula.SceneError, match="at 12 of 12 corners"):
        with_keys(normals=-CORNERS)


@pytest.mark.parametrize("kind", ["f4", "f8", "u1"])
def test_a_buffer_that_is_used_again_changes_nothing_that_was_added(kind: str) -> None:
    """Whatever its type: what is converted is a copy by itself, what is not is one, too."""
    scene = {**SCENE, "materials": {"clay": {"texture": "t"}}, "objects": []}
    texels = np.random.default_rng(5).integers(0, 256, (4, 4, 3)).astype(kind)
    arrays: list[Any] = [CORNERS.astype("f8"), FACES.astype("u4"), np.array([[0, 0], [1, 0], [0, 1], [1, 1]], "f8"),
                         CORNERS.astype("f8")]

    def built(change: Callable[[Any], None]) -> str:
        given, picture = [one.copy() for one in arrays], texels.copy()
        b = cistula.SceneBuilder(scene).mesh("t", *given[:3], material="clay", normals=given[3])
        b.texture("t", picture)
        for one in (*given[:4], picture):
            change(one)
        return b.build().hash

    def scribble(one: Any) -> None:
        one[:] = 7 * one[:]
        one[0] = 0
    assert built(scribble) == built(lambda one: None)


def test_textures_are_arrays() -> None:
    def with_texture(array: Any, **keys: object) -> np.ndarray[Any, Any]:
        scene = {**SCENE, "materials": {"floor": {"texture": "t"}}, "objects": [], "ambient": 1, "camera": {"position": [0, 0, 3],
                 "up": [0, 1, 0]}}
        quad = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]])
        b = cistula.SceneBuilder(scene).texture("t", array, **keys)
        b.mesh("floor", quad, [[0, 1, 2], [0, 2, 3]], uvs=[[0, 1], [1, 1], [1, 0], [0, 0]], material="floor")
        return b.build().render(size=(8, 6)).rgb()

    gray = np.full((2, 2), 128, np.uint8)
    assert np.array_equal(with_texture(gray), with_texture(np.repeat(gray[..., None], 3, axis=2)))
    assert with_texture(gray, colorspace="linear").mean() > 2 * with_texture(gray).mean()
    half = np.full((2, 2, 3), 0.5)
    assert np.array_equal(with_texture(half), with_texture(half.astype(np.float32)))
    corner = np.zeros((2, 2, 3))
    corner[0, 0] = 1  # the top left of the picture
    seen = with_texture(corner, filter="nearest")[..., 0] > 0.1
    assert seen[:3, :4].all() and not seen[3:].any() and not seen[:, 4:].any()


@pytest.mark.skipif(not _core.reads_all_pictures, reason="built without OpenImageIO")
@pytest.mark.parametrize("name,dtype,channels", [("a.png", "uint8", 3), ("gray.png", "uint8", 1), ("alpha.png", "uint8", 4),
                                                 ("deep.png", "uint16", 3), ("a.jpg", "uint8", 3), ("a.tif", "float32", 3)])
def test_textures_that_a_wheel_reads_are_those_of_the_library(name: str, dtype: str, channels: int, tmp_path: Path,
                                                              monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = np.random.default_rng(3).random((5, 7, channels)) * (1 if dtype == "float32" else np.iinfo(dtype).max)
    picture = oiio.ImageOutput.create(str(tmp_path / name))
    assert picture and picture.open(str(tmp_path / name), oiio.ImageSpec(7, 5, channels, dtype)) and picture.write_image(numbers.astype(dtype))
    picture.close()
    scene = {**SCENE, "textures": {"t": {"file": name}}, "materials": {"m": {"texture": "t"}},
             "objects": [{"name": "q", "quad": [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], "material": "m"}]}
    native = cistula.Scene.from_dict(scene, folder=tmp_path)
    monkeypatch.setattr(_core, "reads_all_pictures", False)
    ours = cistula.Scene.from_dict(scene, folder=tmp_path)
    assert ours.render().hash == native.render().hash
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    assert _core.run_program("render", [b"-q", b"-o", os.fsencode(tmp_path / "a.exr"), os.fsencode(tmp_path / "scene.json")]) == 0
    assert cistula.compare(tmp_path / "a.exr", native.render(), layers="R,G,B,A", fail=0)
    monkeypatch.setitem(sys.modules, "OpenImageIO", None)
    with pytest.raises(cistula.FileError, match="pip install openimageio"):
        cistula.Scene.from_dict(scene, folder=tmp_path)


def test_a_wrong_scene_is_told_by_its_pointer() -> None:
    with pytest.raises(cistula.SceneError) as error:
        cistula.Scene.from_dict({**SCENE, "objects": [{**CUBE, "solid": "cubee"}]})
    assert error.value.pointer == "/objects/0/solid" and "did you mean 'cube'" in str(error.value)
    with pytest.raises(cistula.SceneError, match="nan") as error:
        cistula.Scene.from_dict({**SCENE, "lights": [{"position": [0, float("nan"), 0]}]})
    assert error.value.pointer == "/lights/0/position/1"
    assert isinstance(error.value, ValueError) and pickle.loads(pickle.dumps(error.value)).pointer == error.value.pointer
    with pytest.raises(cistula.FileError, match="none.obj") as missing:
        cistula.Scene.from_dict({**SCENE, "objects": [{"name": "m", "mesh": "none.obj", "material": "clay"}]})
    assert missing.value.pointer == "/objects/0"
    with pytest.raises(cistula.SceneError) as error:
        cistula.SceneBuilder(SCENE).mesh("t", CORNERS, FACES, material="clya").build()
    assert error.value.pointer == "/objects/1/material"


def test_a_frame_that_is_refused_is_named() -> None:
    onto_the_ball = {"keys": [[0, [9, 0, 0]], [2, [1, 0, 0]], [3, [9, 0, 0]]], "interpolation": "step"}
    scene = {**SCENE, "objects": [{"solid": "sphere", "material": "clay"}], "lights": [{"position": onto_the_ball}]}
    frames: list[int] = []
    with pytest.raises(cistula.SceneError, match="^frame 2: .*the light lies on the surface") as error:
        frames.extend(image.frame for image in cistula.Scene.from_dict(scene).film(range(4), size=(8, 6)))
    assert frames == [0, 1] and error.value.pointer == "/lights/0"


def test_several_threads_take_all_frames_of_a_film() -> None:
    film, taken = cistula.Scene.from_dict(SCENE).film([0] * 40, size=(8, 6)), list[int]()
    threads = [threading.Thread(target=lambda: taken.extend(image.frame for image in film)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert taken == [0] * 40 and next(film, None) is None


def test_a_zero_byte_in_a_name_cuts_nothing(tmp_path: Path) -> None:
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(SCENE))
    image = cistula.Scene.load(os.fsencode(file)).render(size=(4, 3))  # type: ignore[arg-type]
    for name, call in (("path", lambda: cistula.Scene.load(f"{file}\0.png")), ("folder", lambda: cistula.Scene.from_dict(SCENE, folder="a\0b")),
                       ("a", lambda: cistula.compare(f"{file}\0.exr", image)), ("b", lambda: cistula.compare(image, f"{file}\0.exr"))):
        with pytest.raises(cistula.ArgumentError, match=f"^{name}=.*a zero byte is in the name") as error:
            call()
        assert isinstance(error.value, ValueError) and error.value.argument == name


def test_files_that_are_wrong(tmp_path: Path) -> None:
    with pytest.raises(cistula.FileError, match="nothing.json") as error:
        cistula.Scene.load("/nothing.json")
    assert isinstance(error.value, OSError)
    (tmp_path / "scene.json").write_text('{"depth": 4,}')
    with pytest.raises(cistula.SceneError, match=r"scene.json:1:\d+"):
        cistula.Scene.load(tmp_path / "scene.json")


@pytest.mark.parametrize("call,message", [
    (lambda s: s.render(depth=5000), "depth=5000: must be a whole number from 1 to 1024"),
    (lambda s: s.render(depth=2.5), "depth=2.5: must be a whole number"),
    (lambda s: s.render(size=(0, 3)), "size=0x3: must be WIDTHxHEIGHT"),
    (lambda s: s.render(crop=(10, 10, 500, 0)), "crop 10x10[+]500[+]0: leaves the frame, which is 32x24"),
    (lambda s: s.render(layers="ID"), "layers=ID: there is no layer 'ID'; the layers are: id"),
    (lambda s: s.render(max_samples=9), "max_samples 9: is for target_error"),
    (lambda s: s.render(target_error=0.1, cutoff=0.1), "target_error 0.1: cutoff has no place here"),
    (lambda s: s.render(bits="hlaf"), "bits=hlaf: must be float or half; did you mean 'half'"),
    (lambda s: s.render(devices=[1]), "devices=1: "),
    (lambda s: s.render(frame=-1), "frame=-1: must be 0 or more"),
    (lambda s: s.render(frame=1.5), "frame=1.5: must be a whole number"),
    (lambda s: s.pixel(1, 2.5), "y=2.5: must be a whole number"),
    (lambda s: s.pixel(1, 2, sample=9), 'sample=9: must be "middle" or 0 to 0'),
    (lambda s: s.render().save("a.png"), "path=a.png: must be named [*].exr"),
    (lambda s: s.render().preview("a.jpg"), "path=a.jpg: must be named [*].png"),
    (lambda s: cistula.compare(s.render(), s.render(), fail=float("nan")), "fail=nan: must be a number from 0 to inf"),
    (lambda s: cistula.compare(s.render(), s.render(), failpercent=120, fail=1), "failpercent=120: must be a number from 0 to 100"),
    (lambda s: cistula.compare(s.render(), s.render(), failpercent=3), "failpercent=3: is for fail"),
    (lambda s: s.pixel(32, 0), "x=32, y=0: is outside of the frame, which is 32x24"),
    (lambda s: s.intersect([0, 0], [1, 0]), "origins: must be N x 3 numbers"),
    (lambda s: s.intersect(np.zeros((2, 3)), np.ones((3, 3))), "directions: has 3 rows, origins 2"),
    (lambda s: s.intersect([0, 0, 5], [[0, 0, 1], [0, 0, 0]]), "ray 1: needs"),
    (lambda s: cistula.SceneBuilder(SCENE).mesh("m", CORNERS, [[0, 1, 4]], material="clay"), "triangles: must be 0 to 3"),
    (lambda s: cistula.SceneBuilder(SCENE).mesh("m", CORNERS, [[0, 1, 0.5]], material="clay"), "triangles: must be M x 3 whole"),
    (lambda s: cistula.SceneBuilder(SCENE).texture("t", np.zeros((2, 2), int)), "array: must be H x W"),
    (lambda s: cistula.Scene.from_dict(SCENE, precision="half"), "precision=half: must be auto or float or double"),
])
def test_arguments_are_named_with_what_would_be_right(call: Callable[[cistula.Scene], object], message: str) -> None:
    with pytest.raises(cistula.ArgumentError, match=message):
        call(cistula.Scene.from_dict(SCENE))


def test_an_unknown_argument_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="no argument 'dpeth'; did you mean 'depth'"):
        cistula.Scene.from_dict(SCENE).render(dpeth=3)  # type: ignore[call-arg]


@pytest.mark.skipif("cuda" in cistula.backends(), reason="built with CUDA")
def test_a_backend_that_is_not_there() -> None:
    with pytest.raises(cistula.DeviceError, match="no CUDA backend"):
        cistula.Scene.from_dict(SCENE).render(backend="cuda")


def test_renders_warn_as_render_does(source: Path) -> None:
    scene = cistula.Scene.load(source / "scenes/glass.json")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        scene.render(size=(32, 18))
        assert not said, "nothing is lost at the scene's own depth"
        scene.render(size=(32, 18), depth=1)
        list(scene.film(range(3), size=(32, 18), depth=1))
    alone, film = (str(one.message) for one in said)
    assert "glass.json: depth 1 may have taken up to " in alone
    assert "glass.json: in 3 of 3 frames, most in frame " in film
    assert all(one.filename == __file__ for one in said)


def test_remarks_on_scenes_are_warnings() -> None:
    tiny = {"name": "tiny", "solid": "cube", "radius": 1e-6, "center": [3, 0, 0], "material": "clay"}
    with pytest.warns(UserWarning, match="double"):
        scene = cistula.Scene.from_dict({**SCENE, "objects": [CUBE, tiny]})
    assert scene.precision == "double" and len(scene.warnings) == 1


def test_an_old_processor_is_told_by_what_it_lacks() -> None:
    assert lacking("flags\t\t: fpu avx avx2 fma bmi1 bmi2 f16c movbe abm") == []
    assert lacking("flags\t\t: fpu avx fma bmi1 bmi2 f16c movbe abm") == ["AVX2"]
