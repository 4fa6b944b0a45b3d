"""What the tests of the Python package share. ctest names the build in the environment."""
from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

os.environ.setdefault("PYTHONWARNINGS", "default")


def until(condition: Callable[[], bool], process: subprocess.Popen[Any] | None = None) -> None:
    """Waits until it holds, while the process lives. What never comes true meets the limit of ctest, which alone knows of seconds."""
    while not condition():
        assert process is None or process.poll() is None, "it ended before"
        time.sleep(0.005)


def processor_seconds(process: int) -> float:
    """The time that processors worked for it, which does not pass where others have them."""
    words = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


@pytest.fixture(scope="session")
def source() -> Path:
    """The root of the source tree."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def programs() -> Path:
    """The folder with render and the other programs."""
    return Path(os.environ["CISTULA_BUILD"]) / "bin"


@pytest.fixture
def render(programs: Path, tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """Runs render with these options, the image into a file.exr of tmp_path, and returns the entry of its stats."""

    def run(scene: Path, *options: str) -> dict[str, Any]:
        stats = tmp_path / "stats.json"
        command = [str(programs / "render"), str(scene), "-q", "-o", str(tmp_path / "file.exr"), "--stats", str(stats), *options]
        assert subprocess.run(command, check=False).returncode in (0, 5)  # 5: a target error was missed
        entry: dict[str, Any] = json.loads(stats.read_text())["benchmarks"][0]
        return entry

    return run
