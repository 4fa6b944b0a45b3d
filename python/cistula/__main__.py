"""The commands of `cistula NAME ...`: programs of the native module, and modules of the package with main(arguments) -> exit
code."""
import importlib
import os
import signal
import sys
from collections.abc import Sequence

from cistula.command import Refused, run

PROGRAMS = {
    "render": "a scene as EXR images",
    "compare": "how two pictures differ, or those of a suite",
    "verify": "hard cases against closed forms, on this machine",
}
COMMANDS = PROGRAMS | {
    "report": "what accuracy costs in time, measured and shown as a page",
    "view": "layers of EXR pictures as PNG, and contact sheets",
    "farm": "tasks of a film, for OpenJD, Slurm and make",
    "import": "a scene of a mesh: PLY, OBJ or STL",
}
MODULES = {"import": "importer"}  # where its name is a word of Python


def run_program(name: str, arguments: Sequence[str]) -> int:
    """Runs a program, as it runs by itself: signals are for it."""
    try:
        from cistula import _core
    except ImportError as error:
        raise Refused(f"{error}; `make wheel` or `make test` builds the native module") from error
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    return _core.run_program(name, [os.fsencode(word) for word in arguments])


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command that the first argument names with the others, and returns its exit code."""
    name, *others = (sys.argv[1:] if arguments is None else list(arguments)) or ["--help"]
    if name in ("-h", "--help"):
        print("usage: cistula COMMAND ...\n\n" + "\n".join(f"  {n:10}{what}" for n, what in COMMANDS.items())
              + "\n\ncistula COMMAND --help tells more.")
        return 0
    if name == "--version":
        from importlib.metadata import version
        print("cistula " + version("cistula"))
        return 0
    if name not in COMMANDS:
        print(f"cistula: {name}: no such command; there are {', '.join(COMMANDS)}", file=sys.stderr)
        return 2
    if name in PROGRAMS:
        return run(name, lambda: run_program(name, others))
    return run(name, lambda: int(importlib.import_module("." + MODULES.get(name, name), "cistula").main(others)))


if __name__ == "__main__":
    sys.exit(main())
