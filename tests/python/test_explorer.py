"""The explorer's page in Chromium, without a window: clicks, keys, the slider, widths, dark; and the widget. What the page adds up is
what `render` gives."""
from __future__ import annotations

import base64
import contextlib
import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cistula
import numpy as np
import pytest
from conftest import processor_seconds, until

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium (Debian: apt-get install chromium)")


class Browser:
    """A page in Chromium, driven by its DevTools protocol over a pair of pipes."""

    def __init__(self, profile: Path) -> None:
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()

        def pipes() -> None:  # are those of the numbers 3 and 4 there
            read, write = os.dup(to_read), os.dup(to_write)
            os.dup2(read, 3)
            os.dup2(write, 4)

        command = [str(CHROMIUM), "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--force-color-profile=srgb",
                   f"--user-data-dir={profile}", "about:blank"]
        self._process = subprocess.Popen(command, preexec_fn=pipes, close_fds=False, stdout=subprocess.DEVNULL,
                                         stderr=subprocess.DEVNULL, start_new_session=True)
        os.close(to_read)
        os.close(to_write)
        self._numbers, self._rest, self._session = itertools.count(1), b"", ""
        self.complaints: list[str] = []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.ask(domain + ".enable")

    def close(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        os.close(self._to)
        os.close(self._from)

    def ask(self, method: str, **parameters: object) -> Any:
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": parameters} | ({"sessionId": self._session} if self._session else {})
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self._rest:
                part = os.read(self._from, 1 << 20)
                assert part, "Chromium ended"
                self._rest += part
            text, self._rest = self._rest.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("method") in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded"):
                self.complaints.append(json.dumps(answer["params"]))
            if answer.get("id") == number:
                assert "error" not in answer, answer
                return answer["result"]

    def run(self, script: str) -> Any:
        """The value of a script, once it is there."""
        answer = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait(self, condition: str) -> None:
        """Until a script is true."""
        end = time.monotonic() + 60
        while not self.run(f"!!({condition})"):
            assert time.monotonic() < end, f"{condition} never came true: " + str(self.run("document.body.innerText"))
            time.sleep(0.02)

    def open(self, page: Path, link: str = "", width: int = 1280, dark: bool = False) -> None:
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.ask("Page.navigate", url="about:blank")
        self.ask("Page.navigate", url=page.resolve().as_uri() + link)
        self.wait("document.querySelector('article h2') && document.readyState === 'complete'")

    def click(self, selector: str, across: float = 0.5, down: float = 0.5) -> None:
        self.run(f"document.querySelector({selector!r}).scrollIntoView({{block: 'center'}})")
        box = self.run(f"document.querySelector({selector!r}).getBoundingClientRect().toJSON()")
        place = {"x": box["x"] + across * box["width"], "y": box["y"] + down * box["height"], "button": "left", "clickCount": 1}
        self.ask("Input.dispatchMouseEvent", type="mousePressed", **place)
        self.ask("Input.dispatchMouseEvent", type="mouseReleased", **place)

    def key(self, name: str) -> None:
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=name, code=name)

    def title(self, number: int = 0) -> str:
        return str(self.run(f"document.querySelectorAll('article h2')[{number}].innerText.trim()"))

    def radiance(self) -> list[float]:
        text = str(self.run("document.querySelector('.sum b').innerText"))
        values = [float(part) for part in text.split()]
        return values if len(values) == 3 else values * 3

    def picture(self, file: Path) -> None:
        """A PNG of the whole page, for eyes."""
        file.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot", captureBeyondViewport=True)["data"]))


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    started = Browser(tmp_path_factory.mktemp("chromium"))
    yield started
    started.close()


@pytest.fixture
def quiet(browser: Browser) -> Iterator[Browser]:
    """A browser to whose console nothing is written."""
    browser.complaints.clear()
    yield browser
    browser.run("1")
    assert not browser.complaints


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory, source: Path, programs: Path) -> Path:
    file = tmp_path_factory.mktemp("page") / "glass.html"
    subprocess.run([programs / "render", source / "scenes" / "glass.json", "-q", "--res", "320x180", "--depth", "6", "--cutoff", "0", "--explore", file,
                    "--explore-mb", "1"], check=True)
    return file


def data_of(page: Path) -> Any:
    return json.loads(page.read_text().split('id="cistula-data">')[1].split("</script>")[0])


def trees_of(data: Any) -> dict[tuple[int, int], Any]:
    """The rays of all pixels of a page."""
    step, (width, height) = data["step"], data["size"]
    rows = [json.loads(zlib.decompress(base64.b64decode(row))) for row in data["rows"]]
    return {(min(x * step + step // 2, width - 1), min(y * step + step // 2, height - 1)): rays
            for y, row in enumerate(rows) for x, rays in enumerate(row)}


def color(value: Any) -> np.ndarray[Any, Any]:
    return np.array(value if isinstance(value, list) else [value] * 3, dtype=np.float64)


def at_depth(rays: Any, depth: int, bound: list[float]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """What a pixel's rays bring at a depth, and what may be missing, as the page adds them up."""
    levels: list[int] = []
    brings, missing = np.zeros(3), np.zeros(3)
    for parent, _, end, weight, adds, ledger, lights, *_ in rays:
        levels.append(levels[parent] + 1 if parent >= 0 else 0)
        if levels[-1] < depth:
            brings += color(adds) + sum((color(light[1]) for light in lights), np.zeros(3))
        if levels[-1] == depth or levels[-1] < depth and end >= 3:
            missing += color(weight) * bound if levels[-1] == depth else color(ledger)
    return brings, missing


@pytest.mark.parametrize("depth", [1, 2, 6])
def test_pixels_add_up_to_the_picture_at_every_depth(page: Path, source: Path, depth: int) -> None:
    data = data_of(page)
    image = cistula.Scene.load(source / "scenes" / "glass.json").render(size=(320, 180), depth=depth, cutoff=0, supersample=1, layers=("error",))
    error = np.stack([image["error." + c] for c in "RGB"], axis=-1)
    worth = 0
    for (x, y), rays in trees_of(data).items():
        brings, missing = at_depth(rays, depth, data["bound"])
        # Each number has three digits, and none is below 0: half a unit of the third is 0.5 % at most.
        assert np.allclose(brings, image.rgb()[y, x], rtol=0.0051, atol=1e-6), (x, y)
        assert np.allclose(missing, error[y, x], rtol=0.0051, atol=1e-6), (x, y)
        worth += len(rays)
    assert worth > 5000


def test_bodies_and_rays_are_where_the_picture_has_them(page: Path, source: Path) -> None:
    data = data_of(page)
    solids = {"cube": 12, "tetrahedron": 6, "octahedron": 12, "dodecahedron": 30, "icosahedron": 30}
    objects = json.loads((source / "scenes" / "glass.json").read_text())["objects"]
    expected = {one["name"]: solids[one["solid"]] if "solid" in one else 4 for one in objects}  # the floor, without its diagonal
    assert {name: len(body) for name, body in zip(data["objects"], data["bodies"], strict=True)} == expected
    right, up, forward = map(np.array, data["axes"])
    met = 0
    for (x, y), rays in trees_of(data).items():
        if rays[0][2] != 0:
            continue
        at = np.array(rays[0][7])
        across, down = (side @ at / (forward @ at) / data["tan_half_width"] * 160 for side in (right, -up))
        assert (160 + across, 90 + down) == pytest.approx((x + 0.5, y + 0.5), abs=0.1)  # of points of four digits
        met += 1
    assert met > 100


def test_the_grid_fills_the_size_and_python_writes_the_same_page(page: Path, source: Path, programs: Path, tmp_path: Path) -> None:
    assert page.stat().st_size <= 1e6
    data = data_of(page)
    coarse = tmp_path / "coarse.html"
    scene = cistula.Scene.load(str(source / "scenes" / "glass.json"))
    image = scene.render(size=(320, 180), depth=6, cutoff=0)
    image.explore(str(coarse), mb=0.3)
    assert coarse.stat().st_size <= 3e5 and data_of(coarse)["step"] > data["step"]
    image.explore(str(tmp_path / "same.html"), mb=1)
    assert (tmp_path / "same.html").read_bytes() == page.read_bytes()
    kept = coarse.read_bytes()
    with pytest.raises(cistula.ArgumentError, match="give more"):
        image.explore(str(coarse), mb=0.05)
    assert coarse.read_bytes() == kept
    with pytest.raises(cistula.ArgumentError, match="crop"):
        scene.render(size=(320, 180), crop=(8, 8, 0, 0)).explore(str(coarse))


@pytest.mark.parametrize(("options", "message"), [
    (["--explore", "p.html", "--pixel", "1,2"], "--pixel excludes --explore"),
    (["--explore", "p.html", "-o", "a.exr"], "-o has no place here"),
    (["--explore", "p.html", "-f", "0-2"], "name that one"),
    (["--explore-mb", "3"], "requires --explore"),
    (["--explore", "p.html", "--explore-mb", "0.02"], "--explore-mb 0.02: the picture and the coarsest grid"),
    (["--explore", "glass.json"], "would be both the scene and --explore")])
def test_wrong_options_are_refused(options: list[str], message: str, source: Path, programs: Path, tmp_path: Path) -> None:
    shutil.copy(source / "scenes" / "glass.json", tmp_path)
    for name in ("floor.data", "marble.data"):
        shutil.copy(source / "scenes" / name, tmp_path)
    answer = subprocess.run([programs / "render", "glass.json", "--res", "320x180", *options], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert answer.returncode == 2 and message in answer.stderr, answer.stderr
    assert not (tmp_path / "p.html").exists()


@pytest.mark.parametrize("share", [0.5, 1.5])  # while it renders, while it follows rays
def test_an_interruption_ends_it_and_leaves_no_file(share: float, source: Path, programs: Path, tmp_path: Path) -> None:
    command = [str(programs / "render"), str(source / "scenes" / "infinity.json"), "--res", "320x180", "--depth", "64"]
    before = os.times()
    subprocess.run([*command, "-q", "-o", "a.exr"], cwd=tmp_path, check=True)
    after = os.times()
    whole = after.children_user + after.children_system - before.children_user - before.children_system
    (tmp_path / "a.exr").unlink()
    process = subprocess.Popen([*command, "--explore", "p.html", "--explore-mb", "900"], cwd=tmp_path)
    until(lambda: processor_seconds(process.pid) > share * whole, process)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    assert not list(tmp_path.iterdir())


def test_the_json_of_a_pixel_is_one_line(source: Path, programs: Path) -> None:
    text = subprocess.run([programs / "render", source / "scenes" / "glass.json", "--pixel", "640,400", "--json", "-"], capture_output=True, text=True,
                          check=True).stdout
    assert text.count("\n") == 1 and ": " not in text.replace("glass.json", "")
    assert json.loads(text)["pixel"] == [640, 400]


@needs_chromium
def test_clicks_and_arrow_keys_choose_pixels(quiet: Browser, page: Path) -> None:
    data = data_of(page)
    step, trees = data["step"], trees_of(data)
    quiet.open(page)
    x, y = next(place for place in trees if place[0] >= 80 and place[1] >= 90)
    quiet.click(".marks", (x + 0.5) / 320, (y + 0.5) / 180)
    quiet.wait(f"location.hash === '#{x},{y}'")
    assert quiet.title() == f"Pixel {x}, {y}"
    assert quiet.radiance() == pytest.approx(list(at_depth(trees[x, y], 6, data["bound"])[0]), rel=0.006)
    assert quiet.run("document.querySelectorAll('li[data-ray]').length") > 1
    quiet.run("document.querySelector('.marks').focus()")
    for key, place in (("ArrowRight", (x + step, y)), ("ArrowDown", (x + step, y + step)), ("ArrowLeft", (x, y + step)), ("ArrowUp", (x, y))):
        quiet.key(key)
        quiet.wait("location.hash === '#%d,%d'" % place)
    quiet.run("location.hash = '#0,0'")
    quiet.wait(f"document.querySelector('h2').innerText.includes('Pixel {step // 2}, {step // 2}')")


@needs_chromium
def test_depth_and_lights_change_the_pixel(quiet: Browser, page: Path) -> None:
    data = data_of(page)
    (x, y), rays = max(trees_of(data).items(), key=lambda entry: len(entry[1]))
    quiet.open(page, f"#{x},{y}")
    assert quiet.title() == f"Pixel {x}, {y}"
    for depth in (1, 3, 6):
        quiet.run(f"(e => {{ e.value = {depth}; e.dispatchEvent(new Event('input')); }})(document.querySelector('.depth'))")
        brings, missing = at_depth(rays, depth, data["bound"])
        assert quiet.radiance() == pytest.approx(list(brings), rel=0.006, abs=1e-9)
        assert quiet.run("parseFloat(document.querySelector('.bound i').style.width)") == pytest.approx(
            100 * brings.sum() / (brings.sum() + missing.sum()), abs=0.1)
    assert len(set(quiet.run("[...document.querySelectorAll('.depths div')].map(e => e.title)"))) == 6
    quiet.click(".lights input")
    off = data["lights"][0]["place"]
    dark = sum((color(light[1]) for ray in rays for light in ray[6] if data["lights"][light[0]]["place"] == off), np.zeros(3))
    assert quiet.radiance() == pytest.approx(list(at_depth(rays, 6, data["bound"])[0] - dark), rel=0.02, abs=1e-4)
    quiet.click(".lights input")
    assert quiet.radiance() == pytest.approx(list(at_depth(rays, 6, data["bound"])[0]), rel=0.006)


@needs_chromium
def test_two_pixels_stand_side_by_side(quiet: Browser, page: Path) -> None:
    quiet.open(page, "#40,40;200,100")
    first, second = quiet.title(0), quiet.title(1)
    assert first != second
    boxes = quiet.run("[...document.querySelectorAll('article')].map(e => e.getBoundingClientRect().toJSON())")
    assert boxes[0]["y"] == boxes[1]["y"] and boxes[0]["x"] + boxes[0]["width"] < boxes[1]["x"]
    quiet.click("article:nth-child(2) h2")
    quiet.run("document.querySelector('.marks').focus()")
    quiet.key("ArrowRight")
    quiet.wait(f"!document.querySelector('article:nth-child(2) h2').innerText.includes('{second}')")
    assert quiet.title(0) == first
    quiet.click(".compare")
    quiet.wait("document.querySelectorAll('article').length === 1")
    quiet.click(".compare")
    quiet.wait("document.querySelectorAll('article').length === 2")


@needs_chromium
def test_the_view_in_space_turns_and_comes_back(quiet: Browser, page: Path) -> None:
    quiet.open(page)
    pixels = "document.querySelector('.space').toDataURL()"
    own = quiet.run(pixels)
    quiet.run("document.querySelector('.space').focus()")
    quiet.key("ArrowLeft")
    assert quiet.run(pixels) != own
    quiet.click(".home")
    assert quiet.run(pixels) == own


@needs_chromium
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [1280, 390])
def test_it_fits_wide_and_narrow_light_and_dark(quiet: Browser, page: Path, width: int, dark: bool) -> None:
    quiet.open(page, "#100,100;200,100", width, dark)
    assert quiet.run("document.documentElement.scrollWidth") <= width
    assert quiet.run("getComputedStyle(document.querySelector('h1')).color") == ("rgb(227, 232, 238)" if dark else "rgb(23, 32, 43)")
    assert quiet.run("[...document.querySelectorAll('article, figure')].every(e => e.getBoundingClientRect().right <= innerWidth)")


@needs_chromium
def test_names_cannot_leave_the_data(quiet: Browser, source: Path, page: Path, tmp_path: Path) -> None:
    name = "</script><script>throw 1</script><img src=x onerror='throw 2'>\u2028\""
    scene = json.loads((source / "scenes" / "glass.json").read_text())
    for entry in scene["objects"]:
        entry["name"] = name + entry.get("name", "")
    scene = json.loads(json.dumps(scene).replace("\"crystal\"", json.dumps(name)))
    image = cistula.Scene.from_dict(scene, folder=str(source / "scenes")).render(size=(64, 36))
    image.explore(str(tmp_path / "p.html"))
    assert (tmp_path / "p.html").read_text().count("<script") == page.read_text().count("<script")
    quiet.open(tmp_path / "p.html", "#32,20")
    assert name.replace("\u2028", "") in str(quiet.run("document.querySelector('ol').textContent")).replace("\u2028", "")
    assert not quiet.run("document.querySelector('ol img')")


class FakeWidget:
    """What is used of anywidget.AnyWidget."""

    def __init__(self) -> None:
        self.sent: list[Any] = []
        self.handler: Callable[..., None]

    def on_msg(self, handler: Callable[..., None]) -> None:
        self.handler = handler

    def send(self, message: Any) -> None:
        self.sent.append(message)


class FakeTrait:
    def __init__(self, value: str) -> None:
        self.value = value

    def tag(self, sync: bool) -> str:
        return self.value


@needs_chromium
def test_the_widget_asks_for_any_pixel(quiet: Browser, source: Path, page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", SimpleNamespace(AnyWidget=FakeWidget))
    monkeypatch.setitem(sys.modules, "traitlets", SimpleNamespace(Unicode=FakeTrait))
    widget = cistula.Scene.load(source / "scenes" / "glass.json").render(size=(64, 36)).explore()
    quiet.open(page)
    quiet.run(f"""(async () => {{
        const script = URL.createObjectURL(new Blob([{json.dumps(widget._esm)}.replace('"cistula-data"', '"none"')], {{type: "text/javascript"}}));
        const widget = (await import(script)).default, el = document.createElement("div");
        document.body.replaceChildren(el);
        window.asked = [];
        widget.render({{el, model: {{get: () => {json.dumps(widget.start)}, on: (_, answer) => window.answer = answer, send: m => asked.push(m)}}}});
    }})()""")

    def answer(pixel: dict[str, int]) -> None:
        quiet.wait("asked.length")
        assert quiet.run("asked.shift()") == pixel
        widget.handler(widget, pixel, [])
        quiet.run(f"answer({json.dumps(widget.sent.pop())})")

    answer({"x": 32, "y": 18})
    quiet.wait("document.querySelector('article h2')?.innerText.includes('Pixel 32, 18')")
    quiet.run("document.querySelector('.marks').focus()")
    quiet.key("ArrowRight")
    answer({"x": 33, "y": 18})
    quiet.wait("document.querySelector('article h2')?.innerText.includes('Pixel 33, 18')")
    widget.handler(widget, {"x": "left", "y": 18}, [])
    assert "error" in widget.sent.pop()


def test_without_anywidget_it_says_what_to_install(source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(ImportError, match="pip install"):
        cistula.Scene.load(source / "scenes" / "glass.json").render(size=(16, 9)).explore()


def test_bodies_have_their_own_wires(tmp_path: Path) -> None:
    scene = cistula.Scene.from_dict({
        "camera": {"position": [0, -9, 0], "target": [0, 0, 0]}, "materials": {"m": {}}, "lights": [{"position": [0, -5, 9]}],
        "objects": [{"solid": "box", "size": [2, 4, 6], "material": "m"}, {"solid": "sphere", "center": [9, 0, 0], "radius": 2, "material": "m"}]})
    scene.render(size=(16, 9)).explore(tmp_path / "p.html")
    box, ball = (np.array(wires) + [0, -9, 0] for wires in data_of(tmp_path / "p.html")["bodies"])
    assert box.shape == (12, 2, 3)
    assert (np.abs(box) == [1, 2, 3]).all()
    assert ball.shape == (72, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(ball - [9, 0, 0], axis=-1), 2, rtol=1e-4)
