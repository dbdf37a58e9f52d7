# SPDX-License-Identifier: Apache-2.0
"""The arrays of a mesh, and how other libraries get them: what `Delaunay` and `ConstrainedDelaunay` share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _gpu, _show
from cadt._queries import Queries

if TYPE_CHECKING:
    from collections.abc import Callable


class Mesh(Queries):
    """Base of `Delaunay` and `ConstrainedDelaunay`."""

    _mesh: _cadt.Triangulation | None
    _gpu: _gpu.Mesh | None
    _cache: dict[str, Any]

    @property
    def points(self) -> Any:
        """The points, as they were given where they are an array, else as one of shape (n, 2)."""
        return self._points

    @property
    def simplices(self) -> Any:
        """Triangles: (t, 3) int32 indices of points, counterclockwise. t = 2 v - 2 - h for v vertices, h on the hull."""
        return self._cached("simplices", lambda m: m.triangles, lambda g: g.simplices)

    @property
    def neighbors(self) -> Any:
        """(t, 3) int32: the triangle opposite each vertex, -1 outside the hull."""
        return self._cached("neighbors", lambda m: m.neighbors, lambda g: g.neighbors)

    @property
    def hull(self) -> Any:
        """The convex hull: (h,) int32, a counterclockwise loop of points, those on its edges included."""
        return self._cached("hull", lambda m: m.hull)

    @property
    def convex_hull(self) -> Any:
        """The edges of the convex hull: (h, 2) int32, a counterclockwise loop."""

        def edges(mesh: _cadt.Triangulation) -> np.ndarray:
            return np.stack([mesh.hull, np.roll(mesh.hull, -1)], axis=1)

        return self._cached("convex_hull", edges)

    @property
    def edges(self) -> Any:
        """The edges, each once: (e, 2) int32, the lower index first, ascending. O(n)."""
        return self._cached("edges", lambda m: m.edges())

    @property
    def vertex_neighbors(self) -> tuple[Any, Any]:
        """The neighbours of each point: ``indptr`` (n + 1,) int64 and ``indices`` int32.

        Those of point p are ``indices[indptr[p]:indptr[p + 1]]``, counterclockwise.

        >>> indptr, indices = Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]]).vertex_neighbors
        >>> indices[indptr[0]:indptr[1]]
        array([1, 2], dtype=int32)
        """
        return self._cached("vertex_neighbors", lambda m: m.vertex_neighbors())

    @property
    def incident_triangles(self) -> tuple[Any, Any]:
        """The triangles at each point, as `vertex_neighbors`."""
        return self._cached("incident_triangles", lambda m: m.incident_triangles())

    @property
    def half_edges(self) -> Any:
        """The opposite of each half-edge, as in delaunator: (3 t,) int64, -1 on the hull."""
        return self._cached("half_edges", lambda m: m.half_edges())

    @property
    def vertex_to_simplex(self) -> Any:
        """The lowest triangle of each point: (n,) int32, -1 without triangles. A duplicate has that of what it equals."""
        return self._cached("vertex_to_simplex", lambda m: m.vertex_triangle())

    @property
    def duplicate_of(self) -> Any:
        """(n,) int32: the lowest point that each point equals, if that is another one; else -1."""

        def of(mesh: _cadt.Triangulation) -> np.ndarray:
            result = np.full(mesh.number_of_points, -1, dtype=np.int32)
            result[mesh.duplicates[:, 0]] = mesh.duplicates[:, 1]
            return result

        return self._cached("duplicate_of", of)

    @property
    def n_points(self) -> int:
        return self._any.number_of_points

    @property
    def n_triangles(self) -> int:
        return self._any.number_of_triangles

    @property
    def dimension(self) -> int:
        """Of the points: -1 none, 0 one place, 1 a line, 2 the plane. Below 2 there are no triangles."""
        return self._any.dimension

    @property
    def statistics(self) -> dict[str, Any]:
        """Work, conflicts, memory and times of the call, by name."""
        return self._any.statistics

    @property
    def device(self) -> str:
        """Where the mesh was computed."""
        s = self._any.statistics
        return "host" if s["backend"] in ("host", "") else f"{s['backend']}: {s['device']}"

    # To other libraries

    def plot(self, ax: Any = None, **how: Any) -> Any:
        """Draws the triangles, if there are any, with matplotlib (``triplot``) and returns the axes."""
        return _show.plot(self, ax, how)

    def to_matplotlib(self) -> Any:
        """A ``matplotlib.tri.Triangulation`` of the same arrays. Raises InputError without triangles."""
        return _show.to_matplotlib(self)

    def to_pyvista(self, z: Any = None) -> Any:
        """A ``pyvista.PolyData``; `z`: heights of the points, else 0."""
        return _show.to_pyvista(self, z)

    def to_meshio(self, z: Any = None) -> Any:
        """A ``meshio.Mesh``; `z`: heights of the points, else the mesh is plane."""
        return _show.to_meshio(self, z)

    def save(self, path: Any, z: Any = None) -> None:
        """Writes ``.npz`` (points, simplices, neighbors, convex_hull, and `z` as height), or with meshio what the suffix says
        (``.ply .vtk .obj .stl``).

        The file appears whole or not at all, and behind a symbolic link, if `path` is one.

        Raises
        ------
        FileError
            The suffix says no format, or the file cannot be written.
        InputError
            There are no triangles, which ``.npz`` alone takes.
        ImportError
            The suffix needs meshio, which is not installed.
        """
        _show.save(self, path, z)

    # Plumbing

    def _cells(self, inside: bool) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """The triangles for other programs, on the host, and what is said of each."""
        return self._host_mesh.triangles, {}

    def _outside(self) -> np.ndarray | None:
        """Whether each triangle is outside; None: all are inside."""
        return None

    @property
    def _any(self) -> Any:
        return self._mesh if self._gpu is None else self._gpu.mesh

    @property
    def _host_mesh(self) -> _cadt.Triangulation:
        if self._mesh is None:
            self._mesh = self._gpu.mesh.download()  # type: ignore[union-attr]
        return self._mesh

    @property
    def _host_points(self) -> np.ndarray:
        return self._points if self._gpu is None else self._gpu.points_on_host()

    def _cached(self, name: str, of_host: Callable, of_gpu: Callable | None = None) -> Any:
        """An array of the host's mesh, of the kind of array that the points are."""
        if name not in self._cache:
            if self._gpu is None:
                self._cache[name] = read_only(of_host(self._mesh))
            elif of_gpu is not None:
                self._cache[name] = of_gpu(self._gpu)
            else:
                self._cache[name] = self._gpu.array.like(of_host(self._host_mesh))
        return self._cache[name]

    def _host(self, name: str, of: Callable) -> Any:
        if name not in self._cache:
            self._cache[name] = of(self._host_mesh)
        return self._cache[name]


def read_only(arrays: Any) -> Any:
    """An array, or several, of the host that a mesh keeps: nobody may change them."""
    for a in arrays if isinstance(arrays, tuple) else (arrays,):
        a.flags.writeable = False
    return arrays
