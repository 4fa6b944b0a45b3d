"""Reads STL files, text and binary, as programs write them."""
from __future__ import annotations

from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from cistula.command import Refused, shown

Solid = tuple[str, npt.NDArray[Any]]  # its name, and the corners of its triangles, M x 3 x 3


def read_solids(path: Path) -> tuple[list[Solid], list[str]]:
    """The solids that have triangles, and what is to be said of the file. Raises Refused, OSError."""
    label = shown(str(path))
    if path.exists() and not path.is_file():
        raise Refused(f"{label}: is no file", 3)
    data = path.read_bytes()
    count, room = int.from_bytes(data[80:84], "little"), len(data) - 84
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) and room != 50 * count:
        data = data.decode("utf-16", "replace").encode()
    text = data.removeprefix(b"\xef\xbb\xbf").rstrip(b"\0\x1a \t\r\n")
    if text.lstrip()[:5].lower() == b"solid" and b"\0" not in text and room != 50 * count:
        solids, remarks = _of_text(text, label)
    else:
        solids, remarks = _of_binary(data, count, room, label)
    solids = [solid for solid in solids if len(solid[1])]
    if not solids:
        raise Refused(f"{label}: no triangles were found in it; an STL of text begins with \"solid\" and has a line for each vertex", 3)
    return solids, remarks


def _of_binary(data: bytes, count: int, room: int, label: str) -> tuple[list[Solid], list[str]]:
    more = data[84 + 50 * count:]
    if room < 50 * count or room < 0 or (len(more) >= 50 and more.strip(b"\0")):
        raise Refused(f"{label}: has {len(data)} bytes, but the {count} triangles that it counts at byte 80 take {84 + 50 * count}; "
                      "it is cut off, or no STL file", 3)
    rows = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("color", "<u2")]), count, 84)
    return [("", rows["corners"].astype(float))], [f"{label}: ignored {len(more)} bytes after the last triangle"] if more else []


def _of_text(text: bytes, label: str) -> tuple[list[Solid], list[str]]:
    """Statements may share lines, but for solid and endsolid, whose names end with the line."""
    solids: list[tuple[str, list[list[list[float]]]]] = []
    loop: list[list[float]] | None = None
    is_open, number, ignored = False, 0, dict[str, bool]()

    def refuse(problem: str) -> NoReturn:
        raise Refused(f"{label}:{number}: {problem}", 3)

    for number, line in enumerate(text.splitlines(), 1):
        words = line.split()
        at = 0
        while at < len(words):
            key, at = words[at].lower(), at + 1
            if at == 1 and key in (b"solid", b"endsolid"):
                if loop is not None:
                    refuse("a solid begins or ends within a loop of vertices; give endloop first")
                is_open = key == b"solid"
                if is_open:
                    name = b" ".join(words[1:])
                    try:
                        solids.append((name.decode(), []))
                    except UnicodeDecodeError:
                        solids.append((name.decode("latin-1"), []))
                break
            if key == b"outer":
                if loop is not None or not is_open:
                    refuse("a loop begins " + ("within another" if loop is not None else "outside of a solid"))
                loop = []
            elif key == b"vertex":
                if loop is None:
                    refuse("a vertex stands outside of a loop; \"outer loop\" begins one")
                try:
                    point = [float(word) for word in words[at:at + 3] if b"_" not in word]
                except ValueError:
                    point = []
                if len(point) != 3:
                    refuse(f"expected three numbers after vertex, found {shown(b' '.join(words[at:at + 3]).decode(errors='replace'))!r}")
                loop.append(point)
                at += 3
            elif key == b"endloop":
                if loop is None or len(loop) != 3:
                    refuse(f"a loop has {len(loop or ())} vertices; in an STL it has 3, so export triangles")
                solids[-1][1].append(loop)
                loop = None
            elif key == b"facet":  # its normal follows from its vertices
                while at < len(words) and words[at].lower() != b"outer":
                    at += 1
            elif key not in (b"loop", b"endfacet"):
                ignored[shown(key.decode(errors="replace"))] = True
                break
    if loop is not None:
        refuse("the file ends within a loop of vertices: it is cut off")
    remarks = [f"{label}: ends without \"endsolid\"; it may be cut off"] if is_open else []
    if ignored:
        remarks.append(f"{label}: ignored what has no meaning here: {', '.join(list(ignored)[:24])}")
    return [(name, np.array(triangles, float).reshape(-1, 3, 3)) for name, triangles in solids], remarks
