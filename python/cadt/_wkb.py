# SPDX-License-Identifier: Apache-2.0
"""Polygons and lines in well-known binary (OGC 06-103r4, and PostGIS's variant with flags), without a library for it."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np

from cadt._errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

LINE, POLYGON, MULTILINE, MULTIPOLYGON = 2, 3, 5, 6
_PARTS = {MULTILINE: LINE, MULTIPOLYGON: POLYGON}


class _Reader:
    """The lines and rings of a geometry, as x, y and z, which is NaN where there is none."""

    def __init__(self, data: bytes, index: int) -> None:
        self.data, self.index, self.at = data, index, 0
        self.lines: list[np.ndarray] = []

    def fail(self, why: str) -> InputError:
        return InputError(f"geometry {self.index} cannot be read as WKB: {why} at byte {self.at}", self.index)

    def take(self, form: str) -> int:
        size = struct.calcsize(form)
        if self.at + size > len(self.data):
            raise self.fail("it ends")
        (value,) = struct.unpack_from(form, self.data, self.at)
        self.at += size
        return value

    def read(self, kinds: tuple[int, ...]) -> None:
        order = self.take("B")
        if order > 1:
            raise self.fail(f"a byte order of {order}")
        end = "<" if order == 1 else ">"
        word = self.take(end + "I")
        kind, flags = word & 0x0FFFFFFF, word >> 28
        has_z = kind // 1000 in (1, 3) or bool(flags & 8)
        columns = 2 + has_z + (kind // 1000 in (2, 3) or bool(flags & 4))
        if flags & 2:
            self.take(end + "I")  # the reference system
        if kind % 1000 not in kinds or kind >= 4000:
            raise self.fail(f"a geometry of type {kind}")
        kind %= 1000
        for _ in range(1 if kind == LINE else self.take(end + "I")):
            if kind in _PARTS:
                self.read((_PARTS[kind],))
                continue
            n = self.take(end + "I")
            if self.at + 8 * columns * n > len(self.data):
                raise self.fail("it ends")
            line = np.full((n, 3), np.nan)
            given = np.frombuffer(self.data, end + "f8", columns * n, self.at).reshape(n, columns)
            line[:, : 2 + has_z] = given[:, : 2 + has_z]
            self.lines.append(line)
            self.at += 8 * columns * n


def lines_of_wkb(
    geometries: Sequence[bytes], kinds: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y and z of all lines and rings, their offsets, and the offsets in these of the geometries.

    Raises InputError with the index of a geometry of another type, or that is damaged.
    """
    lines: list[np.ndarray] = []
    counts = []
    for index, data in enumerate(geometries):
        reader = _Reader(bytes(data), index)
        reader.read(kinds)
        if any(reader.data[reader.at :]):  # zeros may fill up a row
            raise reader.fail("there is more")
        lines += reader.lines
        counts.append(len(reader.lines))
    points = np.concatenate(lines) if lines else np.empty((0, 3))
    return points, offsets_of([len(line) for line in lines]), offsets_of(counts)


def offsets_of(counts: Sequence[int] | np.ndarray) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(np.asarray(counts, dtype=np.int64))]).astype(np.int64)
