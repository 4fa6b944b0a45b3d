"""`cistula farm`: its job by make, by Open Job Description and by Slurm, and what may happen to tasks."""
import json
import os
import random
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import processor_seconds, until

from cistula import farm_task
from cistula.farm_task import folder_and_name, format_frames, images_of, parse_frames

OpenEXR = pytest.importorskip("OpenEXR")

SCENE = {"film": {"width": 64, "height": 36, "frames": 3, "supersample": 2}, "depth": 4, "ambient": 0.1,
         "camera": {"position": [-5, -6, 3], "target": [0, 0, 0.9], "fov": 42},
         "materials": {"floor": {"color": 1, "diffuse": 0.8, "reflection": 0.2},
                       "glass": {"color": [0.5, 0.8, 1], "diffuse": 0.3, "specular": 1, "reflection": 0.2, "transmission": 0.6}},
         "objects": [{"name": "floor", "quad": [[-6, -6, 0], [6, -6, 0], [6, 6, 0], [-6, 6, 0]], "material": "floor"},
                     {"name": "cube", "solid": "cube", "center": [-0.8, 0.6, 0.9], "radius": 1.5, "material": "glass"}],
         "lights": [{"position": [4, -3, 6], "color": [1, 0.875, 0.75]}]}
TWELVE = ["-f", "0-4", "--res", "200x120", "--supersample", "3", "--layers", "diffuse,cryptomatte"]


class Farm:
    """A folder with a scene, s.json, and what is done there."""

    def __init__(self, folder: Path, programs: Path) -> None:
        self.folder = folder
        # python3 is this one, not a script that looks for one.
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        self.environment = {**os.environ, "CISTULA_BIN": str(programs), "PATH": path}
        self.render = programs / "render"
        (folder / "s.json").write_text(json.dumps(SCENE))

    def run(self, *command: str | Path, **more: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, **{"cwd": self.folder, "env": self.environment, "text": True, "capture_output": True,
                                          "check": False, "errors": "surrogateescape", **more})

    def done(self, *command: str | Path, **more: Any) -> str:
        result = self.run(*command, **more)
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout

    def farm(self, *arguments: str, scene: str = "s.json") -> str:
        return self.done(sys.executable, "-m", "cistula", "farm", scene, *arguments)

    def refused(self, code: int, message: str, *arguments: str) -> None:
        before = sorted(self.folder.rglob("*"))
        result = self.run(sys.executable, "-m", "cistula", "farm", *arguments)
        assert (result.returncode, result.stdout, result.stderr.count("\n")) == (code, "", 1), result.stderr
        assert result.stderr.startswith("cistula farm: ") and message in result.stderr, result.stderr
        assert sorted(self.folder.rglob("*")) == before

    def job(self) -> dict[str, str]:
        return dict(json.loads((self.folder / "farm/job.json").read_text()))

    def whole(self, *options: str) -> None:
        """Renders the film in one run, to whole/."""
        self.done(self.render, "s.json", "-q", "-o", "whole/f.##.exr", *options)

    def expect_whole(self) -> None:
        """The files of whole/ are those of out/, which has nothing unfinished, and its manifest names them."""
        names = sorted(os.listdir(self.folder / "whole"))
        for name in names:
            assert (self.folder / "whole" / name).read_bytes() == (self.folder / "out" / name).read_bytes(), name
        self.done("sha256sum", "-c", "--quiet", "manifest.sha256", cwd=self.folder / "out")
        lines = (self.folder / "out/manifest.sha256").read_text().splitlines()
        assert [line.split("  ")[1] for line in lines] == [name for name in names if name.endswith(".exr")]
        assert not [name for name in os.listdir(self.folder / "out") if "part" in name or name.startswith(".")]

    def task(self, number: int | str, *more: str) -> "subprocess.Popen[str]":
        """A task in a process group of its own."""
        return subprocess.Popen(["python3", "farm/task.py", str(number), *more], cwd=self.folder, env=self.environment, text=True,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)


@pytest.fixture
def film(tmp_path: Path, programs: Path) -> Farm:
    return Farm(tmp_path, programs)


def children(process: int) -> list[int]:
    found = Path(f"/proc/{process}/task/{process}/children").read_text().split()
    return [int(word) for word in found]


def test_frame_lists() -> None:
    assert parse_frames("7,0-20x5,3-4,010") == [0, 3, 4, 5, 7, 10, 15, 20]
    assert parse_frames("0-9:3,5") == [0, 3, 5, 6, 9]
    assert format_frames([0, 1, 2, 3, 7, 10, 13, 20]) == "0-3,7-13x3,20"
    for seed in range(200):
        frames = sorted(random.Random(seed).sample(range(60), 1 + seed % 40))
        assert parse_frames(format_frames(frames)) == frames
    for wrong in ("", "a", "1-", "1-2x0", "-1", "1 2"):
        with pytest.raises(ValueError):
            parse_frames(wrong)


def test_names(tmp_path: Path) -> None:
    assert folder_and_name("a/b/f.##.exr") == ("a/b", "f.##.exr")
    assert folder_and_name("a/####/f.exr") == ("a/####", "f.exr")
    assert folder_and_name("sh#t/f.#.exr") == ("sh#t", "f.#.exr")
    assert folder_and_name("#/%d/f.exr") == ("#", "%d/f.exr")
    assert folder_and_name("%04d/f.exr") == (".", "%04d/f.exr")
    assert folder_and_name("/f.exr") == ("/", "f.exr")
    names = ["f.00.exr", "f.diffuse.00.exr", "f.01.exr", "f.100.exr", "f.tile07.00.exr", "f.snapshot.00.exr", "g.00.exr", "f.exr", "f.x.exr"]
    for name in names:
        (tmp_path / name).touch()
    found = images_of(f"{tmp_path}/f.##.exr", [0, 100])[1]
    assert [file.name for file in found] == ["f.00.exr", "f.100.exr", "f.diffuse.00.exr"]
    assert [file.name for file in images_of(f"{tmp_path}/g.%d.exr", [0])[1]] == ["g.00.exr"]
    (tmp_path / "0003").mkdir()
    (tmp_path / "0003/f.exr").touch()
    assert images_of(f"{tmp_path}/%04d/f.exr", [3])[1] == [tmp_path / "0003/f.exr"]


def test_tasks_take_about_as_long_as_they_shall(film: Farm) -> None:
    arguments = ["-o", "out/f.##.exr", "--to", "farm", "-f", "0-99"]
    text = film.farm(*arguments, "--tiles", "2x2", "--frames-per-task", "7")
    assert "farm: 60 tasks for 100 frames of 4 tiles\n" in text and film.job()["chunk"] == "7"
    film.farm(*arguments, "--tiles", "2x2", "--task-seconds", "1", "--most-tasks", "8", "--res", "640x360", "--supersample", "8")
    assert film.job()["chunk"] == "50"  # no more tasks than there may be, however long they take
    text = film.farm(*arguments, "--task-seconds", "1000000")
    assert film.job()["chunk"] == "100" and "1 tasks for 100 frames of 1 tiles, about " in text
    film.farm(*arguments[:4], "--frames-per-task", "1")
    assert film.job()["frames"] == "0-2"  # those of the film
    film.refused(2, "--most-tasks 3: there are 4 tasks", "s.json", *arguments, "--tiles", "2x2", "--most-tasks", "3")


def test_killed_tasks_cost_nothing_but_themselves(film: Farm) -> None:
    film.whole(*TWELVE)
    film.farm(*TWELVE, "-o", "out/f.##.exr", "--tiles", "4x3", "--to", "farm", "--frames-per-task", "1")
    chance = random.Random(40)
    order = chance.sample(range(60), 60)
    assert film.task(order[-1]).wait() == 0
    killed = 0
    for turn, number in enumerate(order[:40]):
        before = set(os.listdir(film.folder / "out"))
        task = film.task(number)
        # Before it does anything; when render starts; when it has written, if not all.
        until(lambda: (turn % 3 == 0 or task.poll() is not None or (turn % 3 == 1 and children(task.pid) != [])
                       or set(os.listdir(film.folder / "out")) != before))
        os.killpg(task.pid, signal.SIGKILL)
        killed += task.wait() == -signal.SIGKILL
    assert killed >= 10, "too few were still at work"
    film.done("make", "-s", "-j", "2", "-f", "farm/Makefile")
    film.expect_whole()


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_a_cancelled_task_takes_its_render_with_it(film: Farm, how: int) -> None:
    film.farm("-f", "0", "--res", "1920x1080", "--supersample", "64", "-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "1")
    task = film.task(0)
    until(lambda: children(task.pid) != [], task)
    (render,) = children(task.pid)
    until(lambda: processor_seconds(render) > 0.2, task)
    task.send_signal(how)
    assert task.wait() == (130 if how == signal.SIGTERM else -how)
    until(lambda: not Path(f"/proc/{render}").exists() or "Z" in Path(f"/proc/{render}/stat").read_text().rpartition(")")[2])
    assert not list((film.folder / "out").glob("*.exr"))


def test_two_workers_on_a_task_do_it(film: Farm) -> None:
    film.whole(*TWELVE)
    film.farm(*TWELVE, "-o", "out/f.##.exr", "--tiles", "4x3", "--to", "farm", "--frames-per-task", "2")
    for number in range(4):
        both = film.task(number), film.task(number)
        assert [task.wait() for task in both] == [0, 0]
    film.done("make", "-s", "-j", "2", "-f", "farm/Makefile")
    film.expect_whole()


def test_a_full_disk_fails_a_task_and_loses_nothing(film: Farm) -> None:
    options = ["-f", "0-1", "--res", "200x120"]
    film.whole(*options)
    film.farm(*options, "-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "2")
    room = (film.folder / "whole/f.00.exr").stat().st_size * 3 // 2  # the first frame fits, the second does not
    (film.folder / "drill.sh").write_text(f"""mkdir -p out && mount -t tmpfs -o size={room} none out || exit 77
python3 farm/task.py 0 -q; echo $?; ls -A out; mount -o remount,size=64m out
python3 farm/task.py 0 -q && python3 farm/task.py finish && mkdir copy && cp out/* copy""")
    result = film.run("unshare", "-rm", "sh", "drill.sh")
    if result.returncode == 77 or "unshare" in result.stderr:
        pytest.skip("no disk can be made here that gets full: " + result.stderr)
    assert (result.returncode, result.stdout) == (0, "3\nf.00.exr\n"), result.stderr
    assert "No space left on device" in result.stderr
    shutil.rmtree(film.folder / "out")
    (film.folder / "copy").rename(film.folder / "out")
    film.expect_whole()


def test_a_worker_of_another_version_is_refused_and_repeated(film: Farm) -> None:
    options = ["-f", "0", "--res", "80x48"]
    film.whole(*options)
    film.farm(*options, "-o", "out/f.##.exr", "--to", "farm", "--tiles", "2x2")
    for number in range(4):
        assert film.task(number).wait() == 0
    tile = film.folder / "out/f.tile2.00.exr"
    picture = OpenEXR.File(str(tile), separate_channels=True)
    OpenEXR.File({**picture.header(), "cistula:version": "0.0.9"}, picture.channels()).write(str(tile))
    refused = film.run("python3", "farm/task.py", "finish")
    assert refused.returncode == 1 and "out/f.tile2.00.exr" in refused.stderr and "0.0.9" in refused.stderr
    assert not (film.folder / "out/f.00.exr").exists() and not (film.folder / "out/manifest.sha256").exists()
    film.done("make", "-s", "-f", "farm/Makefile")
    film.expect_whole()


def test_a_finish_without_its_tasks_says_what_is_missing(film: Farm) -> None:
    film.farm(*TWELVE, "-o", "out/f.##.exr", "--to", "farm", "--tiles", "4x3")
    assert film.task(0).wait() == 0
    result = film.run("python3", "farm/task.py", "finish")
    assert result.returncode == 3 and "of its 12 tiles are missing" in result.stderr


def test_tasks_are_numbers(film: Farm) -> None:
    film.farm("-f", "0-10", "-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "1")
    assert film.task("010").wait() == 0  # a decimal number, whatever a shell takes it for
    assert os.listdir(film.folder / "out") == ["f.10.exr"]
    for wrong in ("11", "-1", "x", "1.5"):
        result = film.run("python3", "farm/task.py", wrong)
        assert result.returncode == 2 and "0 to 10" in result.stderr


def test_names_have_any_characters(film: Farm) -> None:
    strange = "it's $(touch PWNED) `touch PWNED` \"; a"
    folder = film.folder / strange
    folder.mkdir()
    (film.folder / "s.json").rename(folder / "{{s}} cene.json")
    film.farm("-o", f"{strange}/out/f %%.##.exr", "-f", "0-1", "--to", f"{strange}/$(touch PWNED) # farm", "--frames-per-task", "1",
              scene=f"{strange}/{{{{s}}}} cene.json")
    film.done("make", "-s", "-j", "2", "-f", f"{strange}/$(touch PWNED) # farm/Makefile")
    assert sorted(os.listdir(folder / "out")) == ["f %.00.exr", "f %.01.exr", "manifest.sha256"]
    film.done("sha256sum", "-c", "--quiet", "manifest.sha256", cwd=folder / "out")
    assert not list(film.folder.rglob("PWNED"))


def test_a_job_moves_with_its_film(film: Farm) -> None:
    (film.folder / "a").mkdir()
    (film.folder / "s.json").rename(film.folder / "a/s.json")
    film.done(sys.executable, "-m", "cistula", "farm", "s.json", "-o", "out/f.##.exr", "--to", "farm", "-q", cwd=film.folder / "a")
    (film.folder / "a").rename(film.folder / "b")
    film.done("make", "-s", "-f", "b/farm/Makefile")
    assert (film.folder / "b/out/f.02.exr").exists()


def test_crops_previews_and_layers_in_files(film: Farm) -> None:
    options = ["-f", "0-1", "--crop", "40x20+7+5", "--layers", "diffuse,Z", "--split", "files", "--preview", "out/p.##.png", "--exposure", "-1",
               "--view", "filmic"]
    film.whole(*[option.replace("out/", "whole/") for option in options])
    film.farm(*options, "-o", "out/f.##.exr", "--to", "farm", "--tiles", "2x1")
    film.done("make", "-s", "-f", "farm/Makefile")
    film.expect_whole()
    shutil.rmtree(film.folder / "out")
    film.farm(*options, "-o", "out/f.##.exr", "--to", "farm")
    film.done("make", "-s", "-f", "farm/Makefile")
    film.expect_whole()


def test_a_config_of_colors_is_kept(film: Farm) -> None:
    oiio = pytest.importorskip("OpenImageIO")
    del oiio
    film.environment["OCIO"] = "ocio://default"
    arguments = ["-o", "out/f.##.exr", "--to", "farm", "--preview", "out/p.##.png", "--tiles", "2x1", "--view", "Raw", "--frames-per-task", "1"]
    film.farm(*arguments)
    assert film.job()["ocio"] == "ocio://default"
    film.environment["OCIO"] = "c.ocio"
    film.farm(*arguments)
    assert film.job()["ocio"] == str(film.folder / "c.ocio")
    (film.folder / "render").write_text("#!/bin/sh\necho \"$OCIO\"\n")
    (film.folder / "render").chmod(0o755)
    environment = {k: v for k, v in film.environment.items() if k != "OCIO"} | {"CISTULA_BIN": str(film.folder)}
    assert film.done("python3", "farm/task.py", "0", env=environment) == f"{film.folder}/c.ocio\n"


def test_slurms_cores_are_threads(film: Farm) -> None:
    film.farm("-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "1", "--cpus", "3")
    script = (film.folder / "farm/job.slurm").read_text()
    assert "--cpus-per-task=3\n" in script and "--requeue" in script and "--array=0-2\n" in script
    (film.folder / "render").write_text('#!/bin/sh\necho "$@"\n')
    (film.folder / "render").chmod(0o755)
    text = film.done("python3", "farm/task.py", "1", env={**film.environment, "CISTULA_BIN": str(film.folder), "SLURM_CPUS_PER_TASK": "3"})
    assert text == "s.json -o out/f.##.exr -f 1 --resume --threads 3\n"
    film.farm("-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "1", "--threads", "5")
    assert "--cpus-per-task=5\n" in (film.folder / "farm/job.slurm").read_text()


def test_errors_are_one_line(film: Farm) -> None:
    film.refused(2, "the scene comes first", "-o", "a.exr")
    film.refused(2, "-o/--output", "s.json")
    film.refused(2, "name it *.exr", "s.json", "-o", "a.out")
    film.refused(2, "--resume: is of a run of render", "s.json", "-o", "a.exr", "--resume")
    film.refused(2, "--stats=x: is of a run of render", "s.json", "-o", "a.exr", "--stats=x")
    film.refused(2, "--exposure=1: is of previews", "s.json", "-o", "a.exr", "--exposure", "1")
    film.refused(2, "put #### into the name", "s.json", "-o", "a.#.exr", "--preview", "p.png")
    film.refused(2, "more than there are pixels", "s.json", "-o", "a.exr", "--tiles", "65x1")
    film.refused(2, "--tiles 2: must be columns x rows", "s.json", "-o", "a.exr", "--tiles", "2")
    film.refused(2, "--dept", "s.json", "-o", "a.exr", "--dept", "3")
    film.refused(2, "--compression", "s.json", "-o", "a.exr", "--tiles", "2x2", "--compression", "dwaa")
    film.refused(2, "--task-seconds: 0 must be a number", "s.json", "-o", "a.exr", "--task-seconds", "0")
    film.refused(3, "none.json", "none.json", "-o", "a.exr")
    (film.folder / "full").mkdir()
    (film.folder / "full/a").touch()
    film.refused(2, "--to full: holds other files", "s.json", "-o", "a.exr", "--to", "full")
    film.refused(2, "--to s.json: holds other files", "s.json", "-o", "a.exr", "--to", "s.json")
    film.refused(2, "--to .: holds other files", "s.json", "-o", "a.exr", "--to", ".")
    film.environment["CISTULA_BIN"] = "/nowhere"
    film.refused(2, "there is no render in /nowhere", "s.json", "-o", "a.exr")


def test_the_files_of_a_scene_are_listed(film: Farm) -> None:
    scene = json.loads(json.dumps(SCENE))
    scene["objects"].append({"name": "m", "mesh": "meshes/my mesh.obj", "material": "floor"})
    scene["textures"] = {"t": {"file": "t.data"}}
    (film.folder / "meshes").mkdir()
    (film.folder / "meshes/my mesh.obj").write_text("mtllib my colors.mtl\nv 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n")
    (film.folder / "meshes/my colors.mtl").write_text("newmtl a\nmap_Kd ../w.png\n")
    for name in ("t.data", "w.png", "other.png"):
        (film.folder / name).write_bytes(b"")
    (film.folder / "s.json").write_text(json.dumps(scene, indent=1))
    assert assets(film) == ["meshes/my colors.mtl", "meshes/my mesh.obj", "t.data", "w.png"]


def assets(film: Farm) -> list[str]:
    """The files that the job's bundle names, by their names in the scene's folder."""
    film.farm("-o", "out/f.##.exr", "--to", "farm", "-f", "0", "--frames-per-task", "1")
    listed = json.loads((film.folder / "farm/asset_references.json").read_text())["assetReferences"]["inputs"]["filenames"]
    return sorted(os.path.relpath(name, film.folder) for name in listed)


@pytest.mark.parametrize("mesh,text,library,name", [
    ("tëil.obj", "mtllib c.mtl\n", "c.mtl", "c.mtl"), ("PART.OBJ", "mtllib c.mtl\n", "c.mtl", "c.mtl"), ("a.obj", "mtllib \\\n  c.mtl\n", "c.mtl", "c.mtl"),
    ("a.obj", "mtllib far\\c.mtl\n", "far/c.mtl", "far/c.mtl"), ("a.obj", "mtllib none.mtl\n", "a.mtl", "a.mtl"), ("a.obj", "mtllib\tthe c.mtl \n", "the c.mtl", "the c.mtl"),
    ("a.obj", "\ufeffmtllib c.mtl\n", "c.mtl", "c.mtl"), ("a.obj", "mtllib caf\udce9 %E9.mtl\n", "caf\udce9 %E9.mtl", "caf\udce9 %E9.mtl")])
def test_a_job_lists_what_the_reader_opened(film: Farm, mesh: str, text: str, library: str, name: str) -> None:
    body = text + "usemtl m\nv 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n"
    (film.folder / mesh).write_bytes(body.encode("utf-16-le") if text[0] == "\ufeff" else body.encode(errors="surrogateescape"))
    (film.folder / library).parent.mkdir(exist_ok=True)
    (film.folder / library).write_text("newmtl m\nKd 1 0 0\n")
    scene = {**SCENE, "objects": [*SCENE["objects"], {"name": "m", "mesh": mesh}]}  # type: ignore[misc]
    (film.folder / "s.json").write_text(json.dumps(scene))  # \u00eb
    assert assets(film) == sorted([mesh, name])


def test_a_material_file_that_is_missing_is_said(film: Farm) -> None:
    (film.folder / "a.obj").write_text("mtllib none.mtl\nv 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n")
    (film.folder / "s.json").write_text(json.dumps({**SCENE, "objects": [{"name": "m", "mesh": "a.obj", "material": "floor"}]}))
    result = film.run(sys.executable, "-m", "cistula", "farm", "s.json", "-o", "f.exr", "-f", "0", "--frames-per-task", "1", "--to", "farm")
    assert result.returncode == 0 and "there are no such material libraries: 'none.mtl'" in result.stderr


@pytest.mark.parametrize("frames,message", [("-3-3", "is no frame"), ("5-0:-1", "is no frame"), ("5-0", "ends before it begins")])
def test_frames_that_are_none_are_refused_in_a_line(film: Farm, frames: str, message: str) -> None:
    result = film.run("python3", farm_task.__file__, "step=render", f"frames={frames}", "scene=s.json", "output=f.exr")
    assert (result.returncode, result.stderr.count("\n")) == (2, 1) and message in result.stderr, result.stderr


def openjd() -> Path:
    program = Path(sys.executable).with_name("openjd")
    if not program.exists():
        pytest.skip("openjd is not installed (PyPI: openjd-cli)")
    return program


def test_open_job_description_runs_the_job(film: Farm) -> None:
    options = ["-f", "0-4x2,7", "--res", "80x48", "--layers", "Z", "--preview", "out/my p.##.png", "--exposure", "1"]
    program = openjd()
    film.whole(*[option.replace("out/", "whole/") for option in options])
    text = film.farm(*options, "-o", "out/f.##.exr", "--tiles", "2x1", "--to", "farm", "--frames-per-task", "3")
    film.done(program, "check", "farm/template.json")
    template = json.loads((film.folder / "farm/template.json").read_text())
    paths = {p["name"]: (p["objectType"], p["dataFlow"]) for p in template["parameterDefinitions"] if p["type"] == "PATH"}
    assert paths == {"Scene": ("FILE", "IN"), "Output": ("DIRECTORY", "OUT"), "Preview": ("DIRECTORY", "OUT")}
    values = json.loads((film.folder / "farm/parameter_values.json").read_text())["parameterValues"]
    assert {v["name"]: v["value"] for v in values} == {"Scene": "../s.json", "Output": "../out", "Preview": "../out"}
    shutil.move(film.folder / "farm/template.json", film.folder / "alone.json")  # it needs nothing beside it
    shutil.rmtree(film.folder / "farm")
    command = next(line for line in text.splitlines() if line.startswith("openjd"))
    ran = film.done("sh", "-c", command.replace("farm/template.json", "alone.json"),
                    env={**film.environment, "PATH": f"{program.parent}:{os.environ['PATH']}"})
    assert "Chunks run: 5" in ran, ran  # 0,2,4 and 7 of each of two tiles, and what comes after them
    assert "openjd_progress: 100.00" in ran
    film.expect_whole()
    film.done(program, "run", "alone.json", "-p", "Scene=s.json", "-p", "Output=more", "-p", "Preview=more", "-p", "Frames=1", "-p",
              "OutputName=g.%d.exr")
    assert (film.folder / "more/g.1.exr").exists()


def test_a_cancelled_session_of_open_job_description_takes_render_with_it(film: Farm) -> None:
    program = openjd()
    film.farm("-f", "0", "--res", "1920x1080", "--supersample", "64", "-o", "out/f.##.exr", "--to", "farm", "--frames-per-task", "1")
    session = subprocess.Popen([program, "run", "farm/template.json", "-p", "Scene=s.json", "-p", "Output=out"],
                               cwd=film.folder, env=film.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def at_work() -> list[Path]:
        found = []
        for path in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                found += [path] if f"{film.folder}/out/f".encode() in path.read_bytes() and "render" in path.read_text() else []
            except OSError:
                pass
        return found

    until(lambda: any(path.read_bytes().startswith(str(film.render).encode()) for path in at_work()), session)
    session.terminate()
    session.wait()
    until(lambda: not at_work())
    assert not list((film.folder / "out").glob("*.exr"))


def test_slurm_runs_the_job(film: Farm, source: Path) -> None:
    options = ["-f", "0-1", "--res", "80x48", "--layers", "Z"]
    film.whole(*options)
    film.farm(*options, "-o", "out/f.##.exr", "--tiles", "2x1", "--to", "farm", "--frames-per-task", "1", "--cpus", "1")
    (film.folder / "wait.sh").write_text("""sh farm/submit.sh || exit 1
while squeue -h -o %R | grep -qv DependencyNeverSatisfied; do sleep 0.2; done
""")
    result = film.run("bash", source / "tests/python/slurm.sh", str(film.folder / "slurm"), "sh", "wait.sh")
    if result.returncode == 77:
        pytest.skip(result.stderr)
    assert result.returncode == 0, result.stdout + result.stderr
    log = film.folder / "farm/finish.log"
    assert (film.folder / "out/manifest.sha256").exists(), log.read_text() if log.exists() else os.listdir(film.folder / "farm")
    assert (film.folder / "farm/task-0.log").exists()
    film.expect_whole()


def test_the_task_needs_python_alone() -> None:
    text = Path(farm_task.__file__).read_text(encoding="utf-8")
    assert "{{" not in text, "Open Job Description would put something there"
    assert all(line.split()[1].partition(".")[0] in sys.stdlib_module_names for line in text.splitlines() if line.startswith(("import", "from")))
