# SPDX-License-Identifier: Apache-2.0
"""Points and values from whatever holds them, without a copy where the library can read them as they are."""

from __future__ import annotations

import math
import numbers
import operator
from typing import Any

import numpy as np

from cadt import _cadt
from cadt._errors import InputError

_FLOATS = (np.dtype(np.float64), np.dtype(np.float32))
FILL = "fill them (NaN is a value), or leave out the points"  # what can be done about masked values


def as_points(points: Any, what: str = "points", *, columns: str = "(n, 2)") -> np.ndarray:
    """An array of shape (n, 2), float64 or float32, whose memory the library reads: `points` itself where possible."""
    a = points if type(points) is np.ndarray else to_array(points, what)
    if a.ndim != 2 or a.shape[1] != 2:
        if a.size == 0 and a.ndim == 1:
            return np.empty((0, 2))
        hint = ""
        if a.ndim == 2 and what == "points":
            hint = "; cadt.scipy.Delaunay takes more dimensions (with Qhull)"
            if a.shape[1] == 3:
                hint = "; pass points[:, :2], and heights as values, or cadt.scipy.Delaunay makes tetrahedra (with Qhull)"
            elif a.shape[0] == 2:
                hint = "; pass points.T"
        elif a.ndim == 2 and a.shape[1] == 3:
            hint = "; pass the first two columns"
        elif a.ndim == 1 and a.size % 2 == 0:
            hint = "; np.reshape(..., (-1, 2)) makes rows of x and y in turn"
        raise InputError(f"{what} must have shape {columns}, not {a.shape}{hint}", 0)
    if a.dtype not in _FLOATS or not a.dtype.isnative:
        a = to_float(a, what)
    s0, s1 = a.strides
    size = a.dtype.itemsize
    if s0 < 0 or s0 % size or s1 % size or not a.flags.aligned:
        a = a.copy()  # also of one row, which is contiguous whatever its strides are
    return a


def as_input(points: Any, what: str = "points") -> np.ndarray:
    """As `as_points`. Of more points than a call takes there is no copy: the library refuses so many, whatever they are."""
    a = points if type(points) is np.ndarray else to_array(points, what)
    if a.ndim == 2 and a.shape[1] == 2 and len(a) > _cadt.max_points():
        return np.broadcast_to(0.0, a.shape)
    return as_points(a, what)


def offsets(begins: Any) -> Any:
    """Offsets of rows, as NumPy's or another array: int32 as of SciPy, unless the last one does not fit."""
    return begins.astype(np.int32 if int(begins[-1]) < 2**31 else np.int64)


def contiguous(a: np.ndarray, dtype: Any = None) -> np.ndarray:
    """In C's order, and aligned, which np.ascontiguousarray alone does not see to."""
    a = np.ascontiguousarray(a, dtype=dtype)
    return a if a.flags.aligned else a.copy()


def unmasked(a: Any, what: str, advice: str = "") -> Any:
    """`a`, of which nothing may be masked: np.asarray would take what is below the mask."""
    if not isinstance(a, np.ma.MaskedArray):
        return a
    if np.ma.is_masked(a):
        raise InputError(f"{what} are masked: {advice or f'pass {what} without a mask'}", 0)
    return a.data


def as_array(a: Any, what: str, form: str, advice: str = "") -> np.ndarray:
    """An array without a mask. Raises InputError, which says what `form` is expected, for rows of several lengths."""
    a = unmasked(a, what, advice)
    try:
        return np.asarray(a)
    except ValueError as e:
        raise InputError(f"{what} must be {form}: {e}", 0) from None


def to_array(points: Any, what: str) -> np.ndarray:
    """Lists, anything with ``__array__`` or, on the host, ``__dlpack__``."""
    rows = f"pass np.ma.compress_rows({what}), which are the rows without a mask" if np.ndim(points) == 2 else ""
    points = unmasked(points, what, rows)
    if isinstance(points, (list, tuple)) or hasattr(points, "__array__"):
        try:
            return _of_columns(points, np.asarray(points), what)
        except InputError:
            raise
        except ValueError as e:
            raise InputError(f"{what} must have shape (n, 2): {e}", 0) from None
    if hasattr(points, "__dlpack__"):
        return np.from_dlpack(points)
    a = np.asarray(points)
    if a.dtype == object:
        raise TypeError(f"{what} must be an array of shape (n, 2), not {type(points).__name__}")
    return a


def to_float(a: np.ndarray, what: str) -> np.ndarray:
    """float64 without a change of any value, or an error."""
    if a.dtype.kind in "iu":
        f = a.astype(np.float64)
        if a.dtype.itemsize >= 8 and a.size:
            _check_unchanged(a, f, what)
        return f
    if a.dtype.kind == "f" and a.dtype.itemsize <= 8:
        return a.astype(np.float64 if a.dtype.itemsize != 4 else np.float32)
    if a.dtype.kind == "b" or a.dtype.kind not in "OSUVMmcf" or a.dtype == object:
        kind = "objects" if a.dtype == object else str(a.dtype)
        raise TypeError(f"{what} must be float64 or float32 (or integers), not {kind}")
    raise TypeError(f"{what} must be float64 or float32 (or integers), not {a.dtype}: convert them first")


def _check_unchanged(a: np.ndarray, f: np.ndarray, what: str) -> None:
    """Raises InputError for the first integer of 64 bits that is another number as float64."""
    if not ((a > 2**53) | (a < -(2**53)) if a.dtype.kind == "i" else a > 2**53).any():
        return
    fits = f < (2.0**63 if a.dtype.kind == "i" else 2.0**64)  # what does not was rounded up
    _refuse_rows(~fits | (np.where(fits, f, 0).astype(a.dtype) != a), what)


def _refuse_rows(changed: np.ndarray, what: str) -> None:
    rows = changed.any(axis=-1) if changed.ndim > 1 else changed
    if rows.any():
        first = int(np.argmax(rows))
        raise InputError(
            f"{what}: the integers of row {first} exceed 2**53 and have no float64; subtract an offset first",
            first,
        )


def _of_columns(table: Any, a: np.ndarray, what: str) -> np.ndarray:
    """`a`, or its numbers where it has the objects of pandas' columns that can have gaps (Float64, Int64, Arrow's)."""
    dtypes: Any = getattr(table, "dtypes", None)
    kinds = {getattr(d, "kind", "O") for d in (dtypes if hasattr(dtypes, "__iter__") else (dtypes,))}
    if a.dtype != object or not kinds <= set("iuf"):
        return a
    gaps = np.frompyfunc(lambda v: not isinstance(v, numbers.Real), 1, 1)(a).astype(bool)
    if gaps.any():
        first = int(np.argmax(gaps.any(axis=-1) if gaps.ndim > 1 else gaps))
        raise InputError(f"{what}: row {first} has a missing value (NA): drop such rows", first)
    f = a.astype(np.float64)
    _refuse_rows((a != f).astype(bool) & ~np.isnan(f), what)
    return f


def index_of(i: Any, n: int, what: str) -> int:
    """An index, also from the end, of one of n."""
    k = operator.index(i)
    if not -n <= k < n:
        raise IndexError(f"there is no {what} {k}: there are {n}")
    return k + n if k < 0 else k


def is_x_and_y(xi: Any) -> bool:
    """Whether queries are given as a tuple of arrays x and y, of which one may be a number. Raises InputError where it
    could as well be two points."""
    if not (isinstance(xi, tuple) and len(xi) == 2) or (np.isscalar(xi[0]) and np.isscalar(xi[1])):
        return False
    if all(isinstance(a, (list, tuple)) and len(a) == 2 for a in xi):
        raise InputError(
            "queries: a tuple of two pairs may be two points, or x and y: pass an array of shape (n, 2), or two arrays x and y",
            0,
        )
    return True


def as_queries(xi: Any) -> tuple[np.ndarray, tuple[int, ...]]:
    """Queries of shape (..., 2) as rows, and the shape of the answers."""
    if is_x_and_y(xi):
        x, y = (unmasked(a, "queries") for a in xi)
        try:
            shape = np.broadcast_shapes(np.shape(x), np.shape(y))
            many = math.prod(shape) > _cadt.max_points()  # as in as_input
            xi = np.broadcast_to(0.0, (*shape, 2)) if many else np.stack(np.broadcast_arrays(x, y), axis=-1)
        except ValueError as e:
            raise InputError(f"x and y of queries do not fit together: {e}", 0) from None
    a = xi if type(xi) is np.ndarray else to_array(xi, "queries")
    if a.ndim == 0 or a.shape[-1] != 2:
        raise InputError(f"queries must have shape (..., 2), not {a.shape}", 0)
    shape = a.shape[:-1]
    return as_input(a.reshape(-1, 2), "queries"), shape


def as_values(values: Any, n: int) -> tuple[np.ndarray, tuple[int, ...]]:
    """Values of shape (n, ...) as a contiguous (n, m) array of float64, and the shape of one point's."""
    a = _of_columns(values, as_array(values, "values", f"real numbers of shape ({n},) or ({n}, m)", FILL), "values")
    if a.dtype.kind not in "iuf":
        raise TypeError(f"values must be real numbers, not {a.dtype}")
    if a.ndim == 0 or a.shape[0] != n:
        raise InputError(f"values must have shape ({n},) or ({n}, m): one row a point, not {a.shape}", 0)
    m = int(np.prod(a.shape[1:]))
    return contiguous(a.reshape(n, m), np.float64), a.shape[1:]


def as_indices(a: Any, what: str) -> np.ndarray:
    """A copy of integers of shape (t, 3) as int32; nothing, such as an empty list, is of shape (0, 3)."""
    a = as_array(a, what, "integers of shape (t, 3)")
    if a.shape in ((0,), (0, 3)):
        return np.empty((0, 3), dtype=np.int32)
    if a.ndim != 2 or a.shape[1] != 3 or a.dtype.kind not in "iu":
        raise InputError(f"{what} must be integers of shape (t, 3), not {a.dtype} of {a.shape}", 0)
    if a.size and (a.max() > np.iinfo(np.int32).max or a.min() < -1):
        raise InputError(f"{what} must lie between -1 and 2**31 - 1", 0)
    return np.array(a, dtype=np.int32, order="C")


def as_pairs(segments: Any, what: str) -> np.ndarray:
    """Integers of shape (m, 2) as int32."""
    a = as_array(segments, what, "integers of shape (m, 2)")
    kinds = {getattr(d, "kind", "") for d in np.atleast_1d(np.asarray(getattr(segments, "dtypes", ()), dtype=object))}
    if a.dtype == object and kinds and kinds <= set("iu"):
        a = _of_columns(segments, a, what).astype(np.int64)
    if a.size == 0 and a.ndim <= 2:
        return np.empty((0, 2), dtype=np.int32)
    if a.ndim != 2 or a.shape[1] != 2 or a.dtype.kind not in "iu":
        raise InputError(f"{what} must be integers of shape (m, 2), not {a.dtype} of {a.shape}", 0)
    wrong = (a < 0) | (a > np.iinfo(np.int32).max)
    if wrong.any():
        first = int(np.argmax(wrong.any(axis=1)))
        raise InputError(f"segment {first} has an end that is no point: {a[first].tolist()}", first)
    return contiguous(a, np.int32)
