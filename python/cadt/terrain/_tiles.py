# SPDX-License-Identifier: Apache-2.0
"""The raster of all points, tile by tile: little memory, and each tile's work stays in a core's cache.

A tile is filled from the triangulation of the points of its buckets, a ring of buckets around them, and the convex hull of
all points. A triangle of it is one of the triangulation of all points if its circumscribed circle holds none of the points
that were left out. That is certain when the disc lies within the buckets that were taken; cells in the discs of other
triangles are done again with the points of the buckets that these discs reach, until none is left. So the raster is that
of the one triangulation of all points, whatever the tiles are.
"""

from __future__ import annotations

import concurrent.futures
import dataclasses
import math
import os
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

import cadt

from ._buckets import Buckets, Floats, Mask
from ._mesh import rasterize
from .grid import Grid

PER_TILE = 300_000  # points: the mesh and its queries fit in the caches of one core
MOST_CELLS = 1 << 21  # of a tile
EPS = float(np.finfo(float).eps)


def cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@dataclasses.dataclass(frozen=True)
class _Rect:
    """Cells of rows r0 to r1 and columns c0 to c1."""

    r0: int
    r1: int
    c0: int
    c1: int


class TiledRaster:
    """Linear interpolation at the centres of a grid's cells, in rows from the top."""

    def __init__(
        self,
        points: Buckets,
        grid: Grid,
        *,
        max_edge: float | None = None,
        fill: bool = False,
        threads: int = 0,
        per_tile: int = PER_TILE,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        self.points, self.grid, self.max_edge, self.fill = points, grid, max_edge, fill
        self.per_tile, self.progress = per_tile, progress
        self.threads = threads or cores()
        self.again = 0  # cells that a tile alone did not settle
        # Where the tie between two triangles at a cell's centre shows, it is decided as everywhere.
        self.order = "fast" if max_edge is None else "canonical"

    def rows(self) -> Iterator[Floats]:
        side = (
            math.sqrt(self.per_tile / max(len(self.points.z), 1) * self.points.nx * self.points.ny) * self.points.side
        )
        high = int(min(max(side / self.grid.dy, 1), self.grid.rows, max(MOST_CELLS / self.grid.columns, 512)))
        with concurrent.futures.ThreadPoolExecutor(self.threads) as pool:
            for first in range(0, self.grid.rows, high):
                last = min(first + high, self.grid.rows)
                cells = np.full((last - first, self.grid.columns), np.nan)
                unsure = np.zeros(cells.shape, bool)
                tiles = list(self._split(_Rect(first, last, 0, self.grid.columns)))
                work = [pool.submit(self._tile, tile, cells, unsure, first) for tile in tiles]
                try:
                    for done, job in enumerate(concurrent.futures.as_completed(work)):
                        job.result()
                        if self.progress is not None:
                            self.progress((first + (last - first) * (done + 1) / len(work)) / self.grid.rows)
                except BaseException:
                    for job in work:
                        job.cancel()
                    raise
                self._settle(cells, unsure, first)
                if self.fill:
                    self._fill(cells, first)
                yield cells

    def _centers(self, row: NDArray[np.int64], column: NDArray[np.int64]) -> Floats:
        grid = self.grid
        return np.column_stack((grid.x0 + (column + 0.5) * grid.dx, grid.y1 - (row + 0.5) * grid.dy))

    def _buckets_of(self, tile: _Rect) -> tuple[int, int, int, int]:
        """The buckets that the cells' centres of a tile lie in, and a ring."""
        corner = self._centers(np.array([tile.r1 - 1, tile.r0]), np.array([tile.c0, tile.c1 - 1]))
        column, row = self.points.place(corner)
        nx, ny = self.points.nx, self.points.ny
        return (
            max(int(column[0]) - 1, 0),
            max(int(row[0]) - 1, 0),
            min(int(column[1]) + 2, nx),
            min(int(row[1]) + 2, ny),
        )

    def _split(self, tile: _Rect) -> Iterator[_Rect]:
        rows, columns = tile.r1 - tile.r0, tile.c1 - tile.c0
        small = self.points.count(*self._buckets_of(tile)) <= 2 * self.per_tile and rows * columns <= MOST_CELLS
        if small or rows * columns == 1:
            yield tile
        elif columns * self.grid.dx >= rows * self.grid.dy and columns > 1 or rows == 1:
            half = tile.c0 + columns // 2
            yield from self._split(_Rect(tile.r0, tile.r1, tile.c0, half))
            yield from self._split(_Rect(tile.r0, tile.r1, half, tile.c1))
        else:
            half = tile.r0 + rows // 2
            yield from self._split(_Rect(tile.r0, half, tile.c0, tile.c1))
            yield from self._split(_Rect(half, tile.r1, tile.c0, tile.c1))

    def _mesh(self, xy: Floats, order: str, threads: int) -> cadt.Delaunay:
        return cadt.Delaunay(xy, backend="host", threads=threads, statistics="none", order=order)

    def _tile(self, tile: _Rect, cells: Floats, unsure: Mask, first: int) -> None:
        """Fills the cells of a tile, and marks those that points left out may concern."""
        points, grid = self.points, self.grid
        x0, y0, x1, y1 = self._buckets_of(tile)
        xy, z = points.of_rectangle(x0, y0, x1, y1)
        mesh = self._mesh(xy, self.order, 1)
        place = np.s_[tile.r0 - first : tile.r1 - first, tile.c0 : tile.c1]
        left, right = grid.x0 + tile.c0 * grid.dx, grid.x0 + tile.c1 * grid.dx
        bottom, top = grid.y1 - tile.r1 * grid.dy, grid.y1 - tile.r0 * grid.dy
        part = Grid(left, top, grid.dx, grid.dy, tile.c1 - tile.c0, tile.r1 - tile.r0)
        cells[place] = rasterize(mesh, z, part, max_edge=self.max_edge)
        # The disc of a triangle that reaches cells as well as points that were left out is at least as large as half of
        # what lies between them.
        taken = (
            -math.inf if x0 == 0 else points.x0 + x0 * points.side + points.slack,
            -math.inf if y0 == 0 else points.y0 + y0 * points.side + points.slack,
            math.inf if x1 == points.nx else points.x0 + x1 * points.side - points.slack,
            math.inf if y1 == points.ny else points.y0 + y1 * points.side - points.slack,
        )
        dx, dy = grid.dx / 2, grid.dy / 2  # only the centres of cells count
        gap = min(left + dx - taken[0], bottom + dy - taken[1], taken[2] - right + dx, taken[3] - top + dy) / 2
        center = np.asarray(mesh.circumcenters())
        corners = np.asarray(mesh.simplices)
        off = (center.view(np.complex128) - xy.view(np.complex128)[corners[:, 0]])[:, 0]
        square = np.square(off.real) + np.square(off.imag)
        large = np.flatnonzero(~(square < (0.99 * gap) ** 2)) if gap > 0 else np.arange(len(corners))
        c, r = discs(xy, corners[large])
        with np.errstate(invalid="ignore"):
            within = (
                (c[:, 0] - r >= taken[0])
                & (c[:, 1] - r >= taken[1])
                & (c[:, 0] + r <= taken[2])
                & (c[:, 1] + r <= taken[3])
            )
        self._mark(unsure[place], tile, xy[corners[large[~within]]], c[~within], r[~within])

    def _mark(self, unsure: Mask, tile: _Rect, corner: Floats, center: Floats, radius: Floats) -> None:
        """Marks the cells whose centres are in the discs and in the boxes of their triangles."""
        grid = self.grid
        low, high = corner.min(axis=1), corner.max(axis=1)
        finite = np.isfinite(center).all(axis=1) & np.isfinite(radius)
        center, radius = np.where(finite[:, None], center, 0.0), np.where(finite, radius, math.inf)
        low, high = np.maximum(low, center - radius[:, None]), np.minimum(high, center + radius[:, None])
        # A cell more on each side, so that no rounding counts.
        c0 = np.clip(np.floor((low[:, 0] - grid.x0) / grid.dx - 1), tile.c0, tile.c1).astype(np.int64)
        c1 = np.clip(np.ceil((high[:, 0] - grid.x0) / grid.dx + 1), tile.c0, tile.c1).astype(np.int64)
        r0 = np.clip(np.floor((grid.y1 - high[:, 1]) / grid.dy - 1), tile.r0, tile.r1).astype(np.int64)
        r1 = np.clip(np.ceil((grid.y1 - low[:, 1]) / grid.dy + 1), tile.r0, tile.r1).astype(np.int64)
        count = np.where((c0 < c1) & (r0 < r1), r1 - r0, 0)
        k = np.repeat(np.arange(len(count)), count)
        if len(k) == 0:
            return
        row = np.arange(len(k)) - np.repeat(np.cumsum(count) - count, count) + r0[k]
        away = np.maximum(np.abs(grid.y1 - (row + 0.5) * grid.dy - center[k, 1]) - grid.dy, 0)
        with np.errstate(invalid="ignore"):
            half = np.sqrt(np.square(radius[k]) - np.square(away))
        reached = ~np.isnan(half)
        k, row, half = k[reached], row[reached], half[reached]
        a = np.floor((center[k, 0] - half - grid.x0) / grid.dx - 1)
        b = np.ceil((center[k, 0] + half - grid.x0) / grid.dx + 1)
        a = np.clip(a, c0[k], c1[k]).astype(np.int64) - tile.c0
        b = np.clip(b, c0[k], c1[k]).astype(np.int64) - tile.c0
        change = np.zeros((tile.r1 - tile.r0, tile.c1 - tile.c0 + 1), np.int32)
        np.add.at(change, (row - tile.r0, a), 1)
        np.add.at(change, (row - tile.r0, b), -1)
        unsure |= change.cumsum(axis=1)[:, :-1] > 0

    def _settle(self, cells: Floats, unsure: Mask, first: int) -> None:
        """Does the marked cells again, with more and more points."""
        points = self.points
        row, column = np.nonzero(unsure)
        if len(row) == 0:
            return
        self.again += len(row)
        where = self._centers(row + first, column)
        known = np.zeros_like(points.filled)
        for right in range(-2, 3):
            for up in range(-2, 3):
                known[tuple(reversed(points.place(where + [right * points.side, up * points.side])))] = True
        known &= points.filled
        while len(row):
            chosen = points.of_buckets(known)
            xy = points.xy[chosen]
            mesh = self._mesh(xy, "canonical", self.threads)
            triangle = np.asarray(mesh.find_simplex(where))
            value = np.asarray(mesh.interpolate(points.z[chosen], where))
            if self.max_edge is not None:
                kept = np.zeros(mesh.n_triangles + 1, bool)
                kept[mesh.alpha_shape(math.inf, max_edge=self.max_edge)[0]] = True
                value[~kept[triangle]] = np.nan  # outside, -1 is the last
            # The hull is that of all points: what is outside of it is done.
            done = triangle < 0
            found, which = np.unique(triangle[~done], return_inverse=True)
            count, reached = points.reached(*discs(xy, np.asarray(mesh.simplices)[found]), points.filled & ~known)
            done[~done] = count[which] == 0
            cells[row[done], column[done]] = value[done]
            row, column, where = row[~done], column[~done], where[~done]
            known |= reached

    def _fill(self, cells: Floats, first: int) -> None:
        """The nearest point's value where there is none. It is no farther than the nearest point of the sketch."""
        points = self.points
        row, column = np.nonzero(np.isnan(cells))
        for i in range(0, len(row), 1 << 18):
            r, c = row[i : i + (1 << 18)], column[i : i + (1 << 18)]
            where = self._centers(r + first, c)
            near = points.xy[points.first_of_each[points.sketch.nearest_vertex(where)]]
            distance = np.hypot(*(where - near).T) * (1 + 8 * EPS)
            chosen = points.of_buckets(points.reached(where, distance, points.filled)[1])
            mesh = self._mesh(points.xy[chosen], "canonical", self.threads)
            cells[r, c] = points.z[chosen[mesh.nearest_vertex(where)]]


def discs(xy: Floats, corners: NDArray[np.int32]) -> tuple[Floats, Floats]:
    """Discs that contain the circumscribed ones of triangles: the radius has a bound of all rounding errors on top. It is
    infinite where nothing is left of the determinant."""
    a = xy[corners[:, 0]]
    b, c = xy[corners[:, 1]] - a, xy[corners[:, 2]] - a
    bb, cc = np.einsum("ij,ij->i", b, b), np.einsum("ij,ij->i", c, c)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        cross = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
        ux = (c[:, 1] * bb - b[:, 1] * cc) / (2 * cross)
        uy = (b[:, 0] * cc - c[:, 0] * bb) / (2 * cross)
        radius = np.hypot(ux, uy)
        # Differences are exact or have one rounding. Relative to |b||c|, the determinant is good to a few of them, and so
        # is the place of the centre relative to the radius.
        loss = 32 * EPS * np.sqrt(bb * cc) / np.abs(cross)
        error = radius * (loss + 16 * EPS) + 4 * np.abs(a).max(axis=1, initial=0.0) * EPS
        radius = np.where(loss < 0.01, radius + 2 * error, np.inf)
    return a + np.column_stack((ux, uy)), radius
