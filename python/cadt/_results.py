# SPDX-License-Identifier: Apache-2.0
"""What queries return that is more than an array."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Voronoi:
    """The Voronoi diagram of the vertices of a mesh.

    Attributes
    ----------
    vertices : (t, 2) float64
        The circumcentres of the triangles, in their order; infinite where a triangle is too thin.
    indptr, indices : (n + 1,) uint32 and int32
        Cell of point p: the vertices ``indices[indptr[p]:indptr[p + 1]]``, counterclockwise. The cell of a hull vertex
        is unbounded between its last and its first vertex; a duplicate has none.
    ridge_points : (e, 2) int32
        The points on both sides of each edge.
    ridge_vertices : (e, 2) int32
        The Voronoi vertices of each edge. -1: it is a ray from the first one, at a right angle to the hull edge, on the
        right of the line from the first point to the second.
    """

    vertices: np.ndarray
    indptr: np.ndarray
    indices: np.ndarray
    ridge_points: np.ndarray
    ridge_vertices: np.ndarray

    def cell(self, point: int) -> np.ndarray:
        """The Voronoi vertices around a point, counterclockwise: an array of indices."""
        return self.indices[self.indptr[point] : self.indptr[point + 1]]


class Check(NamedTuple):
    """One check of `VerifyReport`: its name, whether it passed, how often it failed, where first, and how."""

    name: str
    passed: bool
    failures: int
    first: int
    what: str


@dataclass(frozen=True)
class VerifyReport:
    """Outcome of an exact check of a mesh, which shares no predicate with what triangulates points, and segments that do
    not cross. True if all is well."""

    ok: bool
    summary: str
    checks: tuple[Check, ...]
    triangles_examined: int
    edges_examined: int
    ties: int

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        return self.summary


def report_of(report: dict[str, Any]) -> VerifyReport:
    checks = tuple(Check(*check) for check in report.pop("checks"))
    return VerifyReport(checks=checks, **report)
