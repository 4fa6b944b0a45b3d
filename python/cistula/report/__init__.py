"""`cistula report`: measures what accuracy costs in time and writes it as a page."""
from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cistula.command import Parser, Refused, number, shown, write_whole

HELP = """Examples:
  cistula report scenes/benchmark.json --quick --res 320x240 -o report.html
  cistula report scenes/benchmark.json scenes/platonic.json --backend cuda --scaling --json gpu.json
  cistula report --from gpu.json -o report.html       measured elsewhere

Exit codes: 0 done, 1 a frame cannot be trusted or has no end, 2 command line or scene, 3 file, 4 device, 130 interrupted."""


def parser() -> Parser:
    made = Parser("report", epilog=HELP, description="Measures what accuracy costs in time: every knob of a render alone and all "
                                                     "together, against a reference, as a page.")
    add = made.add_argument
    add("scenes", metavar="SCENE", nargs="*", help="scene files to measure")
    add("--from", metavar="FILE", nargs="+", dest="records", help="show records that --json wrote, on whatever machine; measures nothing")
    add("-o", "--output", metavar="FILE", help="the report, one HTML file that needs nothing else")
    add("--json", metavar="FILE", help="write what was measured, for --from and for programs")
    add("--backend", metavar="NAME", help="embree (CPU) or cuda (GPU); embree")
    add("--device", metavar="LIST", help="GPUs by their numbers; 0")
    add("--threads", metavar="N", type=number(1, 4096, int), help="threads; all")
    add("--res", metavar="WxH", help="frames of this many pixels; each scene's film")
    add("--repetitions", metavar="N", type=number(1, 1000, int), help="timed runs of each setting after warm-up; 10, --quick 3")
    add("--limit", metavar="S", type=number(1e-3, 1e6), help="leave out settings whose frames take longer than S seconds; 2")
    add("--quick", action="store_true", help="fewer settings and runs: to try it out")
    add("--scaling", choices=("also", "only"), metavar="also|only",
        help="also time against triangles, lights, depth, pixels and GPUs, by the first scene; --scaling=only: nothing else")
    add("-q", "--quiet", action="store_true", help="errors only")
    return made


def check(options: Any) -> None:
    """Raises Refused for options that do not go together, and files that are read and written."""
    measuring = {name: getattr(options, name) for name in ("backend", "device", "threads", "res", "limit", "repetitions", "quick", "scaling", "json")}
    if options.records:
        if options.scenes:
            raise Refused(f"{options.scenes[0]}: a scene and --from; measure the scene first with --json FILE, or leave --from out")
        for name, value in measuring.items():
            if value:
                raise Refused(f"--{name}: is for measuring; --from shows what was measured before")
    elif not options.scenes:
        raise Refused("no scene is given; cistula report SCENE... -o report.html, or --from FILE.json; --help tells more")
    if not options.output and not options.json:
        raise Refused("nothing would be written; add -o FILE.html, or --json FILE")
    if options.scaling == "only" and len(options.scenes) > 1:
        raise Refused("--scaling=only: looks at one scene; give one")
    if "-" in options.scenes:
        raise Refused("-: a report names its scenes; give files")
    files = [*options.scenes, *(options.records or []), options.output, options.json]
    places = [os.path.realpath(file) for file in files if file]
    for file in filter(None, (options.output, options.json)):
        if places.count(os.path.realpath(file)) > 1:
            raise Refused(f"{shown(file)}: is read, or written twice; give a file of its own")
        folder = Path(os.path.realpath(file)).parent
        if not os.access(folder, os.W_OK) or Path(file).is_dir():  # found before a long run rather than after it
            raise Refused(f"{shown(file)}: cannot be written; give a file in a folder that there is", 3)


def main(arguments: Sequence[str]) -> int:
    """Runs the command. Raises Refused, cistula.Error."""
    made = parser()
    if {"-h", "--help"} & set(arguments):
        made.print_help()
        return 0
    options = made.parse(["--scaling=also" if word == "--scaling" else word for word in arguments])
    check(options)
    try:
        import jinja2  # noqa: F401
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise Refused(f"{error.name} is not there; pip install 'cistula[report]'") from None
    import cistula

    from .measure import Options, measure
    from .page import NO_RECORD, page_of, targets

    text = ""
    if options.records:
        try:
            records = [json.loads(Path(file).read_bytes()) for file in options.records]
            text = page_of(records)
        except NO_RECORD as error:
            why = shown(f"{type(error).__name__}: {error}".replace("\n", " ")[:200])
            raise Refused(f"{shown(', '.join(options.records))}: is no record of cistula report ({why}); give what its --json wrote", 3) from None
    else:
        how = Options(options.backend or "embree", options.device or "0", options.threads, options.res, quick=options.quick,
                      repetitions=options.repetitions or (3 if options.quick else 10), warm_ups=1 if options.quick else 2,
                      limit=options.limit or 2.0, quiet=options.quiet)
        try:
            records = [measure(options.scenes, how, scenes=options.scaling != "only", scale=bool(options.scaling))]
        except cistula.Error as error:
            codes = {cistula.FrameError: 1, cistula.FileError: 3, cistula.DeviceError: 4}
            raise Refused(str(error), codes.get(type(error), 2)) from None
    files: dict[Path, bytes] = {}
    if options.json:
        files[Path(options.json)] = (json.dumps(records[0] | {"targets": targets(records[0])}, indent=1) + "\n").encode()
    if options.output:
        files[Path(options.output)] = (text or page_of(records)).encode()
    write_whole(files)
    return 0
