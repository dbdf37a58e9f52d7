# SPDX-License-Identifier: Apache-2.0
"""The Delaunay triangulation, and what it can be asked."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices, _gpu, _show
from cadt._errors import InputError, LimitError, OptionError
from cadt._points import as_points, as_queries, as_values
from cadt._progress import reporter
from cadt._results import VerifyReport, Voronoi, report_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_METHODS = ("linear", "nearest", "natural")


class Delaunay:
    """The Delaunay triangulation of points in the plane.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        float64 or float32, with any strides, and read where it lies; integers are converted. Lists, and objects with
        ``__array__``, ``__dlpack__`` or ``__cuda_array_interface__``: arrays of CuPy, PyTorch or JAX on a GPU stay there,
        in the producer's current stream, and all results are arrays of the same kind on that GPU; so are arrays of
        PyOpenCL. Points that equal an earlier one are no vertices (`duplicate_of`). The points must not change while
        the mesh is used.
    backend : {"host", "opencl", "cuda"}, optional
        Where to compute. Default: where the points are; for points of the host a GPU if there is one and there are
        200,000 points or more, else the host.
    device : int or str, optional
        Device of the back end: its index in `cadt.devices`, or a part of its name.
    order : {"canonical", "fast"}
        Order of the triangles. Canonical: each starts with its lowest index and they ascend, so that the arrays are the
        same from every device and call. Fast: as the device left them.
    threads : int, optional
        Threads of the host at most. Default: one for each core.
    max_memory : int, optional
        Limit of the device's memory in bytes.
    statistics : {"none", "counters", "timing"}
        What `statistics` counts.
    progress : bool or callable, optional
        True: a progress bar of tqdm where it is installed, else a line on a terminal. A callable gets
        ``(phase, fraction)``; what it raises ends the call.

    Raises
    ------
    InputError
        A coordinate is NaN or infinite, or the shape is wrong.
    TypeError
        The dtype cannot be taken (complex, object, strings, ...).
    LimitError
        More than 536,870,910 points.
    BackendUnavailable, OptionError, OutOfMemory, DeviceError, KernelBuildError

    Notes
    -----
    The result is exact: predicates are, and ties between cocircular points are broken by symbolic perturbation, as in
    CGAL, so the set of triangles is a function of the points alone. Expected O(n log n) work for a sort and O(n) for
    the rest. The GIL is released; Ctrl-C ends a call. Meshes never change, and threads may share them.

    Examples
    --------
    >>> mesh = Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]])
    >>> mesh
    <cadt.Delaunay: 4 points, 2 triangles, host>
    >>> mesh.neighbors
    array([[ 1, -1, -1],
           [-1,  0, -1]], dtype=int32)
    """

    def __init__(
        self,
        points: Any,
        *,
        backend: str | None = None,
        device: int | str | None = None,
        order: str = "canonical",
        threads: int | None = None,
        max_memory: int | None = None,
        statistics: str = "counters",
        progress: bool | Callable[[str, float], object] | None = None,
    ) -> None:
        self._mesh: _cadt.Triangulation | None = None
        self._gpu: _gpu.Mesh | None = None
        self._cache: dict[str, Any] = {}
        arguments = (backend, device, order, threads, max_memory, statistics)
        if (on_gpu := _gpu.array_on_device(points)) is not None:
            self._points: Any = points
            with reporter(progress) as report:
                self._gpu = _gpu.Mesh(on_gpu, arguments, report)
            self._options = self._gpu.options
            return
        self._points = as_points(points)
        n = len(self._points)
        self._options = _devices.make_options(*arguments)
        open_device = _devices.device_for(self._options, device, threads, n)
        with reporter(progress) as report:
            if open_device is not None:
                self._mesh = open_device.triangulate(self._points, self._options, report)
            else:
                if self._options.backend == "auto":
                    self._options = self._options.on_host()
                self._mesh = _cadt.triangulate(self._points, self._options, report)

    @classmethod
    def from_simplices(cls, points: Any, simplices: Any, neighbors: Any = None, *, verify: bool = True) -> Delaunay:
        """The mesh of another program, e.g. of ``scipy.spatial.Delaunay``.

        Parameters
        ----------
        points : array_like, shape (n, 2)
        simplices : array_like of int, shape (t, 3)
            Vertices of each triangle; clockwise ones are turned.
        neighbors : array_like of int, shape (t, 3), optional
            Of each triangle, the one opposite each vertex, -1 outside. Derived if missing.
        verify : bool
            Whether the whole mesh is verified exactly. False: its structure alone, so that no query can run away.

        Raises
        ------
        InvalidMesh
            It is no Delaunay triangulation of the points; `check` names the first check that failed.

        Examples
        --------
        >>> Delaunay.from_simplices([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]).n_triangles
        1
        """
        self = cls.__new__(cls)
        self._points = as_points(points)
        self._gpu, self._cache = None, {}
        self._options = _devices.make_options("host", None, "canonical", None, None, "counters")
        triangles = _indices(simplices, "simplices")
        of = None if neighbors is None else _indices(neighbors, "neighbors")
        if len(triangles) and triangles.min() >= 0 and triangles.max() < len(self._points):
            p = self._points.astype(np.float64, copy=False)[triangles]
            ab, ac = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
            turn = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0] < 0
            triangles[turn] = triangles[turn][:, [0, 2, 1]]
            if of is not None and of.shape == triangles.shape:
                of[turn] = of[turn][:, [0, 2, 1]]
        self._mesh = _cadt.adopt(self._points, triangles, of, verify)
        return self

    # The mesh

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
        """The lowest triangle of each point: (n,) int32, -1 without triangles."""
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
    def hash(self) -> str:
        """32 hexadecimal digits that depend on the set of triangles alone: the same from every device and order."""
        return self._host("hash", lambda m: m.hash())

    @property
    def statistics(self) -> dict[str, Any]:
        """Work, conflicts, memory and times of the call, by name."""
        return self._any.statistics

    @property
    def device(self) -> str:
        """Where the mesh was computed."""
        s = self._any.statistics
        return "host" if s["backend"] in ("host", "") else f"{s['backend']}: {s['device']}"

    # Queries

    def find_simplex(self, xi: Any) -> Any:
        """The triangle that contains each query: int32, -1 outside.

        Exact. Hull and edges belong to the mesh; on an edge or vertex it is the lowest triangle. O(log n) each.

        Parameters
        ----------
        xi : array_like, shape (..., 2)

        >>> Delaunay([[0, 0], [1, 0], [0, 1]]).find_simplex([[0.5, 0.5], [0.6, 0.6]])
        array([ 0, -1], dtype=int32)
        """
        if self._gpu is not None:
            return self._gpu.find_simplex(xi)
        q, shape = as_queries(xi)
        if self._empty():
            _finite(q)
            return np.full(shape, -1, dtype=np.int32)
        return self._queries().locate(q).reshape(shape)

    def barycentric(self, xi: Any) -> tuple[Any, Any]:
        """`find_simplex`, and barycentric coordinates there: (...) int32 and (..., 3) float64, NaN outside."""
        if self._gpu is not None:
            return self._gpu.barycentric(xi)
        q, shape = as_queries(xi)
        if self._empty():
            _finite(q)
            return np.full(shape, -1, dtype=np.int32), np.full((*shape, 3), np.nan)
        triangles, weights = self._queries().barycentric(q)
        return triangles.reshape(shape), weights.reshape(*shape, 3)

    def within_hull(self, xi: Any) -> Any:
        """Whether each query lies in the convex hull, its boundary included. Exact."""
        if self._gpu is not None:
            return self._gpu.find_simplex(xi) >= 0
        q, shape = as_queries(xi)
        if self._empty():
            _finite(q)
            return np.zeros(shape, dtype=bool)
        return self._queries().within_hull(q).view(bool).reshape(shape)

    def nearest_vertex(self, xi: Any, k: int = 1) -> Any:
        """The k nearest points of each query: (...) int32, or (..., k) for k > 1; -1 where there are no more.

        Exact; of equally near ones the lowest.

        >>> Delaunay([[0, 0], [1, 0], [0, 1]]).nearest_vertex([0.9, 0.2])
        array(1, dtype=int32)
        """
        k = operator.index(k)
        if k < 1:
            raise OptionError(f"k must be 1 or more, not {k}", "k")
        if self._gpu is not None:
            return self._gpu.nearest_vertex(xi, k)
        q, shape = as_queries(xi)
        wanted = shape if k == 1 else (*shape, k)
        if self._empty():
            _finite(q)
            return np.full(wanted, -1, dtype=np.int32)
        if k <= self.n_points:
            return self._queries().nearest(q, k).reshape(wanted)
        result = np.full(wanted, -1, dtype=np.int32)
        result[..., : self.n_points] = self._queries().nearest(q, self.n_points).reshape(*shape, -1)
        return result

    def interpolate(self, values: Any, xi: Any, method: str = "linear", *, outside: str = "nan") -> Any:
        """Values between the points: (..., m...) float64 for values of shape (n, m...).

        Parameters
        ----------
        values : array_like, shape (n,) or (n, m)
        xi : array_like, shape (..., 2)
        method : {"linear", "nearest", "natural"}
            Natural neighbours (Sibson, 1981) are smooth but at the points.
        outside : {"nan", "nearest"}
            What queries outside the convex hull get.

        >>> mesh = Delaunay([[0, 0], [1, 0], [0, 1]])
        >>> float(mesh.interpolate([0, 10, 20], [0.25, 0.25]))
        7.5
        """
        _one_of(method, _METHODS, "method")
        _one_of(outside, ("nan", "nearest"), "outside")
        if self._gpu is not None:
            return self._gpu.interpolate(values, xi, method, outside)
        v, one = as_values(values, self.n_points)
        q, shape = as_queries(xi)
        if self._empty() or v.shape[1] == 0:
            _finite(q)
            return np.full((*shape, *one), np.nan)
        return self._queries().interpolate(v, q, method, outside).reshape((*shape, *one))

    def rasterize(
        self,
        values: Any,
        *,
        bounds: Sequence[float] | None = None,
        shape: tuple[int, int] | None = None,
        resolution: float | tuple[float, float] | None = None,
        method: str = "linear",
        max_edge: float | None = None,
        origin: str = "upper",
    ) -> Any:
        """Values at the centres of the cells of a grid: (rows, columns, m...) float64, NaN outside the hull.

        Parameters
        ----------
        values : array_like, shape (n,) or (n, m)
        bounds : (xmin, ymin, xmax, ymax), optional
            Default: those of the points.
        shape : (rows, columns)
        resolution : float or (dx, dy)
            Size of a cell, instead of `shape`; `bounds` grow at the right and at the bottom (origin "lower": top) to
            whole cells.
        method : {"linear", "nearest", "natural"}
        max_edge : float, optional
            Cells in triangles with a longer edge are NaN.
        origin : {"upper", "lower"}
            Whether the first row is the top one, as in images and GIS, or the bottom one.
        """
        _one_of(method, _METHODS, "method")
        longest = _length(max_edge, "max_edge")
        points = self.points if self._gpu is None else None
        if bounds is None:
            if points is None:
                bounds = self._gpu.bounds()  # type: ignore[union-attr]
            elif len(points) == 0:
                raise InputError("without points there are no bounds: pass bounds=", 0)
            else:
                low, high = points.min(axis=0), points.max(axis=0)
                bounds = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
        grid, rows, columns = grid_of(bounds, shape, resolution, origin)
        if self._gpu is not None:
            return self._gpu.rasterize(values, grid, rows, columns, method, longest)
        v, one = as_values(values, self.n_points)
        if self._empty() or v.shape[1] == 0:
            return np.full((rows, columns, *one), np.nan)
        # The library makes a raster of one value a point.
        rasters = [
            self._queries().rasterize(grid, columns, rows, np.ascontiguousarray(v[:, [j]]), method, longest)
            for j in range(v.shape[1])
        ]
        result = rasters[0] if len(rasters) == 1 else np.stack(rasters, axis=-1)
        return result.reshape(rows, columns, *one)

    def circumcenters(self) -> Any:
        """The circumcentre of each triangle: (t, 2) float64."""
        if self._gpu is not None:
            return self._gpu.circumcenters()
        return np.empty((0, 2)) if self._empty() else self._queries().circumcenters()

    def voronoi(self) -> Voronoi:
        """The Voronoi diagram, as arrays of the host."""
        return Voronoi(*self._queries().voronoi())

    def voronoi_polygons(self, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """The Voronoi cells within a box (xmin, ymin, xmax, ymax): ``indptr`` (n + 1,) and ``xy`` (k, 2).

        That of point p is ``xy[indptr[p]:indptr[p + 1]]``, counterclockwise.
        """
        if len(box) != 4:
            raise InputError("the box is (xmin, ymin, xmax, ymax)", 0)
        return self._queries().voronoi_polygons(tuple(float(b) for b in box))

    def largest_empty_circles(self, k: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The k largest circles without a point inside and with the centre in the hull, largest first.

        Returns their centres (k, 2), radii (k,) and triangles (k,), whose circumcircles they are.
        """
        k = operator.index(k)
        if k < 0:
            raise OptionError(f"k must not be negative, but it is {k}", "k")
        return self._queries().largest_empty_circles(k)

    def alpha_shape(self, radius: float, *, max_edge: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The triangles with a circumradius of at most `radius` and no edge longer than `max_edge`, and their boundary.

        Returns the indices of the triangles, ascending, and edges (e, 2) with the triangles on the left (Edelsbrunner,
        Kirkpatrick, Seidel, 1983).
        """
        return self._queries().outline(_length(radius, "radius"), _length(max_edge, "max_edge"))

    def verify(self) -> VerifyReport:
        """Checks the whole mesh exactly, with predicates that share no code with those that made it. O(n)."""
        return report_of(self._host_mesh.verify(self._host_points))

    # To other libraries

    def plot(self, ax: Any = None, **how: Any) -> Any:
        """Draws the triangles with matplotlib (``triplot``) and returns the axes."""
        return _show.plot(self, ax, how)

    def to_matplotlib(self) -> Any:
        """A ``matplotlib.tri.Triangulation`` of the same arrays."""
        return _show.to_matplotlib(self)

    def to_pyvista(self, z: Any = None) -> Any:
        """A ``pyvista.PolyData``; `z`: heights of the points, else 0."""
        return _show.to_pyvista(self, z)

    def to_meshio(self, z: Any = None) -> Any:
        """A ``meshio.Mesh``; `z`: heights of the points, else the mesh is plane."""
        return _show.to_meshio(self, z)

    def save(self, path: Any, z: Any = None) -> None:
        """Writes ``.npz`` (points, simplices, neighbors), or with meshio what the suffix says (``.ply .vtk .obj .stl``).

        The file appears whole or not at all.
        """
        _show.save(self, path, z)

    # Plumbing

    def __repr__(self) -> str:
        return f"<cadt.Delaunay: {self.n_points:,} points, {self.n_triangles:,} triangles, {self.device}>"

    def __reduce__(self) -> tuple:
        mesh = self._host_mesh
        return _restore, (type(self), self._host_points, mesh.triangles, mesh.neighbors)

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
        return self._points if self._gpu is None else as_points(self._gpu.array.to_host())

    def _cached(self, name: str, of_host: Callable, of_gpu: Callable | None = None) -> Any:
        """An array of the host's mesh, of the kind of array that the points are."""
        if name not in self._cache:
            if self._gpu is None:
                self._cache[name] = of_host(self._mesh)
            elif of_gpu is not None:
                self._cache[name] = of_gpu(self._gpu)
            else:
                self._cache[name] = self._gpu.array.like(of_host(self._host_mesh))
        return self._cache[name]

    def _host(self, name: str, of: Callable) -> Any:
        if name not in self._cache:
            self._cache[name] = of(self._host_mesh)
        return self._cache[name]

    def _empty(self) -> bool:
        return self._any.number_of_triangles == 0

    def _queries(self) -> _cadt.Queries:
        if "queries" not in self._cache:
            self._cache["queries"] = _cadt.Queries(self._host_points, self._host_mesh, self._options)
        return self._cache["queries"]


def grid_of(
    bounds: Sequence[float],
    shape: tuple[int, int] | None,
    resolution: float | tuple[float, float] | None,
    origin: str,
) -> tuple[tuple[float, float, float, float], int, int]:
    """Corner and cell size of a grid (cadt::Grid), rows and columns."""
    if origin not in ("upper", "lower"):
        raise OptionError(f"origin must be 'upper' or 'lower', not {origin!r}", "origin")
    if len(bounds) != 4:
        raise InputError("bounds are (xmin, ymin, xmax, ymax)", 0)
    x0, y0, x1, y1 = (float(b) for b in bounds)
    if (shape is None) == (resolution is None):
        raise OptionError("pass either shape=(rows, columns) or resolution=", "shape")
    if not (math.isfinite(x1 - x0) and math.isfinite(y1 - y0)) or x1 < x0 or y1 < y0:
        raise InputError(f"bounds must be finite, xmin <= xmax and ymin <= ymax, not {tuple(bounds)}", 0)
    if resolution is not None:
        dx, dy = (float(r) for r in (resolution if isinstance(resolution, (tuple, list)) else (resolution, resolution)))
        if not (dx > 0 and dy > 0 and math.isfinite(dx) and math.isfinite(dy)):
            raise OptionError(f"resolution must be positive, not {resolution}", "resolution")
        columns, rows = (max(1, math.ceil((b - a) / d - 1e-9)) for a, b, d in ((x0, x1, dx), (y0, y1, dy)))
    else:
        try:
            rows, columns = (operator.index(s) for s in shape)  # type: ignore[union-attr]
        except (TypeError, ValueError):
            raise OptionError(f"shape must be two whole numbers (rows, columns), not {shape!r}", "shape") from None
        if rows < 1 or columns < 1:
            raise OptionError(f"shape must be (rows, columns), 1 or more, not {shape}", "shape")
        dx, dy = (x1 - x0) / columns, (y1 - y0) / rows
    if rows * columns >= 2**31:
        raise LimitError(
            f"a raster has fewer than 2**31 cells, not {rows:,} x {columns:,}: take larger cells, or several rasters",
            rows * columns,
            2**31 - 1,
        )
    return ((x0, y1, dx, -dy) if origin == "upper" else (x0, y0, dx, dy)), rows, columns


def _indices(a: Any, what: str) -> np.ndarray:
    a = np.asarray(a)
    if a.ndim != 2 or a.shape[1] != 3 or a.dtype.kind not in "iu":
        raise InputError(f"{what} must be integers of shape (t, 3), not {a.dtype} of {a.shape}", 0)
    if a.size and (a.max() > np.iinfo(np.int32).max or a.min() < -1):
        raise InputError(f"{what} must lie between -1 and 2**31 - 1", 0)
    return np.array(a, dtype=np.int32, order="C")


def _one_of(value: str, names: Sequence[str], option: str) -> None:
    if value not in names:
        raise OptionError(f"{option} must be one of {', '.join(map(repr, names))}, not {value!r}", option)


def _length(value: float | None, option: str) -> float:
    result = math.inf if value is None else float(value)
    if not result >= 0:
        raise OptionError(f"{option} must be a number and not negative, not {value}", option)
    return result


def _finite(q: np.ndarray) -> None:
    bad = ~np.isfinite(q).all(axis=1)
    if bad.any():
        first = int(np.argmax(bad))
        raise InputError(f"query {first} is not finite", first)


def _restore(cls: type[Delaunay], points: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray) -> Delaunay:
    self = cls.__new__(cls)
    self._points, self._gpu, self._cache = points, None, {}
    self._options = _devices.make_options("host", None, "canonical", None, None, "counters")
    self._mesh = _cadt.adopt(points, simplices, neighbors, False)
    return self
