# SPDX-License-Identifier: Apache-2.0
"""Points of files by range: LAS and LAZ through laspy, .npy without loading, tables of text as a whole, and as the program cadt reads them."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from cadt._errors import FileError, InputError
from cadt._points import to_float
from cadt._tables import TableError, plain_layout, read_table

LAS = (".las", ".laz")
TEXT = (".csv", ".xyz", ".xy", ".txt")
READ_FORMATS = (*LAS, ".npy", *TEXT)


@dataclass(frozen=True)
class File:
    """A file with `count` points. `box` is what its header promises (LAS), `step` the distance of its coordinates."""

    path: str
    count: int
    box: tuple[float, float, float, float] | None = None
    step: float = 0.0

    def differs_from(self, bounds: np.ndarray) -> bool:
        """Whether the header's box is not that of its points, by more than rounding."""
        if self.box is None:
            return False
        return not (np.abs(np.asarray(self.box) - bounds) <= self.step).all()  # NaN differs


def open_file(path: str | os.PathLike[str]) -> File:
    """Looks at a file; tables of text are read. Raises FileError."""
    name = os.fspath(path)
    suffix = pathlib.PurePath(name).suffix.lower()
    if suffix not in READ_FORMATS:
        raise FileError(f"{name}: points are read from files that end in one of: {', '.join(READ_FORMATS)}", name)
    if suffix in LAS:
        with _las(name) as reader:
            header = reader.header
            _require_room(name, header)
            box = (*header.mins[:2].tolist(), *header.maxs[:2].tolist())
            return File(name, int(header.point_count), box, float(max(header.scales[:2])))
    return File(name, len(_table(name)))


def read(file: File, first: int, count: int) -> np.ndarray:
    """Points first, ..., first + count - 1 of a file: (count, 2) float64, -0 as 0. Raises FileError."""
    suffix = pathlib.PurePath(file.path).suffix.lower()
    rows = _read_las(file.path, first, count) if suffix in LAS else _table(file.path)[first : first + count, :2]
    if len(rows) != count:
        raise FileError(
            f"{file.path}: {first + len(rows)} points of the {file.count} that are promised: the file is truncated, or has "
            "been changed meanwhile",
            file.path,
        )
    try:
        rows = to_float(rows, "points")
    except InputError as error:
        where = f"row {first + error.index} (counted from 0)"
        raise FileError(f"{file.path}: {where} has an integer beyond 2**53, which is no double", file.path) from error
    return np.add(rows, 0.0, dtype=np.float64, order="C")


def _las(path: str) -> Any:
    try:
        import laspy
    except ImportError as error:
        raise ImportError('reading LAS and LAZ needs laspy and lazrs: pip install "cadt[scale]"') from error
    try:
        return laspy.open(path, decompression_selection=laspy.DecompressionSelection.base())
    except Exception as error:  # whatever a damaged header leads to: numpy, struct, lazrs
        raise FileError(f"{path}: is no LAS or LAZ file: {error}", path) from error


# Compressed points of one place, with all else equal, take some thousandths of a byte each.
MOST_POINTS_A_BYTE = 4096


def _require_room(path: str, header: Any) -> None:
    """A damaged number of points would make tasks without end. Raises FileError."""
    size = os.path.getsize(path)
    if header.are_points_compressed:
        most = size * MOST_POINTS_A_BYTE
    else:
        most = max(0, size - header.offset_to_point_data) // header.point_format.size
    if header.point_count > most:
        raise FileError(
            f"{path}: is damaged or truncated: its header promises {header.point_count} points, and {size} bytes have "
            f"{most} at most",
            path,
        )


def _read_las(path: str, first: int, count: int) -> np.ndarray:
    try:
        with _las(path) as reader:
            header = reader.header
            if first:
                reader.seek(first)
            points = reader.read_points(count)
            rows = np.empty((len(points), 2))
            # A coordinate is a whole number of steps from an offset: one product and one sum, both rounded.
            for k, name in enumerate("XY"):
                np.multiply(np.asarray(points[name]), header.scales[k], out=rows[:, k])
                rows[:, k] += header.offsets[k]
            return rows
    except (FileError, ImportError, MemoryError):
        raise
    except Exception as error:
        raise FileError(f"{path}: is damaged at points {first} to {first + count}: {error}", path) from error


def _table(path: str) -> np.ndarray:
    """x and y of each row, and perhaps more columns."""
    try:
        if not path.lower().endswith(".npy"):
            return read_table(path, plain_layout)
        table = np.load(path, mmap_mode="r", allow_pickle=False)
    except TableError as error:
        raise FileError(f"{path}: {error}", path) from error
    except (OSError, ValueError, EOFError) as error:
        raise FileError(f"{path}: cannot be read: {error}", path) from error
    if table.ndim != 2 or table.shape[1] not in (2, 3) or table.dtype.kind not in "iuf" or table.dtype.itemsize > 8:
        raise FileError(
            f"{path}: must hold numbers of shape (n, 2) or (n, 3), not {table.dtype} of {table.shape}", path
        )
    if len(table) == 0:
        raise FileError(f"{path}: has no points", path)
    return table


@dataclass(frozen=True)
class Piece:
    """Points with input indices first, first + 1, ...: ranges of files one after another, as (file, first, count)."""

    first: int
    ranges: tuple[tuple[File, int, int], ...]

    def read(self) -> np.ndarray:
        if len(self.ranges) == 1:
            return read(*self.ranges[0])
        return np.concatenate([np.empty((0, 2)), *(read(*r) for r in self.ranges)])

    def place_of(self, row: int) -> tuple[str, int]:
        """File, and row in it."""
        for file, first, count in self.ranges:
            if row < count:
                return file.path, first + row
            row -= count
        raise IndexError(row)


def cut(files: list[File], points: int) -> list[Piece]:
    """All points of the files in pieces of `points`, the last one perhaps with fewer."""
    pieces: list[Piece] = []
    ranges: list[tuple[File, int, int]] = []
    begin, room = 0, points
    for file in files:
        first = 0
        while first < file.count:
            count = min(room, file.count - first)
            ranges.append((file, first, count))
            first, room = first + count, room - count
            if room == 0:
                pieces.append(Piece(begin, tuple(ranges)))
                begin, room, ranges = begin + points, points, []
    if ranges or not pieces:
        pieces.append(Piece(begin, tuple(ranges)))
    return pieces
