"""Runs a task of a film, or what comes after all of them: task.py N [OPTION OF render]..., task.py finish.

N counts from 0. The film is in job.json beside this file, whose names are as from the folder "root"; KEY=VALUE goes before
it, and is enough where there is no job.json. What is complete stays as it is, so that a task may be killed and run again, on
two machines at once, too. $CISTULA_BIN: the folder of render and render-merge. This file needs nothing but Python 3.9."""
import ctypes
import hashlib
import json
import os
import re
import shlex
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

RANGE = re.compile(r"(\d+)(?:-(\d+)(?:[x:](\d+))?)?")
PLACE = re.compile(r"%%|#+(?=[^/]*\Z)|%0?(\d*)d")  # of a frame number in a name


def parse_frames(text: str) -> list[int]:
    """The frames of a list such as 0-299x5,7, in ascending order; Open Job Description writes : for x."""
    frames: set[int] = set()
    for item in text.split(","):
        found = RANGE.fullmatch(item.strip())
        if not found or int(found[3] or 1) == 0:
            raise ValueError(f"'{item}' is no frame, no range A-B and no A-BxSTEP; a list looks like 0-299x5,7")
        if int(found[2] or found[1]) < int(found[1]):
            raise ValueError(f"'{item}' has no frame: it ends before it begins")
        frames.update(range(int(found[1]), int(found[2] or found[1]) + 1, int(found[3] or 1)))
    return sorted(frames)


def format_frames(frames: list[int]) -> str:
    """A short list of ascending frames."""
    items: list[str] = []
    while frames:
        step = frames[1] - frames[0] if len(frames) > 1 else 1
        end = next((i for i, frame in enumerate(frames) if frame != frames[0] + i * step), len(frames))
        end = end if end > 2 or step == 1 else 1
        items.append(f"{frames[0]}-{frames[end - 1]}" + (f"x{step}" if step > 1 else "") if end > 1 else str(frames[0]))
        frames = frames[end:]
    return ",".join(items)


def tiles_of(grid: str) -> int:
    columns, _, rows = (grid or "1x1").partition("x")
    return int(columns) * int(rows)


def folder_and_name(pattern: str) -> tuple[str, str]:
    """The last folder that all files of a name are in, and their name in it."""
    cut = pattern.rfind("/", 0, PLACE.search(pattern + "#").start()) + 1  # type: ignore[union-attr]
    return pattern[:cut].rstrip("/") or pattern[:cut] or ".", pattern[cut:]


def images_of(output: str, frames: list[int]) -> tuple[Path, list[Path]]:
    """The folder of a film's images, and those that there are, those of layers, too: named alike, with a word before the
    number or the extension."""
    folder, name = folder_and_name(output)
    lead, place, end = PLACE.sub(lambda m: "%" if m[0] == "%%" else "\0", name).partition("\0")
    if not place:
        lead, end = os.path.splitext(lead)
    word = r"(?P<word>[^/]+[._ -])?(?P<frame>\d+)" if place else r"(?P<word>\.[^/]+)?(?P<frame>)"
    form = re.compile(re.escape(lead) + word + re.escape(end))
    files, wanted = Path(folder).glob("*/" * name.count("/") + "*"), {str(frame) for frame in frames}
    named = ((file, form.fullmatch(str(file.relative_to(folder)))) for file in files)
    return Path(folder), sorted(file for file, m in named if m and not re.match(r"\.?(tile\d|snapshot)", m["word"] or "")
                                and (not place or str(int(m["frame"])) in wanted))


def write_manifest(folder: Path, files: list[Path]) -> None:
    """Writes manifest.sha256 into the folder, as sha256sum does it there."""
    path, lines = folder / "manifest.sha256", []
    for file in files:
        name, value = str(file.relative_to(folder)), hashlib.sha256()
        with open(file, "rb") as image:
            while block := image.read(1 << 20):
                value.update(block)
        quoted = name.replace("\\", "\\\\").replace("\n", "\\n")
        lines.append(("\\" if quoted != name else "") + f"{value.hexdigest()}  {quoted}\n")
    new = path.with_name(f".manifest.{os.getpid()}")
    try:
        new.write_text("".join(lines), errors="surrogateescape")
        os.replace(new, path)
    finally:
        new.unlink(missing_ok=True)


def run(arguments: list[str], environment: dict[str, str]) -> int:
    """Runs a program and returns its exit code. SIGTERM goes on to it; where this process is killed, it is asked to end."""
    asked: list[int] = []
    child: list[subprocess.Popen[bytes]] = []

    def forward(number: int, _: Any) -> None:
        asked.append(number)
        for process in child:
            process.send_signal(number)

    signal.signal(signal.SIGTERM, forward)
    for number in (signal.SIGINT, signal.SIGHUP):  # of a terminal, which sends them to the program, too
        signal.signal(number, lambda *_: None)
    libc = ctypes.CDLL(None)

    def end_with_parent() -> None:
        libc.prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG

    child.append(subprocess.Popen(arguments, env=environment, preexec_fn=end_with_parent))
    if asked:  # before there was a program
        child[0].terminate()
    code = child[0].wait()
    return 128 - code if code < 0 else code


def main(words: list[str]) -> int:
    here = Path(__file__).resolve().parent
    job = dict.fromkeys(("options", "tiles", "preview", "look", "ocio"), "")
    if (here / "job.json").exists():
        job.update(json.loads((here / "job.json").read_text()))
        os.chdir(here / job["root"])
    more: list[str] = []
    for word in words:
        key, equals, value = word.partition("=")
        if equals and key.isalpha():
            job[key] = value
        else:
            more.append(word)
    try:
        parse_frames(job.get("frames", "0"))
    except ValueError as error:
        print(f"task.py: Frames: {error}", file=sys.stderr)
        return 2
    if "step" not in job and more[:1] != ["finish"]:
        frames, tiles, chunk = parse_frames(job.get("frames", "0")), tiles_of(job["tiles"]), int(job.get("chunk", 1))
        count, number = -(-len(frames) // chunk) * tiles, int(more[0]) if more and more[0].isdecimal() else -1
        if not 0 <= number < count:
            print(f"task.py: there is no task {' '.join(more[:1])}; they are 0 to {count - 1}, and finish", file=sys.stderr)
            return 2
        first = number // tiles * chunk
        job |= {"step": "render", "tile": str(number % tiles), "frames": format_frames(frames[first:first + chunk])}
        more.pop(0)
    finish = job.get("step") != "render"
    programs = Path(os.environ.get("CISTULA_BIN") or job["programs"])
    common = ["-o", job["output"], "-f", format_frames(parse_frames(job["frames"]))]
    common += ["--tiles", job["tiles"]] if job["tiles"] else []
    options = shlex.split(job["options"])
    picture = (["--preview", job["preview"]] if job["preview"] else []) + shlex.split(job["look"])
    if finish and job["tiles"]:
        crop = [word for i, word in enumerate(options) if "--crop" in (word.partition("=")[0], options[i - 1])]
        arguments = [str(programs / "render-merge"), *crop, *common, *picture, "-q"]
    else:
        arguments = [str(programs / "render"), job["scene"], *options, *common, "--resume"]
        arguments += ["--tile", job["tile"]] if job["tiles"] else picture
        if (cpus := os.environ.get("SLURM_CPUS_PER_TASK")) and "--threads" not in job["options"]:
            arguments += ["--threads", cpus]
        arguments += ["-q"] if finish else more
    try:
        code = run(arguments, os.environ | ({"OCIO": job["ocio"]} if job["ocio"] else {}))
        if code not in (0, 5):  # 5: a target error is missed in some pixels; the files are written
            return code
        if finish:
            write_manifest(*images_of(job["output"], parse_frames(job["frames"])))
    except OSError as error:
        print(f"task.py: {error.filename or arguments[0]}: {error.strerror}; $CISTULA_BIN names the folder of render",
              file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
