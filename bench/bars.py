"""bars.py OUT.json RECORD.json...: merges records of Google Benchmark and prints every bar beside what was measured."""
import json
import statistics
import sys


class Records:
    def __init__(self, paths):
        self.context, self.benchmarks = None, []
        for path in paths:
            with open(path) as file:
                record = json.load(file)
            record["context"].pop("executable", None)
            self.context = self.context or record["context"]
            self.benchmarks += record["benchmarks"]

    def runs(self, name):
        """The repetitions of a benchmark, in the order in which they ran."""
        chosen = [b for b in self.benchmarks if b["run_type"] == "iteration" and b["run_name"].startswith(name)]
        if not chosen:
            sys.exit(f"bars.py: the records have no benchmark {name}")
        return sorted(chosen, key=lambda b: b.get("repetition_index", 0))

    def times(self, name, clock="real_time"):
        return [b[clock] for b in self.runs(name)]

    def counter(self, name, key):
        return self.runs(name)[0][key]

    def ratio(self, over, under, clock="real_time"):
        """Of the medians, and the range over the single repetitions of both."""
        a, b = self.times(over, clock), self.times(under, clock)
        return statistics.median(a) / statistics.median(b), min(a) / max(b), max(a) / min(b)


def main():
    out, *paths = sys.argv[1:]
    records = Records(paths)
    scene, sphere = "benchmark.json/", "bumpy_sphere/"
    bars = []  # name, what holds, bar, value, low, high

    def bar(name, relation, limit, value, low=None, high=None):
        met = value >= limit if relation == ">=" else value <= limit
        entry = {"bar": name, "relation": relation, "limit": limit, "value": value, "met": met}
        if low is not None:
            entry["low"], entry["high"] = low, high
        bars.append(entry)

    bar("POV-Ray's time / Cistula's, depth 16", ">=", 15, *records.ratio(scene + "povray", scene + "cistula"))
    bar("  share of pixels within 0.004 of it", ">=", 0.99, records.counter(scene + "images", "share_within_0.004"))
    bar("rays a second / Embree's robust triangles", ">=", 0.95,
        *records.ratio(sphere + "embree_robust", sphere + "cistula/float", "cpu_time"))
    for precision, limit in (("float", 160), ("double", 240)):
        bar(f"bytes a triangle at the peak, {precision}", "<=", limit,
            records.counter(f"{sphere}memory/{precision}", "bytes_per_triangle"))
    for depth in (4, 16):
        bar(f"time of double / float, depth {depth}", "<=", 1.6,
            *records.ratio(f"{scene}double/depth:{depth}", f"{scene}float/depth:{depth}"))
    for effects, limit in (("opaque", 1.8), ("mirrors", 1.4), ("benchmark", 1.1)):
        for precision in ("float", "double"):
            run = f"effects/{effects}/{precision}/"
            bar(f"all effects / those needed, {effects}, {precision}", ">=", limit, *records.ratio(run + "all", run + "auto"))
    for precision in ("float", "double"):
        bar(f"with / without lights on edges, {precision}", "<=", 1.3,
            *records.ratio(f"effects/edge_lights/{precision}/auto", f"effects/benchmark/{precision}/auto"))

    for b in bars:
        spread = f"{b['low']:9.3f} to {b['high']:<9.3f}" if "low" in b else ""
        verdict = "met" if b["met"] else "MISSED"
        print(f"{b['bar']:<48} {b['value']:9.3f}  {b['relation']} {b['limit']:<6} {verdict:<7}{spread}")
    for name in ("povray", "cistula"):
        times = records.times(scene + name)
        print(f"{name} on benchmark.json, depth 16: median {statistics.median(times):.0f} ms, "
              f"{min(times):.0f} to {max(times):.0f}")
    with open(out, "w") as file:
        json.dump({"context": records.context, "benchmarks": records.benchmarks, "bars": bars}, file, indent=2)
        file.write("\n")
    print(f"written: {out}")


if __name__ == "__main__":
    main()
