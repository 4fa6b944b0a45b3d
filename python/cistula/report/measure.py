"""Measurements for the report: a record in the format of Google Benchmark, with a part for every scene beside it."""
from __future__ import annotations

import base64
import io
import json
import random
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import numpy.typing as npt

import cistula
from cistula import _core
from cistula.command import Refused
from cistula.scene import keywords

Json = dict[str, Any]
Picture = npt.NDArray[np.floating[Any]]

DEEPEST, REFERENCE_SAMPLES = 256, 16  # depth of references, and their samples on a side
KNOB_CUTOFF = 2.0**-40                # radiance that a pixel may lose in references of one knob
HALF_CODE, RELATIVE_EPSILON = 0.5 / 255, 0.01
SMALL = 480                           # pixels of the longer side of pictures on the page
KINDS = ("primary", "reflected", "transmitted", "shadow")
NEVER = float("inf")


@dataclass(frozen=True)
class Setting:
    """What trades time for accuracy. With a target error, that decides depth, cutoff and samples."""

    depth: int = 4
    cutoff: float = 0.0
    precision: str = "float"
    supersample: int = 1
    target_error: float = 0.0

    @property
    def name(self) -> str:
        if self.target_error:
            return f"target:{self.target_error:g}/{self.precision}"
        return f"depth:{self.depth}/cutoff:{self.cutoff:g}/{self.precision}/samples:{self.supersample}x{self.supersample}"

    @property
    def arguments(self) -> Json:
        """Those of Scene.render, and, with - for _, the options of render."""
        if self.target_error:
            return {"target_error": self.target_error}
        return {"supersample": self.supersample, "depth": self.depth, "cutoff": self.cutoff}

    @property
    def effort(self) -> tuple[float, ...]:
        """Numbers that a frame's work grows with, each alone."""
        if self.target_error:
            return 4, self.precision == "double", -self.target_error, 1024
        return self.supersample**2, self.precision == "double", -self.cutoff, self.depth

    def is_harder(self, other: Setting) -> bool:
        """Whether a frame takes at least as long as one of `other`, as no knob makes it easier."""
        return bool(self.target_error) == bool(other.target_error) and all(a >= b for a, b in zip(self.effort, other.effort))


@dataclass
class Options:
    """How to measure."""

    backend: str = "embree"
    devices: str = "0"
    threads: int | None = None
    size: str | None = None
    repetitions: int = 10
    warm_ups: int = 2
    limit: float = 2.0  # seconds; settings with slower frames are left out
    quick: bool = False
    quiet: bool = False

    @property
    def machine(self) -> Json:
        return {"backend": self.backend, "threads": self.threads, "devices": self.devices if self.backend == "cuda" else None}

    @property
    def patience(self) -> float:
        """Seconds without a pixel done after which a frame that is needed is given up."""
        return self.limit * REFERENCE_SAMPLES**2

    def step(self, name: str) -> None:
        if not self.quiet:
            print(name, file=sys.stderr, flush=True)


class TooLong(Exception):
    """A frame exceeded its limit."""


@dataclass
class Frames:
    """Renders single frames of one scene, which is compiled in each precision when that is first asked for."""

    load: Callable[[str], cistula.Scene]
    options: Options
    size: str | None = None
    compile_ms: dict[str, float] = field(default_factory=dict)
    scenes: dict[str, cistula.Scene] = field(default_factory=dict)

    @classmethod
    def of_file(cls, file: str, options: Options, size: str | None) -> Frames:
        return cls(lambda precision: cistula.Scene.load(file, precision=precision), options, size)

    def scene(self, precision: str = "float") -> cistula.Scene:
        if precision not in self.scenes:
            start = time.perf_counter()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # they are printed; where float is not for this scene shows in its errors
                self.scenes[precision] = self.load(precision)
            self.compile_ms[precision] = 1e3 * (time.perf_counter() - start)
        return self.scenes[precision]

    def render(self, setting: Setting, *, limit: float = NEVER, patience: float = NEVER, **more: Any) -> cistula.Image:
        """Raises TooLong after `limit` seconds, or `patience` seconds without progress."""
        start = moved = time.perf_counter()
        last = 0.0

        def watch(done: float) -> None:
            nonlocal moved, last
            now = time.perf_counter()
            if done != last:
                moved, last = now, done
            if done < 1 and (now - start > limit or now - moved > patience):
                raise TooLong

        return self.scene(setting.precision).render(
            progress=watch, **{"size": self.size, **self.options.machine, **setting.arguments, **more})

    def depth(self) -> int:
        """The scene's own."""
        return int(self.scene().render(size="1x1", supersample=1, **self.options.machine).header["cistula:depth"])  # type: ignore[arg-type]


def picture_of(image: cistula.Image) -> Picture:
    return image.sums * image.unit


def metrics(picture: Picture, reference: Picture) -> Json:
    """Errors over all channels of all pixels; `p999` and `over_half_code` are of each pixel's worst channel."""
    off = np.abs(picture - reference)
    largest = off.max(axis=2)
    n = largest.size
    y, x = np.unravel_index(largest.argmax(), largest.shape)
    rmse, peak = float(np.sqrt(np.mean(off**2))), max(1.0, float(reference.max()))
    return {"max": float(largest.max()), "rmse": rmse, "psnr": 20 * float(np.log10(peak / rmse)) if rmse else "inf",
            "p999": float(np.partition(largest.ravel(), n - 1 - n // 1000)[n - 1 - n // 1000]),
            "relative_mse": float(np.mean(off**2 / (reference**2 + RELATIVE_EPSILON))), "peak": peak,
            "over_half_code": float(np.mean(largest > HALF_CODE)),
            "worst": {"x": int(x), "y": int(y), "here": picture[y, x].tolist(), "reference": reference[y, x].tolist()}}


def plan(base: Setting, quick: bool) -> dict[Setting, dict[str, Setting]]:
    """All settings to measure, each with, for a knob that it turns alone, the same without that knob's error."""
    settings: dict[Setting, dict[str, Setting]] = {base: {}}

    def some(few: list[Any], many: list[Any]) -> list[Any]:
        return few if quick else many

    def add(alone: dict[str, Setting] | None = None, **turned: Any) -> None:
        settings.setdefault(replace(base, **turned), {}).update(alone or {})

    depths = sorted({*some([1, 2, 4, 8, 16], [1, 2, 4, 8, 16, 32, 64]), base.depth})
    cutoffs = some([0.002], [0.02, 0.002])
    for depth in depths:  # all knobs together
        for k in some([1, 2, 4], [1, 2, 4, 8]):
            for cutoff in (0.0, *cutoffs):
                add(depth=depth, cutoff=cutoff, supersample=k)
        for k in some([1], [1, 4]):
            add(depth=depth, supersample=k, precision="double")
    whole = replace(base, depth=DEEPEST, cutoff=KNOB_CUTOFF)  # each knob alone
    for depth in sorted({*some([1, 2, 3, 4, 6, 8, 12, 16], [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64]), base.depth}):
        add({"depth": whole}, depth=depth)
    for cutoff in some([1e-1, 1e-2, 1e-3, 1e-4], [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6]):
        add({"cutoff": whole}, depth=DEEPEST, cutoff=cutoff)
    for k in some([1, 2, 4, 8], [1, 2, 3, 4, 6, 8, 12]):
        add({"samples": replace(base, supersample=REFERENCE_SAMPLES)}, supersample=k)
    for depth in depths:
        add({"precision": replace(base, depth=depth, precision="double")}, depth=depth)
    for target in some([0.1, 0.05, 0.02, 0.01, 0.004], [0.3, 0.1, 0.05, 0.02, 0.01, 0.004, 0.002, 0.001]):
        add(target_error=target)
        if target <= 0.05:  # where rounding moves edges, no number of samples in float meets a target
            add(target_error=target, precision="double")
        if target <= 0.004:
            cutoffs = [*cutoffs, target / 4]
    for cutoff in cutoffs:  # all samples without a target, to compare
        add(depth=DEEPEST, cutoff=cutoff, supersample=REFERENCE_SAMPLES)
    return settings


class SceneReport:
    """Measures one scene: `record`, and `entries`, its benchmarks."""

    def __init__(self, file: str, name: str, options: Options) -> None:
        self.options, self.name, self.entries = options, name, list[Json]()
        self.frames = Frames.of_file(file, options, options.size)
        scene = self.frames.scene()
        for warning in () if options.quiet else scene.warnings:
            print(f"cistula report: warning: {warning}", file=sys.stderr)
        self.base = Setting(self.frames.depth())
        self.stages: Json = {}
        self.record: Json = {"name": name, "file": file, "hash": scene.hash, "base": asdict(self.base), "effects": scene.effects(),
                             "left_out": [], "yardsticks": [], "stages": self.stages}
        for step in (self.measure_stages, self.measure_rays, self.measure_parity, self.measure_errors, self.measure_times):
            options.step(f"{name}: {step.__name__.removeprefix('measure_')}")
            step()

    def needed(self, setting: Setting, **more: Any) -> cistula.Image:
        """A frame without which there is no report. Raises Refused where it does not get on."""
        patience = self.options.patience
        try:
            return self.frames.render(setting, patience=patience, **more)
        except TooLong:
            raise Refused(f"{self.record['file']}: a frame that is needed, {setting.name}, does not get on within {patience:g} seconds: "
                          "where next to no light is lost and much goes both ways, ray trees have no end; a larger --limit gives it "
                          "more time", 1) from None

    def measure_stages(self) -> None:
        """What comes before and after a frame, in ms by precision, and the size of frames."""
        self.frames.scenes.clear()  # with the trees that are built
        for precision in ("double", "float"):
            setting = replace(self.base, precision=precision)
            self.frames.scene(precision)
            start = time.perf_counter()
            image = self.needed(setting)
            waited = 1e3 * (time.perf_counter() - start - image.seconds)
            for stage, ms in (("compile", self.frames.compile_ms[precision]), ("prepare", waited), ("first frame", 1e3 * image.seconds)):
                self.stages.setdefault(stage, {})[precision] = [ms]
        encode = []
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(self.options.repetitions):
                start = time.perf_counter()
                image.save(folder + "/a.exr")
                encode.append(1e3 * (time.perf_counter() - start))
        self.stages["encode"] = {"float": encode, "double": encode}  # the file has floats in either precision
        frames = [self.needed(self.base, effects="all") for _ in range(self.options.repetitions + 1)]
        self.stages["all effects"] = {"float": [1e3 * frame.seconds for frame in frames[1:]]}
        height, width = image.sums.shape[:2]
        scale = min(1.0, SMALL / max(width, height))
        self.small = max(1, round(width * scale)), max(1, round(height * scale))
        self.record |= {"width": width, "height": height}

    def measure_rays(self) -> None:
        """Rays by kind that each depth adds, and where in the picture they are."""
        before, levels = dict.fromkeys(KINDS, 0), []
        for depth in range(1, min(self.base.depth, 8 if self.options.quick else 32) + 1):
            image = self.needed(replace(self.base, depth=depth))
            levels.append({"depth": depth, "rays": {kind: image.ray_counts[kind] - before[kind] for kind in KINDS}})
            before = image.ray_counts
            if image.seconds > self.options.limit:
                break
        image = self.needed(self.base, size=self.small, layers="cost")
        cost = image["cost"]
        self.record |= {"levels": levels, "heat": self.picture(heat_png(cost)) | {"mean": float(cost.mean()), "most": float(cost.max())},
                        "picture": self.picture(image._repr_png_())}

    def picture(self, png: bytes) -> Json:
        return {"png": base64.b64encode(png).decode(), "width": self.small[0], "height": self.small[1]}

    def measure_parity(self) -> None:
        """Compares one frame of all ways in which this machine renders it."""
        ways: dict[str, Json] = {"Embree": {}, "Embree, one ray at a time": {"lanes": 1}, "Embree, all effects": {"effects": "all"}}
        if self.options.backend == "cuda":
            ways["CUDA"] = self.options.machine
        self.record["parity"] = cases = list[Json]()
        for precision in ("float", "double"):
            first: list[npt.NDArray[Any]] = []
            for name, way in ways.items():
                image = self.needed(replace(self.base, precision=precision), size=self.small, layers="data",
                                    **{"backend": "embree", "devices": None, **way})
                values = [np.ascontiguousarray(v).view(f"u{v.itemsize}") for v in (image.sums, image.id, image.z, image.normal)]
                if first:
                    cases.append({"first": "Embree", "second": name, "precision": precision, "compared": sum(v.size for v in values),
                                  "differing": int(sum(np.count_nonzero(a != b) for a, b in zip(first, values)))})
                first = first or values

    def reference(self, setting: Setting, render: Callable[..., cistula.Image]) -> tuple[Picture, Json]:
        """A picture to measure errors against, and what its truncation took from it at most."""
        image = render(setting, layers="error")
        lost = np.stack([image[f"error.{channel}"] for channel in "RGB"]).astype(np.float64)
        remainder = {"mean": float(lost.mean()), "rms": float(np.sqrt(np.mean(lost**2))), "max": float(lost.max())}
        return picture_of(image), {"setting": asdict(setting), "remainder": remainder, "seconds": image.seconds}

    def measure_errors(self) -> None:
        """Those of every setting. All are tried but those that are harder than one which took too long."""
        record, options = self.record, self.options
        setting = Setting(DEEPEST, 2.0 ** (-11 if options.quick else -18), "double", REFERENCE_SAMPLES)
        truth, record["reference"] = self.reference(setting, self.needed)
        references: dict[Setting, Picture | None] = {}
        stopped: list[Setting] = []
        for setting, knobs in sorted(plan(self.base, options.quick).items(), key=lambda one: (one[0].target_error > 0, one[0].effort)):
            try:
                if any(setting.is_harder(one) for one in stopped):
                    raise TooLong
                image = self.frames.render(setting, limit=options.limit)
            except TooLong:
                stopped.append(setting)
                record["left_out"].append(setting.name)
                continue
            picture, name = picture_of(image), f"{self.name}/{setting.name}"
            entry: Json = {"name": name, "run_name": name, "run_type": "iteration", "time_unit": "ms", "repetition_times": [],
                           "scene": self.name, "setting": asdict(setting), "film_hash": image.hash, "rays": image.rays,
                           "samples": setting.supersample**2, "error": metrics(picture, truth), "alone": {}}
            if image.target:
                over = float(np.mean(np.abs(picture - truth).max(axis=2) > setting.target_error))
                entry |= {"samples": image.target["samples"] / picture[..., 0].size, "target": {"over": over, "missed": image.target["missed"]}}
            for knob, without in knobs.items():
                if without not in references:
                    try:
                        references[without], told = self.reference(without, lambda *a, **k: self.frames.render(*a, **k, patience=options.patience))
                        record["yardsticks"].append({"knob": knob, **told})
                    except TooLong:
                        references[without] = None
                        record["left_out"].append(f"{without.name}: the reference of {knob}")
                if (reference := references[without]) is not None:
                    entry["alone"][knob] = metrics(picture, reference)
            self.entries.append(entry)

    def measure_times(self) -> None:
        """All settings once a round, each round in a new order, so that disturbances hit all alike."""
        order, shuffle = self.entries[:], random.Random(1)
        for turn in range(1, self.options.warm_ups + self.options.repetitions):  # the frames for the errors were the first
            shuffle.shuffle(order)
            for entry in order:
                image = self.frames.render(Setting(**entry["setting"]))
                if turn >= self.options.warm_ups:
                    entry["repetition_times"].append(1e3 * image.seconds)
                    for part, seconds in image.times.items():
                        entry.setdefault(part + "_ms", []).append(1e3 * seconds)
        for entry in order:
            entry["real_time"], entry["iterations"] = median(entry["repetition_times"]), self.options.repetitions


def heat_png(cost: npt.NDArray[np.float32]) -> bytes:
    """Rays of every pixel as colors, logarithmic."""
    from matplotlib import image

    file, steps = io.BytesIO(), 64  # few colors, to keep the file small
    place = np.log(np.maximum(cost, 1))
    place = (place - place.min()) / max(float(np.ptp(place)), 1e-9)
    image.imsave(file, np.round(place * steps) / steps, cmap="inferno", vmin=0, vmax=1, format="png")
    return file.getvalue()


def generated(objects: list[Json], **material: Any) -> Json:
    """A scene with a body at the origin, in front of the camera."""
    return {"camera": {"position": [0, -3, 1], "target": [0, 0, 0]}, "lights": [{"position": [-4, -4, 5]}, {"position": [5, -3, 4]}],
            "materials": {"matte": {"diffuse": 0.8, "specular": 0.2, **material}}, "objects": objects}


def start_up_ms(options: Options) -> float:
    """What the first frame of a process waits for, whatever its scene: of a GPU its context and the code of kernels."""
    scene = cistula.Scene.from_dict(generated([{"name": "body", "solid": "icosahedron", "material": "matte"}]), precision="float")
    start = time.perf_counter()
    return 1e3 * (-scene.render(size="16x16", **options.machine).seconds + time.perf_counter() - start)


def wavy_sheet(count: int) -> Callable[[str], cistula.Scene]:
    """A scene of about so many triangles, which face the camera."""
    n = round((count / 2) ** 0.5) + 1
    x, z = np.meshgrid(np.linspace(-4, 4, n), np.linspace(-4, 4, n))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([corner[:, None] + [0, 1, n + 1], corner[:, None] + [0, n + 1, n]])
    points = np.stack([x, 0.1 * np.sin(5 * x) * np.sin(6 * z), z], axis=-1).reshape(-1, 3)
    builder = cistula.SceneBuilder(generated([])).mesh("body", points, triangles, material="matte")
    return lambda precision: builder.build(precision=precision)


def edge_lights(count: int) -> Callable[[str], cistula.Scene]:
    """An icosahedron with so many lights on every edge, together as bright as two."""
    body = {"name": "body", "solid": "icosahedron", "material": "matte", "edge_lights": {"count": count, "color": 2 / (30 * count)}}
    return lambda precision: cistula.Scene.from_dict(generated([body], reflection=0.2, transmission=0.5) | {"lights": []}, precision=precision)


def scaling(file: str, options: Options) -> list[Json]:
    """Times against the size of scene and frame, on generated scenes and the given one."""
    side = 4 if options.quick else 1
    size, name = f"{640 // side}x{480 // side}", Path(file).name
    given = Frames.of_file(file, options, size)
    base = Setting(given.depth())
    series: list[Json] = []

    def add(name: str, what: str, values: list[int], frames: Callable[[int], Frames], setting: Callable[[int], Setting]) -> None:
        """A series up to the first value that takes too long."""
        points: list[Json] = []
        for value in values:
            options.step(f"scaling: {name} {value}")
            of, images = frames(value), list[cistula.Image]()
            try:
                for turn in range(options.warm_ups + options.repetitions):
                    images.append(of.render(setting(value), limit=NEVER if turn else options.limit))
            except TooLong:
                break
            points.append({"value": value, "time": [1e3 * i.times.get("kernel", i.seconds) for i in images[options.warm_ups:]], "rays": images[0].rays})
        if points:
            series.append({"name": name, "what": f"{what}, float, one sample", "points": points})

    def sized(pixels: int) -> str:
        width = round((pixels * 16 / 9) ** 0.5)
        return f"{width}x{pixels // width}"

    few = options.quick
    add("triangles", f"a wavy sheet that fills the frame, two lights, depth 1, {size}", [10**k for k in range(3, 6 if few else 8)],
        lambda n: Frames(wavy_sheet(n), options, size), lambda n: Setting(1))
    add("lights", f"on the edges of an icosahedron (kr 0.2, kt 0.5), depth 4, {size}", [30 * 2**k for k in range(2 if few else 6)],
        lambda n: Frames(edge_lights(n // 30), options, size), lambda n: Setting(4))
    add("depth", f"{name}, {size}", [2**k for k in range(5 if few else 7)], lambda n: given, Setting)
    add("pixels", f"{name}, depth {base.depth}", [3600 * 4**k for k in range(3 if few else 7)], lambda n: replace(given, size=sized(n)), lambda n: base)
    gpus = options.devices.split(",") if options.backend == "cuda" else []
    if len(gpus) > 1:
        add("GPUs", f"{name}, 3840x2160, depth {base.depth}", list(range(1, len(gpus) + 1)),
            lambda n: replace(given, size="3840x2160", options=replace(options, devices=",".join(gpus[:n]))), lambda n: base)
    return series


def measure(files: list[str], options: Options, *, scenes: bool, scale: bool) -> Json:
    """A record of all that was asked for. Raises Refused, cistula.Error."""
    options.step("start-up")
    start_up = start_up_ms(options)  # before anything else uses the GPU
    context: Json = json.loads(_core.run_context(keywords({"backend": options.backend, "devices": options.devices if options.backend == "cuda" else None})))
    context |= {"executable": "cistula report", "backend": options.backend, "threads": options.threads or context["num_cpus"],
                "repetitions": options.repetitions, "warm_ups": options.warm_ups, "quick": options.quick,
                "limit_seconds": options.limit, "start_up_ms": start_up}
    stems = [Path(file).stem for file in files]
    reports = [SceneReport(file, stem if stems.count(stem) == 1 else file, options) for file, stem in zip(files, stems) if scenes]
    return {"context": context, "benchmarks": [entry for report in reports for entry in report.entries],
            "scenes": [report.record for report in reports], "scaling": scaling(files[0], options) if scale else []}
