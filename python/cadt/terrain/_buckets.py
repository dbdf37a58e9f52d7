# SPDX-License-Identifier: Apache-2.0
"""Points sorted into square buckets: those of any region are slices, and which discs reach beyond a region is counted."""

from __future__ import annotations

import concurrent.futures
import itertools
import math
import os

import numpy as np
from numpy.typing import NDArray

import cadt
from cadt import _cadt

from .cloud import Cloud

PER_BUCKET = 40  # points on average: a ring of buckets around a tile of 150,000 points is a fifteenth of it
MOST_BUCKETS = 1 << 18
MOST_OF_SKETCH = 50_000
PIECE = 1 << 20  # points sorted at a time: they fit in a cache, and several threads have work
MOST_PIECES = 32
SAFE = (1e-90, 1e90)  # lengths whose products are no subnormal numbers and do not overflow
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


def cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Squares:
    """The buckets of so many points in a box."""

    def __init__(self, bounds: tuple[float, float, float, float], n: int, per_bucket: int = PER_BUCKET) -> None:
        self.x0, self.y0, self.x1, self.y1 = bounds
        width, height = max(self.x1 - self.x0, 1e-300), max(self.y1 - self.y0, 1e-300)
        count = min(max(n // per_bucket, 1), MOST_BUCKETS)
        self.side = max(math.sqrt(width * height / count), width / 4000, height / 4000)
        self.nx, self.ny = (max(1, math.ceil(length / self.side)) for length in (width, height))
        while self.nx * self.ny > MOST_BUCKETS:
            self.side *= 1.1
            self.nx, self.ny = (max(1, math.ceil(length / self.side)) for length in (width, height))
        # A bucket's points lie in its square but for the rounding of the division.
        self.slack = 1e-9 * self.side + 8 * float(np.spacing(max(map(abs, bounds))))

    def place(self, xy: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Column and row of each point's bucket; the nearest one for those outside."""
        column = np.clip((xy[:, 0] - self.x0) / self.side, 0, self.nx - 1).astype(np.int64)
        row = np.clip((xy[:, 1] - self.y0) / self.side, 0, self.ny - 1).astype(np.int64)
        return column, row

    def sort(self, xy: Floats, z: Floats) -> NDArray[np.int32]:
        """Brings points and their values to the order of the buckets, row by row, in place; within a bucket they stay as
        they were. Where each bucket begins, and the end of the last one."""
        return _cadt.sort_by_square(xy, z, self.x0, self.y0, self.side, self.nx, self.ny)


class Buckets(Squares):
    """A cloud in pieces, each in the order of the buckets, row by row from the lower left; within a bucket of a piece the
    order is as before. The cloud's own arrays are sorted, so that the points are there once."""

    def __init__(self, cloud: Cloud, per_bucket: int = PER_BUCKET, piece: int = PIECE, threads: int = 0) -> None:
        n = len(cloud)
        super().__init__(cloud.bounds, n, per_bucket)
        self.xy, self.z = np.ascontiguousarray(cloud.xy), cloud.z
        size = max(piece, -(-n // MOST_PIECES))
        # Where bucket k of piece i begins, and where it ends: begin[i, k] and begin[i, k + 1].
        self.begin = np.empty((-(-n // size), self.nx * self.ny + 1), np.int32)
        with concurrent.futures.ThreadPoolExecutor(threads or cores()) as pool:
            list(pool.map(self._sort, range(0, n, size), itertools.repeat(size), self.begin))
        counts = np.diff(self.begin)
        in_bucket = counts.sum(axis=0)
        self._most = int(in_bucket.max())
        self.filled: Mask = (in_bucket > 0).reshape(self.ny, self.nx)
        # Points in the buckets left of and below a corner.
        self._sums = np.zeros((self.ny + 1, self.nx + 1), np.int64)
        self._sums[1:, 1:] = in_bucket.reshape(self.ny, self.nx).cumsum(axis=0).cumsum(axis=1)

        full = np.flatnonzero(in_bucket)
        full = full[:: -(-len(full) // MOST_OF_SKETCH)]
        self.sketch_points = self.xy[self.begin[(counts[:, full] > 0).argmax(axis=0), full]]
        self.sketch = cadt.Delaunay(self.sketch_points, backend="host", statistics="none")
        self.hull = self._hull()

    def _sort(self, first: int, size: int, begin: NDArray[np.int32]) -> None:
        begin[:] = self.sort(self.xy[first : first + size], self.z[first : first + size])
        begin += first

    @property
    def useful(self) -> bool:
        """Whether tiles are smaller than the whole: not if nearly all points lie in a few buckets, as with an outlier. Nor
        are they made of the smallest and largest numbers."""
        if not SAFE[0] < max(self.x1 - self.x0, self.y1 - self.y0) < SAFE[1]:
            return False
        return self.sketch.n_triangles > 0 and 16 * self._most < len(self.z)

    def _hull(self) -> NDArray[np.int64]:
        """The vertices of the convex hull of all points. A bucket deep in the hull of the sketch has none."""
        inside: Mask = np.zeros((self.ny + 1, self.nx + 1), bool)
        if self.sketch.n_triangles:
            x, y = self.x0 + np.arange(self.nx + 1) * self.side, self.y0 + np.arange(self.ny + 1) * self.side
            corners = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
            inside = np.asarray(self.sketch.within_hull(corners), bool).reshape(inside.shape)
        # With a ring of buckets around it, so that rounding is harmless.
        deep = np.zeros_like(self.filled)
        deep[1:-1, 1:-1] = inside[:-3, :-3] & inside[:-3, 3:] & inside[3:, :-3] & inside[3:, 3:]
        candidates = self.of_mask(self.filled & ~deep)
        mesh = cadt.Delaunay(self.xy[candidates], backend="host", statistics="none")
        return np.unique(candidates[np.asarray(mesh.hull)]) if mesh.n_triangles else np.empty(0, np.int64)

    def count(self, x0: int, y0: int, x1: int, y1: int) -> int:
        """Points in the buckets x0 <= column < x1, y0 <= row < y1."""
        s = self._sums
        return int(s[y1, x1] - s[y0, x1] - s[y1, x0] + s[y0, x0])

    def of_rectangle(self, x0: int, y0: int, x1: int, y1: int) -> tuple[Floats, Floats]:
        """Coordinates and values of the points in a rectangle of buckets, and of the hull's vertices, in their order."""
        rows = np.arange(y0, y1) * self.nx
        ends = np.column_stack((self.begin[:, rows + x0].ravel(), self.begin[:, rows + x1].ravel()))
        run = np.searchsorted(ends[:, 0], self.hull, side="right") - 1
        others = self.hull[(run < 0) | (self.hull >= ends[run, 1])]
        ends = np.concatenate((ends, np.column_stack((others, others + 1))))
        ends = ends[ends[:, 0] < ends[:, 1]]
        ends = ends[np.argsort(ends[:, 0])].tolist()
        return np.concatenate([self.xy[a:b] for a, b in ends]), np.concatenate([self.z[a:b] for a, b in ends])

    def of_buckets(self, mask: Mask) -> NDArray[np.int64]:
        """The points in the buckets of a mask, and the hull's vertices, ascending."""
        return np.union1d(self.of_mask(mask), self.hull)

    def of_mask(self, mask: Mask) -> NDArray[np.int64]:
        """The points in the buckets of a mask, ascending."""
        numbers = np.flatnonzero(mask)
        first = self.begin[:, numbers].ravel()
        length = self.begin[:, numbers + 1].ravel() - first
        offset = np.repeat(first - (length.cumsum() - length), length)
        return np.arange(len(offset)) + offset

    def reached(self, center: Floats, radius: Floats, of: Mask) -> tuple[NDArray[np.int64], Mask]:
        """How many buckets of the mask `of` each disc reaches, and which buckets are reached at all."""
        radius = np.where(np.isfinite(radius), radius, np.inf) + self.slack
        edge = self.y0 + np.arange(self.ny + 1) * self.side
        sums = np.zeros((self.ny, self.nx + 1), np.int64)
        sums[:, 1:] = of.cumsum(axis=1)
        counts = np.zeros(len(radius), np.int64)
        change = np.zeros((self.ny, self.nx + 1), np.int64)
        for i in range(0, len(radius), 1024):
            c, r = center[i : i + 1024], radius[i : i + 1024]
            below, above = edge[None, :-1] - c[:, 1:], c[:, 1:] - edge[None, 1:]
            near = np.maximum(np.maximum(below, above), 0)
            with np.errstate(invalid="ignore", over="ignore"):
                half = np.sqrt(r[:, None] ** 2 - near**2)
                left, right = (c[:, :1] - half - self.x0) / self.side, (c[:, :1] + half - self.x0) / self.side
            whole = ~np.isfinite(c).all(axis=1) | np.isinf(r)
            half[whole], left[whole], right[whole] = 0, 0, self.nx
            touched = ~np.isnan(half) & (right >= 0) & (left < self.nx)
            k, row = np.nonzero(touched)
            a = np.clip(np.floor(left[k, row]), 0, self.nx - 1).astype(np.int64)
            b = np.clip(np.floor(right[k, row]), 0, self.nx - 1).astype(np.int64) + 1
            counts[i : i + 1024] = np.bincount(k, sums[row, b] - sums[row, a], minlength=len(r)).astype(np.int64)
            np.add.at(change, (row, a), 1)
            np.add.at(change, (row, b), -1)
        return counts, of & (change.cumsum(axis=1)[:, :-1] > 0)
