"""`cistula report`: what is measured, the front, pages and records, errors."""
from __future__ import annotations

import contextlib
import io
import json
import os
import re
import signal
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cistula.__main__ import main

pytest.importorskip("jinja2")
pytest.importorskip("matplotlib")

from cistula.report import page, words  # noqa: E402
from cistula.report.measure import Setting, metrics, plan  # noqa: E402

SMALL = {"film": {"width": 32, "height": 18}, "depth": 6, "camera": {"position": [0, -4, 1.5], "target": [0, 0, 0.5]},
         "materials": {"glass": {"color": [0.4, 0.6, 0.9], "reflection": 0.2, "transmission": 0.5}, "floor": {"reflection": 0.2}},
         "objects": [{"name": "gem", "solid": "icosahedron", "center": [0, 0, 1], "material": "glass"},
                     {"name": "floor", "quad": [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], "material": "floor"}],
         "lights": [{"position": [2, -3, 4]}]}


def report(folder: Path, *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error."""
    out, error = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = main(["report", *arguments])
    return code, out.getvalue(), error.getvalue()


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with small.json, its record r.json and its page r.html."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "small.json").write_text(json.dumps(SMALL))
    code, out, error = report(folder, "small.json", "--quick", "--limit", "20", "--scaling", "--json", "r.json", "-o", "r.html")
    assert (code, out) == (0, ""), error
    assert "small: errors" in error
    return folder


def record_of(folder: Path) -> Any:
    return json.loads((folder / "r.json").read_text())


class Balanced(HTMLParser):
    """Elements that are closed in order, no more and no less; what is referred to is there."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.feed(text)
        assert not self.open
        assert len(self.ids) == len(set(self.ids))
        for name in re.findall(r'(?:href="|url\()#([^")]*)', text):
            assert name in self.ids, name

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids += [value or "" for key, value in attrs if key == "id"]
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open.pop() == tag


def test_the_same_record_gives_the_same_page(measured: Path) -> None:
    assert report(measured, "--from", "r.json", "-o", "again.html") == (0, "", "")
    assert (measured / "again.html").read_bytes() == (measured / "r.html").read_bytes()


def test_a_page_stands_alone_and_has_no_empty_section(measured: Path) -> None:
    text = (measured / "r.html").read_text()
    Balanced(text)
    assert "<script" not in text and "url(http" not in text and not re.search(r'(src|href)="(?!#|data:)', text)
    assert re.findall(r'<section id="(\w+)"', text) == ["pareto", "knobs", "where", "parity", "scaling", "machine"]
    assert all(len(part) > 500 for part in text.split("<section")[1:])
    assert "render small.json --res 32x18" in text and "start the threads, once a process" in text and "target error, double" in text
    assert len(text) < 400_000


def test_what_is_measured_is_what_the_knobs_promise(measured: Path) -> None:
    record = record_of(measured)
    by_depth = {}
    for entry in record["benchmarks"]:
        assert len(entry["repetition_times"]) == 3 and entry["real_time"] == sorted(entry["repetition_times"])[1]
        if "depth" in entry["alone"]:
            by_depth[entry["setting"]["depth"]] = entry["alone"]["depth"]["rmse"]
    errors = [by_depth[depth] for depth in sorted(by_depth)]
    assert len(errors) >= 8 and errors[0] > 0 and errors == sorted(errors, reverse=True)
    [scene] = record["scenes"]
    assert scene["left_out"] == [] and scene["base"]["depth"] == 6
    base = next(e for e in record["benchmarks"] if e["setting"] == scene["base"])
    assert sum(sum(level["rays"].values()) for level in scene["levels"]) == base["rays"]
    assert scene["levels"][0]["rays"]["primary"] == 32 * 18
    assert len(scene["parity"]) == 4 and all(case["differing"] == 0 and case["compared"] > 32 * 18 * 7 for case in scene["parity"])
    assert [one["name"] for one in record["scaling"]] == ["triangles", "lights", "depth", "pixels"]
    assert record["context"]["start_up_ms"] >= 0 and record["context"]["cpu"]


def test_targets_are_met_and_have_a_table(measured: Path) -> None:
    table = record_of(measured)["targets"]["small"]
    assert [row["target_error"] for row in table["rows"]] == [0.1, 0.05, 0.02, 0.01, 0.004]
    assert [row["target_error"] for row in table["in_double"]] == [0.05, 0.02, 0.01, 0.004]
    for before, row in zip(table["rows"], table["rows"][1:]):
        assert row["rmse"] < before["rmse"] and row["samples"] > before["samples"] and row["missed"] == 0 and row["rmse"] <= row["target_error"]
        assert row["fixed"] == "none" or row["fixed_p999"] <= row["p999"]


def test_scaling_alone_is_shown_beside_another_record_of_the_machine(measured: Path) -> None:
    code, _, error = report(measured, "small.json", "--quick", "--repetitions", "1", "--scaling=only", "-q", "--json", "s.json")
    assert (code, error) == (0, "")
    assert json.loads((measured / "s.json").read_text())["benchmarks"] == []
    assert report(measured, "--from", "r.json", "s.json", "-o", "both.html")[0] == 0
    text = (measured / "both.html").read_text()
    Balanced(text)
    assert text.count("<dt>Processor</dt>") == 1 and text.count("small, scaling</td>") == 1 and text.count(">scaling</td>") == 1


def test_a_front_joins_only_what_ranges_tell_apart() -> None:
    def entry(error: float, *runs: float) -> dict[str, Any]:
        return {"error": error, "repetition_times": list(runs)}

    close, noisy, quick = entry(1, 8, 9, 10), entry(2, 1.8, 2, 8), entry(4, 1, 2, 3)
    assert page.front_of([noisy, quick, close], lambda e: float(e["error"])) == [quick, close]
    as_close = entry(1.001, 2, 3, 4)  # as close, and certainly quicker
    assert page.front_of([close, as_close, entry(5, 9, 9, 9)], lambda e: float(e["error"])) == [as_close]
    assert page.front_of([], lambda e: 0.0) == []


def test_metrics_are_those_of_their_definitions() -> None:
    reference = np.zeros((2, 3, 3))
    reference[0, 0] = 2
    picture = reference.copy()
    picture[1, 2, 1] = 0.5
    found = metrics(picture, reference)
    assert found["max"] == 0.5 and (found["worst"]["x"], found["worst"]["y"]) == (2, 1) and found["worst"]["here"] == [0, 0.5, 0]
    assert found["rmse"] == pytest.approx((0.25 / 18) ** 0.5) and found["psnr"] == pytest.approx(20 * np.log10(2 / found["rmse"]))
    assert found["relative_mse"] == pytest.approx(0.25 / 0.01 / 18) and found["over_half_code"] == pytest.approx(1 / 6)
    assert metrics(reference, reference)["psnr"] == "inf"


def test_a_setting_is_harder_where_no_knob_makes_it_easier() -> None:
    assert Setting(8).is_harder(Setting(4)) and not Setting(8, cutoff=0.1).is_harder(Setting(4))
    assert Setting(4, 0.01, "double", 2).is_harder(Setting(4, 0.02)) and not Setting(target_error=0.1).is_harder(Setting(1))
    settings = plan(Setting(6), quick=True)
    assert settings[Setting(6)]["depth"] == Setting(256, 2.0**-40) and len(settings) > 50


def test_numbers_are_short() -> None:
    assert [words.number(n) for n in (0, 0.00123, 1e-4, 3.4e-7, 1e7, 9.99e-5, "inf")] == ["0", "0.00123", "10⁻⁴", "3.4·10⁻⁷", "10⁷", "10⁻⁴", "inf"]
    assert [words.milliseconds(0.7712), words.milliseconds(1234), words.percent(0.25), words.percent(0.99)] == ["0.771 ms", "1.23 s", "25 %", "99 %"]
    assert "<small>1 ms to 3 ms</small>" in words.time([3, 1, 2])


def test_settings_that_take_too_long_are_left_out_and_named(tmp_path: Path) -> None:
    (tmp_path / "small.json").write_text(json.dumps(SMALL))
    code, _, error = report(tmp_path, "small.json", "--quick", "--repetitions", "1", "--res", "96x54", "--threads", "1", "--limit", "0.06", "-q",
                            "--json", "r.json", "-o", "r.html")
    assert code == 0, error
    record = record_of(tmp_path)
    left_out = record["scenes"][0]["left_out"]
    assert "depth:256/cutoff:0.002/float/samples:16x16" in left_out and record["benchmarks"]
    assert not {e["name"].split("/", 1)[1] for e in record["benchmarks"]} & set(left_out)
    assert "Left out, as a frame takes too long" in (tmp_path / "r.html").read_text()


def test_a_reference_without_end_is_given_up(tmp_path: Path) -> None:
    quads = [[[7, -3, -7], [-3, 7, -7], [-9, 1, 5], [1, -9, 5]], [[-7, 3, -7], [3, -7, -7], [9, -1, 5], [-1, 9, 5]],
             [[-7, -3, 7], [3, 7, 7], [9, 1, -5], [-1, -9, -5]], [[7, 3, 7], [-3, -7, 7], [-9, -1, -5], [1, 9, -5]]]
    room = {"film": {"width": 16, "height": 9}, "depth": 2, "ambient": 1, "background": 1, "camera": {"position": [0.4, -1.8, 0.3], "target": [0, 0, 0]},
            "materials": {"clear": {"diffuse": 0, "reflection": 0.5, "transmission": 0.5}, "mirror": {"diffuse": 0, "reflection": 1}},
            "objects": [{"name": f"solid {x}", "solid": "octahedron", "center": [x, 0.2, -0.1], "radius": 0.8, "material": "clear"} for x in (-0.9, 0.9)]
            + [{"name": f"wall {quad}", "quad": quad, "material": "mirror"} for quad in quads]}
    (tmp_path / "room.json").write_text(json.dumps(room))
    code, _, error = report(tmp_path, "room.json", "--quick", "--limit", "0.001", "-q", "-o", "r.html")
    assert code == 1 and "room.json: a frame that is needed, depth:256/" in error and "have no end" in error
    assert os.listdir(tmp_path) == ["room.json"]


REFUSED: list[tuple[list[str], int, str]] = [
    (["-o", "x.html"], 2, "no scene is given"),
    (["small.json"], 2, "nothing would be written"),
    (["small.json", "-o", "x.html", "--res", "12"], 2, "size=12"),
    (["small.json", "-o", "x.html", "--repetitions", "0"], 2, "--repetitions: 0 must be a whole number"),
    (["small.json", "-o", "x.html", "--quik"], 2, "did you mean --quick?"),
    (["small.json", "-o", "x.html", "--scaling=all"], 2, "--scaling"),
    (["small.json", "small.json", "-o", "x.html", "--scaling=only"], 2, "looks at one scene"),
    (["small.json", "-o", "small.json"], 2, "a file of its own"),
    (["small.json", "-o", "x.html", "--json", "x.html"], 2, "a file of its own"),
    (["small.json", "--from", "r.json", "-o", "x.html"], 2, "a scene and --from"),
    (["--from", "r.json", "--quick", "-o", "x.html"], 2, "--quick: is for measuring"),
    (["--from", "none.json", "-o", "x.html"], 3, "none.json"),
    (["--from", "bad.json", "-o", "x.html"], 3, "bad.json: is no record of cistula report"),
    (["--from", "small.json", "-o", "x.html"], 3, "small.json: is no record of cistula report"),
    (["small.json", "-o", "no/such/x.html"], 3, "no/such/x.html"),
    (["none.json", "-o", "x.html", "-q"], 3, "none.json"),
    (["bad.json", "-o", "x.html", "-q"], 2, "bad.json"),
    (["small.json", "-o", "x.html", "--backend", "gpu"], 2, "backend=gpu"),
]


@pytest.mark.parametrize(("arguments", "code", "message"), REFUSED, ids=[" ".join(r[0]) for r in REFUSED])
def test_what_is_wrong_is_refused_in_one_line(measured: Path, arguments: list[str], code: int, message: str) -> None:
    (measured / "bad.json").write_text('{"context": {}, "benchmarks": [NaN]}')
    found, out, error = report(measured, *arguments)
    lines = [line for line in error.splitlines() if line.startswith("cistula report: ")]
    assert (found, out, len(lines)) == (code, "", 1) and message in lines[0], error
    assert not (measured / "x.html").exists()


def test_damaged_records_are_refused_or_shown(measured: Path) -> None:
    def places(value: Any) -> list[tuple[Any, Any]]:
        pairs = list(value.items()) if isinstance(value, dict) else list(enumerate(value)) if isinstance(value, list) else []
        return [(value, key) for key, _ in pairs] + [place for _, part in pairs for place in places(part)]

    record = record_of(measured)
    record["benchmarks"] = [e for e in record["benchmarks"] if e["setting"]["target_error"] or e["alone"]][:6]
    count = len(places(record))
    for turn in range(0, count, count // 9):
        damaged = json.loads(json.dumps(record))
        holder, key = places(damaged)[turn]
        holder[key] = ["<b>", None, -1, 1e300, {}][turn % 5]
        (measured / "damaged.json").write_text(json.dumps(damaged))
        code, _, error = report(measured, "--from", "damaged.json", "-o", "damaged.html")
        assert code == 0 or (code == 3 and "is no record" in error), (turn, key, error)
        if code == 0:
            assert "<b><" not in (measured / "damaged.html").read_text()


def test_an_interruption_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "small.json").write_text(json.dumps(SMALL))
    process = subprocess.Popen([sys.executable, "-m", "cistula", "report", "small.json", "--res", "320x180", "-o", "r.html", "--json", "r.json"],
                               cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    assert process.stderr
    assert any("stages" in line for line in process.stderr)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    assert process.stderr.read().splitlines()[-1] == "cistula report: interrupted"
    assert os.listdir(tmp_path) == ["small.json"]
