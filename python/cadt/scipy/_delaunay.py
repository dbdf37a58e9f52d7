# SPDX-License-Identifier: Apache-2.0
"""scipy.spatial.Delaunay of points in the plane."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import Delaunay as _Triangulation

from cadt import _cadt
from cadt._points import offsets
from cadt.scipy._hull import HullFinder
from cadt.scipy._plane import Plane

if TYPE_CHECKING:
    import cadt


class Delaunay(Plane, _Triangulation):
    """Delaunay triangulation with the interface of `scipy.spatial.Delaunay`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or cadt.Delaunay
        Copied only to make contiguous doubles of them. They must not change while this is used. With another number of
        columns this is SciPy's triangulation.
    furthest_site : bool
        True: SciPy's triangulation.
    incremental : bool
        Whether `add_points` may be called. Each call triangulates all points.
    qhull_options : str, optional
        ``Qbb Qc Qz Q12 Qt Qx Q11 Pp`` mean what they do in SciPy (without Qc, `coplanar` is empty), and so does QJ unless
        there are duplicates. With any other this is SciPy's triangulation.
    backend, device, threads, progress
        As for `cadt.Delaunay`.

    Attributes
    ----------
    points : (npoints, 2) float64
    simplices, neighbors : (nsimplex, 3) int32
        Counterclockwise; the k-th neighbour is opposite the k-th vertex, -1 outside.
    equations : (nsimplex, 4) float64
        [normal, offset] of each triangle on the paraboloid.
    paraboloid_scale, paraboloid_shift : float
        Of the third coordinate, as Qhull chooses them.
    transform : (nsimplex, 3, 2) float64
        To barycentric coordinates, with a relative error of a few eps in each number. NaN where the triangle is nearly
        degenerate: its reciprocal condition number is below 1000 eps, as in SciPy.
    vertex_to_simplex : (npoints,) int32
        The lowest triangle of each point; of a duplicate that of the point that it equals.
    convex_hull : (nfaces, 2) int32
    coplanar : (ncoplanar, 3) int32
        Each duplicate, a triangle at it, and the vertex that it equals.
    vertex_neighbor_vertices : (indptr, indices)
        Both int32; offsets beyond it int64.
    mesh : cadt.Delaunay
        The mesh with all its queries; None if this is SciPy's triangulation.

    Examples
    --------
    >>> tri = Delaunay([[0, 0], [1, 0], [0, 1], [1, 1], [0, 0]])
    >>> tri.simplices
    array([[0, 1, 2],
           [1, 3, 2]], dtype=int32)
    >>> tri.coplanar
    array([[4, 0, 0]], dtype=int32)
    >>> tri.find_simplex([[0.2, 0.2], [3, 3]])
    array([ 0, -1], dtype=int32)
    """

    _default_options = "Qbb Qc Qz Q12"
    _transform: np.ndarray | None
    _vertex_to_simplex: np.ndarray | None
    _vertex_neighbor_vertices: tuple[np.ndarray, np.ndarray] | None

    def _reset(self) -> None:
        super()._reset()
        self.nsimplex = self._mesh.n_triangles
        self._transform = self._vertex_to_simplex = self._vertex_neighbor_vertices = None

    # Attributes of SciPy's instances. They are arrays of their own that may be written to, as in SciPy.

    @cached_property
    def simplices(self) -> np.ndarray:
        return np.array(self._mesh.simplices)

    @cached_property
    def neighbors(self) -> np.ndarray:
        return np.array(self._mesh.neighbors)

    @cached_property
    def _paraboloid(self) -> tuple[float, float]:
        return _cadt.paraboloid(self._points, "Qbb" in self._options, "Qz" in self._options)

    @property
    def paraboloid_scale(self) -> float:
        return self._paraboloid[0]

    @paraboloid_scale.setter
    def paraboloid_scale(self, scale: float) -> None:
        self.__dict__["_paraboloid"] = (scale, self.__dict__.get("_paraboloid", (1.0, 0.0))[1])

    @property
    def paraboloid_shift(self) -> float:
        return self._paraboloid[1]

    @paraboloid_shift.setter
    def paraboloid_shift(self, shift: float) -> None:
        self.__dict__["_paraboloid"] = (self.__dict__.get("_paraboloid", (1.0, 0.0))[0], shift)

    @cached_property
    def equations(self) -> np.ndarray:
        return _cadt.equations(self._points, self._mesh._host_mesh, *self._paraboloid)

    @cached_property
    def coplanar(self) -> np.ndarray:
        if "Qc" not in self._options:
            return np.empty((0, 3), dtype=np.intc)
        equal = self._mesh.duplicate_of
        duplicates = np.flatnonzero(equal >= 0)
        vertices = equal[duplicates]
        at = self._mesh.vertex_to_simplex[vertices]
        return np.stack([duplicates.astype(np.intc), at, vertices], axis=1)

    @cached_property
    def good(self) -> np.ndarray:
        return np.ones(self.nsimplex, dtype=np.intc)

    # SciPy's properties, which keep what they have computed in these attributes.

    @property
    def transform(self) -> np.ndarray:
        if self._transform is None and self.mesh is not None:
            self._transform = _cadt.transforms(self._points, self.mesh._host_mesh)
        return super().transform

    @property
    def vertex_to_simplex(self) -> np.ndarray:
        if self._vertex_to_simplex is None and self.mesh is not None:
            result = np.array(self.mesh.vertex_to_simplex, dtype=np.intc)
            if "Qc" not in self._options:
                result[self.mesh.duplicate_of >= 0] = -1
            self._vertex_to_simplex = result
        return super().vertex_to_simplex

    @property
    def vertex_neighbor_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        if self._vertex_neighbor_vertices is None and self.mesh is not None:
            indptr, indices = self.mesh.vertex_neighbors
            self._vertex_neighbor_vertices = (offsets(indptr), np.array(indices, dtype=np.intc))
        return super().vertex_neighbor_vertices

    @property
    def convex_hull(self) -> np.ndarray:
        return super().convex_hull if self.mesh is None else np.array(self.mesh.convex_hull, dtype=np.intc)

    # Methods

    def find_simplex(self, xi: Any, bruteforce: bool = False, tol: float | None = None) -> np.ndarray:
        """The triangle that contains each query: int32, -1 outside and for queries that are not finite.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
        bruteforce : bool
            True: SciPy's search, on this mesh.
        tol : float, optional
            Default: exact, but queries outside of the hull by less than 100 eps of the length of its nearest edge are
            found. 0: exact. Any other: SciPy's search with this tolerance, on this mesh.
        """
        if self.mesh is None or bruteforce or (tol is not None and tol != 0):
            return super().find_simplex(xi, bruteforce, tol)
        xi = np.asarray(xi)
        if xi.shape[-1] != 2:  # IndexError for a single number, as SciPy
            raise ValueError("wrong dimensionality in xi")
        x = queries(xi)
        found = locate(self.mesh, x)
        if tol is None:
            self._hull_finder.find(x, found)
        return found.reshape(xi.shape[:-1])

    def plane_distance(self, xi: Any) -> np.ndarray:
        """Distances on the paraboloid between each query and the plane of each triangle: (..., nsimplex) float64."""
        xi = np.asarray(xi)
        if xi.ndim == 0 or xi.shape[-1] != self.ndim:  # SciPy reads beyond the end of others
            raise ValueError(f"xi must have shape (..., {self.ndim}), not {xi.shape}")
        if self.mesh is None:
            return super().plane_distance(xi)
        with np.errstate(all="ignore"):  # of queries that are not finite
            return self.lift_points(xi) @ self.equations[:, :3].T + self.equations[:, 3]

    def lift_points(self, x: Any) -> np.ndarray:
        """Points (..., 2) on Qhull's paraboloid: (..., 3)."""
        x = np.asarray(x)
        if self.mesh is None:
            return super().lift_points(x)
        x = x.astype(np.double, copy=False)
        # The scale first: squares may be too large or too small.
        height = (self.paraboloid_scale * x * x).sum(axis=-1, keepdims=True) + self.paraboloid_shift
        return np.concatenate([x, height], axis=-1)

    @cached_property
    def _hull_finder(self) -> HullFinder:
        return HullFinder(self._points, self._mesh)


def queries(xi: np.ndarray) -> np.ndarray:
    """Queries as rows of floats that the library reads."""
    if xi.dtype.kind == "c":
        raise TypeError("queries must be real numbers, not complex ones")
    if xi.dtype != np.float32:
        xi = xi.astype(np.float64, copy=False)
    return xi.reshape(-1, 2)


def locate(mesh: cadt.Delaunay, x: np.ndarray) -> np.ndarray:
    """`cadt.Delaunay.find_simplex`, and -1 for queries that are not finite."""
    try:
        return mesh.find_simplex(x)
    except ValueError:
        finite = np.isfinite(x).all(axis=1)
        if finite.all():
            raise
    found = np.full(len(x), -1, dtype=np.int32)
    found[finite] = mesh.find_simplex(x[finite])
    return found
