"""Errors as the programs print them: one line, which names the place, what is wrong and what would be right."""
from __future__ import annotations

import re


class Error(Exception):
    """What can be mended by who calls. str() is the whole line.

    source, pointer: the file and the JSON pointer in it; argument: its name; remedy: what would be right. Each may be None.
    """

    def __init__(self, line: str, source: str | None = None, pointer: str | None = None, argument: str | None = None,
                 remedy: str | None = None) -> None:
        super().__init__(line)
        self.source = source
        self.pointer = pointer
        self.argument = argument
        self.remedy = remedy


class SceneError(Error, ValueError):
    """A scene is wrong at `pointer`, or at a line and column that the message names."""


class ArgumentError(Error, ValueError):
    """An argument is wrong; the message begins with its name and value."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class DeviceError(Error):
    """There is no usable GPU, or this build does not have the backend."""


class FrameError(Error, ArithmeticError):
    """A frame cannot be trusted, or missed its target: a number was not finite, a stated limit was passed."""


_KINDS: dict[str, type[Error]] = {"usage": ArgumentError, "scene": SceneError, "file": FileError, "device": DeviceError,
                                  "failed": FrameError, "target": FrameError}
_PLACE = re.compile(r"(?P<source>.*?)(: (?P<pointer>/.*?)(: .*)?|(:\d+){1,2})?$", re.DOTALL)


def of_library(line: str, kind: str, subject: str, place: str, remedy: str) -> Error:
    """The exception for an error of the library."""
    parts = _PLACE.match(place)
    assert parts is not None
    return _KINDS.get(kind, Error)(line, parts["source"] or None, parts["pointer"], subject or None, remedy or None)
