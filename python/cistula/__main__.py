"""The commands of `cistula NAME ...`; each is a module of the package with main(arguments) -> exit code."""
import importlib
import sys
from collections.abc import Sequence

from cistula.command import run

COMMANDS = {
    "report": "what accuracy costs in time, measured and shown as a page",
    "view": "layers of EXR pictures as PNG, and contact sheets",
    "farm": "tasks of a film, for OpenJD, Slurm and make",
    "import": "a scene of a mesh: PLY, OBJ or STL",
}
MODULES = {"import": "importer"}  # where its name is a word of Python


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
    return run(name, lambda: int(importlib.import_module("." + MODULES.get(name, name), "cistula").main(others)))


if __name__ == "__main__":
    sys.exit(main())
