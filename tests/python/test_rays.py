"""Rays, segments, pixels, comparisons and the self-check."""
from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import cistula

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def scene() -> cistula.Scene:
    return cistula.Scene.load(SOURCE / "scenes" / "platonic.json")


CUBE = cistula.Scene.from_dict({"materials": {"m": {}, "g": {"transmission": 0.5, "tint": [1, 0.5, 0]}}, "objects": [
    {"name": "cube", "solid": "cube", "radius": float(np.sqrt(3)), "material": "m"},
    {"name": "glass", "solid": "cube", "radius": float(np.sqrt(3)), "center": [5, 0, 0], "material": "g"}]})


@pytest.mark.parametrize("name", ["platonic", "glass", "hard/far-camera"])
def test_rays_meet_what_pixels_show(name: str) -> None:
    scene = cistula.Scene.load(SOURCE / "scenes" / f"{name}.json")
    image = scene.render(size=(64, 36), supersample=1, layers=("id", "P", "N", "Z"))
    camera = np.array(image.header["worldToCamera"]).reshape(4, 4)
    position = -camera[3, :3] @ camera[:3, :3].T
    points = np.stack([image["P.X"], image["P.Y"], image["P.Z"]], axis=-1).astype(float).reshape(-1, 3)
    seen = (image.id.ravel() > 0) & (image.id.ravel() <= len(scene.objects))
    hits = scene.intersect(position, points[seen] - position)
    assert (hits.object == image.id.ravel()[seen] - 1).mean() > 0.99  # P is float: rays at silhouettes differ
    same = hits.object == image.id.ravel()[seen] - 1
    normals = image.normal.reshape(-1, 3)[seen][same]
    assert np.abs(np.einsum("ij,ij->i", hits.normal[same], normals)).min() > 0.99


@pytest.mark.parametrize("name", ["platonic", "glass", "hard/far-camera"])
def test_rays_meet_what_trees_of_pixels_say(name: str) -> None:
    """Those that start at the camera, however far, exactly; those that start on faces a little off them (docs/python.md, Rays)."""
    scene = cistula.Scene.load(SOURCE / "scenes" / f"{name}.json")
    image = scene.render(size=(64, 36), supersample=1, layers="id")
    began_on_faces = 0
    for x, y in [(x, y) for y in range(1, 36, 7) for x in range(2, 64, 9)]:
        first, *others = scene.pixel(x, y, size=(64, 36), supersample=1).rays
        assert first.end == "light" or scene.intersect(first.origin, first.direction).object[0] == image.id[y, x] - 1
        others = [ray for ray in others if ray.end in ("surface", "background")]
        if not others:
            continue
        origins, directions = (np.array([getattr(ray, key) for ray in others]) for key in ("origin", "direction"))
        extent = np.ptp(origins, axis=0).max()
        hits = scene.intersect(origins + 1e-5 * extent * directions, directions)
        assert hits.object.tolist() == [scene.objects.index(ray.surface.object) if ray.surface else -1 for ray in others]
        began_on_faces += len(others)
    assert began_on_faces > 100


def test_hits_are_arrays_by_ray() -> None:
    hits = CUBE.intersect([0.25, 0.5, 9], [[0, 0, -2], [0, 0, 1], [0, 0, -1]])
    assert len(hits) == 3 and hits.objects == ["cube", "glass"] and hits.materials == ["m", "g"]
    assert hits.distance == pytest.approx([8, np.inf, 8]) and hits.object.tolist() == [0, -1, 0]
    assert hits.point[0] == pytest.approx([0.25, 0.5, 1]) and hits.normal[2].tolist() == [0, 0, 1] and hits.crossing[0] == 1
    assert not hits.distance.flags.owndata and not hits.distance.flags.writeable
    inside = CUBE.intersect([0, 0, 0], [0, 0, 1])
    assert inside.crossing[0] == 2 and inside.distance[0] == pytest.approx(1) and inside.normal[0].tolist() == [0, 0, -1]
    assert len(CUBE.intersect(np.zeros((0, 3)), np.zeros((0, 3)))) == 0


def test_where_rays_start_changes_nothing_but_the_distance() -> None:
    """From beyond the scene's bounds (docs/python.md, Rays)."""
    far = CUBE.intersect([0.25, 0.5, 1e6], [0, 0, -1])
    assert far.object[0] == 0 and far.distance[0] == pytest.approx(1e6 - 1) and far.point[0] == pytest.approx([0.25, 0.5, 1])
    above = CUBE.intersect([0.25, 0.5, 1 + 1e-3], [[0, 0, -1], [0, 0, 1]])  # off a face
    assert above.object.tolist() == [0, -1]


def test_order_and_threads_change_no_bit(scene: cistula.Scene) -> None:
    random = np.random.default_rng(1)
    directions = random.normal((0.7, 0.6, -0.25), 0.2, (2000, 3))
    all_at_once = scene.intersect([-10.8, -9.9, 5.2], directions)
    order = random.permutation(2000)
    again = scene.intersect([-10.8, -9.9, 5.2], directions[order], threads=1)
    assert np.array_equal(all_at_once.distance[order], again.distance) and np.array_equal(all_at_once.point[order], again.point)


def test_light_passes_glass() -> None:
    share = CUBE.transmittance([[0, 0, 9], [5, 0, 9], [9, 9, 9]], [[0, 0, -9], [5, 0, -9], [9, 9, -9]])
    assert share.shape == (3, 3)
    assert share == pytest.approx(np.array([[0, 0, 0], [0.25, 0.0625, 0], [1, 1, 1]]), abs=1e-6)


def test_a_pixel_is_its_rays(scene: cistula.Scene, programs: Path) -> None:
    pixel = scene.pixel(64, 40, size=(128, 72))
    command = [str(programs / "render"), str(SOURCE / "scenes" / "platonic.json"), "--res", "128x72", "--pixel", "64,40"]
    assert pixel.text() == subprocess.run(command, capture_output=True, text=True, check=True).stdout
    told = json.loads(pixel.json())
    assert told["pixel"] == [64, 40] and np.float32(told["totals"]["radiance"][0]) == np.float32(pixel.radiance[0])
    image = scene.render(size=(128, 72))
    assert [image[c][40, 64] for c in "RGB"] == list(pixel.radiance)
    first = pixel.rays[0]
    assert first.parent == -1 and first.kind == "primary" and pixel.samples == 9 and pixel.sample(4) == pixel.rays
    assert all(ray.parent < i for i, ray in enumerate(pixel.rays)) and len(pixel.rays) > 3
    below = sum(np.array(ray.adds) for ray in pixel.rays if ray.parent >= 0)
    assert np.allclose(below, first.adds_below)
    surface = first.surface
    assert surface is not None and surface.object in scene.objects and {light.name for light in surface.lights} <= set(scene.lights)
    sums = sum(np.array(sample[0].adds) + sample[0].adds_below for sample in map(pixel.sample, range(9)))
    assert np.allclose(sums / 9, pixel.radiance, rtol=1e-6)
    with pytest.raises(IndexError, match="0 to 8"):
        pixel.sample(9)


def test_pictures_are_compared(scene: cistula.Scene, tmp_path: Path) -> None:
    image, other = (scene.render(size=(32, 18), depth=depth) for depth in (8, 2))
    image.save(tmp_path / "a.exr")
    other.save(tmp_path / "b.exr")
    assert cistula.compare(image, image) and cistula.compare(image, tmp_path / "a.exr")
    differ = cistula.compare(tmp_path / "a.exr", tmp_path / "b.exr")
    assert not differ and not differ.passes and "differ" in differ.verdict and any("depth" in line for line in differ.header)
    assert differ.max == max(channel.max for channel in differ.channels) > 0
    worst = max(differ.channels, key=lambda channel: channel.max)
    assert abs(image[worst.name][worst.y, worst.x] - other[worst.name][worst.y, worst.x]) == np.float32(worst.max)
    assert cistula.compare(image, other, fail=differ.max) and not cistula.compare(image, other, fail=differ.max / 2)
    assert cistula.compare(image, other, layers="A", fail=0) and json.loads(differ.json())
    with pytest.raises(cistula.FileError, match="none.exr"):
        cistula.compare(image, tmp_path / "none.exr")


def test_what_is_not_finite_passes_no_threshold(scene: cistula.Scene) -> None:
    far, near = (scene.render(size=(32, 18), layers="Z", z_far=z_far) for z_far in (np.inf, 1e5))
    assert np.isinf(far["Z"]).any() and cistula.compare(far, far)
    for thresholds in ({"fail": np.inf}, {"fail": 0, "failpercent": 100}, {"hardfail": np.inf}):
        same, other = cistula.compare(far, far, **thresholds), cistula.compare(far, near, allow_nonfinite=True, **thresholds)
        assert not same and "not finite in both; the first: Z at" in same.verdict
        assert not other and "not finite in one" in other.verdict
        assert cistula.compare(far, far, allow_nonfinite=True, **thresholds)
    with pytest.raises(cistula.ArgumentError, match="allow_nonfinite: is for fail or hardfail"):
        cistula.compare(far, far, allow_nonfinite=True)


def test_the_renderer_checks_itself() -> None:
    told: list[cistula.CaseResult] = []
    results = cistula.verify(True, cases="geometry/axis-parallel", precision="double", progress=told.append)
    assert {row.intersector for row in results} >= {"embree", "bvh", "brute"} and {row.precision for row in results} == {"double"}
    assert all(results) and len(told) == len(results) and all(row.tried > 0 and row.unit and not row.complaint for row in results)
    with pytest.raises(cistula.ArgumentError, match="backend=embre: must be embree or cuda or all; did you mean 'embree'"):
        cistula.verify(backend="embre")
    with pytest.raises(cistula.ArgumentError, match="geometry/nothing"):
        cistula.verify(cases=["geometry/nothing"])

    def stop(row: cistula.CaseResult) -> None:
        raise InterruptedError(row.name)
    with pytest.raises(InterruptedError, match="geometry/axis-parallel"):
        cistula.verify(True, cases=["geometry/axis-parallel"], progress=stop)
