"""`cistula NAME ...`."""
import signal
import subprocess
import sys
from pathlib import Path


def cistula(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "cistula", *arguments], capture_output=True, text=True, check=False)


def test_help_lists_the_commands() -> None:
    answer = cistula("--help")
    assert answer.returncode == 0
    assert "view" in answer.stdout and "farm" in answer.stdout and "render" in answer.stdout


def test_programs_are_those_of_the_build(source: Path, programs: Path, tmp_path: Path) -> None:
    """Files, words and exit codes of commands are those of programs."""
    def answers(name: str, *words: str) -> "subprocess.CompletedProcess[bytes]":
        runs = [subprocess.run([*command, *words], capture_output=True, cwd=tmp_path, check=False) for command in
                ([programs / ("render" if name == "render" else "render-" + name)], [sys.executable, "-m", "cistula", name])]
        assert runs[0].returncode == runs[1].returncode and runs[0].stderr == runs[1].stderr and runs[0].stdout == runs[1].stdout
        return runs[0]

    scene = str(source / "scenes" / "glass.json")
    image = tmp_path / "a\udcff.exr"
    frame = ("--res", "32x18", "--supersample", "1", "-q")
    assert answers("render", scene, "-o", str(image), *frame).returncode == 0
    first = image.read_bytes()
    image.unlink()
    assert cistula("render", scene, "-o", str(image), *frame).returncode == 0 and image.read_bytes() == first
    assert answers("render", scene, "--pixel", "3,4", *frame).stdout
    assert answers("render", scene, "-o", "b.exr", "--depth", "1", *frame).returncode == 0
    assert answers("compare", str(image), "b.exr", "--fail", "9", "--layers", "R,G,B").returncode == 0
    assert answers("compare", str(image), "b.exr", "--json", "-").returncode == 1
    assert answers("verify", "--list").stdout.count(b"\n") > 50
    for words in (("render", "--dpeth", "3"), ("render", "none.json"), ("compare", "b.exr", "none.exr"), ("verify", "--case", "none/")):
        assert answers(*words).returncode in (2, 3)


def test_a_program_that_is_interrupted_leaves_no_file(source: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "cistula", "render", str(source / "scenes" / "infinity.json"), "-o", str(tmp_path / "a.exr"), "--res", "4096x4096",
               "--progress", "json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert run.stdout and b"read" in run.stdout.readline() and b"begin" in run.stdout.readline()
        run.send_signal(signal.SIGINT)
        assert run.wait(60) == 130 and not (tmp_path / "a.exr").exists()


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
    assert "native module" in answer("-m", "cistula", "render", "a.json").stderr
    missing = answer("-c", "import cistula; cistula.Scene")
    assert missing.returncode != 0 and missing.stderr.splitlines()[-1].startswith("ImportError: cistula.Scene: the native module is not here")
