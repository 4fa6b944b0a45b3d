"""`cistula NAME ...`."""
import subprocess
import sys
from pathlib import Path


def cistula(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "cistula", *arguments], capture_output=True, text=True, check=False)


def test_help_lists_the_commands() -> None:
    answer = cistula("--help")
    assert answer.returncode == 0
    assert "view" in answer.stdout and "farm" in answer.stdout


def test_an_unknown_command_is_named_with_those_that_there_are() -> None:
    answer = cistula("veiw")
    assert answer.returncode == 2
    assert answer.stderr.count("\n") == 1
    assert "veiw" in answer.stderr and "view" in answer.stderr


def test_a_checkout_runs_the_commands_without_the_native_module(source: Path) -> None:
    def answer(*arguments: str) -> "subprocess.CompletedProcess[str]":
        return subprocess.run([sys.executable, *arguments], env={"PYTHONPATH": str(source / "python")}, cwd=source,
                              capture_output=True, text=True)
    for name in ("view", "farm"):
        assert answer("-m", "cistula", name, "--help").returncode == 0
    missing = answer("-c", "import cistula; cistula.Scene")
    assert missing.returncode != 0 and missing.stderr.splitlines()[-1].startswith("ImportError: cistula.Scene: the native module is not here")
