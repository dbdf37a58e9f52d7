# SPDX-License-Identifier: Apache-2.0
"""scipy.spatial.Voronoi of points in the plane."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Voronoi as _Diagram

from cadt.scipy._plane import Plane

if TYPE_CHECKING:
    import cadt

_EPS = float(np.finfo(np.double).eps)


class Voronoi(Plane, _Diagram):
    """Voronoi diagram with the interface of `scipy.spatial.Voronoi`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        As for `Delaunay`.
    furthest_site : bool
        True: SciPy's diagram.
    incremental : bool
        Whether `add_points` may be called.
    qhull_options : str, optional
        As for `Delaunay`. Qz, which is a default, adds an empty region.
    backend, device, threads, progress
        As for `cadt.Delaunay`.

    Attributes
    ----------
    points : (npoints, 2) float64
    vertices : (nvertices, 2) float64
        One for all triangles that have a common circumcircle, up to rounding; none for those at the hull that are flat
        up to rounding.
    ridge_points : (nridges, 2) int32
    ridge_vertices : list of [vertex, vertex]
        -1 first: to infinity. `ridge_dict` has them by points.
    regions : list of lists
        Vertices of each region, counterclockwise; -1: infinity. The first is empty and no point's (with Qz).
    point_region : (npoints,) intp
    mesh : cadt.Delaunay
        None if this is SciPy's diagram.

    >>> v = Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
    >>> v.vertices.tolist()
    [[1.0, 0.0], [0.0, 1.0], [2.0, 1.0], [1.0, 2.0]]
    >>> v.regions[v.point_region[4]]
    [0, 2, 3, 1]
    """

    _default_options = "Qbb Qc Qz"

    def _reset(self) -> None:
        super()._reset()
        self._ridge_dict = None

    @cached_property
    def _merged(self) -> tuple[np.ndarray, np.ndarray]:
        """The Voronoi vertex of each triangle, -1 at infinity, and the lowest triangle of each Voronoi vertex."""
        mesh = self._mesh
        t, k = np.nonzero(mesh.neighbors > np.arange(mesh.n_triangles)[:, None])
        u = mesh.neighbors[t, k]
        # By a power of two, so that products of four coordinates are neither too large nor too small.
        largest = float(np.abs(self._points).max())
        points = np.ldexp(self._points, -int(np.frexp(largest)[1]))
        tolerance = 8 * _EPS * float(np.abs(points).max())
        same = cocircular(points, mesh.simplices[t], mesh.simplices[u], mesh.neighbors[u], t, tolerance)
        outside = flat_at_hull(points, mesh, tolerance)
        label = np.arange(mesh.n_triangles)
        if same.any():
            graph = coo_array((np.ones(int(same.sum()), dtype=bool), (t[same], u[same])), shape=(len(label),) * 2)
            label = connected_components(graph, directed=False)[1]
        elif not outside.any():
            return label, label
        _, first, of = np.unique(np.where(outside, -1, label), return_index=True, return_inverse=True)
        if outside.any():
            first = np.delete(first, 0)
        rank = np.empty(len(first), dtype=np.intp)
        rank[np.argsort(first)] = np.arange(len(first))
        rank = np.insert(rank, 0, -1) if outside.any() else rank
        return rank[of.reshape(-1)], np.sort(first)

    @cached_property
    def vertices(self) -> np.ndarray:
        return self._mesh.circumcenters()[self._merged[1]]

    @cached_property
    def _ridges(self) -> tuple[np.ndarray, np.ndarray]:
        diagram = self._mesh.voronoi()
        of = np.append(self._merged[0], -1)  # -1 stays
        ends = np.sort(of[diagram.ridge_vertices], axis=1)
        keep = ends[:, 0] != ends[:, 1]
        return np.array(diagram.ridge_points[keep], dtype=np.intc), ends[keep]

    @cached_property
    def ridge_points(self) -> np.ndarray:
        return self._ridges[0]

    @cached_property
    def ridge_vertices(self) -> list[list[int]]:
        return self._ridges[1].tolist()

    @cached_property
    def point_region(self) -> np.ndarray:
        equal = self._mesh.duplicate_of
        vertex = equal < 0
        region = np.cumsum(vertex) - (0 if "Qz" in self._options else 1)
        duplicates = np.flatnonzero(~vertex)
        region[duplicates] = region[equal[duplicates]] if "Qc" in self._options else -1
        return region.astype(np.intp, copy=False)

    @cached_property
    def regions(self) -> list[list[int]]:
        mesh = self._mesh
        diagram = mesh.voronoi()
        begin = diagram.indptr.astype(np.intp)
        # The cells of the hull have a corner at infinity, between their last and their first.
        counts = np.diff(begin)
        counts[mesh.hull] += 1
        corners = np.insert(self._merged[0][diagram.indices], begin[np.sort(mesh.hull)], -1)
        end = np.cumsum(counts)
        full = np.flatnonzero(counts)
        first = end[full] - counts[full]
        # Of corners in turn that are one vertex, the first stays; before a cell's first is its last.
        before = np.roll(corners, 1)
        before[first] = corners[end[full] - 1]
        keep = corners != before
        owner = np.repeat(np.arange(len(counts)), counts)
        alone = np.bincount(owner[keep], minlength=len(counts)) == 0
        keep[first] |= alone[full]
        kept = np.bincount(owner[keep], minlength=len(counts))[full]
        flat = corners[keep].tolist()
        ends = np.cumsum(kept)
        result = [flat[a:b] for a, b in zip((ends - kept).tolist(), ends.tolist())]
        return [[], *result] if "Qz" in self._options else result


def cocircular(
    points: np.ndarray, a: np.ndarray, b: np.ndarray, back: np.ndarray, t: np.ndarray, tolerance: float
) -> np.ndarray:
    """Whether triangles `a` and their neighbours `b` have one circumcircle, as far as coordinates with errors of some
    `tolerance` can tell. `back`: the neighbours of b, among which is `t`, the index of a."""
    opposite = np.take_along_axis(b, np.argmax(back == t[:, None], axis=1)[:, None], axis=1)
    d = points[opposite[:, 0]]
    edges = [points[a[:, k]] - d for k in range(3)]
    with np.errstate(all="ignore"):
        squares = [np.einsum("ij,ij->i", e, e) for e in edges]
        determinant, permanent = np.zeros(len(t)), np.zeros(len(t))
        for k in range(3):
            p, q = edges[k - 2], edges[k - 1]
            one, two = p[:, 0] * q[:, 1], p[:, 1] * q[:, 0]
            determinant += squares[k] * (one - two)
            permanent += squares[k] * (np.abs(one) + np.abs(two))
        longest = np.sqrt(np.max(squares, axis=0))
        # The bound of the determinant's own rounding is Shewchuk's (1997).
        return np.abs(determinant) <= 12 * _EPS * permanent + tolerance * longest**3


def flat_at_hull(points: np.ndarray, mesh: cadt.Delaunay, tolerance: float) -> np.ndarray:
    """Triangles at the hull, or behind such, that are flat as far as coordinates with errors of some `tolerance` can
    tell: their circumcentres are at infinity."""
    a, b, c = (points[mesh.simplices[:, k]] for k in range(3))
    u, v = b - a, c - a
    with np.errstate(all="ignore"):
        twice_area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        longest = np.sqrt(np.maximum(np.einsum("ij,ij->i", u, u), np.einsum("ij,ij->i", v, v)))
        flat = np.flatnonzero(twice_area <= tolerance * longest)
    result = np.zeros(mesh.n_triangles, dtype=bool)
    of = mesh.neighbors[flat]
    while flat.size:
        now = ((of < 0) | result[of]).any(axis=1)
        if not now.any():
            break
        result[flat[now]] = True
        flat, of = flat[~now], of[~now]
    # Where all is flat, nothing else is left: as it is.
    return result if not result.all() else np.zeros_like(result)
