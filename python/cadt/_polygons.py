# SPDX-License-Identifier: Apache-2.0
"""Triangles inside many polygons with holes."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cadt import _cadt, _devices, _show
from cadt._arrays import as_host_points
from cadt._errors import InputError
from cadt._points import index_of, unmasked
from cadt._progress import reporter
from cadt._segments import as_offsets
from cadt._wkb import MULTIPOLYGON, POLYGON, lines_of_wkb, offsets_of

if TYPE_CHECKING:
    from collections.abc import Callable


_EMPTY = bytes((1, POLYGON)) + bytes(7)  # a polygon without rings, in WKB


class PolygonProblem(NamedTuple):
    """A polygon without triangles: its number, the reason, and the ring points where it is.

    The reason is "too few points", "not finite", "self-crossing", "ring crosses ring" or "zero area". Of edges that
    cross, `first` and `second` are the points where they begin; of a first ring without points, both are -1.
    """

    polygon: int
    reason: str
    first: int
    second: int


class Polygons:
    """The triangles of many polygons: ``result[p]`` are those of polygon p, (k, 3) int32.

    Attributes
    ----------
    points : (n, 2)
        The points of all rings: the array that was given, where it could be taken as it is. It must not change.
    triangles : (t, 3) int32
        Of all polygons, one after another, counterclockwise; indices of `points`.
    triangle_offsets : (p + 1,) int64
        Polygon p has the triangles ``triangle_offsets[p]`` to ``triangle_offsets[p + 1] - 1``.
    problems : tuple of PolygonProblem
        The polygons that have none, ascending.
    statistics : dict
    """

    def __init__(self, points: np.ndarray, found: Any, index: Any, crs: Any) -> None:
        self.points = points
        self.triangles: np.ndarray = found.triangles
        self.triangle_offsets: np.ndarray = found.triangle_offsets
        self.problems = tuple(PolygonProblem(*p) for p in found.problems)
        self.statistics: dict[str, Any] = found.statistics
        self._index, self._crs = index, crs

    def __len__(self) -> int:
        return len(self.triangle_offsets) - 1

    def __getitem__(self, p: int) -> np.ndarray:
        p = index_of(p, len(self), "polygon")
        return self.triangles[self.triangle_offsets[p] : self.triangle_offsets[p + 1]]

    @property
    def polygon_of(self) -> np.ndarray:
        """(t,) int64: the polygon of each triangle."""
        return np.repeat(np.arange(len(self)), np.diff(self.triangle_offsets))

    def to_geoseries(self) -> Any:
        """The triangles as a ``geopandas.GeoSeries`` of polygons; each has the index of the row that it is of."""
        geopandas, shapely = _show._need("geopandas", "geopandas"), _show._need("shapely", "shapely")
        of = self.polygon_of
        index = of if self._index is None else self._index.take(of)
        return geopandas.GeoSeries(shapely.polygons(self.points[self.triangles]), index=index, crs=self._crs)

    def plot(self, ax: Any = None, values: Any = None, **how: Any) -> Any:
        """Draws the triangles with matplotlib (``tripcolor``), coloured by polygon or by `values`, one a polygon; returns
        the axes."""
        if ax is None:
            ax = _show._need("matplotlib.pyplot", "matplotlib").gca()
        color = np.arange(len(self)) % 12 if values is None else np.asarray(values, dtype=np.float64)
        if color.shape != (len(self),):
            raise InputError(f"values must have shape ({len(self)},): one a polygon, not {color.shape}", 0)
        how.setdefault("cmap", "Paired" if values is None else "viridis")
        if len(self.triangles):  # without the points of others, which may be far away or no numbers
            used, corners = np.unique(self.triangles, return_inverse=True)
            faces = color[self.polygon_of].astype(float)
            ax.tripcolor(*self.points[used].T, corners.reshape(-1, 3), facecolors=faces, **how)
        ax.set_aspect("equal")
        return ax

    def __repr__(self) -> str:
        bad = f", {len(self.problems):,} without" if self.problems else ""
        return f"<cadt.Polygons: {len(self):,} polygons, {len(self.triangles):,} triangles{bad}>"


def polygons(
    geometry: Any,
    ring_offsets: Any = None,
    polygon_offsets: Any = None,
    *,
    backend: str | None = None,
    device: int | str | None = None,
    threads: int | None = None,
    max_memory: int | None = None,
    progress: bool | Callable[[str, float], object] | None = None,
) -> Polygons:
    """Triangulates polygons with holes, each by the constrained Delaunay triangulation of its own points and edges.

    Parameters
    ----------
    geometry : array_like, shape (n, 2); or polygons
        Points of rings, with offsets. Or a ``geopandas.GeoSeries`` or ``GeoDataFrame``, an array or list of shapely's
        polygons and multipolygons, or a list, array or Series of them in WKB (bytes). Each row is one polygon, also one of
        several parts, of which none may cross another; ``GeoSeries.explode`` makes them rows of their own. Heights are
        left out, and so is what is no polygon in a collection (as ``make_valid`` makes them), which WKB may not have.
        Rows that are empty or missing have too few points.
    ring_offsets : array_like of int, shape (r + 1,), optional
        Ring r has the points ``ring_offsets[r]`` to ``ring_offsets[r + 1] - 1``. It may repeat its first point.
    polygon_offsets : array_like of int, shape (p + 1,), optional
        Polygon p has the rings ``polygon_offsets[p]`` to ``polygon_offsets[p + 1] - 1``. Default: each ring is a polygon.

    Raises
    ------
    InputError
        Offsets do not fit; or a row is no polygon, damaged WKB or masked: `index` is the row, where it is known.

    Notes
    -----
    Inside is what an odd number of rings goes around; their directions do not matter. A hole of one point is a vertex of
    the mesh, one of two points an edge; the first ring, also of a row of several parts, must have three. A polygon with a
    defect has no triangles and is listed in `problems`, the others do not suffer; ``GeoSeries.make_valid`` mends most of
    them, or `ConstrainedDelaunay` with its crossings. The other parameters are as for `Delaunay`.

    Examples
    --------
    A square with a hole, and a bow-tie:

    >>> xy = [[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [0, 0], [1, 1], [1, 0], [0, 1]]
    >>> result = cadt.polygons(xy, [0, 4, 7, 11], [0, 2, 3])
    >>> result
    <cadt.Polygons: 2 polygons, 7 triangles, 1 without>
    >>> result.problems
    (PolygonProblem(polygon=1, reason='self-crossing', first=7, second=9),)
    """
    index = crs = None
    if ring_offsets is None:
        if polygon_offsets is not None:
            raise InputError("polygon_offsets need ring_offsets", 0)
        points, rings, of_rings, index, crs = _of_geometries(geometry)
    else:
        points, rings = as_host_points(geometry, "ring points"), as_offsets(ring_offsets, "ring_offsets")
        of_rings = np.arange(len(rings)) if polygon_offsets is None else as_offsets(polygon_offsets, "polygon_offsets")
    options = _devices.make_options(backend, device, "canonical", threads, max_memory, "counters")
    options = _devices.placed(options, len(points))
    with reporter(progress) as report:
        return Polygons(points, _cadt.triangulate_polygons(points, rings, of_rings, options, report), index, crs)


def _of_geometries(geometry: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, Any, Any]:
    """Ring points, offsets of rings and polygons, and a GeoSeries' index and reference system."""
    geometry = getattr(geometry, "geometry", geometry) if hasattr(geometry, "crs") else geometry
    index, crs = getattr(geometry, "index", None), getattr(geometry, "crs", None)
    if callable(index):  # the method of lists
        index = None
    if hasattr(geometry, "__array__"):
        geometry = _as_objects(geometry)
    if isinstance(geometry, (list, tuple, np.ndarray)):
        in_wkb = [isinstance(g, (bytes, bytearray, memoryview)) for g in geometry]
        missing = [type(g).__name__ in ("NoneType", "NAType") or (isinstance(g, float) and g != g) for g in geometry]
        if all(map(operator.or_, in_wkb, missing)) and (any(in_wkb) or not in_wkb):
            in_rows = [_EMPTY if gone else g for g, gone in zip(geometry, missing)]
            points, rings, polygons_ = lines_of_wkb(in_rows, (POLYGON, MULTIPOLYGON))
            return np.ascontiguousarray(points[:, :2]), rings, polygons_, index, crs
        if any(in_wkb):
            first = list(map(operator.or_, in_wkb, missing)).index(False)
            kind = type(geometry[first]).__name__
            raise InputError(
                f"geometry {first} is a {kind}: pass WKB bytes of all polygons in a list, an array or a Series", first
            )
        geometry = [None if gone else g for g, gone in zip(geometry, missing)]
    shapely = _show._need("shapely", "shapely")
    rows = np.atleast_1d(np.asarray(geometry, dtype=object))
    if rows.ndim != 1 or not (shapely.is_geometry(rows) | shapely.is_missing(rows)).all():
        raise InputError(
            "polygons are points with ring_offsets=, a GeoSeries, shapely's geometries, or WKB bytes of all polygons in a "
            "list, an array or a Series",
            0,
        )
    wrong = ~np.isin(shapely.get_type_id(rows), (-1, 3, 6, 7))
    if wrong.any():
        first = int(np.argmax(wrong))
        raise InputError(f"geometry {first} is a {rows[first].geom_type}: pass polygons and multipolygons", first)
    parts, row = shapely.get_parts(rows, return_index=True)
    while (shapely.get_type_id(parts) > 3).any():  # collections have parts in turn
        parts, part = shapely.get_parts(parts, return_index=True)
        row = row[part]
    row, parts = row[shapely.get_type_id(parts) == 3], parts[shapely.get_type_id(parts) == 3]
    rings, part = shapely.get_rings(parts, return_index=True)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    ring_offsets = offsets_of(np.bincount(ring, minlength=len(rings)))
    polygon_offsets = offsets_of(np.bincount(row[part], minlength=len(rows)))
    return xy, ring_offsets, polygon_offsets, index, crs


def _as_objects(rows: Any) -> np.ndarray:
    """An array or Series of any dtype, such as pandas' of Arrow's bytes, as an array of objects."""
    rows = unmasked(rows, "polygons")
    if getattr(getattr(rows, "dtype", None), "kind", "") != "S":
        return np.atleast_1d(np.asarray(rows, dtype=object))
    # numpy makes S93 of bytes, and drops zeros at their ends, such as of coordinates.
    a = np.atleast_1d(np.asarray(rows))
    return np.array([g.ljust(a.itemsize, b"\0") for g in a.flat], dtype=object).reshape(a.shape)
