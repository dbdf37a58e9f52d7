# SPDX-License-Identifier: Apache-2.0
"""CuPy's ``cupyx.scipy.spatial.Delaunay`` for points in the memory of a GPU, computed by cadt.

What is different from CuPy's: the triangulation is exact and complete, for any coordinates; `neighbors` are indices of
triangles; no edge is missing in `vertex_neighbor_vertices`; the attributes that CuPy documents but does not have are there.
It does not derive from CuPy's class, whose Clough-Tocher interpolator reads packed neighbours: for values between the points
ask ``tri.mesh.interpolate``.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

import cadt
from cadt._errors import OptionError
from cadt._points import offsets

__all__ = ["Delaunay"]


class Rows(tuple):
    """(indptr, indices): an attribute in SciPy, a method in CuPy, and here both."""

    __slots__ = ()

    def __call__(self) -> Rows:
        return self


class Delaunay:
    """Delaunay triangulation with the interface of ``cupyx.scipy.spatial.Delaunay``.

    Parameters
    ----------
    points : cupy.ndarray, shape (npoints, 2)
        float64, float32, float16 or small integers. Arrays of other libraries are taken as `cadt.Delaunay` takes them;
        all results are of the same library, and in the memory of the same device.
    furthest_site, incremental : bool
        Must be False, as in CuPy.

    Attributes
    ----------
    points : as given
    simplices, neighbors : (nsimplex, 3) int32
        Counterclockwise; the k-th neighbour is opposite the k-th vertex, -1 outside.
    vertex_neighbor_vertices : (indptr, indices)
        int32, offsets beyond it int64. May be called too, as CuPy's method.
    vertex_to_simplex : (npoints,) int32
    convex_hull : (nfaces, 2) int32
    coplanar : (ncoplanar, 3) int32
        Each point that equals an earlier one, a triangle at it, and the vertex that it equals.
    npoints, nsimplex, ndim, furthest_site
    mesh : cadt.Delaunay
        With all its queries.

    Raises
    ------
    ValueError
        The points are not of two dimensions, or an argument is not supported.

    >>> tri = Delaunay(np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]))
    >>> tri.simplices
    array([[0, 1, 2],
           [1, 3, 2]], dtype=int32)
    >>> indptr, indices = tri.vertex_neighbor_vertices()
    """

    ndim = 2
    furthest_site = False

    def __init__(self, points: Any, furthest_site: bool = False, incremental: bool = False) -> None:
        if len(points.shape) != 2 or points.shape[1] != 2:
            raise ValueError(f"Delaunay takes points of shape (n, 2), not {tuple(points.shape)}")
        if furthest_site:
            raise ValueError("furthest_site is not supported, as in CuPy")
        if incremental:
            raise ValueError("incremental is not supported, as in CuPy")
        self.points = points
        self.mesh = cadt.Delaunay(points)

    @property
    def simplices(self) -> Any:
        return self.mesh.simplices

    @property
    def neighbors(self) -> Any:
        return self.mesh.neighbors

    @property
    def convex_hull(self) -> Any:
        return self.mesh.convex_hull

    @property
    def npoints(self) -> int:
        return self.mesh.n_points

    @property
    def nsimplex(self) -> int:
        return self.mesh.n_triangles

    @cached_property
    def vertex_neighbor_vertices(self) -> Rows:
        indptr, indices = self.mesh.vertex_neighbors
        return Rows((offsets(indptr), indices))

    @property
    def vertex_to_simplex(self) -> Any:
        return self.mesh.vertex_to_simplex

    @cached_property
    def coplanar(self) -> Any:
        equal = self.mesh.duplicate_of
        (duplicates,) = (equal >= 0).nonzero()
        result = equal.repeat(3).reshape(-1, 3)[duplicates]
        result[:, 0] = duplicates
        result[:, 1] = self.vertex_to_simplex[duplicates]
        return result

    def find_simplex(self, xi: Any, bruteforce: bool = False, tol: float | None = None) -> Any:
        """The triangle that contains each query: int32, -1 outside.

        Parameters
        ----------
        xi : array, shape (..., 2)
        bruteforce : bool
            Not used, as in CuPy.
        tol : None or 0
            The answers are exact: the hull and all edges belong to the triangulation, and nothing outside of it.
        """
        if tol:
            raise OptionError(f"find_simplex is exact: tol must be None or 0, not {tol}", "tol")
        if len(xi.shape) == 0 or xi.shape[-1] != 2:
            raise ValueError(f"queries must have shape (..., 2), not {tuple(xi.shape)}")
        return self.mesh.find_simplex(xi)

    def __repr__(self) -> str:
        return f"<cadt.cupy.Delaunay: {self.npoints:,} points, {self.nsimplex:,} triangles, {self.mesh.device}>"
