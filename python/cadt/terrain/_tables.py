# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers: .xyz, .txt, .csv and .npy, through NumPy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ._files import Room, why
from .errors import FileError, UsageError

CHUNK = 1 << 20  # rows copied at a time


class TableSource:
    """x, y and a value a row. `columns` names them, counted from 1 or by the header: "1,2,3", "lon,lat,depth"."""

    crs = None

    def __init__(self, path: str, columns: str) -> None:
        self.path = path
        try:
            if path.lower().endswith(".npy"):
                table = np.load(path, mmap_mode="r", allow_pickle=False)
                names: list[str] = []
            else:
                table, names = _read_text(path)
        except (OSError, ValueError) as error:
            raise FileError(path, f"cannot be read: {why(error)}") from error
        if table.ndim != 2 or not np.issubdtype(table.dtype, np.number):
            raise FileError(path, f"is no table of numbers: shape {table.shape}, {table.dtype}")
        self._table = table
        self._columns = _choose(path, columns or "1,2,3", names, table.shape[1])
        self.count = len(table)

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        for first in range(0, self.count, CHUNK):
            rows = self._table[first : first + CHUNK]
            xy, z = room(len(rows))
            for out, column in zip((xy[:, 0], xy[:, 1], z), self._columns):
                out[:] = rows[:, column]
                bad = np.flatnonzero(~np.isfinite(out))
                if len(bad):
                    row = first + int(bad[0])
                    raise FileError(
                        self.path, f"row {row} (counted from 0) has no finite number in column {column + 1}"
                    )
            step(first + len(rows))


def _read_text(path: str) -> tuple[NDArray[np.float64], list[str]]:
    with open(path, encoding="utf-8") as file:
        first = next((line for line in file if line.strip() and not line.startswith("#")), "")
    mark = "," if "," in first else ";" if ";" in first else None
    words = [word.strip().strip('"') for word in first.split(mark)]
    try:
        [float(word) for word in words]
        names: list[str] = []
    except ValueError:
        names = words
    if not first:
        raise FileError(path, "is empty")
    with open(path, encoding="utf-8") as file:
        if names:
            while next(file) != first:
                pass
        return np.loadtxt(file, delimiter=mark, ndmin=2), names


def _choose(path: str, columns: str, names: list[str], width: int) -> list[int]:
    asked = [word.strip() for word in columns.split(",")]
    if len(asked) != 3:
        raise UsageError(f"--columns {columns}: three columns are needed: x,y,value")
    chosen = []
    for word in asked:
        if word in names:
            chosen.append(names.index(word))
        elif word.isdigit() and 1 <= int(word) <= width:
            chosen.append(int(word) - 1)
        else:
            has = ", ".join(names) if names else f"{width} columns without names"
            raise UsageError(f"--columns {columns}: {path} has no column {word}; it has: {has}")
    return chosen
