"""The notebooks of docs/notebooks run as they are, and so do README.md's lines of Python."""
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import nbclient
import nbformat
import pytest

NOTEBOOKS = sorted(Path(__file__).parents[2].glob("docs/notebooks/*.ipynb"))


@pytest.fixture
def checkout(source: Path, tmp_path: Path) -> Path:
    """A folder with what notebooks take from a checkout; what they write does not go there."""
    (tmp_path / "docs/notebooks").mkdir(parents=True)
    for name in ("scenes", "tests"):
        (tmp_path / name).symlink_to(source / name)
    return tmp_path


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(file: Path, checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IPYTHONDIR", str(checkout / "ipython"))
    book = nbformat.read(file, as_version=4)  # type: ignore[no-untyped-call]
    nbformat.validate(book)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code), "notebooks are kept without outputs"
    # The limit of ctest ends what hangs; a cell has none of its own.
    nbclient.NotebookClient(book, timeout=None, startup_timeout=1_000_000, resources={"metadata": {"path": str(checkout / "docs/notebooks")}}).execute()
    outputs = [output for cell in code for output in cell.outputs]
    said = "".join(output.text for output in outputs if output.get("name") == "stderr")
    assert "Warning" not in said, said
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_all_five_are_there() -> None:
    assert [file.stem[0] for file in NOTEBOOKS] == list("12345")


def test_the_extra_brings_what_notebooks_import(source: Path) -> None:
    code = "\n".join(cell.source for file in NOTEBOOKS for cell in nbformat.read(file, as_version=4).cells  # type: ignore[no-untyped-call]
                     if cell.cell_type == "code")
    imported = {name.lower() for name in re.findall(r"^\s*(?:import|from)\s+(\w+)", code, re.MULTILINE)} - sys.stdlib_module_names
    project = tomllib.loads((source / "pyproject.toml").read_text())["project"]
    lists = project["dependencies"] + project["optional-dependencies"]["notebooks"]
    brought = {re.split(r"[<>=]", entry)[0] for entry in lists}
    of_a_checkout = {"shading_model"}  # in tests/
    assert imported - brought == {"cistula"} | of_a_checkout
    assert {"numpy", "matplotlib", "openexr", "anywidget"} <= brought


def test_links_of_notebooks_lead_somewhere(source: Path) -> None:
    for file in NOTEBOOKS:
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", file.read_text()):
            assert (file.parent / target).exists(), f"{file.name}: {target}"


def test_the_lines_of_the_readme_make_its_picture(source: Path, programs: Path, tmp_path: Path) -> None:
    lines = re.findall(r"^```python\n(.*?)^```", (source / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    assert len(lines) == 1
    scene = json.loads((source / "scenes/platonic.json").read_text())
    scene["film"] = {"width": 96, "height": 54}
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes/platonic.json").write_text(json.dumps(scene))
    shutil.copy(source / "scenes/marble.data", tmp_path / "scenes")
    before = os.getcwd()
    os.chdir(tmp_path)
    try:
        exec(lines[0], {})
    finally:
        os.chdir(before)
    subprocess.run([programs / "render", "scenes/platonic.json", "-q", "-o", "a.exr", "--preview", "a.png"], cwd=tmp_path, check=True)
    assert (tmp_path / "platonic.png").read_bytes() == (tmp_path / "a.png").read_bytes()
