"""gpu_bars.py PARTS OUT.json: what bench/gpu-check left in PARTS as one record, and every bar beside what was measured.

Exit code 1 where host and device differ or were not compared, compute-sanitizer found something or a program failed; else 0."""
import glob
import json
import os
import re
import sys

from bars import Records

FRAMES = "benchmark.json/"  # width x height/depth/precision, see bench/gpu/frame_times.cpp
SPHERE = "bumpy_sphere/"


class Part(Records):
    """The record of one step; without it everything is empty."""

    def __init__(self, folder, step):
        record, path = {}, f"{folder}/{step}.json"
        if os.path.exists(path):
            with open(path) as file:
                record = json.load(file)
        super().__init__([path] if "benchmarks" in record else [])
        self.context = self.context or record.get("context", {})
        self.kernels = record.get("kernels", [])
        self.parity = {"cases": record.get("cases", []), **record.get("parity", {})}

    def named(self, name):
        """The benchmark of that name, whatever follows it (split:-1), on one GPU; of several the kernels' own split."""
        found = [b for b in self.benchmarks if (b["name"] + "/").startswith(name + "/") and "/devices:" not in b["name"]]
        return sorted(found, key=lambda b: "/split:" in b["name"] and not b["name"].endswith("/split:-1"))[:1]

    def time(self, name):
        return next((b["real_time"] for b in self.named(name)), None)


def load_records(folder):
    parts = {}
    for step in ("times", "parity", "golden", "seed", "fast"):
        try:
            parts[step] = Part(folder, step)
        except (ValueError, KeyError, OSError) as error:
            sys.exit(f"gpu_bars.py: {folder}/{step}.json is no record: {error!r}")
    commits = sorted({p.context["commit"] for p in parts.values() if p.context.get("commit")})
    if len(commits) > 1:
        sys.exit(f"gpu_bars.py: the records are of several commits, {', '.join(commits)}; run all steps again")
    return parts


def ratio(over, under):
    return over / under if over and under else None


# ---- compute-sanitizer

FINDING = re.compile(r"Invalid |Uninitialized |Misaligned |out of bounds|Out-of-range|Malloc/Free|Leaked ")
REFUSAL = re.compile(r"not supported|Internal Sanitizer Error|[Uu]nable to|not permitted|permission|not enabled|debugger|"
                     r"terminated before first instrumented|was not found|no attachable process", re.IGNORECASE)


def judge(log):
    """One run: passed, found, refused (by machine or tool, in words known for that), missing, or failed in any other way."""
    lines = log.strip().splitlines()
    code = int(lines[-1].split()[-1])
    summary = next((line.strip("= ") for line in reversed(lines) if "ERROR SUMMARY" in line), "")
    errors = re.search(r"ERROR SUMMARY: (\d+) error", summary)
    count = int(errors.group(1)) if errors else None
    if "compute-sanitizer is not installed" in log:
        result = "missing"
    elif code == 0 and count == 0:
        result = "passed"
    elif FINDING.search(log) or (count and not REFUSAL.search(log)):
        result = "found"
    else:
        result = "refused" if REFUSAL.search(log) else "failed"
    entry = {"result": result, "exit_code": code, "summary": summary}
    if result in ("found", "refused", "failed"):
        entry["output"] = lines[:12]
    return entry


def read_sanitizer(folder):
    runs = []
    for path in sorted(glob.glob(f"{folder}/sanitizer/*.log")):
        tool, *scene, precision, sampling = os.path.basename(path)[:-len(".log")].split("-")
        with open(path, errors="replace") as file:
            runs.append({"tool": tool, "scene": "-".join(scene), "precision": precision, "sampling": sampling, **judge(file.read())})
    return runs


# ---- bars

class Bars:
    def __init__(self):
        self.all = []

    def add(self, name, relation, limit, goal, value, unit="", **more):
        """Without a limit it is for the record. What was not measured meets nothing."""
        within = {"<=": lambda bar: value <= bar, ">=": lambda bar: value >= bar}[relation]
        entry = {"bar": name, "relation": relation, "limit": limit, "goal": goal, "value": value, "unit": unit}
        entry["met"] = None if limit is None else value is not None and within(limit)
        entry["goal_met"] = None if goal is None else value is not None and within(goal)
        self.all.append({**entry, **more})

    def print(self):
        for b in self.all:
            value = "-" if b["value"] is None else f"{b['value']:.4g}"
            limit = "" if b["limit"] is None else f"{b['relation']} {b['limit']:g}"
            goal = "" if b["goal"] is None else f"goal {b['goal']:g}"
            verdict = {None: "", True: "met", False: "MISSED"}[b["met"]]
            if b["goal_met"]:
                verdict += ", goal too"
            if b["value"] is None:
                verdict = "NOT MEASURED"
            print(f"{b['bar']:<58} {value:>10} {b['unit']:<8} {limit:<8} {goal:<10} {verdict}")


def parity_bars(bars, parts):
    cases = parts["parity"].parity.get("cases", []) + parts["times"].parity.get("cases", [])

    def of_kind(case):
        for prefix in ("scenes", "generated", "bumpy_sphere"):
            if case["case"].startswith(prefix + "/"):
                return prefix
        return "functions"

    for kind, step, name in (("functions", "parity", "functions: words that differ"),
                             ("scenes", "parity", "scenes/ and golden hashes: values that differ"),
                             ("generated", "parity", "generated scenes: values that differ"),
                             ("bumpy_sphere", "times", "rays: those that differ")):
        chosen = [c for c in cases if of_kind(c) == kind]
        compared = sum(c["compared"] for c in chosen)
        bars.add(name, "<=", 0, None, sum(c["differing"] for c in chosen) if compared else None, compared=compared, step=step)
    golden = parts["golden"].parity
    bars.add("golden images: renders that differ", "<=", 0, None, golden["differing"] if golden.get("compared") else None,
             compared=golden.get("compared", 0), step="golden")


def frame_bars(bars, times):
    for frame, precision, limit, goal in (("3840x2160/depth:4", "float", 1.0, 0.6), ("3840x2160/depth:8", "float", 2.8, 1.6),
                                          ("3840x2160/depth:4", "double", 1.7, 1.0), ("3840x2160/depth:8", "double", 4.5, 2.8),
                                          ("640x480/depth:8", "float", 0.35, 0.2)):
        bars.add(f"benchmark.json, {frame.replace('/depth:', ', depth ')}, {precision}", "<=", limit, goal,
                 times.time(f"{FRAMES}{frame}/{precision}"), "ms")


def seed_bars(bars, times, seed):
    """The best of its grids; its precision is double, the bar is on float."""
    for depth in (4, 8):
        grids = {b["name"].split("grid:")[-1]: b["real_time"] for b in seed.benchmarks
                 if b["name"].startswith(f"seed/3840x2160/depth:{depth}/")}
        best = min(grids, key=grids.get, default=None)
        for precision, limit, goal in (("float", 24, 40), ("double", None, None)):
            bars.add(f"seed_baseline's time / ours in {precision}, depth {depth}", ">=", limit, goal,
                     ratio(grids.get(best), times.time(f"{FRAMES}3840x2160/depth:{depth}/{precision}")), "x",
                     best_grid=best, seed_ms=grids.get(best))


def ray_bars(bars, times):
    for kind, limit, goal in (("primary", 1.5, 3), ("bounced", 0.8, 1.6), ("occlusion", 1.0, 2)):
        for precision in ("float", "double"):
            found = [b for b in times.benchmarks if b["name"].endswith(f"{SPHERE}{kind}/{precision}")]
            in_float = precision == "float"
            bars.add(f"bumpy sphere, {kind} rays, {precision}", ">=", limit if in_float else None, goal if in_float else None,
                     found[0]["rays_per_second"] / 1e9 if found else None, "Grays/s")


def fast_bars(bars, times, fast):
    ratios = {}
    for b in fast.benchmarks:
        if b["name"].startswith(FRAMES):
            ratios[b["name"]] = ratio(next((o["real_time"] for o in times.benchmarks if o["name"] == b["name"]), None), b["real_time"])
    known = {name: value for name, value in ratios.items() if value}
    worst = max(known, key=known.get, default=None)
    bars.add("time of the exact kernels / of fast-math ones, worst", "<=", 1.25, 1.1, known.get(worst), "x", worst=worst, each=known)


def effect_bars(bars, times):
    """effects/SCENE/SAMPLES/PRECISION/auto and .../all, at 1280x720, or with one sample at the size that stands for SAMPLES."""
    ms = {b["name"]: b["real_time"] for b in times.benchmarks if b["name"].startswith("effects/")}

    def gains(scene, samples):
        return {p: ratio(ms.get(f"effects/{scene}/{samples}/{p}/all"), ms.get(f"effects/{scene}/{samples}/{p}/auto"))
                for p in ("float", "double")}

    for scene, limit in (("opaque", 1.8), ("mirrors", 1.4), ("benchmark", 1.1)):
        for samples in ("4x4", "3840x2160", "1x1"):
            each = gains(scene, samples)
            bars.add(f"{scene}, {samples}: all effects / those it needs, worst precision", ">=", limit, None,
                     min((v for v in each.values() if v), default=None), "x", each=each)
    every = {name[len("effects/"):-len("/auto")]: ratio(ms.get(name[:-len("auto")] + "all"), t)
             for name, t in ms.items() if name.endswith("/auto") and t > 0}  # a camera that looks away takes no time
    worst = min(every, key=every.get, default=None)
    bars.add("scenes/ and these: all effects / those needed, worst", ">=", 0.98, None, every.get(worst), "x", worst=worst, each=every)
    edge = {f"{s}/{p}": ratio(ms.get(f"effects/edge_lights/{s}/{p}/auto"), ms.get(f"effects/benchmark/{s}/{p}/auto"))
            for s in ("4x4", "3840x2160", "1x1") for p in ("float", "double")}
    bars.add("six seen lights on every edge / none, worst", "<=", 1.3, None, max((v for v in edge.values() if v), default=None), "x",
             each=edge)


def film_bars(bars, times):
    """film/.../kernel and film/.../writers alone, film/.../film together, all in the time of the whole film."""
    alone, whole = [], None
    for b in times.benchmarks:
        kind = re.match(r"film/(?:.*/)?(kernels?|writers?|film)$", b["name"])
        if not kind:
            continue
        if kind.group(1) == "film":
            whole = b["real_time"]
        else:
            alone.append(b["real_time"])
    bars.add("film: the slower of kernel and writers alone / both at once", ">=", 0.9, None,
             ratio(max(alone) if len(alone) == 2 else None, whole), "x")


def device_bars(bars, times):
    """NAME/devices:N/...: the same frame on N GPUs."""
    by_frame = {}
    for b in times.benchmarks:
        found = re.fullmatch(r"(.*)/devices:(\d+)(.*)", b["name"])
        if found:
            by_frame.setdefault(found.group(1) + found.group(3), {})[int(found.group(2))] = b["real_time"]
    for devices, limit in ((2, 1.9), (4, 3.7)):
        measured = {name: ratio(t.get(1), t.get(devices)) for name, t in by_frame.items() if t.get(devices)}
        least = min((v for v in measured.values() if v), default=None)
        bars.add(f"speed of {devices} GPUs / of one", ">=", limit, None, least, "x", each=measured)
    eight = [ratio(t.get(1), t.get(8)) for t in by_frame.values() if t.get(8)]
    if eight:
        bars.add("speed of 8 GPUs / of one", ">=", None, 7.6, min(v for v in eight if v), "x")


def read_steps(folder):
    steps = {}
    for path in sorted(glob.glob(f"{folder}/*.status")):
        with open(path) as file:
            steps[os.path.basename(path)[:-len(".status")]] = int(file.read())
    return steps


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: gpu_bars.py PARTS OUT.json")
    folder, out = sys.argv[1:]
    parts, steps, sanitizer = load_records(folder), read_steps(folder), read_sanitizer(folder)
    bars = Bars()
    parity_bars(bars, parts)
    frame_bars(bars, parts["times"])
    seed_bars(bars, parts["times"], parts["seed"])
    ray_bars(bars, parts["times"])
    fast_bars(bars, parts["times"], parts["fast"])
    effect_bars(bars, parts["times"])
    film_bars(bars, parts["times"])
    device_bars(bars, parts["times"])
    bars.print()
    for run in sanitizer:
        print(f"compute-sanitizer {run['tool']:<9} {run['scene']}.json, {run['precision']:<6} {run['sampling']:<8} {run['result']:<8} {run['summary']}")

    compared = sum(b["compared"] for b in bars.all if "compared" in b)
    differing = sum(b["value"] or 0 for b in bars.all if "compared" in b)
    failed = [f"{step}: exit code {code}" for step, code in steps.items() if code != 0]
    failed += [f"{b['bar']}: nothing was compared" for b in bars.all if b.get("compared") == 0 and b["step"] in steps]
    failed += [f"{r['tool']} on {r['scene']}.json in {r['precision']}, {r['sampling']}: {r['result']}" for r in sanitizer
               if r["result"] in ("found", "failed")]
    first = next((part.context for part in parts.values() if part.context), {})
    others = {step: {key: value for key, value in part.context.items() if first.get(key) != value} for step, part in parts.items()}
    context = {**first, "steps": steps, "programs": {step: other for step, other in others.items() if other}}
    benchmarks = [b for step in ("times", "seed") for b in parts[step].benchmarks]
    benchmarks += [{**b, "name": "fast_math/" + b["name"]} for b in parts["fast"].benchmarks]
    with open(out, "w") as file:
        json.dump({"context": context, "benchmarks": benchmarks, "kernels": parts["times"].kernels,
                   "parity": {"compared": compared, "differing": differing,
                              "cases": [c for p in ("parity", "times", "golden") for c in parts[p].parity.get("cases", [])]},
                   "sanitizer": sanitizer, "bars": bars.all}, file, indent=2)
        file.write("\n")
    print(f"written: {out}")
    if first.get("commit", "").endswith("-dirty"):
        print(f"built from a changed source tree ({first['commit']}): no record to keep")
    if failed or differing:
        sys.exit("gpu-check failed: " + "; ".join(([f"{differing} differ"] if differing else []) + failed))


if __name__ == "__main__":
    main()
