"""The report's page, made of records alone, on whatever machine."""
from __future__ import annotations

import math
import shlex
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from statistics import median
from typing import Any

import jinja2
from markupsafe import Markup

from . import charts, words
from .charts import Axes, Drawing, Point
from .measure import DEEPEST, KINDS, KNOB_CUTOFF, RELATIVE_EPSILON, Json, Setting

LEAST_GAIN = 0.01  # of two errors that differ by less, the quicker setting's counts
MOST_OVER = 0.01   # share of the pixels that may be over half a code
KNOBS: dict[str, tuple[str, str, Callable[[Json], float]]] = {
    "depth": ("Depth", "surfaces along a path", lambda setting: float(setting["depth"])),
    "cutoff": ("Cutoff", "radiance that a pixel may lose", lambda setting: float(setting["cutoff"])),
    "samples": ("Samples", "samples per pixel", lambda setting: float(setting["supersample"] ** 2))}
FACTS = {"cpu": "Processor", "num_cpus": "Hardware threads", "devices": "GPU", "gpu_driver": "Driver", "driver": "CUDA of the driver",
         "compiler": "Compiler", "flags": "Flags", "cistula_version": "Version", "commit": "Commit"}
NO_RECORD = (ArithmeticError, AttributeError, LookupError, RuntimeError, TypeError, ValueError, jinja2.TemplateError)


def middle(entry: Json) -> float:
    return float(median(entry["repetition_times"]))


def front_of(entries: list[Json], error: Callable[[Json], float]) -> list[Json]:
    """Settings that nothing closer is as quick as, quickest first: from the closest on, each whose slowest run is quicker than
    the quickest run of the one before."""
    front: list[Json] = []
    for entry in sorted(entries, key=lambda e: (error(e), middle(e))):
        if front and max(entry["repetition_times"]) >= min(front[-1]["repetition_times"]):
            continue
        if front and error(entry) <= (1 + LEAST_GAIN) * error(front[-1]):
            front.pop()
        front.append(entry)
    return front[::-1]


def slope(points: list[tuple[float, float]]) -> float | None:
    """Of the line through points by least squares; None for fewer than three."""
    if len(points) < 3:
        return None
    x, y = (sum(p[i] for p in points) / len(points) for i in (0, 1))
    square = sum((p[0] - x) ** 2 for p in points)
    return sum((p[0] - x) * (p[1] - y) for p in points) / square if square else None


def target_rows(entries: list[Json]) -> list[Json]:
    """What targets come to, each beside the quickest fixed setting that keeps 99.9 % of the pixels as close."""
    fixed = sorted((e for e in entries if not e["setting"]["target_error"]), key=middle)
    rows = []
    for e in sorted((e for e in entries if e["setting"]["target_error"]), key=lambda e: -e["setting"]["target_error"]):
        row = {"target_error": e["setting"]["target_error"], "precision": e["setting"]["precision"],
               **{k: e["error"][k] for k in ("rmse", "p999", "max", "worst")}, "over_target": e["target"]["over"],
               "missed": e["target"]["missed"], "samples": e["samples"], "time_ms": middle(e), "times": e["repetition_times"], "fixed": "none"}
        if beside := next((f for f in fixed if f["error"]["p999"] <= e["error"]["p999"]), None):
            row |= {"fixed": Setting(**beside["setting"]).name, "fixed_setting": beside["setting"], "fixed_p999": beside["error"]["p999"],
                    "fixed_times": beside["repetition_times"], "ratio": middle(e) / middle(beside)}
        rows.append(row)
    return rows


def targets(record: Json) -> Json:
    """The rows by scene, those in float and in double, for other programs."""
    by_scene = {s["name"]: target_rows([e for e in record["benchmarks"] if e["scene"] == s["name"]]) for s in record["scenes"]}
    return {name: {key: [r for r in rows if r["precision"] == precision] for key, precision in (("rows", "float"), ("in_double", "double"))}
            for name, rows in by_scene.items()}


def timed(x: float, runs: list[float]) -> Point:
    return x, median(runs), min(runs), max(runs)


class Shown:
    """A scene of a record with what the page says of it."""

    def __init__(self, record: Json, scene: Json, title: str, number: int) -> None:
        self.record, self.scene, self.title, self.id = record, scene, title, f"scene{number}"
        self.entries: list[Json] = [e for e in record["benchmarks"] if e["scene"] == scene["name"]]
        for entry in self.entries:
            if not entry["repetition_times"] or bool(entry["setting"]["target_error"]) != ("target" in entry):
                raise ValueError(f"{entry['name']} has no times, or a target and none")
        self.remainder = scene["reference"]["remainder"]
        self.smallest = min((e["error"]["rmse"] for e in self.entries), default=0.0)
        self.tight = 16 * self.remainder["rms"] <= self.smallest
        self.hidden_rms, self.hidden = (0.0 if self.tight else float(self.remainder[key]) for key in ("rms", "max"))
        self.front = front_of(self.entries, self.rmse)
        digits = slope([(math.log10(self.rmse(e)), math.log10(middle(e))) for e in self.front if self.rmse(e) > 0])
        self.digit = 10**-digits if digits and digits < 0 else None
        self.quickest = min((e for e in self.entries if e["error"]["over_half_code"] <= MOST_OVER), key=middle, default=None)
        self.targets = target_rows(self.entries)
        self.rays = sum(sum(level["rays"].values()) for level in scene["levels"])

    def rmse(self, entry: Json) -> float:
        return float(entry["error"]["rmse"]) + self.hidden_rms

    def largest(self, entry: Json) -> float:
        return float(entry["error"]["max"]) + self.hidden

    def command(self, entry: Json) -> str:
        options = {"res": f"{self.scene['width']}x{self.scene['height']}", **Setting(**entry["setting"]).arguments,
                   "precision": entry["setting"]["precision"], "backend": self.record["context"]["backend"]}
        return shlex.join(["render", self.scene["file"], *(w for k, v in options.items() for w in ("--" + k.replace("_", "-"), f"{v}")),
                           "-o", Path(self.scene["name"]).stem + ".exr"])

    def find(self, **setting: Any) -> Json | None:
        """The entry of the scene's own setting, but for some of its numbers."""
        return next((e for e in self.entries if e["setting"] == self.scene["base"] | setting), None)

    def pareto_chart(self) -> Markup:
        drawing = Drawing([4.6], f"{self.title}: error against time, {len(self.entries)} settings")
        [axes] = drawing.axes
        axes.plot(*zip(*((middle(e), self.rmse(e)) for e in self.front)), color=charts.INK, linewidth=1, alpha=0.6, zorder=1)
        grids = sorted({e["setting"]["supersample"] for e in self.entries if not e["setting"]["target_error"]})

        def group(e: Json) -> tuple[int, bool]:
            return 0 if e["setting"]["target_error"] else e["setting"]["supersample"], e["setting"]["precision"] == "double"

        for (k, twice), some in groupby(sorted(self.entries, key=group), group):
            color, label = (grids.index(k), f"{k}×{k}") if k else (5, "target error")
            for e in some:
                runs, on = e["repetition_times"], e in self.front
                charts.dots(axes, [(middle(e), self.rmse(e))], color, "o" if k else "D", twice, alpha=1 if on else 0.4)
                axes.hlines(self.rmse(e), min(runs), max(runs), colors=charts.color(color), linewidth=1.2 if on else 0)
            charts.dots(axes, [], color, "o" if k else "D", twice, label=label + (", double" if twice else ""))
        charts.scale(axes.xaxis, [middle(e) for e in self.entries], "time of a frame, ms")
        charts.scale(axes.yaxis, [self.rmse(e) for e in self.entries], "error (RMSE)")
        return drawing.svg(legend=axes)

    def knob(self, name: str) -> Json | None:
        """The chart of a knob turned alone, with what it says; None where it was not measured."""
        title, label, value = KNOBS[name]
        entries = sorted((e for e in self.entries if name in e["alone"]), key=lambda e: value(e["setting"]))
        if not entries:
            return None
        x = [value(e["setting"]) for e in entries]
        hidden = max((y["remainder"]["rms"] for y in self.scene["yardsticks"] if y["setting"]["cutoff"] == KNOB_CUTOFF and name != "samples"), default=0.0)
        resolved = [(v, e["alone"][name]) for v, e in zip(x, entries) if e["alone"][name]["rmse"] > 16 * hidden]
        exact = sum(e["alone"][name]["rmse"] == 0 for e in entries)
        drawing = Drawing([2.3, 2.0], f"{self.title}: error and time against {label}")
        error, time = drawing.axes
        for key, color, word in (("rmse", 0, "RMSE"), ("max", 5, "largest")):
            charts.line(error, [(v, e[key]) for v, e in resolved], color, label=word)
        charts.line(time, [timed(v, e["repetition_times"]) for v, e in zip(x, entries)], 1)
        charts.scale(error.yaxis, [e["rmse"] for _, e in resolved], "error")
        charts.scale(time.yaxis, [middle(e) for e in entries], "time, ms")
        charts.scale(time.xaxis, x, label, log=name != "depth")
        fall = slope([(v, math.log(e["rmse"])) for v, e in resolved if v >= 4]) if name == "depth" else None
        return {"title": title, "chart": drawing.svg(legend=error if resolved else None), "fall": math.exp(-fall) if fall else None,
                "exact": exact, "unresolved": len(entries) - len(resolved) - exact}

    def precision_rows(self) -> list[Json]:
        """Depths with the error of float, and the times of both precisions."""
        pairs = [(e, self.find(depth=e["setting"]["depth"], precision="double")) for e in self.entries if "precision" in e["alone"]]
        return [{"depth": e["setting"]["depth"], "error": e["alone"]["precision"], "float": e["repetition_times"],
                 "double": twice["repetition_times"], "ratio": middle(twice) / middle(e)} for e, twice in pairs if twice]

    def target_chart(self) -> Markup:
        drawing = Drawing([2.6, 1.6, 1.9], f"{self.title}: errors, samples and time against target error")
        error, samples, time = drawing.axes
        for precision in ("float", "double"):
            twice = precision == "double"
            rows = [r for r in self.targets if r["precision"] == precision]

            def draw(axes: Axes, color: int, value: Callable[[Json], Any], marker: str = "o", label: str = "") -> None:
                charts.line(axes, [(r["target_error"], *value(r)) for r in rows], color, marker, twice, label=label and label + ", double" * twice)

            draw(error, 0, lambda r: [r["rmse"] + self.hidden_rms], "o", "RMSE")
            draw(error, 2, lambda r: [r["p999"] + self.hidden], "^", "99.9 %")
            draw(error, 5, lambda r: [r["max"] + self.hidden], "v", "largest")
            draw(samples, 3, lambda r: [r["samples"]], "D")
            draw(time, 1, lambda r: timed(0, r["times"])[1:], "D")
        x = sorted({r["target_error"] for r in self.targets})
        error.plot(x, x, color=charts.INK, linewidth=1, label="error = target")
        for axes, key, label in ((error, "rmse", "error"), (samples, "samples", "samples"), (time, "time_ms", "time, ms")):
            charts.scale(axes.yaxis, [r[key] for r in self.targets], label)
        charts.scale(time.xaxis, x, "target error")
        return drawing.svg(legend=error)

    def rays_chart(self) -> Markup:
        levels, pixels = self.scene["levels"], self.scene["width"] * self.scene["height"]
        drawing = Drawing([2.9], f"{self.title}: rays by kind that each depth adds")
        [axes] = drawing.axes
        bottom = [0.0] * len(levels)
        for kind, color in zip(KINDS, (0, 1, 2, 6)):
            heights = [level["rays"][kind] / pixels for level in levels]
            axes.bar([level["depth"] for level in levels], heights, 0.8, bottom, color=charts.color(color),
                     label=f"{kind}, {words.percent(sum(heights) * pixels / max(self.rays, 1))}")
            bottom = [a + b for a, b in zip(bottom, heights)]
        charts.scale(axes.xaxis, [level["depth"] for level in levels], "depth", log=False)
        charts.scale(axes.yaxis, [], "rays a pixel", log=False)
        return drawing.svg(legend=axes)

    def stage_rows(self) -> list[tuple[str, Any, Any]]:
        """Before, in and after a frame: name and times by precision."""
        stages, gpu = self.scene["stages"], self.record["context"]["backend"] == "cuda"
        frames = [self.find() or {}, self.find(precision="double") or {}]
        parts = [("kernel_ms", "kernels of a frame"), ("transfer_ms", "its reading back")] if gpu else []
        return [("read and compile the scene", *map(stages["compile"].get, ("float", "double"))),
                ("build trees, upload" if gpu else "build trees", *map(stages["prepare"].get, ("float", "double"))),
                ("the first frame", *map(stages["first frame"].get, ("float", "double"))),
                *((text, *(f.get(key) for f in frames)) for key, text in [*parts, ("repetition_times", "a frame, all in all")]),
                ("a frame by code for all effects", stages["all effects"]["float"], None),
                ("encode and write an EXR", *map(stages["encode"].get, ("float", "double")))]


def scaling_chart(series: Json) -> Markup:
    drawing = Drawing([2.6], f"time against {series['name']}")
    [axes] = drawing.axes
    points = [timed(p["value"], p["time"]) for p in series["points"]]
    charts.line(axes, points, 0)
    charts.scale(axes.xaxis, [p[0] for p in points], series["name"], log=series["name"] != "GPUs")
    charts.scale(axes.yaxis, [p[1] for p in points], "time of a frame, ms")
    return drawing.svg()


def machines(records: list[Json]) -> list[Json]:
    """Machines, each once, with the runs on them."""
    found: dict[str, Json] = {}
    for record in records:
        context = record["context"]
        facts = {text: ", ".join(v) if isinstance(v := context[key], list) else v for key, text in FACTS.items() if context.get(key)}
        what = ", ".join([s["name"] for s in record["scenes"]] + ["scaling"] * bool(record["scaling"]))
        found.setdefault(repr(facts), {"facts": facts, "runs": []})["runs"].append(context | {"what": what})
    return list(found.values())


def page_of(records: list[Json]) -> str:
    """The page. Raises one of NO_RECORD where records are none."""
    pairs = [(record, scene) for record in records for scene in record["scenes"]]
    names = [scene["name"] for _, scene in pairs]
    shown = [Shown(record, scene, scene["name"] + (f" · {record['context']['backend']}" if names.count(scene["name"]) > 1 else ""), i)
             for i, (record, scene) in enumerate(pairs, 1)]
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"number": words.number, "percent": words.percent, "time": words.time, "setting": words.setting,
                            "ms": words.milliseconds, "count": "{:,.0f}".format}
    return environment.get_template("page.html").render(
        scenes=shown, names=", ".join(dict.fromkeys(names)) or "scaling", machines=machines(records), knobs=list(KNOBS), deepest=DEEPEST,
        within=1 - MOST_OVER, epsilon=RELATIVE_EPSILON, scaling=[(one, scaling_chart(one)) for record in records for one in record["scaling"]]) + "\n"
