# SPDX-License-Identifier: Apache-2.0
"""The constrained Delaunay triangulation. Its arrays are in _mesh.py and _domains.py, what it can be asked in _queries.py."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices, _gpu
from cadt._arrays import adapter_of, array_on_device
from cadt._domains import DomainMesh
from cadt._errors import InputError, InternalError, OptionError
from cadt._mesh import read_only
from cadt._points import as_input, as_points, as_values, contiguous
from cadt._progress import reporter
from cadt._results import VerifyReport, report_of
from cadt._segments import constraints_of, segments_of, segments_there

if TYPE_CHECKING:
    from collections.abc import Callable


# Of a mesh on a device, what has to be as on the host.
_COMPARED = (
    *("edge_flags", "inside", "region", "region_value", "region_attribute"),
    *("added_points", "added_parents", "moved_points", "rounded_valid"),
)


class ConstrainedDelaunay(DomainMesh):
    """The triangulation of points that has given segments as edges, and is Delaunay but for them.

    Segments are given as pairs of points, as polylines, as rings, or as several of these; they are numbered in this
    order. It has the arrays of `Delaunay` and answers what that is asked, as far as that holds for a mesh with segments.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        As for `Delaunay`. Points on a GPU stay there, and so does the mesh (see the notes).
    segments : array_like of int, shape (m, 2), optional
        The two points of each. They may repeat, overlap, lie on the hull and end anywhere; points on them divide them.
    polylines, rings : array_like of int, shape (k + 1,), or a pair of arrays, optional
        Offsets as in GeoArrow: polyline i has the points ``offsets[i]`` to ``offsets[i + 1] - 1``. A pair
        ``(offsets, vertices)``: offsets count in this list of points. The last point of a ring is joined with its first;
        one of a single point has no segment.
    crossing : {"error", "exact"} or ("grid", width)
        What becomes of segments that cross. Error: `CrossingError` with all pairs. Exact: crossings become vertices
        (`added_points`), and all decisions are made with their exact places. Grid: all points move to the nearest
        multiples of the width, and segments with them (snap rounding).
    domain : {"hull", "outer", "even_odd", "nonzero", "layers", "seeds"}
        Which triangles are `inside`: all; those enclosed by segments; those an odd number of segments from the outside;
        those with a winding number other than 0; those at an odd depth; those that no hole reaches.
    holes : array_like, shape (h, 2), optional
        With ``domain="seeds"``: places from which holes spread to the next segment, as they do from the outside.
    regions : array_like, shape (r, 3), optional
        With ``domain="seeds"``: x, y and the attribute of the region there (`region_attribute`); of several in one region
        the first one counts. Holes and regions that are beyond the hull are left out.
    backend, device, threads, max_memory, statistics, progress
        As for `Delaunay`.

    Raises
    ------
    CrossingError
        Segments cross (``crossing="error"``); `pairs` has all pairs.
    DomainError
        Segments do not close at the point `vertex`, and the domain is "even_odd" or "nonzero".
    InputError
        As for `Delaunay`; a segment has an end that is no point: `index` is the segment; or what must be integers or numbers
        of some shape are not.
    OptionError
        `crossing` or `domain` is no value above; a place of `holes` or `regions` is not finite, or they come without
        ``domain="seeds"``.

    Notes
    -----
    The result is unique: it depends neither on the order nor on the direction of segments, and is the same from every
    device and equal to CGAL's. With crossings that holds for triangles as places: `added_points` are numbered in the
    order of segments, as points are by theirs. Expected O(n log n) work, and O(log) a triangle that segments cross. The GIL is released;
    Ctrl-C ends a call. Meshes never change, and threads may share them.

    Points on a GPU: segments are int32 or int64 of the same library there, or of the host, as polylines and rings are;
    these are uploaded, being indices. All arrays are of the points' library, and queries are answered on the device.

    - Without a copy, those of the device: `simplices`, `neighbors`, `edge_flags`, `chains`, `triangles_inside`,
      `added_points`, `added_parents`, and, except with ``domain="hull"``, `region`, `region_value`, `region_attribute`;
      so are the `points` of a mesh with crossings or on a grid. `inside` is made of flags there.
    - Made on the host when they are first asked for, and uploaded: all others.
    - Made on the host by the call: a mesh on a grid, and one where the device cannot find what crosses (several segments
      through one place, or very many through the same triangles); the triangles of seeds.

    JAX rounds doubles to float32 unless ``jax_enable_x64`` is set; queries take the doubles. `hash` and `verify` make the
    mesh again on the host, which takes as long as ``backend="host"``, and compare the two: until then the arrays that were
    given must not change.

    Interpolation and rasters take values of the points that were given (`at_crossings` says what crossings get) or of all
    `points`. Nearest points, natural neighbours, Voronoi diagrams and empty circles take a Delaunay mesh: unless all
    segments, and all edges beside rounded crossings, happen to be Delaunay edges they raise `NotDelaunay`; ask ``Delaunay(mesh.points)``.

    Examples
    --------
    A square with a square hole:

    >>> xy = [[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]]
    >>> mesh = cadt.ConstrainedDelaunay(xy, rings=[0, 4, 8], domain="even_odd")
    >>> mesh
    <cadt.ConstrainedDelaunay: 8 points, 8 segments, 10 triangles, 8 inside, host>
    >>> t = mesh.find_simplex([[0.5, 0.5], [1.5, 1.5], [9, 9]])  # -1: in no triangle
    >>> mesh.triangles_inside.shape, ((t >= 0) & mesh.inside[t]).tolist()
    ((8, 3), [True, False, False])

    Two segments that cross:

    >>> xy = [[0, 0], [2, 2], [0, 2], [2, 0]]
    >>> cadt.ConstrainedDelaunay(xy, [[0, 1], [2, 3]])
    Traceback (most recent call last):
    cadt._errors.CrossingError: 1 pair of segments crosses: 0 and 1; ...
    >>> mesh = cadt.ConstrainedDelaunay(xy, [[0, 1], [2, 3]], crossing="exact")
    >>> mesh.added_points, mesh.n_triangles
    (array([[1., 1.]]), 4)
    """

    def __init__(
        self,
        points: Any,
        segments: Any = None,
        *,
        polylines: Any = None,
        rings: Any = None,
        crossing: str | tuple[str, float] = "error",
        domain: str = "hull",
        holes: Any = None,
        regions: Any = None,
        backend: str | None = None,
        device: int | str | None = None,
        threads: int | None = None,
        max_memory: int | None = None,
        statistics: str = "counters",
        progress: bool | Callable[[str, float], object] | None = None,
    ) -> None:
        self._gpu: _gpu.ConstrainedMesh | None = None
        self._cache: dict[str, Any] = {}
        self._constraints, self._again = constraints_of(crossing, domain, holes, regions)
        if (on_gpu := array_on_device(points)) is not None:
            self._mesh, self._points, self._given = None, points, int(on_gpu.a.shape[0])
            self._segments = segments_there(on_gpu, segments, polylines, rings)
            how = (backend, device, "canonical", threads, max_memory, statistics)
            with reporter(progress) as report:
                self._gpu = _gpu.ConstrainedMesh(on_gpu, self._segments, self._constraints, domain != "hull", how, report)
            self._options = self._gpu.options
            if self._gpu.all_points is not None:
                self._points = self._gpu.all_points
            return
        if adapter_of(segments) is not None:
            raise InputError("segments on a device need points there: pass points on it, or segments of the host", 0)
        self._input = as_input(points)
        self._given = len(self._input)
        self._segments = read_only(segments_of(segments, polylines, rings, len(self._input)))
        self._options = _devices.make_options(backend, device, "canonical", threads, max_memory, statistics)
        arguments = (self._input, self._segments, self._constraints)
        open_device = _devices.device_for(self._options, device, threads, len(self._input))
        with reporter(progress) as report:
            if open_device is not None:
                self._made = _cadt.triangulate_constrained_by(open_device, *arguments, self._options, report)
            else:
                if self._options.backend == "auto":
                    self._options = self._options.on_host()
                self._made = _cadt.triangulate_constrained(*arguments, self._options, report)
        made = self._made
        self._mesh = made.mesh
        first: Any = made.moved_points if len(made.moved_points) else self._input
        self._points = read_only(np.concatenate([first, made.added_points])) if len(made.added_points) else first

    # Segments

    @property
    def segments(self) -> Any:
        """(m, 2) int32: all segments, as they are numbered."""
        return self._segments

    @property
    def edge_flags(self) -> Any:
        """(t,) uint32, on a GPU int32: bit k is set if the edge opposite vertex k is part of a segment."""
        return self._of("edge_flags", lambda c: c.edge_flags, lambda g: g.edge_flags)

    @property
    def constrained_edges(self) -> np.ndarray:
        """(e, 2) int32: the edges that are part of segments, the lower point first, ascending."""
        return self._of("constrained_edges", lambda c: c.edges)

    @property
    def edge_sources(self) -> tuple[np.ndarray, np.ndarray]:
        """The segments that each of `constrained_edges` is part of: ``indptr`` (e + 1,) and ``indices``.

        i for segment i in the direction of the edge, -1 - i against it.
        """
        return self._of("edge_sources", lambda c: c.sources)

    @property
    def chains(self) -> tuple[np.ndarray, np.ndarray]:
        """The points along each segment: ``indptr`` (m + 1,) int64, on a GPU int32, and ``indices`` int32.

        Those of segment s are ``indices[indptr[s]:indptr[s + 1]]``, from its first end to its second; none if its ends
        are equal points.
        """
        return self._of("chains", lambda c: c.chains, lambda g: g.chains)

    @property
    def degenerate_segments(self) -> np.ndarray:
        """The segments whose ends are equal points, ascending: int32."""
        return self._of("degenerate_segments", lambda c: c.degenerate_segments)

    # Crossings

    @property
    def points(self) -> Any:
        """The vertices: the points that were given, with ``("grid", width)`` where they have moved, and behind them
        `added_points`."""
        return self._points

    @property
    def added_points(self) -> Any:
        """(a, 2) float64: the vertices made for crossings, rounded to the nearest doubles."""
        return self._of("added_points", lambda c: c.added_points, lambda g: g.added_points)

    @property
    def added_parents(self) -> Any:
        """(a, 2) int32: for each of them, the lowest pair of segments that cross there."""
        return self._of("added_parents", lambda c: c.added_parents, lambda g: g.added_parents)

    @property
    def rounded_valid(self) -> bool:
        """Whether triangles are still counterclockwise with rounded coordinates. True without added points. If not,
        queries raise `InvalidMesh`, and `verify` names those that rounding has turned over."""
        return (self._made if self._gpu is None else self._gpu.mesh).rounded_valid

    def at_crossings(self, values: Any) -> Any:
        """Values of the points that were given, shape (n, ...), with those of `added_points` behind them.

        They are linear along the first of their two segments (`added_parents`) from the given point before to the one
        behind, at their rounded places. Those of points on a GPU are computed on the host.

        >>> mesh = cadt.ConstrainedDelaunay([[0, 0], [2, 2], [0, 2], [2, 0]], [[0, 1], [2, 3]], crossing="exact")
        >>> mesh.at_crossings([0, 10, 7, 7])
        array([ 0., 10.,  7.,  7.,  5.])
        """
        n = self._given
        if self._gpu is not None and n == self.n_points:
            return self._gpu._values(values)[0]
        v, one = as_values(values if self._gpu is None else self._gpu._as_host(values), n)
        if n == self.n_points:
            return v.reshape(n, *one)
        result = self._on_host.values_at_crossings(self._host_input()[0], v).reshape(self.n_points, *one)
        return result if self._gpu is None else self._gpu.array.like(result)

    # Checks

    @property
    def hash(self) -> str:
        """32 hexadecimal digits of triangles and constrained edges, by the numbers of their vertices.

        The same from every device and for each direction of segments and, without `added_points`, for each order.
        """
        if "hash" not in self._cache:
            self._cache["hash"] = self._host_made().hash()
        return self._cache["hash"]

    def verify(self) -> VerifyReport:
        """Checks the whole mesh exactly: triangles, segments, regions, by code that did not make them. O(n).

        On a grid, that points have moved to the centres of their cells as well, and that segments meet those of `chains`.
        """
        return report_of(self._host_made().verify(*self._host_input(), self._constraints))

    # Plumbing

    def _host_input(self) -> tuple[np.ndarray, np.ndarray]:
        """Points and segments, copied to the host where they are on a device."""
        if self._gpu is None:
            return self._input, self._segments
        array = self._gpu.array
        return as_points(array.to_host()), contiguous(array.host_of(self._segments), np.int32)

    def _host_made(self) -> _cadt.ConstrainedTriangulation:
        """As `_on_host`. That of a device is made again on the host, and must be equal."""
        if self._gpu is None:
            return self._made
        options = _devices.make_options("host", None, "canonical", None, None, "counters")
        points, segments = self._host_input()
        made = _cadt.triangulate_constrained(points, segments, self._constraints, options)
        there = self._gpu.mesh.download_constrained()
        pairs = [(of.mesh.triangles, of.mesh.neighbors, *of.chains) for of in (there, made)]
        for name in _COMPARED:
            pairs[0] += (getattr(there, name),)
            pairs[1] += (getattr(made, name),)
        if not all(np.array_equal(a, b, equal_nan=True) for a, b in zip(*pairs)):
            raise InternalError("the mesh on the device is not the one that the host makes of the same input")
        return made

    def _complete(self, values: Any) -> Any:
        if self._given == self.n_points:
            return values
        shape = np.shape(values)
        if shape[:1] not in ((self._given,), (self.n_points,)):
            rows = f"{self._given} rows, one a point that was given, or {self.n_points}, with those of added_points"
            raise InputError(f"values must have {rows}, not the shape {shape}", 0)
        return self.at_crossings(values) if shape[0] == self._given else values

    def _queries(self) -> _cadt.Queries:
        if "queries" not in self._cache:
            self._cache.setdefault("queries", self._queries_of(self._host_input()[0], self._on_host))
        return self._cache["queries"]

    def __repr__(self) -> str:
        inside = int(np.count_nonzero(self.inside)) if self._gpu is None else self._gpu.number_inside
        return (
            f"<cadt.ConstrainedDelaunay: {self.n_points:,} points, {self._segments.shape[0]:,} segments, "
            f"{self.n_triangles:,} triangles, {inside:,} inside, {self.device}>"
        )

    def __reduce__(self) -> tuple:
        return _restore, (type(self), *self._host_input(), self._again)


def _restore(cls: type[ConstrainedDelaunay], points: np.ndarray, segments: np.ndarray, how: dict) -> Any:
    return cls(points, segments, backend="host", **how)
