# SPDX-License-Identifier: Apache-2.0
"""Queries that rounding has put just outside of the convex hull."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import cadt

# How far outside, in lengths of the hull's edge: SciPy's tolerance.
_TOLERANCE = 100 * np.finfo(np.double).eps


class HullFinder:
    """The edge of the hull that a query outside of it faces, by the angle around a point inside."""

    def __init__(self, points: np.ndarray, mesh: cadt.Delaunay) -> None:
        hull = mesh.hull
        # By a power of two, so that products are neither too large nor too small.
        self.exponent = int(np.frexp(np.abs(points[hull]).max())[1])
        corners = np.ldexp(points[hull], -self.exponent)
        self.center = corners.mean(axis=0)
        angles = self._angle(corners)
        first = int(np.argmin(angles))
        self.edges = np.roll(np.stack([hull, np.roll(hull, -1)], axis=1), -first, axis=0)
        # The loop is counterclockwise: angles ascend but for rounding.
        self.angles = np.maximum.accumulate(np.roll(angles, -first))
        self.begin = np.roll(corners, -first, axis=0)
        self.along = np.roll(self.begin, -1, axis=0) - self.begin
        self.extent = float(np.ptp(corners, axis=0).max())
        self.square = np.einsum("ij,ij->i", self.along, self.along)
        # The triangle of each edge: the one that has it and nothing on the other side.
        triangles, opposite = np.nonzero(mesh.neighbors < 0)
        start = mesh.simplices[triangles, (opposite + 1) % 3]
        order = np.argsort(start)
        self.triangles = triangles[order[np.searchsorted(start, self.edges[:, 0], sorter=order)]].astype(np.int32)

    def _angle(self, x: np.ndarray) -> np.ndarray:
        return np.arctan2(x[:, 1] - self.center[1], x[:, 0] - self.center[0])

    def near(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of queries outside: which are within the tolerance, the number of their edge, and where along it (0 to 1)."""
        with np.errstate(all="ignore"):
            x = np.ldexp(x, -self.exponent)
            edges = np.searchsorted(self.angles, self._angle(x), side="right") - 1
            begin = self.begin[edges]
            # Most queries are far away. Within the tolerance of the edge beside is near this one's line too.
            cross = np.abs(
                (x[:, 0] - begin[:, 0]) * self.along[edges, 1] - (x[:, 1] - begin[:, 1]) * self.along[edges, 0]
            )
            close = np.flatnonzero(cross <= 1e-9 * self.extent * np.sqrt(self.square[edges]))
            x, edges = x[close], edges[close]
            best = np.full(len(x), -1, dtype=np.int64)
            where = np.zeros(len(x))
            # Rounding may have chosen the edge beside the one that is nearest.
            for step in (0, -1, 1):
                e = (edges + step) % len(self.angles)
                d, along = x - self.begin[e], self.along[e]
                away = np.abs(d[:, 0] * along[:, 1] - d[:, 1] * along[:, 0]) / self.square[e]
                t = (d * along).sum(axis=1) / self.square[e]
                hit = (best < 0) & (away <= _TOLERANCE) & (t >= -_TOLERANCE) & (t <= 1 + _TOLERANCE)
                best[hit], where[hit] = e[hit], t[hit]
        rows = np.flatnonzero(best >= 0)
        return close[rows], best[rows], where[rows].clip(0, 1)

    def outside(self, x: np.ndarray, found: np.ndarray) -> np.ndarray:
        out = np.flatnonzero(found < 0)
        return out[np.isfinite(x[out]).all(axis=1)]

    def find(self, x: np.ndarray, found: np.ndarray) -> None:
        """Fills in the triangles of queries that are within the tolerance."""
        out = self.outside(x, found)
        if out.size:
            rows, edges, _ = self.near(x[out].astype(np.double, copy=False))
            found[out[rows]] = self.triangles[edges]

    def interpolate(self, values: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which queries are within the tolerance, and the values there, between those of the edge's ends."""
        rows, edges, t = self.near(x)
        begin, end = values[self.edges[edges, 0]], values[self.edges[edges, 1]]
        return rows, begin * (1 - t)[:, None] + end * t[:, None]
