"""bars.py OUT.csv RECORD.json...: every bar beside what was measured, as rows of bench/results/history.csv.

The records are Google Benchmark's or of its shape, of one commit and one machine. Exit code 0; 1 where a bar does not hold;
3 where the records are of no use."""
import csv
import datetime
import json
import os
import statistics
import sys

HEADER = ["date", "commit", "machine", "bar", "value", "limit", "holds"]


def fail(message):
    print(f"bars.py: {message}", file=sys.stderr)
    sys.exit(3)


class History:
    """Rows of history.csv, of one run; `context` is a record's."""

    def __init__(self, context):
        gpus = context.get("devices", [])
        machine = " and ".join(f"{gpus.count(name)} {name}" for name in dict.fromkeys(gpus))
        date = context.get("date") or datetime.datetime.now(datetime.timezone.utc).isoformat()
        self.key = [date[:10], context["commit"], machine or f"{context['cpu']} with {context['num_cpus']} threads"]
        self.rows, self.holds = [], True

    def add(self, bar, value, limit=""):
        """`limit` is as in ">=22" or "<=1.1"; without one the value is for the record."""
        holds = ""
        if limit:
            holds = "yes" if (value >= float(limit[2:]) if limit.startswith(">=") else value <= float(limit[2:])) else "no"
        self.holds = self.holds and holds != "no"
        self.rows.append([*self.key, bar, f"{value:.5g}", limit, holds])
        print(f"{bar:<44} {value:10.5g}  {limit:<8}{ {'yes': 'holds', 'no': 'DOES NOT HOLD'}.get(holds, '')}", flush=True)

    def append_to(self, path):
        begins = not os.path.exists(path) or os.path.getsize(path) == 0
        with open(path, "a", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(([HEADER] if begins else []) + self.rows)
        print(f"written: {path}")


class Records:
    def __init__(self, paths):
        self.context, self.benchmarks, self.cases = {}, [], []
        for path in paths:
            with open(path) as file:
                record = json.load(file)
            self.context = self.context or record["context"]
            if record["context"]["commit"] != self.context["commit"]:
                fail(f"{path} is of {record['context']['commit']}, the others of {self.context['commit']}; run all steps again")
            kind = "fast/" if record["context"].get("executable") == "gpu_check_fast" else ""
            self.benchmarks += [{**b, "name": kind + b["run_name"]} for b in record.get("benchmarks", []) if b["run_type"] == "iteration"]
            parity = record.get("parity", {})  # of gpu_check by cases, of render-compare as a whole
            self.cases += parity.get("cases", [{"case": "golden", **parity}] if parity else [])

    def named(self, name):
        found = [b for b in self.benchmarks if (b["name"] + "/").startswith(name + "/")]
        return found or fail(f"the records have no benchmark {name}")

    def has(self, name):
        return any(b["name"].startswith(name) for b in self.benchmarks)

    def thread_counts(self, name):
        return sorted({int(b["name"].split("threads:")[1].split("/")[0]) for b in self.benchmarks if b["name"].startswith(name)})

    def time(self, name, clock="real_time"):
        return statistics.median(b[clock] for b in self.named(name))

    def ratio(self, over, under, clock="real_time"):
        return self.time(over, clock) / self.time(under, clock)


def cpu_bars(add, records):
    scene, sphere = "benchmark.json/", "bumpy_sphere/"
    for key, shown, least, agree in (("povray", scene, ">=60", ">=0.99"), ("povray/glass", "glass_on_tiles.json/", ">=15", ">=0.98"),
                                     ("povray/mesh", "knot_between_mirrors.json/", ">=6", ">=0.99"),
                                     ("povray/spheres", "spheres.json/", ">=15", ""),
                                     ("povray/sky", "bodies_under_a_sky.json/", "", ">=0.999")):
        for threads in records.thread_counts(shown + "povray/"):
            name = f"{key}/time-ratio" + ("" if threads == 2 else f"/threads:{threads}")
            add(name, records.ratio(f"{shown}povray/threads:{threads}", f"{shown}cistula/threads:{threads}"), least if threads == 2 else "")
        add(f"{key}/share-within-0.004", records.named(shown + "images")[0]["share_within_0.004"], agree)
    for kind in ("primary", "mirrored"):
        for theirs, least in (("", ">=0.95"), ("_16", ">=0.9")):
            rays = f"{sphere}{kind}/"
            add(f"embree{theirs}/{kind}/rays-ratio", records.ratio(f"{rays}embree_robust{theirs}", rays + "cistula/float", "cpu_time"), least)
    for precision, most in (("float", 160), ("double", 240)):
        add(f"bytes-a-triangle/{precision}", records.named(f"{sphere}memory/{precision}")[0]["bytes_per_triangle"], f"<={most}")
    for depth in (4, 16):
        add(f"double-over-float/depth:{depth}", records.ratio(f"{scene}double/depth:{depth}", f"{scene}float/depth:{depth}"), "<=1.6")


def gpu_bars(add, records):
    """seed_baseline counts by the best of its grids; it computes in double, and the bar is on our float."""
    for kind in ("functions", "scenes", "generated", "golden", "devices"):
        chosen = [case for case in records.cases if case["case"].startswith(kind)]
        if chosen:
            add(f"parity/{kind}", sum(case["differing"] for case in chosen), "<=0")
    picture = "benchmark.json/3840x2160/"
    for precision in ("float", "double"):
        for depth in (4, 8):
            frame = f"depth:{depth}/{precision}"
            if not records.has(picture + frame):
                continue
            if records.has("seed/") and precision == "float":
                best = min(b["real_time"] for b in records.named(f"seed/3840x2160/depth:{depth}"))
                add(f"seed/depth:{depth}", best / records.time(picture + frame), ">=22")
            add(f"kernel-ms/3840x2160/{frame}", records.time(picture + frame))
            if records.has("fast/"):
                add(f"exact-over-fast/3840x2160/{frame}", records.ratio(picture + frame, "fast/" + picture + frame))
    balls = "spheres.json/1280x720/3x3/depth:12/float"
    if records.has(balls):
        add("rays-a-second/spheres", records.named(balls)[0]["rays"] / (records.time(balls) / 1e3), ">=1e9")
    heavy = f"{picture}6x6/depth:8/float/devices:"
    for count, least in ((2, ">=1.9"), (4, ">=3.7"), (8, ">=7.6")):
        if records.has(f"{heavy}{count}"):
            add(f"devices:{count}/speed-ratio", records.ratio(f"{heavy}1", f"{heavy}{count}"), least)


def main():
    out, *paths = sys.argv[1:]
    records = Records(paths)
    history = History(records.context)
    (gpu_bars if "devices" in records.context else cpu_bars)(history.add, records)
    if os.path.exists(out):
        os.remove(out)
    history.append_to(out)
    return 0 if history.holds else 1


if __name__ == "__main__":
    sys.exit(main())
