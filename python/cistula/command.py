"""What the commands share: errors of one line, options, nearest names, files that are written whole or not at all."""
import argparse
import difflib
import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NoReturn

from cistula.errors import DeviceError, Error, FileError, FrameError


class Refused(Exception):
    """An error that ends a command: a line that says what is wrong and what would be right, and the exit code, 2 for the
    command line, 3 for a file."""

    def __init__(self, message: str, code: int = 2) -> None:
        super().__init__(message)
        self.code = code


class Parser(argparse.ArgumentParser):
    """A parser of a command's options that refuses by Refused."""

    def __init__(self, command: str, **more: str) -> None:
        super().__init__(prog="cistula " + command, allow_abbrev=False,
                         formatter_class=argparse.RawDescriptionHelpFormatter, **more)  # type: ignore[arg-type]

    def error(self, message: str) -> NoReturn:
        raise Refused(message + "; --help tells more")

    def parse(self, arguments: Sequence[str]) -> argparse.Namespace:
        """All arguments; an unknown one is answered by the option most like it."""
        options, extra = self.parse_known_args(arguments)
        if extra and extra[0].startswith("-"):
            near = difflib.get_close_matches(extra[0].split("=")[0], self._option_string_actions, 1)
            like = f"; did you mean {near[0]}?" if near else ""
            raise Refused(f"{extra[0]}: no such option{like}; --help lists them")
        if extra:
            raise Refused(f"{extra[0]}: one file at a time; --help tells more")
        return options


def number(low: float, high: float, kind: type = float) -> Callable[[str], float]:
    """A type of options: numbers from `low` to `high`."""
    def read(text: str) -> float:
        try:
            value: float = kind(text)
        except ValueError:
            value = float("nan")
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text} must be a {'whole ' * (kind is int)}number from {low:g} to {high:g}")
        return value
    return read


def shown(name: str) -> str:
    """A name on one line, whatever characters it has."""
    return name if name.isprintable() else name.encode("unicode_escape", "surrogateescape").decode()


def nearest_first(name: str, known: Iterable[str]) -> str:
    """All names that there are, those most like `name` first, at most 20."""
    like = sorted(known, key=lambda one: -difflib.SequenceMatcher(None, name.lower(), one.lower()).ratio())
    return ", ".join(map(shown, like[:20])) + (f" and {len(like) - 20} more" if len(like) > 20 else "")


def write_whole(files: dict[Path, bytes]) -> None:
    """Writes files beside their names and puts all in place once they are whole; where that fails, none. Raises Refused."""
    written: list[tuple[str, Path]] = []
    try:
        for path, data in files.items():
            path = Path(os.path.realpath(path))
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(prefix=".", suffix=".part", dir=path.parent)
            written.append((name, path))
            with open(handle, "wb") as file:
                file.write(data)
            umask = os.umask(0)
            os.umask(umask)
            os.chmod(name, 0o666 & ~umask)
        for name, path in written:
            os.replace(name, path)
    except OSError as error:
        raise Refused(f"{shown(str(path))}: cannot be written: {error.strerror or error}", 3) from error
    finally:
        for name, _ in written:
            Path(name).unlink(missing_ok=True)


def run(name: str, work: Callable[[], int]) -> int:
    """Runs a command's work and returns its exit code; what goes wrong becomes a line on standard error."""
    try:
        code = work()
        sys.stdout.flush()
        return code
    except Refused as error:
        message, code = str(error), error.code
    except Error as error:
        message, code = str(error), {FrameError: 1, FileError: 3, DeviceError: 4}.get(type(error), 2)
    except OSError as error:
        message, code = f"{error.filename or 'standard output'}: {error.strerror or error}", 3
        if not error.filename:  # what is left to be said cannot be said at the end either
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    except MemoryError:
        message, code = "there is not enough memory", 3
    except KeyboardInterrupt:
        message, code = "interrupted", 130
    except Exception as error:
        message, code = f"a fault of this program: {type(error).__name__}: {' '.join(str(error).split())}", 1
    print(f"cistula {name}: {message}", file=sys.stderr)
    return code
