# SPDX-License-Identifier: Apache-2.0
"""The cells of a grid in a file, in square blocks."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ._buckets import Floats
from ._store import ArrayFile
from .cog import BLOCK
from .grid import Grid

LEAST_SIDE, MOST_SIDE = 64, 2048  # cells


def side_for(cells: float) -> int:
    """Of blocks for regions of so many cells: as large as a region, which then meets four. Each costs a pass over the
    triangles of the region, and each of its cells much less than that of a triangle."""
    side = 1 << round(math.log2(max(math.sqrt(cells), 1)))
    return min(max(side, LEAST_SIDE), MOST_SIDE)


@dataclasses.dataclass(frozen=True)
class Block:
    """Cells of a grid, as a part of it."""

    number: int
    grid: Grid


class Blocks:
    """All cells; NaN until they are written."""

    def __init__(self, grid: Grid, side: int, path: str, dtype: str) -> None:
        self.grid, self.side = grid, side
        self.nx, self.ny = -(-grid.columns // side), -(-grid.rows // side)
        self._type = np.dtype(dtype)
        self._file = ArrayFile(path, np.dtype((self._type, (side, side))))
        self._written = np.zeros(self.nx * self.ny, bool)

    @property
    def bytes(self) -> int:
        """Of the file when all blocks are written."""
        return self.nx * self.ny * self._file.dtype.itemsize

    def block(self, number: int) -> Block:
        grid, side = self.grid, self.side
        row, column = number // self.nx * side, number % self.nx * side
        return Block(number, grid.part(row, column, min(side, grid.rows - row), min(side, grid.columns - column)))

    def read(self, block: Block) -> Floats:
        return self._whole(block.number)[: block.grid.rows, : block.grid.columns]

    def write(self, block: Block, cells: Floats, where: NDArray[np.bool_]) -> None:
        """Some of a block's cells."""
        whole = self._whole(block.number)
        whole[: block.grid.rows, : block.grid.columns][where] = cells[where]
        self._file.write(block.number, whole)
        self._written[block.number] = True

    def rows(self) -> Iterator[Floats]:
        """From the top, some at a time: whole tiles of the output. Removes the file in the end."""
        high = max(BLOCK, self.side)
        for first in range(0, self.grid.rows, high):
            cells = np.empty((min(high, self.grid.rows - first), self.grid.columns), self._type)
            for row in range(first // self.side, -(-(first + len(cells)) // self.side)):
                for column in range(self.nx):
                    block = self.block(row * self.nx + column)
                    part = block.grid
                    below, right = cells[part.first_row - first :], part.first_column + part.columns
                    below[: part.rows, part.first_column : right] = self.read(block)
            yield cells
        self._file.remove()

    def _whole(self, number: int) -> Floats:
        if self._written[number]:
            return self._file.read(number, 1)[0]
        return np.full((self.side, self.side), np.nan, self._type)
