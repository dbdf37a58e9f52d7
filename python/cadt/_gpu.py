# SPDX-License-Identifier: Apache-2.0
"""Meshes in the memory of a device, and what they can be asked there: results are arrays of the points' library."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cadt import _cadt, _devices
from cadt._arrays import Array
from cadt._errors import BackendUnavailable, InputError, OptionError
from cadt._points import as_points, as_queries, as_values, is_x_and_y


class Mesh:
    """A mesh in device memory and what it can be asked."""

    def __init__(self, array: Array, arguments: tuple, report: Any) -> None:
        backend, device, order, threads, max_memory, statistics = arguments
        if backend not in (None, array.backend):
            raise OptionError(
                f"the points are in the memory of a device ({array.backend}): leave backend out, or pass points of the host",
                "backend",
            )
        if device is not None:
            raise OptionError("points on a device are triangulated there: leave device out", "device")
        if statistics == "none":
            raise OptionError("statistics='none' would not wait for the device; use 'counters'", "statistics")
        self.array = array
        self.options = _devices.make_options(
            array.backend, array.device, order, threads, max_memory, statistics, array.queue
        )
        key = (array.backend, array.device, threads, array.queue)
        self.triangulator = array.triangulator = _devices.open_device(self.options, key, array.stream)
        if self.triangulator.backend != array.backend:
            raise BackendUnavailable("the device of the points cannot be used", array.backend, "")
        self.points = array.coordinates(array.a)
        array.begin()
        self.mesh = self._triangulate(report)
        self._queries: Any = None

    def _triangulate(self, report: Any) -> Any:
        return _cadt.triangulate_on_device(self.triangulator, self.points, self.options, report)

    @property
    def simplices(self) -> Any:
        return self.array.words(self.mesh, "triangles", (self.mesh.number_of_triangles, 3))

    @property
    def neighbors(self) -> Any:
        return self.array.words(self.mesh, "neighbors", (self.mesh.number_of_triangles, 3))

    def points_on_host(self) -> np.ndarray:
        return as_points(self.array.to_host())

    def bounds(self) -> tuple[float, float, float, float]:
        _devices.refuse_after_fork()
        if self.mesh.number_of_points == 0:
            raise InputError("without points there are no bounds: pass bounds=", 0)
        return self.array.bounds()

    def _ask(self) -> Any:
        self.array.begin()
        if self._queries is None:
            self._queries = _cadt.DeviceQueries(self.mesh, self.points)
        return self._queries

    @property
    def _is_empty(self) -> bool:
        """Without triangles there is nothing on the device to ask: all queries are outside."""
        return self.mesh.number_of_triangles == 0

    def _on_host(self) -> _cadt.Queries:
        """A mesh of the host without triangles, which refuses what is not finite."""
        none, options = np.empty((0, 2)), self.options.on_host()
        return _cadt.Queries(none, _cadt.triangulate(none, options), options)

    def _filled(self, shape: tuple[int, ...], value: float) -> Any:
        return self.array.like(np.full(shape, value))

    def _nowhere(self, shape: tuple[int, ...]) -> Any:
        return self.array.like(np.full(shape, -1, dtype=np.int32))

    def _rows(self, xi: Any) -> tuple[Any, tuple[int, ...]]:
        _devices.refuse_after_fork()
        if is_x_and_y(xi):
            x, y = xi
            here = self.array.is_here(x) and self.array.is_here(y) and tuple(x.shape) == tuple(y.shape)
            xi = self.array.stack([x, y]) if here else tuple(map(self._as_host, xi))
        if not self.array.is_here(xi):
            q, shape = as_queries(xi)
            xi = self.array.like(q.astype(np.float64).reshape(*shape, 2))
        if len(xi.shape) == 0 or xi.shape[-1] != 2:
            raise InputError(f"queries must have shape (..., 2), not {tuple(xi.shape)}", 0)
        shape = tuple(xi.shape[:-1])
        rows = self.array.rows(xi.reshape(math.prod(shape), 2), "queries")
        if self._is_empty:
            self._on_host().locate(self.array.host_of(rows))
        return rows, shape

    def _as_host(self, a: Any) -> Any:
        return self.array.host_of(a) if self.array.is_here(a) else a

    def within_hull(self, xi: Any) -> Any:
        return self.array.flags(self.find_simplex(xi) + 1)

    def find_simplex(self, xi: Any) -> Any:
        q, shape = self._rows(xi)
        if self._is_empty:
            return self._nowhere(shape)
        result = self.array.empty(shape, "int32")
        self._ask().locate(self.array.coordinates(q), self.array.memory(result))
        return self.array.finished(result)

    def barycentric(self, xi: Any) -> tuple[Any, Any]:
        q, shape = self._rows(xi)
        if self._is_empty:
            return self._nowhere(shape), self._filled((*shape, 3), np.nan)
        triangles, weights = self.array.empty(shape, "int32"), self.array.empty((*shape, 3), "float64")
        self._ask().barycentric(self.array.coordinates(q), self.array.memory(triangles), self.array.memory(weights))
        return self.array.finished(triangles), self.array.finished(weights)

    def nearest_vertex(self, xi: Any, k: int) -> Any:
        q, shape = self._rows(xi)
        if self._is_empty:
            return self._nowhere(shape if k == 1 else (*shape, k))
        result = self.array.empty(shape if k == 1 else (*shape, k), "int32")
        self._ask().nearest(self.array.coordinates(q), k, self.array.memory(result))
        return self.array.finished(result)

    def _values(self, values: Any) -> tuple[Any, tuple[int, ...]]:
        _devices.refuse_after_fork()
        n = self.mesh.number_of_points
        if not self.array.takes(values):
            host, one = as_values(values, n)
            return self.array.like(host.reshape(n, *one)), one
        v = self.array.take(values, "float64")
        if len(v.shape) == 0 or v.shape[0] != n:
            raise InputError(f"values must have shape ({n},) or ({n}, m): one row a point, not {tuple(v.shape)}", 0)
        return v, tuple(v.shape[1:])

    def interpolate(self, values: Any, xi: Any, method: str, outside: str) -> Any:
        v, one = self._values(values)
        q, shape = self._rows(xi)
        if self._is_empty or math.prod(one) == 0:
            return self._filled((*shape, *one), np.nan)
        result = self.array.empty((*shape, *one), "float64")
        memory = self.array.memory
        self._ask().interpolate(memory(v), self.array.coordinates(q), memory(result), method, outside)
        return self.array.finished(result)

    def rasterize(self, values: Any, grid: tuple, rows: int, columns: int, method: str, max_edge: float) -> Any:
        v, one = self._values(values)
        m = math.prod(one)
        if self._is_empty and m != 0:
            self._on_host().rasterize(grid, columns, rows, np.empty((0, 1)), method, max_edge)
        if self._is_empty or m == 0:
            return self._filled((rows, columns, *one), np.nan)
        # The library makes a raster of one value a point.
        rasters = []
        of = v.reshape(v.shape[0], m)
        for j in range(m):
            raster = self.array.empty((rows, columns), "float64")
            column, memory = self.array.column(of, j), self.array.memory
            self._ask().rasterize(grid, columns, rows, memory(column), memory(raster), method, max_edge)
            rasters.append(self.array.finished(raster))
        return rasters[0] if not one else self.array.stack(rasters).reshape(rows, columns, *one)

    def circumcenters(self) -> Any:
        if self._is_empty:
            return self._filled((0, 2), np.nan)
        result = self.array.empty((self.mesh.number_of_triangles, 2), "float64")
        self._ask().circumcenters(self.array.memory(result))
        return self.array.finished(result)


class ConstrainedMesh(Mesh):
    """A mesh with segments in device memory."""

    def __init__(
        self, array: Array, segments: Any, constraints: Any, has_domain: bool, arguments: tuple, report: Any
    ) -> None:
        self.segments, self._constraints, self._has_domain = segments, constraints, has_domain
        super().__init__(array, arguments, report)
        mesh = self.mesh
        self._given, self._shape = int(array.a.shape[0]), (mesh.number_of_points, 2)
        self.all_points: Any = None  # where they are not the points that were given
        if mesh.all_points_handle:
            self.all_points = array.doubles(mesh, "all_points", self._shape)
            self.points = _cadt.DevicePoints(mesh.all_points_handle, mesh.number_of_points, False)

    def _triangulate(self, report: Any) -> Any:
        arguments = (self.points, self.array.memory(self.segments), self._constraints, self.options, report)
        return _cadt.triangulate_constrained_on_device(self.triangulator, *arguments)

    def points_on_host(self) -> np.ndarray:
        if self.all_points is None:
            return super().points_on_host()
        return self.array.doubles_on_host(self.mesh, "all_points", self._shape)

    def bounds(self) -> tuple[float, float, float, float]:
        if self.all_points is None:
            return super().bounds()
        xy = self.points_on_host()
        (x0, y0), (x1, y1) = xy.min(axis=0).tolist(), xy.max(axis=0).tolist()
        return (x0, y0, x1, y1)

    @property
    def added_points(self) -> Any:
        if self.all_points is None:
            return self.array.finished(self.array.empty((0, 2), "float64"))
        return self.all_points[self._given :]

    @property
    def added_parents(self) -> Any:
        return self.array.words(self.mesh, "added_parents", (self.mesh.number_added, 2))

    @property
    def edge_flags(self) -> Any:
        return self._of_triangles("edge_flags")

    @property
    def chains(self) -> tuple[Any, Any] | None:
        if self.mesh.chain_length >= 2**31:  # no int32
            return None
        offsets = self.array.words(self.mesh, "chain_offsets", (self.segments.shape[0] + 1,))
        return offsets, self.array.words(self.mesh, "chain_vertices", (self.mesh.chain_length,))

    # Domains: none of these without one, but for the triangles inside.

    @property
    def number_inside(self) -> int:
        return self.mesh.number_inside if self._has_domain else self.mesh.number_of_triangles

    @property
    def triangles_inside(self) -> Any:
        if not self._has_domain:
            return self.simplices
        return self.array.words(self.mesh, "triangles_inside", (self.mesh.number_inside, 3))

    @property
    def inside(self) -> Any:
        return self.array.flags(self._of_triangles("inside")) if self._has_domain else None

    @property
    def region(self) -> Any:
        return self._of_triangles("regions") if self._has_domain else None

    @property
    def region_value(self) -> Any:
        if not self._has_domain:
            return None
        return self.array.words(self.mesh, "region_values", (self.mesh.number_of_regions,))

    @property
    def region_attribute(self) -> Any:
        if not self._has_domain or self.mesh.number_of_regions == 0:
            return None
        return self.array.doubles(self.mesh, "region_attributes", (self.mesh.number_of_regions,))

    def _of_triangles(self, which: str) -> Any:
        return self.array.words(self.mesh, which, (self.mesh.number_of_triangles,))
