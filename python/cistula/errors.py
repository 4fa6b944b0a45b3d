"""Errors as the programs print them: one line, which names the place, what is wrong and what would be right."""
from __future__ import annotations

import re


class Error(Exception):
    """What can be mended by who calls. str() is the whole line.

    code: the exit code of `render` for it; source, pointer: the file and the JSON pointer in it, or None.
    """

    def __init__(self, line: str, code: int = 2, source: str | None = None, pointer: str | None = None) -> None:
        super().__init__(line)
        self.code = code
        self.source = source
        self.pointer = pointer


class SceneError(Error, ValueError):
    """A scene is wrong at `pointer`, or at a line and column that the message names."""


class ArgumentError(Error, ValueError):
    """An argument is wrong; the message begins with its name and value."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class DeviceError(Error):
    """There is no usable GPU, or this build does not have the backend."""


class FrameError(Error, ArithmeticError):
    """A frame cannot be trusted: a number was not finite, or a stated limit was passed."""


_KINDS: dict[int, type[Error]] = {1: FrameError, 3: FileError, 4: DeviceError}
_PLACE = re.compile(r"(?P<source>[^:]+)(:\d+(:\d+)?: |: (?P<pointer>/[^:\s]*): )")


def of_message(line: str, code: int) -> Error:
    """The exception for an error of the library: the only place where it is told what kind it is."""
    place = _PLACE.match(line)
    if place is None:
        return _KINDS.get(code, ArgumentError)(line, code)
    return _KINDS.get(code, SceneError)(line, code, place["source"], place["pointer"])
