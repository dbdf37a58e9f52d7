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
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

import cadt

from ._buckets import SAFE, Buckets, Floats, Mask, cores
from ._mesh import rasterize
from .grid import Grid

PER_TILE = 150_000  # points: the mesh and its queries fit in the caches of one core
MOST_CELLS = 1 << 21  # of a tile
EPS = float(np.finfo(float).eps)


@dataclasses.dataclass(frozen=True)
class _Rect:
    """Cells of rows r0 to r1 and columns c0 to c1."""

    r0: int
    r1: int
    c0: int
    c1: int


@dataclasses.dataclass
class _Strip:
    """Rows of cells from `first` on, and the jobs that fill them."""

    first: int
    cells: Floats
    unsure: Mask = dataclasses.field(init=False)  # cells that a tile alone does not settle
    work: list[concurrent.futures.Future[None]] = dataclasses.field(default_factory=list)

    def __post_init__(self) -> None:
        self.unsure = np.zeros(self.cells.shape, bool)


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
        with concurrent.futures.ThreadPoolExecutor(self.threads) as pool:
            ahead: _Strip | None = None  # so that all threads have work while a strip ends
            try:
                for strip in self._strips(pool):
                    if ahead is not None:
                        yield self._finished(ahead)
                    ahead = strip
                if ahead is not None:
                    yield self._finished(ahead)
            finally:
                pool.shutdown(cancel_futures=True)

    def _strips(self, pool: concurrent.futures.Executor) -> Iterator[_Strip]:
        grid, points = self.grid, self.points
        side = math.sqrt(self.per_tile / max(len(points.z), 1) * points.nx * points.ny) * points.side
        high = int(min(max(side / grid.dy, 1), grid.rows, max(MOST_CELLS / grid.columns, 512)))
        first = 0
        while first < grid.rows:
            last = min(first + high, grid.rows)
            if last < grid.rows:
                last = self._near_border(last, first, grid.rows, (grid.y1 - points.y0) / grid.dy, points.side / grid.dy)
            strip = _Strip(first, np.full((last - first, grid.columns), np.nan))
            for tile in self._split(_Rect(first, last, 0, grid.columns)):
                strip.work.append(pool.submit(self._tile, tile, strip))
            yield strip
            first = last

    def _finished(self, strip: _Strip) -> Floats:
        rows = self.grid.rows
        for done, job in enumerate(concurrent.futures.as_completed(strip.work)):
            job.result()
            if self.progress is not None:
                self.progress((strip.first + len(strip.cells) * (done + 1) / len(strip.work)) / rows)
        self._settle(strip)
        if self.fill:
            self._fill(strip.cells, strip.first)
        return strip.cells

    @staticmethod
    def _near_border(cell: int, first: int, last: int, origin: float, side: float) -> int:
        """Where cells from `first` to `last` are cut near `cell`: if there is one, at a border of buckets, so that both
        sides need fewer of them. Borders are `side` cells apart; one is at `origin`."""
        border = math.ceil(origin + round((cell - origin) / side) * side - 0.5)
        return border if first < border < last and 2 * abs(border - cell) < cell - first else cell

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
        grid, points = self.grid, self.points
        rows, columns = tile.r1 - tile.r0, tile.c1 - tile.c0
        small = self.points.count(*self._buckets_of(tile)) <= 2 * self.per_tile and rows * columns <= MOST_CELLS
        if small or rows * columns == 1:
            yield tile
        elif columns * grid.dx >= rows * grid.dy and columns > 1 or rows == 1:
            half = tile.c0 + columns // 2
            half = self._near_border(half, tile.c0, tile.c1, (points.x0 - grid.x0) / grid.dx, points.side / grid.dx)
            yield from self._split(_Rect(tile.r0, tile.r1, tile.c0, half))
            yield from self._split(_Rect(tile.r0, tile.r1, half, tile.c1))
        else:
            half = tile.r0 + rows // 2
            half = self._near_border(half, tile.r0, tile.r1, (grid.y1 - points.y0) / grid.dy, points.side / grid.dy)
            yield from self._split(_Rect(tile.r0, half, tile.c0, tile.c1))
            yield from self._split(_Rect(half, tile.r1, tile.c0, tile.c1))

    def _mesh(self, xy: Floats, order: str, threads: int) -> cadt.Delaunay:
        return cadt.Delaunay(xy, backend="host", threads=threads, statistics="none", order=order)

    def _tile(self, tile: _Rect, strip: _Strip) -> None:
        """Fills the cells of a tile, and marks those that points left out may concern."""
        points, grid = self.points, self.grid
        x0, y0, x1, y1 = self._buckets_of(tile)
        xy, z = points.of_rectangle(x0, y0, x1, y1)
        mesh = self._mesh(xy, self.order, 1)
        place = np.s_[tile.r0 - strip.first : tile.r1 - strip.first, tile.c0 : tile.c1]
        part = grid.part(tile.r0, tile.c0, tile.r1 - tile.r0, tile.c1 - tile.c0)
        strip.cells[place] = rasterize(mesh, z, part, max_edge=self.max_edge)
        taken = (
            -math.inf if x0 == 0 else points.x0 + x0 * points.side + points.slack,
            -math.inf if y0 == 0 else points.y0 + y0 * points.side + points.slack,
            math.inf if x1 == points.nx else points.x0 + x1 * points.side - points.slack,
            math.inf if y1 == points.ny else points.y0 + y1 * points.side - points.slack,
        )
        # The triangles whose discs hold a point are connected, and the one that it lies in is among them; of a point that
        # was left out, this one has a corner beyond what was taken.
        corners, neighbors = np.asarray(mesh.simplices), np.asarray(mesh.neighbors)
        x, y = xy[:, 0], xy[:, 1]
        beyond = (x < taken[0]) | (y < taken[1]) | (x > taken[2]) | (y > taken[3])
        front = np.unique(np.flatnonzero(beyond[corners.ravel()]) // 3)
        seen = np.zeros(len(corners) + 1, bool)
        seen[-1] = True  # -1: no neighbour
        while len(front):
            seen[front] = True
            center, radius = discs(xy, corners[front])
            reaches = self._reach(center, radius, taken)
            self._mark(strip.unsure[place], tile, xy[corners[front[reaches]]], center[reaches], radius[reaches])
            front = np.unique(neighbors[front[reaches]])
            front = front[~seen[front]]

    def _reach(self, center: Floats, radius: Floats, taken: tuple[float, float, float, float]) -> Mask:
        """Which discs reach beyond what was taken, within the box of all points."""
        points = self.points
        x, y = center.T
        with np.errstate(invalid="ignore"):
            far_x = np.maximum(np.maximum(points.x0 - x, x - points.x1), 0)
            far_y = np.maximum(np.maximum(points.y0 - y, y - points.y1), 0)
            # Half of what the box leaves of a disc: the radius is large enough for the rounding here, too.
            half_x = np.sqrt((radius - far_y) * (radius + far_y)) * (1 + 4 * EPS)
            half_y = np.sqrt((radius - far_x) * (radius + far_x)) * (1 + 4 * EPS)
            within = (x - half_x >= taken[0]) & (y - half_y >= taken[1])
            within &= (x + half_x <= taken[2]) & (y + half_y <= taken[3])
        return ~within

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

    def _settle(self, strip: _Strip) -> None:
        """Does the marked cells again, with more and more points."""
        points, cells, first = self.points, strip.cells, strip.first
        row, column = np.nonzero(strip.unsure)
        if len(row) == 0:
            return
        self.again += len(row)
        where = self._centers(row + first, column)
        known = np.zeros_like(points.filled)
        for right in (-1, 0, 1):
            for up in (-1, 0, 1):
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
            near = points.sketch_points[points.sketch.nearest_vertex(where)]
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
        # is the place of the centre relative to the radius. That holds while products of three lengths neither overflow nor
        # are subnormal.
        loss = 32 * EPS * np.sqrt(bb * cc) / np.abs(cross)
        error = radius * (loss + 16 * EPS) + 4 * np.abs(a).max(axis=1, initial=0.0) * EPS
        sound = (loss < 0.01) & (np.minimum(bb, cc) > SAFE[0] ** 2) & (np.maximum(bb, cc) < SAFE[1] ** 2)
        radius = np.where(sound, radius + 2 * error, np.inf)
    return a + np.column_stack((ux, uy)), radius
