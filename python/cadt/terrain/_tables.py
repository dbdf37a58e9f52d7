# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers: .xyz, .txt, .csv and .npy, through NumPy. Headers are read as the program's other commands do."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from ._files import Room, why
from .errors import FileError, TerrainError, UsageError

CHUNK = 1 << 20  # rows copied at a time
# Names of x and y that go together, and of heights.
FAMILIES = (
    (("x",), ("y",)),
    (("lon", "longitude", "long", "lng"), ("lat", "latitude")),
    (("easting", "east"), ("northing", "north")),
)
HEIGHTS = ("z", "height", "elevation", "elev", "altitude", "alt", "depth")


class TableSource:
    """x, y and a value a row. `columns` names them, counted from 1 or by the header: "1,2,3", "lon,lat,depth". Default:
    what the header says, else the first three."""

    crs = None

    def __init__(self, path: str, columns: str) -> None:
        self.path = path
        try:
            if path.lower().endswith(".npy"):
                table = np.load(path, mmap_mode="r", allow_pickle=False)
                self._columns = _choose(path, columns or "1,2,3", [], table.shape[1]) if table.ndim == 2 else []
                self._named = self._columns
            else:
                table, self._named = _read_text(path, columns)
                self._columns = [0, 1, 2]
        except TerrainError:
            raise
        except (OSError, ValueError) as error:
            raise FileError(path, f"cannot be read: {why(error)}") from error
        if table.ndim != 2 or not np.issubdtype(table.dtype, np.number):
            raise FileError(path, f"is no table of numbers: shape {table.shape}, {table.dtype}")
        self._table = table
        self.count = len(table)

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        for first in range(0, self.count, CHUNK):
            rows = self._table[first : first + CHUNK]
            xy, z = room(len(rows))
            for out, column, named in zip((xy[:, 0], xy[:, 1], z), self._columns, self._named):
                out[:] = rows[:, column]
                bad = np.flatnonzero(~np.isfinite(out))
                if len(bad):
                    row = first + int(bad[0])
                    raise FileError(
                        self.path, f"row {row} (counted from 0) has no finite number in column {named + 1}"
                    )
            step(first + len(rows))


def _read_text(path: str, columns: str) -> tuple[NDArray[np.float64], list[int]]:
    """x, y and the value of each row, and the columns that they are from."""

    def lines(file: TextIO) -> Iterator[str]:
        return (line for line in file if line.strip() and not line.lstrip().startswith("#"))

    with open(path, encoding="utf-8-sig") as file:
        first = next(lines(file), "")
    if not first:
        raise FileError(path, "is empty")
    mark = "," if "," in first else ";" if ";" in first else None
    words = [word.strip().strip('"') for word in first.split(mark)]
    known = _recognised(path, [word.lower() for word in words], columns)
    has_names = known is not None or not any(_is_number(word) for word in words)
    by_name = any(not word.strip().isdigit() for word in columns.split(",")) if columns else False
    names = words if has_names or by_name else []
    chosen = known if known and not columns else _choose(path, columns or "1,2,3", names, len(words))
    with open(path, encoding="utf-8-sig") as file:
        rows = lines(file)
        if names:
            next(rows)
        if (row := next(rows, None)) is None:
            raise FileError(path, "has no points, only a header line")
        table = np.loadtxt(itertools.chain([row], rows), delimiter=mark, usecols=chosen, quotechar='"', ndmin=2)
    return table, chosen


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _recognised(path: str, names: list[str], columns: str) -> list[int] | None:
    """The columns of x, y and heights by their names; None if they have none."""

    def find(wanted: tuple[str, ...]) -> int | None:
        return next((names.index(name) for name in wanted if name in names), None)

    for of_x, of_y in FAMILIES:
        x, y, z = find(of_x), find(of_y), find(HEIGHTS)
        if x is None or y is None:
            continue
        if z is None and not columns:
            raise UsageError(f"{path} has no column of heights: name three with --columns; it has: {', '.join(names)}")
        return [x, y, z or 0]
    return None


def _choose(path: str, columns: str, names: list[str], width: int) -> list[int]:
    asked = [word.strip() for word in columns.split(",")]
    if len(asked) != 3:
        raise UsageError(f"--columns {columns}: three columns are needed: x,y,value")
    lower = [name.lower() for name in names]
    chosen = []
    for word in asked:
        if word.isdigit() and 1 <= int(word) <= width:
            chosen.append(int(word) - 1)
        elif not word.isdigit() and word.lower() in lower:
            chosen.append(lower.index(word.lower()))
        else:
            has = ", ".join(names) if names else f"{width} columns without names"
            raise UsageError(f"--columns {columns}: {path} has no column {word}; it has: {has}")
    return chosen
