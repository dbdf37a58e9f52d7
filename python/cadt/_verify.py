# SPDX-License-Identifier: Apache-2.0
"""The exact check of any program's mesh."""

from __future__ import annotations

from typing import Any

from cadt import _cadt
from cadt._points import as_indices, as_points
from cadt._results import VerifyReport, report_of


def verify(points: Any, simplices: Any, neighbors: Any = None, *, canonical_ties: bool = False) -> VerifyReport:
    """Checks the mesh of any program exactly: structure, orientation, hull, all vertices, all empty circles.

    Parameters
    ----------
    points : array_like, shape (n, 2)
    simplices : array_like of int, shape (t, 3)
        Counterclockwise.
    neighbors : array_like of int, shape (t, 3), optional
    canonical_ties : bool
        Whether cocircular points must be triangulated as cadt and CGAL do.

    A wrong mesh is reported, not raised.

    >>> print(cadt.verify([[0, 0], [4, 0], [4, 1], [0, 3]], [[0, 1, 3], [1, 2, 3]]))
    delaunay failed: the edge opposite vertex 0 of triangle 0 (0 1 3), from 1 to 3, ...
    """
    return report_of(
        _cadt.verify(
            as_points(points),
            as_indices(simplices, "simplices"),
            None if neighbors is None else as_indices(neighbors, "neighbors"),
            canonical_ties,
        )
    )
