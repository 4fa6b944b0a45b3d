"""Scene.render and Scene.film give what render gives, and arrays look into it."""
from __future__ import annotations

import gc
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cistula

SOURCE = Path(__file__).resolve().parents[2]
SCENES = sorted((SOURCE / "scenes").glob("*.json"))
ALL = SCENES + sorted((SOURCE / "scenes" / "hard").glob("*.json"))
Render = Callable[..., dict[str, Any]]

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


@pytest.mark.parametrize("scene", ALL, ids=lambda path: path.stem)
def test_the_film_is_that_of_render(scene: Path, render: Render) -> None:
    image = cistula.Scene.load(scene).render(size=(31, 17), supersample=1)
    assert image.hash == render(scene, "--res", "31x17", "--supersample", "1")["film_hash"]


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("scene", SCENES, ids=lambda path: path.stem)
def test_in_both_precisions(scene: Path, precision: str, render: Render) -> None:
    image = cistula.Scene.load(scene, precision=precision).render(size=(24, 16))
    assert image.hash == render(scene, "--res", "24x16", "--precision", precision)["film_hash"]


def test_files_are_those_of_render_byte_for_byte(source: Path, render: Render, tmp_path: Path) -> None:
    scene = source / "scenes" / "glass.json"
    image = cistula.Scene.load(scene).render(size=(64, 36), crop=(20, 10, 5, 6), depth=6, layers=("Z", "N", "cryptomatte"), bits="half",
                                             background="transparent", colorspace="lin_ap1_scene", compression="zips")
    image.save(tmp_path / "ours.exr")
    image.preview(tmp_path / "ours.png", exposure=1, view="filmic", bloom=0.5)
    render(scene, "--res", "64x36", "--crop", "20x10+5+6", "--depth", "6", "--layers", "Z,N,cryptomatte", "--bits", "half", "--background",
           "transparent", "--colorspace", "lin_ap1_scene", "--compression", "zips", "--preview", str(tmp_path / "file.png"), "--exposure",
           "1", "--view", "filmic", "--bloom", "0.5")
    assert (tmp_path / "ours.exr").read_bytes() == (tmp_path / "file.exr").read_bytes()
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "file.png").read_bytes()


def test_a_name_that_no_file_has_is_an_argument_error(tmp_path: Path) -> None:
    image = cistula.Scene.load(SOURCE / "scenes" / "platonic.json").render(size=(16, 9))
    for bad, why in (("a\0b", "a zero byte is in the name"), ("\ud800", "the name is not UTF-8")):
        for call in (image.save, image.preview, image.explore):
            with pytest.raises(cistula.ArgumentError, match=f"^path=.*{why}") as error:
                call(tmp_path / f"{bad}.{'png' if call == image.preview else 'exr'}")
            assert error.value.argument == "path"
    for read in (cistula.Scene.load, lambda name: cistula.compare(name, image), lambda name: cistula.Scene.from_dict({}, folder=name)):
        with pytest.raises(cistula.ArgumentError, match="the name is not UTF-8"):
            read("scene\udcff.json")
    image.save(tmp_path / "\udcff.exr")
    for call, to in ((image.save, "none/a\udcff.exr"), (image.preview, "none/\udcff.png")):
        with pytest.raises(cistula.FileError, match=r"none/a?(\\xff|\udcff)"):
            call(tmp_path / to)
    assert [os.fsencode(path.name) for path in tmp_path.iterdir()] == [b"\xff.exr"]
    with pytest.raises(TypeError, match="PathLike"):
        image.save(1)  # type: ignore[arg-type]


def test_a_target_error_is_reported(source: Path, render: Render, tmp_path: Path) -> None:
    scene = source / "scenes" / "platonic.json"
    image = cistula.Scene.load(scene).render(size=(40, 22), target_error=0.05, max_samples=64)
    assert image.hash == render(scene, "--res", "40x22", "--target-error", "0.05", "--max-samples", "64")["film_hash"]
    assert image.target is not None and image.target["proven"] is True and image.target["missed"] > 0
    assert image.header["cistula:targetError"] == 0.05


@pytest.fixture(scope="module")
def scene() -> cistula.Scene:
    return cistula.Scene.load(SOURCE / "scenes" / "platonic.json")


def test_arrays_look_into_the_image_and_outlive_it(scene: cistula.Scene) -> None:
    image = scene.render(size=(32, 18), layers=("Z", "id", "N"))
    red, sums, ids = image["R"], image.sums, image.id
    assert red.shape == (18, 32) and red.dtype == np.float32 and not red.flags.writeable and not red.flags.owndata
    assert np.shares_memory(red, image["R"]) and np.shares_memory(sums, image.sums)
    assert sums.shape == (18, 32, 3) and sums.dtype == np.int64
    assert np.array_equal((sums * image.unit).astype(np.float32)[..., 0], red)
    assert np.array_equal(image.rgb()[..., 1], image["G"]) and image.rgb().flags.writeable
    assert np.array_equal(ids, image["id"]) and np.array_equal(image.normal[..., 2], image["N.Z"])
    hit = ids > 0
    assert np.array_equal(image.z[hit], image["Z"][hit]) and np.isinf(image.z[~hit]).all()
    kept = red.copy(), sums.copy()
    del image
    gc.collect()
    scene.render(size=(32, 18))
    assert np.array_equal(red, kept[0]) and np.array_equal(sums, kept[1])


def test_images_say_what_they_are(scene: cistula.Scene) -> None:
    image = scene.render(size=(32, 18))
    assert image.channels == ["R", "G", "B", "A"] and image.frame == 0 and image.target is None
    assert image.header["cistula:sceneHash"] == scene.hash and image.header["cistula:depth"] == 8
    assert image.rays > 32 * 18 and image.seconds > 0
    assert image._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(cistula.ArgumentError, match='layers="Z"'):
        _ = image.z
    with pytest.raises(KeyError, match="R, G, B, A"):
        _ = image["Z"]


def test_a_film_is_its_frames(render: Render, source: Path) -> None:
    scene = cistula.Scene.load(source / "scenes" / "seed.json")
    assert scene.frames > 2
    images = list(scene.film(range(1, 3), size=(16, 9), supersample=1))
    assert [image.frame for image in images] == [1, 2]
    for image in images:
        assert image.hash == render(source / "scenes" / "seed.json", "--res", "16x9", "--supersample", "1", "-f", str(image.frame))["film_hash"]
    assert images[0].hash != images[1].hash


def test_no_setting_of_the_machine_changes_the_film(scene: cistula.Scene) -> None:
    whole = scene.render(size=(40, 22)).hash
    assert scene.render(size=(40, 22), threads=1).hash == whole
    assert scene.render(size=(40, 22), lanes=1, effects="all").hash == whole


def test_settings_are_those_of_the_table() -> None:
    from cistula import _core

    assert sorted(cistula.Settings.__annotations__) == sorted(_core.frame_arguments())


@pytest.mark.skipif("cuda" not in cistula.backends(), reason="built without CUDA")
def test_a_gpu_gives_the_same_film(scene: cistula.Scene) -> None:
    try:
        image = scene.render(size=(40, 22), backend="cuda")
    except cistula.DeviceError as error:
        pytest.skip(str(error))
    assert image.hash == scene.render(size=(40, 22)).hash
    frames = [image.hash for image in scene.film([0, 0, 0], size=(40, 22), backend="cuda")]
    assert frames == 3 * [image.hash]
