# SPDX-License-Identifier: Apache-2.0
"""What a mesh can be asked: the part of `Mesh` that other points, values and grids come to."""

from __future__ import annotations

import math
import operator
import reprlib
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices
from cadt._errors import InputError, LimitError, OptionError
from cadt._points import as_queries, as_values
from cadt._results import Voronoi

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cadt import _gpu

_METHODS = ("linear", "nearest", "natural")


class Queries:
    """Base of `Mesh`. A mesh without triangles answers as one that all queries are outside of.

    Queries `xi` are an array of shape (..., 2), or a tuple of two arrays: x and y, of which one may be a number.
    """

    _gpu: _gpu.Mesh | None
    _cache: dict[str, Any]
    _options: _cadt.Options
    _points: Any
    if TYPE_CHECKING:

        @property
        def n_points(self) -> int: ...
        @property
        def n_triangles(self) -> int: ...
        @property
        def _host_mesh(self) -> _cadt.Triangulation: ...
        @property
        def _host_points(self) -> np.ndarray: ...

    def find_simplex(self, xi: Any) -> Any:
        """The triangle that contains each query: int32, -1 outside.

        Exact. Hull and edges belong to the mesh; on an edge or vertex it is the lowest triangle. O(log n) each, and a
        walk of a few triangles, which is long between two far rows of points.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            A tuple of two arrays is x and y.

        >>> Delaunay([[0, 0], [1, 0], [0, 1]]).find_simplex([[0.5, 0.5], [0.6, 0.6]])
        array([ 0, -1], dtype=int32)
        """
        if self._gpu is not None:
            return self._gpu.find_simplex(xi)
        q, shape = as_queries(xi)
        return self._queries().locate(q).reshape(shape)

    def barycentric(self, xi: Any) -> tuple[Any, Any]:
        """`find_simplex`, and barycentric coordinates there: (...) int32 and (..., 3) float64, NaN outside.

        A tuple of two arrays is x and y, as in all queries.
        """
        if self._gpu is not None:
            return self._gpu.barycentric(xi)
        q, shape = as_queries(xi)
        triangles, weights = self._queries().barycentric(q)
        return triangles.reshape(shape), weights.reshape(*shape, 3)

    def within_hull(self, xi: Any) -> Any:
        """Whether each query lies in the convex hull, its boundary included. Exact. A tuple of two arrays is x and y."""
        if self._gpu is not None:
            return self._gpu.within_hull(xi)
        q, shape = as_queries(xi)
        return self._queries().within_hull(q).view(bool).reshape(shape)

    def nearest_vertex(self, xi: Any, k: int = 1) -> Any:
        """The k nearest points of each query: (...) int32, or (..., k) for k > 1; -1 where there are no more.

        Exact, nearest first, equally near ones by index; but of those at the very smallest distance only the first is
        certain to be the lowest, and the others may be any of them. A tuple of two arrays is x and y.

        Raises
        ------
        OptionError
            `k` is below 1, or 2**31 and more.
        LimitError
            There are 2**31 answers or more.

        >>> Delaunay([[0, 0], [1, 0], [0, 1]]).nearest_vertex([0.9, 0.2])
        array(1, dtype=int32)
        """
        k = operator.index(k)
        if not 1 <= k < 2**31:
            raise OptionError(f"k must be 1 or more, and below 2**31, not {_short(k)}", "k")
        if self._gpu is not None:
            return self._gpu.nearest_vertex(xi, k)
        q, shape = as_queries(xi)
        wanted = shape if k == 1 else (*shape, k)
        most = max(self.n_points, 1)
        if k <= most or len(q) * k >= 2**31:  # so many are refused
            return self._queries().nearest(q, k).reshape(wanted)
        result = np.full(wanted, -1, dtype=np.int32)
        result[..., :most] = self._queries().nearest(q, most).reshape(*shape, most)
        return result

    def interpolate(self, values: Any, xi: Any, method: str = "linear", *, outside: str = "nan") -> Any:
        """Values between the points: (..., m...) float64 for values of shape (n, m...).

        Parameters
        ----------
        values : array_like, shape (n,) or (n, m)
        xi : array_like, shape (..., 2)
            A tuple of two arrays is x and y.
        method : {"linear", "nearest", "natural"}
            Natural neighbours (Sibson, 1981) are smooth except at the points.
        outside : {"nan", "nearest"}
            What queries outside the convex hull get.

        >>> mesh = Delaunay([[0, 0], [1, 0], [0, 1]])
        >>> float(mesh.interpolate([0, 10, 20], [0.25, 0.25]))
        7.5
        """
        _one_of(method, _METHODS, "method")
        _one_of(outside, ("nan", "nearest"), "outside")
        if self._gpu is not None:
            return self._gpu.interpolate(self._complete(values), xi, method, outside)
        v, one = self._values(values)
        q, shape = as_queries(xi)
        if v.shape[1] == 0:
            return np.empty((*shape, *one))
        found = self._queries().interpolate(v, q, method, outside)
        if len(v) == 0:  # no points: the library cannot know how many values each would have
            return np.full((*shape, *one), np.nan)
        return found.reshape((*shape, *one))

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

        Raises
        ------
        InputError
            `values` are not one row a point, or `bounds` or `resolution` are not so many finite numbers in order.
        OptionError
            Another argument is none of the above; neither or both of `shape` and `resolution` are given.
        LimitError
            There are 2**31 cells or more.
        """
        _one_of(method, _METHODS, "method")
        longest = _length(max_edge, "max_edge")
        points = self._points if self._gpu is None else None
        if bounds is None:
            if points is None:
                bounds = self._gpu.bounds()  # type: ignore[union-attr]
            elif len(points) == 0:
                raise InputError("without points there are no bounds: pass bounds=", 0)
            else:
                low, high = points.min(axis=0), points.max(axis=0)
                bounds = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
            if shape is not None and (bounds[0] == bounds[2] or bounds[1] == bounds[3]):
                raise InputError("all points have one x or one y, so that cells would have no area: pass bounds=", 0)
        return self._raster(values, *grid_of(bounds, shape, resolution, origin), method, longest)

    def _raster(
        self,
        values: Any,
        grid: tuple[float, float, float, float],
        rows: int,
        columns: int,
        method: str = "linear",
        max_edge: float = math.inf,
    ) -> Any:
        """`rasterize` on a grid by its corner and the size of its cells (cadt::Grid)."""
        if self._gpu is not None:
            return self._gpu.rasterize(self._complete(values), grid, rows, columns, method, max_edge)
        v, one = self._values(values)
        if v.shape[1] == 0:
            return np.empty((rows, columns, *one))
        # The library makes a raster of one value a point.
        rasters = [
            self._queries().rasterize(grid, columns, rows, np.ascontiguousarray(v[:, [j]]), method, max_edge)
            for j in range(v.shape[1])
        ]
        result = rasters[0] if len(rasters) == 1 else np.stack(rasters, axis=-1)
        return result.reshape(rows, columns, *one)

    def circumcenters(self) -> Any:
        """The circumcentre of each triangle: (t, 2) float64."""
        if self._gpu is not None:
            return self._gpu.circumcenters()
        return self._queries().circumcenters()

    def voronoi(self) -> Voronoi:
        """The Voronoi diagram, as arrays of the host."""
        return Voronoi(*self._queries().voronoi())

    def voronoi_polygons(self, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """The Voronoi cells within a box (xmin, ymin, xmax, ymax): ``indptr`` (n + 1,) and ``xy`` (k, 2).

        That of point p is ``xy[indptr[p]:indptr[p + 1]]``, counterclockwise. Raises InputError for what is no box.
        """
        return self._queries().voronoi_polygons(_box(box, "the box is"))

    def largest_empty_circles(self, k: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The k largest circumcircles of triangles, which have no point inside, with the centre in the hull, largest first.

        Returns their centres (k, 2), radii (k,) and triangles (k,); fewer if there are no more. Cocircular points give a
        circle for each of their triangles. A larger circle can have its centre on the boundary of the hull, where it is no
        circumcentre.
        """
        k = operator.index(k)
        if k < 0:
            raise OptionError(f"k must not be negative, but it is {k}", "k")
        return self._queries().largest_empty_circles(min(k, self.n_triangles))  # there are no more

    def alpha_shape(self, radius: float, *, max_edge: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The triangles with a circumradius of at most `radius` and no edge longer than `max_edge`, and their boundary.

        Returns the indices of the triangles, ascending, and edges (e, 2) with the triangles on the left (Edelsbrunner,
        Kirkpatrick, Seidel, 1983). Raises OptionError for what is no length.
        """
        return self._queries().outline(_length(radius, "radius"), _length(max_edge, "max_edge"))

    def _values(self, values: Any) -> tuple[np.ndarray, tuple[int, ...]]:
        return as_values(self._complete(values), self.n_points)

    def _complete(self, values: Any) -> Any:
        """Values of the points that were given, as those of all points."""
        return values

    def _queries(self) -> _cadt.Queries:
        if "queries" not in self._cache:
            self._cache.setdefault("queries", self._queries_of(self._host_points, self._host_mesh))
        return self._cache["queries"]

    def _queries_of(self, points: np.ndarray, mesh: Any) -> _cadt.Queries:
        return _cadt.Queries(points, mesh, _devices.for_queries(self._options))


def cells_along(length: float, cell: float) -> float:
    """Cells that cover a length. What is whole but for the rounding of decimals (2.1 / 0.3) is whole."""
    exact = length / cell
    if not math.isfinite(exact):
        return exact
    whole = float(round(exact))
    return whole if whole >= 1 and abs(exact - whole) <= min(1e-9 * whole, 1e-3) else float(math.ceil(exact))


def grid_of(
    bounds: Sequence[float],
    shape: tuple[int, int] | None,
    resolution: float | tuple[float, float] | None,
    origin: str,
) -> tuple[tuple[float, float, float, float], int, int]:
    """Corner and cell size of a grid (cadt::Grid), rows and columns."""
    if origin not in ("upper", "lower"):
        raise OptionError(f"origin must be 'upper' or 'lower', not {origin!r}", "origin")
    x0, y0, x1, y1 = _box(bounds, "bounds are")
    if (shape is None) == (resolution is None):
        raise OptionError("pass either shape=(rows, columns) or resolution=", "shape")
    if not (math.isfinite(x1 - x0) and math.isfinite(y1 - y0)) or x1 < x0 or y1 < y0:
        raise InputError(f"bounds must be finite, xmin <= xmax and ymin <= ymax, not {tuple(bounds)}", 0)
    if resolution is not None:
        dx, dy = _two_numbers(resolution)
        if not (dx > 0 and dy > 0 and math.isfinite(dx) and math.isfinite(dy)):
            raise OptionError(f"resolution must be positive, not {resolution}", "resolution")
        # There may be more than the largest double, which are too many as well.
        most = sys.float_info.max
        columns, rows = (max(1, int(min(cells_along(b - a, d), most))) for a, b, d in ((x0, x1, dx), (y0, y1, dy)))
    else:
        try:
            rows, columns = (operator.index(s) for s in shape)  # type: ignore[union-attr]
        except (TypeError, ValueError):
            raise OptionError(f"shape must be two whole numbers (rows, columns), not {shape!r}", "shape") from None
        if rows < 1 or columns < 1:
            raise OptionError(f"shape must be (rows, columns), 1 or more, not {shape}", "shape")
    if rows * columns >= 2**31:
        raise LimitError(
            f"a raster has fewer than 2**31 cells, not {_short(rows)} x {_short(columns)}: take larger cells, or several rasters",
            rows * columns,
            2**31 - 1,
        )
    if resolution is None:
        dx, dy = (x1 - x0) / columns, (y1 - y0) / rows
    return ((x0, y1, dx, -dy) if origin == "upper" else (x0, y0, dx, dy)), rows, columns


def _box(given: Any, what: str) -> tuple[float, float, float, float]:
    try:
        x0, y0, x1, y1 = (float(b) for b in given)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{what} four numbers (xmin, ymin, xmax, ymax), not {reprlib.repr(given)}", 0) from None
    return x0, y0, x1, y1


def _two_numbers(resolution: Any) -> tuple[float, float]:
    try:
        sizes = np.asarray(resolution, dtype=np.float64)
        if sizes.shape not in ((), (2,)):
            raise ValueError
    except (TypeError, ValueError):
        raise InputError(f"resolution is one number or two, (dx, dy), not {resolution!r}", 0) from None
    return float(sizes.flat[0]), float(sizes.flat[-1])


def _short(n: int) -> str:
    if -(2**40) < n < 2**40:
        return f"{n:,}"
    return f"-2**{n.bit_length() - 1} or less" if n < 0 else f"2**{n.bit_length() - 1} or more"


def _one_of(value: str, names: Sequence[str], option: str) -> None:
    if value not in names:
        raise OptionError(f"{option} must be one of {', '.join(map(repr, names))}, not {value!r}", option)


def _length(value: float | None, option: str) -> float:
    try:
        result = math.inf if value is None else float(value)
    except (TypeError, ValueError):
        result = math.nan
    except OverflowError:  # a whole number beyond all doubles
        result = math.inf if value > 0 else math.nan  # type: ignore[operator]
    if not result >= 0:
        raise OptionError(f"{option} must be a number and not negative, not {reprlib.repr(value)}", option)
    return result
