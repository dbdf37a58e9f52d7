# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers: .xyz, .txt, .csv and .npy, through NumPy. Text is read as the program's other commands do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cadt._tables import Layout, TableError, check_guess, has_names, read_table, recognised

from ._files import Room, why
from .errors import FileError, TerrainError, UsageError

CHUNK = 1 << 20  # rows copied at a time


class TableSource:
    """x, y and a value a row. `columns` names them, counted from 1 or by the header: "1,2,3", "lon,lat,depth". Default:
    what the header says, else the first three."""

    crs = None

    def __init__(self, path: str, columns: str) -> None:
        self.path = path
        try:
            if path.lower().endswith(".npy"):
                table = _load(path)
                self._columns = _choose(path, columns or "1,2,3", [], table.shape[1]) if table.ndim == 2 else []
            else:
                table, self._columns = _read_text(path, columns), [0, 1, 2]
        except TerrainError:
            raise
        except (OSError, ValueError) as error:
            raise FileError(path, f"cannot be read: {why(error)}") from error
        if table.ndim != 2 or table.dtype.kind not in "iuf":
            raise FileError(path, f"is no table of numbers: shape {table.shape}, {table.dtype}")
        self._table = table
        self.count = len(table)

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        for first in range(0, self.count, CHUNK):
            rows = self._table[first : first + CHUNK]
            xy, z = room(len(rows))
            for out, column in zip((xy[:, 0], xy[:, 1], z), self._columns):
                out[:] = rows[:, column]
                bad = np.flatnonzero(~np.isfinite(out))
                if len(bad):  # of an array
                    row = first + int(bad[0])
                    raise FileError(
                        self.path, f"row {row} (counted from 0) has no finite number in column {column + 1}"
                    )
            step(first + len(rows))


def _load(path: str) -> NDArray[Any]:
    try:
        table = np.load(path, mmap_mode="r", allow_pickle=False)
    except Exception as error:  # a damaged header leads to EOFError, tokenize.TokenError and others
        raise FileError(path, f"cannot be read: {why(error)}") from error
    if not isinstance(table, np.ndarray):
        table.close()
        raise FileError(path, "is no .npy file but an .npz: several arrays; save one of them with numpy.save")
    return table


def _read_text(path: str, columns: str) -> NDArray[np.float64]:
    """x, y and the value of each row."""

    def layout(fields: list[str]) -> Layout:
        known = recognised([field.lower() for field in fields])
        if known and len(known) < 3 and not columns:
            raise UsageError(
                f"{path} has no column of heights: name three with --columns; it has: {', '.join(fields).lower()}"
            )
        by_name = any(not word.strip().isdecimal() for word in columns.split(",")) if columns else False
        has_header = has_names(fields) or by_name
        if not columns:
            if known is None and has_header:
                check_guess(fields)
            return Layout(known or [0, 1, 2], has_header)
        return Layout(_choose(path, columns, fields if has_header else [], len(fields)), has_header)

    try:
        return read_table(path, layout)
    except TableError as error:
        raise FileError(path, str(error)) from error


def _choose(path: str, columns: str, names: list[str], width: int) -> list[int]:
    asked = [word.strip() for word in columns.split(",")]
    if len(asked) != 3:
        raise UsageError(f"--columns {columns}: three columns are needed: x,y,value")
    lower = [name.lower() for name in names]
    chosen = []
    for word in asked:
        if word.isdecimal() and 1 <= int(word) <= width:
            chosen.append(int(word) - 1)
        elif not word.isdecimal() and word.lower() in lower:
            chosen.append(lower.index(word.lower()))
        else:
            has = ", ".join(names) if names else f"{width} columns without names"
            raise UsageError(f"--columns {columns}: {path} has no column {word}; it has: {has}")
    return chosen
