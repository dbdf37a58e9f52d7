# SPDX-License-Identifier: Apache-2.0
"""Segments from pairs of points, polylines and rings, on the host and on a device, and what is to become of them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices
from cadt._arrays import adapter_of
from cadt._errors import InputError, OptionError
from cadt._points import as_array, as_pairs, as_points, contiguous

if TYPE_CHECKING:
    from cadt._arrays import Array

_CROSSINGS = ("error", "exact")
_DOMAINS = ("hull", "outer", "even_odd", "nonzero", "layers", "seeds")


def segments_of(segments: Any, polylines: Any, rings: Any, n: int) -> np.ndarray:
    """All segments, of arrays of the host."""
    for lines, what in ((polylines, "polylines"), (rings, "rings")):
        if any(adapter_of(a) is not None for a in (lines if isinstance(lines, tuple) else (lines,))):
            raise InputError(f"{what} are read on the host: pass copies there", 0)
    parts = [as_pairs(() if segments is None else segments, "segments")]
    parts += [_of_lines(_cadt.polyline_segments, polylines, "polylines", n)]
    parts += [_of_lines(_cadt.ring_segments, rings, "rings", n)]
    return contiguous(np.concatenate(parts))


def segments_there(array: Array, segments: Any, polylines: Any, rings: Any) -> Any:
    """All segments, as an array on the device of the points."""
    if adapter_of(segments) is None:
        return array.from_host(segments_of(segments, polylines, rings, int(array.a.shape[0])))
    if polylines is not None or rings is not None:
        raise InputError("segments on a device stand alone: with polylines or rings, pass segments of the host", 0)
    return array.pairs(segments, "segments")


def as_offsets(offsets: Any, what: str, form: str = "offsets, integers of shape (k + 1,)") -> np.ndarray:
    """Integers of one dimension as int64; `form` is what an InputError says that they must be."""
    a = as_array(offsets, what, form)
    if a.ndim != 1 or a.size == 0 or a.dtype.kind not in "iu":
        raise InputError(f"{what} must be {form}, not {a.dtype} of {a.shape}", 0)
    if a.dtype == np.uint64 and (wrong := a > np.iinfo(np.int64).max).any():
        first = int(np.argmax(wrong))
        raise InputError(f"number {first} of {what} is {a[first]}, more than 2**63 - 1", first)
    return contiguous(a, np.int64)


def _of_lines(make: Any, lines: Any, what: str, n: int) -> np.ndarray:
    if lines is None:
        return np.empty((0, 2), dtype=np.int32)
    vertices: Any = None
    if isinstance(lines, tuple) and len(lines) == 2 and (isinstance(lines[0], (list, tuple)) or np.ndim(lines[0])):
        lines, vertices = lines
    if isinstance(lines, (list, np.ndarray)) and len(lines) == 0:
        return np.empty((0, 2), dtype=np.int32)
    offsets = as_offsets(lines, what, "offsets, integers of shape (k + 1,), or a tuple (offsets, vertices)")
    if vertices is None:
        if offsets[-1] > n:
            raise InputError(f"the offsets of {what} reach to {offsets[-1]}, but there are {n} points", len(offsets) - 1)
        return _made(make, offsets, np.empty(0, dtype=np.int32), what)
    form = "integers of one dimension"
    v = as_array(vertices, f"the vertices of {what}", form)
    if v.ndim != 1 or (v.size and v.dtype.kind not in "iu"):
        raise InputError(f"the vertices of {what} must be {form}, not {v.dtype} of {v.shape}", 0)
    wrong = (v < 0) | (v > np.iinfo(np.int32).max)
    if wrong.any():
        first = int(np.argmax(wrong))
        raise InputError(f"vertex {first} of {what} is no point: {v[first]}", first)
    return _made(make, offsets, contiguous(v, np.int32), what)


def _made(make: Any, offsets: np.ndarray, vertices: np.ndarray, what: str) -> np.ndarray:
    try:
        segments: np.ndarray = make(offsets, vertices)
    except InputError as e:
        raise InputError(f"{what}: {e}", e.index) from None
    return segments


def constraints_of(
    crossing: Any, domain: Any, holes: Any, regions: Any
) -> tuple[_cadt.ConstraintOptions, dict[str, Any]]:
    """The options, and the parameters of which they can be made again, as copies. Raises OptionError for what is no
    crossing or domain, InputError for places that are no numbers."""
    width = 0.0
    if isinstance(crossing, (tuple, list)) and len(crossing) == 2 and _is_one_of(crossing[0], ("grid",)):
        crossing, width = "grid", _width_of(crossing[1])
    elif not _is_one_of(crossing, _CROSSINGS):
        raise OptionError(f"crossing must be 'error', 'exact' or ('grid', width), not {crossing!r}", "crossing")
    if not _is_one_of(domain, _DOMAINS):
        raise OptionError(f"domain must be one of {', '.join(map(repr, _DOMAINS))}, not {domain!r}", "domain")
    places = []
    for name, given, columns in (("holes", holes, 2), ("regions", regions, 3)):
        if adapter_of(given) is not None:
            raise InputError(f"{name} are read on the host: pass a copy there", 0)
        a = as_array(() if given is None else given, name, f"numbers of shape (k, {columns})")
        if a.size and domain != "seeds":
            raise OptionError(f"{name} are for domain='seeds'", name)
        places.append(_as_places(a, name, columns).copy() if a.size else np.empty((0, columns)))
    again = {"crossing": (crossing, width) if crossing == "grid" else crossing, "domain": domain}
    again.update(zip(("holes", "regions"), places))
    return _cadt.ConstraintOptions(crossing, width, domain, *places), again


def _is_one_of(given: Any, names: tuple[str, ...]) -> bool:
    return isinstance(given, str) and given in names  # an array is neither equal nor not


def _width_of(given: Any) -> float:
    try:
        width = float(given)
    except (TypeError, ValueError, OverflowError):
        width = math.nan
    if not (width > 0 and math.isfinite(width)):
        raise OptionError(f"the width of the grid must be a number above 0, not {given!r}", "grid")
    return width


def _as_places(a: np.ndarray, what: str, columns: int) -> np.ndarray:
    """Numbers of shape (k, columns) as float64."""
    if a.ndim == 2 and a.shape[1] == columns and a.dtype.kind in "biufO":
        try:
            return contiguous(a, np.float64)
        except (TypeError, ValueError, OverflowError):  # of objects
            pass
    raise InputError(f"{what} must be numbers of shape (k, {columns}), not {a.dtype} of {a.shape}", 0)


def find_crossings(
    points: Any, segments: Any = None, *, polylines: Any = None, rings: Any = None, threads: int | None = None
) -> np.ndarray:
    """All pairs of segments that cross: (p, 2) int32, the lower index first, ascending. Exact.

    Segments, polylines and rings are given and numbered as those of `ConstrainedDelaunay`; without any there are no pairs.
    Segments cross that have one common point, inside both, at which no point lies. O(n log n + pairs) expected, on the
    host, in 100 to 200 bytes a pair. The GIL is released; Ctrl-C ends it.

    Raises
    ------
    InputError
        As for `ConstrainedDelaunay`.
    OptionError
        `threads` is no whole number, or negative.

    >>> cadt.find_crossings([[0, 0], [2, 2], [0, 2], [2, 0]], [[0, 1], [2, 3]])
    array([[0, 1]], dtype=int32)
    """
    most = _devices.whole(threads, "threads", 31)
    xy = as_points(points)
    return _cadt.find_crossings(xy, segments_of(segments, polylines, rings, len(xy)), most)
