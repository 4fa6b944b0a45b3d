"""The package and what uses it are checked by mypy --strict; every name is documented."""
from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cistula

USE = """
import numpy as np
import cistula
scene = cistula.Scene.load("a.json", precision="double")
image: cistula.Image = scene.render(size=(64, 36), layers=("Z",), progress=lambda share: None)
red = image["R"] * np.float32(2)
for image in scene.film(range(3), depth=4):
    image.save("a.exr")
hits: cistula.Hits = scene.intersect(np.zeros((4, 3)), [0, 0, 1])
total: float = float(hits.distance.sum())
name: str = scene.pixel(3, 4).rays[0].kind
ok: bool = cistula.compare(image, "a.exr", fail=0.1).passes
"""


def test_the_package_is_typed(tmp_path: Path, source: Path) -> None:
    (tmp_path / "use.py").write_text(USE)
    package = Path(cistula.__file__).parent
    answer = subprocess.run([sys.executable, "-m", "mypy", "--config-file", source / "pyproject.toml", "--cache-dir", package.parent / "mypy",
                             package, tmp_path / "use.py", source / "tests" / "python"], capture_output=True, text=True, check=False,
                            cwd=package.parent)
    assert answer.returncode == 0, answer.stdout + answer.stderr


def test_a_wrong_use_is_an_error_of_types(tmp_path: Path, source: Path) -> None:
    (tmp_path / "wrong.py").write_text('import cistula\ncistula.Scene.load("a.json").render(dpeth=3)\n')
    package = Path(cistula.__file__).parent
    answer = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", package.parent / "mypy", tmp_path / "wrong.py"],
                            capture_output=True, text=True, check=False, cwd=package.parent)
    assert "dpeth" in answer.stdout


def test_everything_public_is_documented() -> None:
    for name in cistula.__all__:
        value = getattr(cistula, name)
        assert name.startswith("__") or value.__doc__, name
        if inspect.isclass(value):
            for part in (part for part in vars(value) if not part.startswith("_")):
                documented = getattr(value, part)
                assert getattr(documented, "__doc__", None) or not (callable(documented) or isinstance(documented, property)), (name, part)


def test_what_pages_show_runs(tmp_path: Path, source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first Python of each page, in a smaller size."""
    (tmp_path / "scenes").symlink_to(source / "scenes")
    monkeypatch.chdir(tmp_path)
    for page in ("README.md", "docs/python.md"):
        code = (source / page).read_text().split("```python\n")[1].split("```")[0]
        exec(re.sub(r"render\(.*\)", "render(size=(32, 18))", code), {})
        assert (tmp_path / "platonic.png").exists()
        (tmp_path / "platonic.png").unlink()
