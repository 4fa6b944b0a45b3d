"""What the tests of the Python package share. ctest names the build in the environment."""
import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def source() -> Path:
    """The root of the source tree."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def programs() -> Path:
    """The folder with render and the other programs."""
    return Path(os.environ["CISTULA_BUILD"]) / "bin"
