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
