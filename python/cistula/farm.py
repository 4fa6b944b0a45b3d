"""`cistula farm`: a film as tasks for many machines: for Open Job Description (AWS Deadline Cloud), for Slurm, for make."""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from . import farm_task
from .command import Parser, Refused, number, shown, write_whole
from .farm_task import folder_and_name, format_frames, parse_frames, tiles_of

REFUSED = "--tile --stats --explain --explore --explore-mb --pixel --json --resume --progress --list-devices --print-template".split()

TASK = Path(farm_task.__file__)

SLURM = """#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --requeue
#SBATCH --open-mode=append
"""
TASKS = SLURM + """#SBATCH --array=0-{last}
#SBATCH --cpus-per-task={cpus}
#SBATCH --output=task-%a.log
exec python3 task.py "$SLURM_ARRAY_TASK_ID"
"""
FINISH = SLURM + """#SBATCH --cpus-per-task={cpus}
#SBATCH --output=finish.log
exec python3 task.py finish
"""
SUBMIT = """#!/bin/sh
# Submits the tasks to Slurm, and what comes after all of them. Prints the numbers of both jobs.
# submit.sh [options of sbatch for both]. After a failure the same again goes on from what is complete.
set -eu
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
tasks=$(sbatch --parsable --chdir="$farm" "$@" "$farm/job.slurm")
tasks=${tasks%%;*}
finish=$(sbatch --parsable --chdir="$farm" --dependency="afterok:$tasks" --kill-on-invalid-dep=yes "$@" "$farm/finish.slurm")
echo "$tasks ${finish%%;*}"
"""
MAKEFILE = """# make -j N -f Makefile: N tasks at a time, then what comes after them. What is complete stays as it is.
export CISTULA_FARM := $(value MAKEFILE_LIST)
run = f=$${{CISTULA_FARM\\# }}; f=$${{f%Makefile}}; exec python3 "$${{f:-./}}task.py"
tasks := $(addprefix task-,$(shell seq 0 {last}))
.PHONY: finish $(tasks)
finish: $(tasks)
	@$(run) finish
$(tasks): task-%:
	@$(run) $*
"""


def program(name: str) -> Path:
    """A program of Cistula, from $CISTULA_BIN or the PATH."""
    folder = os.environ.get("CISTULA_BIN")
    found = shutil.which(name, path=folder or None)
    if not found:
        raise Refused(f"there is no {name} in {folder or 'the PATH'}; $CISTULA_BIN names its folder")
    return Path(found).absolute()


class Film:
    """What render is asked for: to look at the frames before others render them."""

    def __init__(self, arguments: list[str], output: str, preview: str, look: list[str]) -> None:
        self.arguments, self.output, self.preview, self.look = arguments, output, preview, look

    def events(self, *what: str, previews: bool = True) -> Iterator[tuple[dict[str, Any], float]]:
        """The records of a run of render whose images are thrown away, each with its time in seconds, until who reads them
        has enough. Raises Refused with what render says, where it fails."""
        with tempfile.TemporaryDirectory(prefix="cistula-farm.") as folder, tempfile.TemporaryFile() as said:
            command = [str(program("render")), *self.arguments, "-o", f"{folder}/{self.output.replace('/', '_')}", *what]
            if previews:
                command += ["--preview", f"{folder}/{self.preview.replace('/', '_')}"] if self.preview else []
                command += self.look
            run = subprocess.Popen([*command, "--progress", "json"], stdout=subprocess.PIPE, stderr=said)
            assert run.stdout
            try:
                for line in run.stdout:
                    yield json.loads(line), time.monotonic()
                if run.wait() not in (0, 5):
                    said.seek(0)
                    text = said.read().decode(errors="replace").strip() or f"render ended with {run.returncode}"
                    raise Refused(text.splitlines()[-1].replace(folder + "/", ""), max(run.returncode, 1))
            finally:
                run.terminate()
                run.stdout.close()
                run.wait()

    def begun(self, given: str, tile: list[str]) -> tuple[list[int], list[Path], list[str]]:
        """The frames that are to be rendered, the files that there are of those that the scene names, and the warnings. By
        then render has begun to: scene and options are right."""
        count, files, said = 0, dict[Path, bool](), []
        for event, _ in self.events(*(["-f", given] if given else []), *tile, previews=not tile):
            if event["event"] == "read":
                files = dict.fromkeys(filter(Path.is_file, map(path_of, event["files"])), True)
            if event["event"] == "message" and event["text"].startswith("render: warning: "):
                said.append(event["text"][len("render: "):])
            if event["event"] == "begin":
                count = event["frames"]
            if event["event"] == "frame":
                break
        return parse_frames(given) if given else list(range(count)), list(files), said

    def seconds(self, frames: list[int], at_most: float = 20) -> float:
        """What a frame takes here: the mean of at most four, from the first to the last, or of what is done in time."""
        some = sorted({frames[i * (len(frames) - 1) // 3] for i in range(4)})
        start, seconds = 0.0, 0.0
        for event, now in self.events("-f", format_frames(some)):
            start = start or now
            if event["event"] == "progress" and event["film_fraction"] > 0:
                seconds = (now - start) / event["film_fraction"] / len(some)
                if now - start > at_most:
                    break
        return max(seconds, 1e-4)


def path_of(name: str) -> Path:
    """The absolute path of a file as a record names it, where %E9 is a byte that is no UTF-8, and %25 a %."""
    plain = re.sub(rb"%(25|[89A-F][0-9A-F])", lambda m: bytes.fromhex(m[1].decode()), name.encode())
    path = Path(os.fsdecode(plain))
    return Path(os.path.realpath(path.parent)) / path.name  # a link by its own name


def template(job: dict[str, str], title: str, seconds: int) -> tuple[dict[str, Any], dict[str, str]]:
    """The job as a template of Open Job Description, whose parameters are all that a film is, and the paths among them."""
    paths, texts = {"Scene": job["scene"]}, {"Frames": job["frames"].replace("x", ":")}
    words = {"scene": "{{Param.Scene}}", "tiles": job["tiles"]}
    for name in ("output", "preview"):
        if job[name]:
            paths[name.title()], texts[name.title() + "Name"] = folder_and_name(job[name])
            words[name] = f"{{{{Param.{name.title()}}}}}/{{{{Param.{name.title()}Name}}}}"
    for name in ("options", "programs", "look"):
        texts[name.title()], words[name] = job[name], f"{{{{Param.{name.title()}}}}}"
    if job["ocio"]:
        (texts if "://" in job["ocio"] else paths)["OCIO"], words["ocio"] = job["ocio"], "{{Param.OCIO}}"
    parameters: list[dict[str, Any]] = [
        {"name": p, "type": "PATH"} | ({"objectType": "DIRECTORY", "dataFlow": "OUT"} if p in ("Output", "Preview")
                                       else {"objectType": "FILE", "dataFlow": "IN"}) for p in paths]
    parameters += [{"name": p, "type": "STRING", "default": text} for p, text in texts.items()]
    parameters += [{"name": "FramesPerTask", "type": "INT", "minValue": 1, "default": int(job["chunk"])},
                   {"name": "TaskSeconds", "type": "INT", "minValue": 0, "default": seconds,
                    "description": "How long a task shall take, where the scheduler chooses its frames; 0: FramesPerTask."}]
    space: list[dict[str, Any]] = [{"name": "Frame", "type": "CHUNK[INT]", "range": "{{Param.Frames}}", "chunks": {
        "defaultTaskCount": "{{Param.FramesPerTask}}", "targetRuntimeSeconds": "{{Param.TaskSeconds}}",
        "rangeConstraint": "NONCONTIGUOUS"}}]
    if job["tiles"]:
        space.append({"name": "Tile", "type": "INT", "range": f"0-{tiles_of(job['tiles']) - 1}"})

    def script(more: dict[str, str], *options: str) -> dict[str, Any]:
        run = {"command": "python3", "args": ["{{Task.File.Task}}", *(f"{k}={v}" for k, v in (words | more).items()), *options],
               "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": 30}}
        return {"actions": {"onRun": run},
                "embeddedFiles": [{"name": "Task", "type": "TEXT", "filename": "task.py", "data": TASK.read_text("utf-8")}]}
    render = {"step": "render", "frames": "{{Task.Param.Frame}}"} | ({"tile": "{{Task.Param.Tile}}"} if job["tiles"] else {})
    steps = [{"name": "Render", "parameterSpace": {"taskParameterDefinitions": space},
              "script": script(render, "--progress=openjd")},
             {"name": "Finish", "dependencies": [{"dependsOn": "Render"}],
              "script": script({"step": "finish", "frames": "{{Param.Frames}}"})}]
    form = {"specificationVersion": "jobtemplate-2023-09", "extensions": ["TASK_CHUNKING"], "name": title,
            "parameterDefinitions": parameters, "steps": steps}
    try:
        from openjd.model import DecodeValidationError, decode_job_template
    except ImportError:
        return form, paths
    try:
        decode_job_template(template=form, supported_extensions=["TASK_CHUNKING"])
    except DecodeValidationError as error:
        raise Refused(f"no template of Open Job Description can be made: {' '.join(str(error).split())}") from error
    return form, paths


def check_folder(folder: Path, scene: Path) -> None:
    """Refuses a folder with anything but an earlier job: none of its files is an input."""
    try:
        ours = not any(folder.iterdir()) or "cistula_farm" in json.loads((folder / "job.json").read_text())
    except FileNotFoundError:
        ours = not folder.exists()
    except (ValueError, OSError):
        ours = False
    if not ours or folder.resolve() == scene.resolve().parent:
        raise Refused(f"--to {shown(str(folder))}: holds other files than those of a job; name a new folder")


def main(arguments: Sequence[str]) -> int:
    usage = "cistula farm SCENE -o NAME [--tiles CxR] [--to DIR] [options of render, which are passed on to it]"
    parser = Parser("farm", description=__doc__, usage=usage, epilog="""examples:
  cistula farm scenes/seed.json -o out/beauty.####.exr --to farm
  cistula farm scenes/seed.json -o out/beauty.####.exr --to farm --tiles 4x3 --bits half --task-seconds 600
  make -j 2 -f farm/Makefile                  on this machine
  sh farm/submit.sh                           by Slurm
  openjd run farm/template.json -p Scene=scenes/seed.json -p Output=out
  deadline bundle submit farm                 by AWS Deadline Cloud

Tasks may be killed and repeated; what is complete stays. The last one writes out/manifest.sha256.

exit codes: as of render""")
    add = parser.add_argument
    add("-o", "--output", required=True, metavar="FILE", help="the images, as of render: *.exr")
    add("-f", "--frames", default="", metavar="LIST", help="as of render: all of the film")
    add("--tiles", default="", metavar="CxR", help="cut every frame into a grid of tiles, which render-merge puts together")
    add("--to", metavar="DIR", help="the folder of the job's files; SCENE.farm in the working directory")
    add("--task-seconds", type=number(1, 1e7), default=300.0, metavar="S", help="how long a task takes here, about; 300")
    add("--frames-per-task", type=number(1, 1e6, int), metavar="N", help="in place of --task-seconds; nothing is measured")
    add("--most-tasks", type=number(1, 1e6, int), default=1000, metavar="N", help="longer tasks if there would be more; 1000")
    add("--cpus", type=number(1, 1024, int), metavar="N", help="cores of a task of Slurm; --threads, or this machine's")
    add("--preview", default="", metavar="FILE", help="as of render; of tiles, render-merge makes them")
    for option in ("--exposure", "--view", "--bloom"):
        add(option, metavar=option[2:].upper(), help="of previews")
    add("-q", "--quiet", action="store_true", help="errors only")
    if not arguments or arguments[0].startswith("-"):
        if {"-h", "--help"} & set(arguments):
            parser.print_help()
            return 0
        raise Refused("the scene comes first, a file: cistula farm SCENE -o FILE.exr; --help tells more")
    scene = arguments[0]
    options, more = parser.parse_known_args(arguments[1:])
    for word in more:
        if word.partition("=")[0] in REFUSED:
            raise Refused(f"{word}: is of a run of render, not of a job of many; leave it out")
    if Path(options.output).suffix.lower() != ".exr":
        raise Refused(f"-o {options.output}: only EXRs say what they show, so that tasks can go on; name it *.exr")
    if options.tiles and not re.fullmatch(r"[1-9]\d{0,4}x[1-9]\d{0,4}", options.tiles):
        raise Refused(f"--tiles {options.tiles}: must be columns x rows, as 4x3")
    tiles = tiles_of(options.tiles)
    look = [f"--{n}={value}" for n in ("exposure", "view", "bloom") if (value := getattr(options, n)) is not None]
    name = re.sub(r"[^\w.-]", "_", Path(scene).stem, flags=re.ASCII)[:60].lstrip("-.") or "film"
    folder = Path(options.to or name + ".farm")
    check_folder(folder, Path(scene))
    if look and not options.preview:
        raise Refused(f"{look[0]}: is of previews; give --preview FILE.png, too")
    film = Film([scene, *more], options.output, options.preview, look)
    frames, files, said = film.begun(options.frames, ["--tiles", options.tiles, "--tile", "0"] if options.tiles else [])
    chunk, seconds = options.frames_per_task, 0.0
    if not chunk:
        seconds = film.seconds(frames)
        longer = -(-len(frames) // max(options.most_tasks // tiles, 1))
        chunk = min(max(int(options.task_seconds * tiles / seconds), longer, 1), len(frames))
    count = -(-len(frames) // chunk) * tiles
    if count > options.most_tasks:
        raise Refused(f"--most-tasks {options.most_tasks}: there are {count} tasks; give fewer tiles or more frames a task")

    def from_folder(path: str) -> str:
        return os.path.relpath(os.path.realpath(path), folder.resolve())
    ocio = os.environ.get("OCIO", "") if options.view not in (None, "srgb", "filmic") else ""
    job = {"cistula_farm": "1", "root": from_folder("."), "programs": str(program("render").parent), "scene": scene,
           "output": options.output, "options": shlex.join(more), "tiles": options.tiles if tiles > 1 else "",
           "preview": options.preview, "look": shlex.join(look), "frames": format_frames(frames), "chunk": str(chunk),
           "ocio": os.path.abspath(ocio) if ocio and "://" not in ocio else ocio}
    form, paths = template(job, name, 0 if options.frames_per_task else int(options.task_seconds))
    values = [{"name": n, "value": from_folder(path)} for n, path in paths.items()]
    assets = [str(path) for path in files]
    threads = re.search(r"--threads[= ](\d+)", job["options"])
    fields = {"name": name, "last": count - 1, "cpus": options.cpus or (threads and threads[1]) or os.cpu_count()}
    write_whole({folder / n: text.encode() for n, text in {
        "task.py": TASK.read_text("utf-8"), "job.json": json.dumps(job, indent=2), "template.json": json.dumps(form, indent=2),
        "parameter_values.json": json.dumps({"parameterValues": values}, indent=2),
        "asset_references.json": json.dumps({"assetReferences": {"inputs": {"filenames": assets}}}, indent=2),
        "job.slurm": TASKS.format(**fields), "finish.slurm": FINISH.format(**fields | {"name": name + "-finish"}),
        "submit.sh": SUBMIT, "Makefile": MAKEFILE.format(**fields)}.items()})
    if not options.quiet:
        for text in said:
            print(f"cistula farm: {text}", file=sys.stderr)
        each = f", about {min(chunk, len(frames)) * seconds / tiles:.3g} s each on this machine" if seconds else ""
        print(f"{shown(str(folder))}: {count} tasks for {len(frames)} frames of {tiles} tiles{each}")
        given = [word for n, path in paths.items() for word in ("-p", f"{n}={path}")]
        for way in (["make", "-j2", "-f", f"{folder}/Makefile"], ["sh", f"{folder}/submit.sh"],
                    ["openjd", "run", f"{folder}/template.json", *given]):
            print(shlex.join(way))
    return 0
