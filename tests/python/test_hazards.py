"""What happens to a library inside Python: signals, threads, forks, callbacks that raise."""
from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import processor_seconds, until

import cistula

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def scene() -> cistula.Scene:
    return cistula.Scene.load(SOURCE / "scenes" / "platonic.json")


def test_progress_is_told(scene: cistula.Scene) -> None:
    told: list[float] = []
    scene.render(size=(480, 270), progress=told.append)
    assert told == sorted(told) and told[-1] == 1 and all(0 <= share <= 1 for share in told)


def test_what_a_callback_raises_ends_the_render_and_comes_out(scene: cistula.Scene) -> None:
    told: list[tuple[float, float]] = []

    def enough(share: float) -> None:
        told.append((share, time.process_time()))
        raise LookupError("enough")

    begin = time.process_time()
    with pytest.raises(LookupError, match="enough"):
        scene.render(size=(7680, 4320), depth=64, progress=enough)
    end = time.process_time()
    [(share, raised)] = told
    assert end - raised < (raised - begin) * (1 - share) / share / 2  # half of what the rest of the picture takes


def interrupted(code: str) -> str:
    """What a process says that gets a SIGINT when processors have worked for it since it printed a line."""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=SOURCE)
    assert process.stdout is not None
    process.stdout.readline()
    before = processor_seconds(process.pid)
    until(lambda: processor_seconds(process.pid) > before + 0.3, process)
    process.send_signal(signal.SIGINT)
    return process.communicate()[0]


END = "\nexcept KeyboardInterrupt: print('stopped')\nelse: print('went on')"


def test_ctrl_c_stops_a_render() -> None:
    code = "import cistula\ns = cistula.Scene.load('scenes/infinity.json')\nprint(1, flush=True)\ntry: s.render(size=(7680, 4320), depth=64)" + END
    assert interrupted(code) == "stopped\n"


def test_ctrl_c_stops_a_compilation() -> None:
    code = """import cistula, numpy as np
n = 1500
x, y = np.meshgrid(np.arange(n), np.arange(n))
points = np.stack([x, y, np.sin(x) + np.cos(1.7 * y)], axis=-1).reshape(-1, 3)
i = (y[:-1, :-1] * n + x[:-1, :-1]).ravel()
faces = np.concatenate([np.stack([i, i + 1, i + n], 1), np.stack([i + 1, i + n + 1, i + n], 1)])
b = cistula.SceneBuilder({'materials': {'m': {}}}).mesh('m', points, faces, material='m')
print(1, flush=True)
try: b.build()""" + END
    assert interrupted(code) == "stopped\n"


def test_other_threads_go_on_while_a_frame_renders(scene: cistula.Scene) -> None:
    counted = during = calls = 0
    stop = False

    def count() -> None:
        nonlocal counted
        while not stop:
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    while during <= 10 + calls:  # a call that holds all others up may still see one step
        before = counted
        scene.render(size=(640, 360))
        during += counted - before
        calls += 1
    stop = True
    thread.join()


def in_threads(number: int, work: Callable[[], object]) -> list[object]:
    results: list[object] = []
    threads = [threading.Thread(target=lambda: results.append(work())) for _ in range(number)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def test_threads_share_scenes(scene: cistula.Scene) -> None:
    whole = scene.render(size=(96, 54)).hash
    assert in_threads(4, lambda: scene.render(size=(96, 54)).hash) == 4 * [whole]
    assert in_threads(3, lambda: cistula.Scene.load(scene.source).render(size=(96, 54)).hash) == 3 * [whole]
    distances = scene.intersect([0, 0, 9], np.random.default_rng(2).normal(size=(999, 3))).distance.tobytes()
    assert in_threads(3, lambda: scene.intersect([0, 0, 9], np.random.default_rng(2).normal(size=(999, 3))).distance.tobytes()) == 3 * [distances]


def child(queue: multiprocessing.Queue[str]) -> None:
    try:
        queue.put(cistula.Scene.load(SOURCE / "scenes" / "platonic.json").render(size=(64, 36)).hash)
    except RuntimeError as error:
        queue.put(str(error))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_after_use_says_so_and_a_spawned_process_works(scene: cistula.Scene) -> None:
    whole = scene.render(size=(64, 36)).hash
    for way, expected in (("fork", "spawn"), ("spawn", whole)):
        context = multiprocessing.get_context(way)
        queue = context.Queue()
        process = context.Process(target=child, args=(queue,))  # type: ignore[attr-defined]
        process.start()
        assert expected in queue.get()
        process.join()


def test_a_fork_before_use_works() -> None:
    code = """import cistula, os
pid = os.fork()
hash = cistula.Scene.load('scenes/platonic.json').render(size=(64, 36)).hash
if pid: os.waitpid(pid, 0)
print(hash, flush=True)"""
    lines = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=SOURCE).stdout.split()
    assert len(lines) == 2 and lines[0] == lines[1]


def test_importing_starts_nothing() -> None:
    code = "import os, cistula; print(len(os.listdir('/proc/self/task')))"
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout == "1\n"


WORKS = ["scene.render(size=(96, 54))", "scene.render(size=(7680, 4320), depth=64)", "list(scene.film([0, 1], size=(320, 180)))",
         "cistula.Scene.load('scenes/hard/nested-shells.json')", "cistula.compare(image, image)", "image.save(FOLDER + '/a.exr')",
         "scene.intersect([0, 0, 9], np.full((9999, 3), -1.0))", "cistula.verify(quick=True)",
         "scene.render(size=(960, 540), progress=lambda share: scene.render(size=(320, 180)))"]


def ended(work: str, folder: Path, end: str = "", before: str = "", threads: int = 2) -> tuple[int, str, str]:
    """Exit code and words of a process whose Python ends while daemon threads work."""
    code = f"""import atexit, os, threading, time, numpy as np
FOLDER = {str(folder)!r}
{before}
import cistula
scene = cistula.Scene.load('scenes/glass.json')
image = scene.render(size=(320, 180))
def work():
    while True: {work}
for i in range({threads}): threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
{end}
print('ends', flush=True)"""
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=SOURCE, timeout=120)
    return process.returncode, process.stdout, process.stderr


@pytest.mark.parametrize("work", WORKS)
def test_python_ends_while_daemon_threads_work(work: str, tmp_path: Path) -> None:
    assert ended(work, tmp_path) == (0, "ends\n", "")


def test_what_ends_after_it_still_works_and_so_does_a_forked_process(tmp_path: Path) -> None:
    late = "def late(): print(cistula.Scene.load('scenes/platonic.json').render(size=(32, 18)).hash != image.hash)\natexit.register(late)"
    assert ended(WORKS[0], tmp_path, before=late) == (0, "ends\nTrue\n", "")
    fork = "pid = os.fork()\nif pid: assert os.waitpid(pid, 0)[1] == 0"
    assert ended(WORKS[1], tmp_path, fork) == (0, "ends\nends\n", "")


def test_a_subinterpreter_is_refused() -> None:
    code = """try: import _interpreters as interpreters
except ImportError: import _xxsubinterpreters as interpreters
made = interpreters.create()
said = interpreters.run_string(made, '''try: import cistula
except ImportError as error: print(error, flush=True)''')
assert said is None, said
import cistula
cistula.Scene.load('scenes/platonic.json').render(size=(32, 18))
print('works')"""
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=SOURCE, timeout=60)
    assert process.stdout == "cistula: this is a subinterpreter; import it in the main interpreter, or in processes of their own\nworks\n"
