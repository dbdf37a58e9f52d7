# SPDX-License-Identifier: Apache-2.0
"""SciPy's interpolators of scattered points, and natural neighbours."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator as _CloughTocher
from scipy.interpolate import LinearNDInterpolator as _Linear
from scipy.interpolate import NearestNDInterpolator as _Nearest
from scipy.interpolate import griddata as _griddata
from scipy.spatial import Delaunay as _Triangulation
from scipy.spatial import cKDTree

import cadt
from cadt.scipy._delaunay import Delaunay, locate, queries
from cadt.scipy._qhull import say

if TYPE_CHECKING:
    from collections.abc import Sequence


def coordinates(points: Any, ndim: int | None = None) -> np.ndarray:
    """Points as SciPy's interpolators take them: an array (..., ndim) or a tuple of arrays, which are broadcast."""
    if isinstance(points, tuple) and len(points) == 1:
        points = points[0]
    if isinstance(points, tuple):
        parts = np.broadcast_arrays(*points)
        result = np.empty((*parts[0].shape, len(parts)))
        for k, part in enumerate(parts):
            result[..., k] = part
        return result
    points = np.asarray(points)
    if points.ndim == 1:
        points = points.reshape(-1, 1 if ndim is None else ndim)
    return points


def regular_grid(args: Sequence[Any]) -> tuple[np.ndarray, np.ndarray, bool] | None:
    """The x and y of queries that are all pairs of them, as numpy.meshgrid and mgrid make them, and whether x changes
    with the row; None for other queries, and for few."""
    xi = args[0] if len(args) == 1 else tuple(args)
    if isinstance(xi, tuple):
        if len(xi) != 2:
            return None
        x, y = np.broadcast_arrays(*xi)
    else:
        xi = np.asarray(xi)
        if xi.ndim != 3 or xi.shape[-1] != 2:
            return None
        x, y = xi[..., 0], xi[..., 1]
    if x.ndim != 2 or min(x.shape) < 2 or x.size < 10_000 or not {x.dtype.kind, y.dtype.kind} <= set("iuf"):
        return None
    for rows_are_x in (False, True):
        a, b = (x.T, y.T) if rows_are_x else (x, y)
        if a[0, 0] == a[-1, 0] and b[0, 0] == b[0, -1] and (a == a[0]).all() and (b == b[:, :1]).all():
            return a[0].astype(np.float64), b[:, 0].astype(np.float64), rows_are_x
    return None


def as_triangulation(points: Any) -> Any:
    """A mesh of cadt's as the triangulation that SciPy's interpolators know; else what was given."""
    return Delaunay(points) if isinstance(points, cadt.Delaunay) else points


class _OnMesh:
    """What the interpolators share: their triangulation is cadt's if the points are in the plane."""

    tri: Any
    values: np.ndarray
    scale: Any
    _method = "linear"

    def __init__(self, points: Any, *args: Any, **how: Any) -> None:
        super().__init__(as_triangulation(points), *args, **how)  # type: ignore[call-arg]  # SciPy's class

    def _calculate_triangulation(self, points: np.ndarray) -> None:
        self.tri = Delaunay(points)

    def _is_ours(self) -> bool:
        return isinstance(self.tri, Delaunay) and self.tri.mesh is not None

    def _rows(self, args: Sequence[Any]) -> tuple[np.ndarray, tuple[int, ...]]:
        """Scaled queries as rows, and the shape of the answers."""
        xi = coordinates(tuple(args), ndim=2)
        if xi.shape[-1] != 2:
            raise ValueError("number of dimensions in xi does not match x")
        x = queries(xi)
        if self.scale is not None:
            x = (x - self.offset) / self.scale  # type: ignore[attr-defined]
        return x, xi.shape[:-1]

    def _evaluate(self, x: np.ndarray) -> np.ndarray:
        """(q, m) values, real or complex; `fill_value` outside."""
        tri, values = self.tri, self.values
        is_complex = values.dtype.kind == "c"
        if is_complex:
            values = np.ascontiguousarray(values, dtype=np.complex128).view(np.float64)
        try:
            result = tri.mesh.interpolate(values, x, self._method)
        except ValueError:
            finite = np.isfinite(x).all(axis=1)
            if finite.all():
                raise
            result = np.full((len(x), values.shape[1]), np.nan)
            result[finite] = tri.mesh.interpolate(values, x[finite], self._method)
        # NaN: outside, or values that are NaN.
        unknown = np.flatnonzero(np.isnan(result[:, 0]) if result.shape[1] == 1 else np.isnan(result).any(axis=1))
        if unknown.size:
            unknown = unknown[locate(tri.mesh, x[unknown]) < 0]
            finite = unknown[np.isfinite(x[unknown]).all(axis=1)]
            rows, on_edge = tri._hull_finder.interpolate(values, x[finite].astype(np.double, copy=False))
            fill = np.array(self.fill_value)  # type: ignore[attr-defined]
            result[unknown] = [fill.real, fill.imag] * (values.shape[1] // 2) if is_complex else fill
            result[finite[rows]] = on_edge
        return result.view(np.complex128) if is_complex else result

    def _call(self, args: Sequence[Any]) -> np.ndarray:
        grid = regular_grid(args) if self._method == "linear" and self.values.shape[1] == 1 else None
        result = None if grid is None else self._raster(*grid)
        if result is None:
            x, shape = self._rows(args)
            result = self._evaluate(x)
        else:
            shape = result.shape
        return result.reshape(shape + self.values_shape)  # type: ignore[attr-defined]

    def _raster(self, x: np.ndarray, y: np.ndarray, rows_are_x: bool) -> np.ndarray | None:
        """Values at all (x, y), which is quicker than one by one; None if x or y are not equidistant, finite and distinct.

        Cells are where the library computes them: not further from where they were given than rounding is, and than
        1e-11 of the grid's extent.
        """
        if self.values.dtype.kind == "c":
            return None
        for a in (x, y):
            if a[0] == a[-1] or not np.isfinite(a).all() or not np.isfinite(float(a[-1]) - float(a[0])):
                return None
            exact = a[0] + (a[-1] - a[0]) / (len(a) - 1) * np.arange(len(a))
            rounding = 4 * np.finfo(np.double).eps * np.abs(a).max()
            if not (np.abs(exact - a).max() <= rounding <= 1e-11 * abs(a[-1] - a[0])):
                return None
        axes = [x, y]
        if self.scale is not None:
            axes = [(a - self.offset[k]) / self.scale[k] for k, a in enumerate(axes)]  # type: ignore[attr-defined]
        steps = [(a[-1] - a[0]) / (len(a) - 1) for a in axes]
        if not all(steps):  # so small that nothing is left of them
            return None
        corner = [a[0] - step / 2 for a, step in zip(axes, steps)]
        raster = self.tri.mesh._raster(self.values[:, 0], (*corner, *steps), len(y), len(x))
        if rows_are_x:
            raster = np.ascontiguousarray(raster.T)
        # Outside, or at the hull, or values that are NaN: one by one.
        at = np.nonzero(np.isnan(raster))
        i, j = at if rows_are_x else at[::-1]
        if i.size:
            raster[at] = self._evaluate(np.stack([axes[0][i], axes[1][j]], axis=1))[:, 0]
        return raster


class LinearNDInterpolator(_OnMesh, _Linear):
    """Linear interpolation with the interface of `scipy.interpolate.LinearNDInterpolator`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay (cadt's or cadt.scipy's)
        With more columns, or SciPy's triangulation, this is SciPy's interpolator.
    values : array_like of real or complex, shape (npoints, ...)
    fill_value : float
        Outside of the convex hull.
    rescale : bool
        Whether the points are scaled to the unit square first.

    The result has the shape of the queries and that of one point's values. All queries are computed at once, in threads.
    Those of large regular grids are as a raster's: at places that rounding moves, by 1e-11 of the grid's extent at most.

    >>> ip = LinearNDInterpolator([[0, 0], [1, 0], [0, 1]], [0, 10, 20])
    >>> ip(0.25, 0.25), ip([[0.5, 0.5], [2, 2]])
    (array(7.5), array([15., nan]))
    """

    def __call__(self, *args: Any, **how: Any) -> np.ndarray:
        if not self._is_ours() or how:
            return super().__call__(*args, **how)
        return self._call(args)


class NaturalNeighborInterpolator(_OnMesh, _Linear):
    """Natural neighbour interpolation (Sibson, 1981): smooth except at the points, and exact for linear functions.

    Parameters as for `LinearNDInterpolator`, in the plane alone.

    >>> ip = NaturalNeighborInterpolator([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]], [0, 0, 0, 0, 1])
    >>> ip(1, 0.5)
    array(0.5)
    """

    _method = "natural"

    def __init__(self, points: Any, values: Any, fill_value: Any = np.nan, rescale: bool = False) -> None:
        if isinstance(points, _Triangulation) and getattr(points, "mesh", None) is None:
            points = points.points
        super().__init__(points, values, fill_value=fill_value, rescale=rescale)
        if not self._is_ours():
            raise ValueError("natural neighbours need points of shape (n, 2)")

    def __call__(self, *args: Any) -> np.ndarray:
        return self._call(args)


class CloughTocher2DInterpolator(_OnMesh, _CloughTocher):
    """`scipy.interpolate.CloughTocher2DInterpolator` on cadt's triangulation: gradients and values are SciPy's.

    SciPy's gradients are NaN where cubes of edge lengths overflow or underflow. Pass ``rescale=True`` there.
    """


class NearestNDInterpolator(_OnMesh, _Nearest):
    """The nearest point's value, with the interface of `scipy.interpolate.NearestNDInterpolator`.

    Exact: of equally near points the lowest. With `tree_options`, options of ``cKDTree.query``, other dimensions, or
    without any triangle it is SciPy's.

    >>> NearestNDInterpolator([[0, 0], [1, 0], [0, 1]], [5, 6, 7])([[0.9, 0.2], [0, 0]])
    array([6., 5.])
    """

    def __init__(self, x: Any, y: Any, rescale: bool = False, tree_options: dict[str, Any] | None = None) -> None:
        # SciPy's constructor would make the k-d tree: that of its base does the rest.
        super(_Nearest, self).__init__(as_triangulation(x), y, rescale=rescale, need_contiguous=False, need_values=False)
        self.values = np.asarray(y)
        self._tree_options = tree_options
        if self.points.ndim != 2 or self.points.shape[1] != 2:
            say(f"nearest neighbours in {self.points.shape[-1]} dimensions", 3)
            self.tree  # noqa: B018  SciPy's errors are those of its constructor

    def _calculate_triangulation(self, points: np.ndarray) -> None:
        pass

    @cached_property
    def tree(self) -> Any:
        """SciPy's k-d tree of the points."""
        return cKDTree(self.points, **(self._tree_options or {}))

    @cached_property
    def _nearest(self) -> cadt.Delaunay | None:
        """The mesh to ask; None: SciPy's tree."""
        if self.points.ndim != 2 or self.points.shape[1] != 2 or self._tree_options:
            return None
        if self.tri is not None and self._is_ours():
            return self.tri.mesh
        mesh = cadt.Delaunay(np.ascontiguousarray(self.points, dtype=np.float64))
        return mesh if mesh.n_triangles else None

    def __call__(self, *args: Any, **query_options: Any) -> np.ndarray:
        if query_options:
            say("nearest neighbours with options of cKDTree.query", 3)
        if query_options or self._nearest is None:
            return super().__call__(*args, **query_options)
        x, shape = self._rows(args)
        nearest = self._nearest.nearest_vertex(x)
        dtype = self.values.dtype if self.values.dtype.kind == "c" else np.float64
        return self.values[nearest].astype(dtype, copy=False).reshape(shape + self.values.shape[1:])

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name not in ("tree", "_nearest")}


_INTERPOLATORS = {
    "linear": LinearNDInterpolator,
    "natural": NaturalNeighborInterpolator,
    "cubic": CloughTocher2DInterpolator,
}


def griddata(
    points: Any,
    values: Any,
    xi: Any,
    method: str = "linear",
    fill_value: Any = np.nan,
    rescale: bool = False,
) -> np.ndarray:
    """Interpolates scattered points, with the interface of `scipy.interpolate.griddata`.

    Parameters
    ----------
    points : array_like, shape (n, 2), or tuple of two arrays (n,)
        With another number of columns the call is SciPy's.
    values : array_like of real or complex, shape (n, ...)
    xi : array_like, shape (..., 2), or tuple of two arrays that are broadcast
    method : {"linear", "nearest", "cubic", "natural"}
        Natural neighbours are cadt's addition.
    fill_value : float
        Outside of the convex hull, except with "nearest".
    rescale : bool
        Whether the points are scaled to the unit square first.

    >>> griddata([[0, 0], [1, 0], [0, 1]], [0, 10, 20], ([0.25, 0.5], [0.25, 0]), method="linear")
    array([7.5, 5. ])
    """
    points = coordinates(points)
    if points.ndim != 2 or points.shape[1] != 2:
        if method == "natural":
            raise ValueError(f"natural neighbours need points of shape (n, 2), not {points.shape}")
        say(f"griddata in {1 if points.ndim < 2 else points.shape[-1]} dimensions", 3)
        return _griddata(points, values, xi, method, fill_value, rescale)
    if method == "nearest":
        return NearestNDInterpolator(points, values, rescale=rescale)(xi)
    if method not in _INTERPOLATORS:
        raise ValueError(f"unknown method {method!r}: 'linear', 'nearest', 'cubic' or 'natural'")
    return _INTERPOLATORS[method](points, values, fill_value=fill_value, rescale=rescale)(xi)
