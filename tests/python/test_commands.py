"""`cistula NAME ...`."""
import subprocess
import sys


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
