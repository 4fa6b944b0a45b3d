"""docs/shading-model.md says all: the tracer that was written from it gives the pixels that render gives."""
# mypy: ignore-errors
import json
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
import shading_model


def colors(path: Path) -> np.ndarray:
    channels = OpenEXR.File(str(path), separate_channels=True).parts[0].channels
    return np.stack([channels[c].pixels for c in "RGB"], axis=-1).astype(float)


def hold_alike(found: np.ndarray, wanted: np.ndarray) -> None:
    off = np.abs(found - wanted).max(axis=-1)
    row, column = np.unravel_index(off.argmax(), off.shape)
    assert off.max() <= 1e-6, f"pixel {column},{row}: {found[row, column]}, not {wanted[row, column]}"


@pytest.mark.parametrize("name", ["benchmark", "seed", "hard/sunk-glass", "hard/critical-angle", "hard/semi-mirror",
                                  "hard/tiny-lamp", "hard/far-floor"])
def test_golden_images(source: Path, name: str) -> None:
    scene = source / f"scenes/{name}.json"
    wanted = colors(source / f"golden/{name}/double.exr")
    height, width, _ = wanted.shape
    hold_alike(shading_model.render(scene, width, height, 1, json.loads(scene.read_text()).get("depth", 4)), wanted)


@pytest.mark.parametrize("name, samples, depth, frame", [("glass", 2, 8, 0), ("platonic", 1, 8, 0), ("infinity", 1, 12, 0),
                                                         ("seed", 3, 6, 37), ("edges", 1, 6, 0)])
def test_renders(source: Path, programs: Path, tmp_path: Path, name: str, samples: int, depth: int, frame: int) -> None:
    scene = source / f"scenes/{name}.json"
    if name == "edges":  # lights on edges, corners and faces, without the meshes and the bodies that touch
        text = json.loads((source / "scenes/hard/lights-on-edges.json").read_text())
        text["objects"] = [o for o in text["objects"] if "mesh" not in o and " of two" not in o["name"]]
        scene = tmp_path / "edges.json"
        scene.write_text(json.dumps(text))
    image = tmp_path / "image.exr"
    subprocess.run([programs / "render", scene, "-q", "-o", image, "--res", "96x54", "--precision", "double", "--cutoff", "0",
                    "--supersample", str(samples), "--depth", str(depth), "-f", str(frame)], check=True)
    hold_alike(shading_model.render(scene, 96, 54, samples, depth, frame), colors(image))


def test_bodies_of_one_glass(programs: Path, tmp_path: Path) -> None:
    """Whole bodies that overlap one another and one of another index: lines and shadows count faces where the index changes."""
    def solid(kind: str, center: list, radius: float, material: str) -> dict:
        return {"solid": kind, "center": center, "radius": radius, "rotate": [10 * radius, 20, 30], "material": material}
    glass = {"color": 0.4, "reflection": 0.2, "transmission": 0.8, "fresnel": True, "index": 1.5}
    objects = [{"quad": [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], "material": "floor"},
               solid("cube", [-0.7, 0, 0.8], 0.7, "glass"), solid("octahedron", [-0.5, 0.1, 0.9], 0.6, "glass"),
               solid("dodecahedron", [0, 0.2, 0.7], 0.5, "glass"), solid("icosahedron", [0.8, 0, 0.7], 0.6, "glass"),
               solid("cube", [0.9, -0.2, 0.8], 0.3, "glass"), solid("octahedron", [0.6, 0.1, 1], 0.5, "water"),
               solid("tetrahedron", [1.1, 0.3, 0.9], 0.8, "air")]
    scene = tmp_path / "glass.json"
    scene.write_text(json.dumps({
        "depth": 6, "ambient": 0.2, "background": [0.3, 0.5, 0.7], "camera": {"position": [0.4, -4, 2.4], "target": [0, 0, 0.6]},
        "lights": [{"position": [2, -2, 5], "color": 0.8}, {"position": [-3, 1, 3], "color": [0.4, 0.3, 0.2]}],
        "materials": {"floor": {"color": [0.8, 0.7, 0.6], "diffuse": 0.9}, "glass": glass, "water": glass | {"index": 1.33},
                      "air": glass | {"index": 1}}, "objects": objects}))
    image = tmp_path / "image.exr"
    subprocess.run([programs / "render", scene, "-q", "-o", image, "--res", "96x54", "--precision", "double", "--cutoff", "0"],
                   check=True)
    hold_alike(shading_model.render(scene, 96, 54, 1, 6), colors(image))
