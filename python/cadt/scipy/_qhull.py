# SPDX-License-Identifier: Apache-2.0
"""What is SciPy's and Qhull's: when a call is left to them, and how that is said."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from scipy.spatial import QhullError

from cadt._errors import Error
from cadt._points import contiguous

# Options that ask for what cadt does anyway, or for how Qhull scales and reports.
_OURS = frozenset(("Qbb", "Qc", "Qz", "Q12", "Qt", "Qx", "Q11", "Pp", "QJ"))
# Incremental Qhull refuses these; its message is as good as ours.
_NOT_INCREMENTAL = frozenset(("Qbb", "QbB", "Qz"))

_said: set[str] = set()


class QhullWarning(UserWarning):
    """A call was left to SciPy and Qhull, because it asks for what cadt does not compute. Said once for each reason."""


class FlatPointsError(Error, QhullError):
    """There is no triangle: fewer than three points, or all on one line."""


def say(reason: str, stacklevel: int = 4) -> None:
    """Warns that SciPy computes, once for each reason."""
    if reason not in _said:
        _said.add(reason)
        warnings.warn(f"{reason}: computed by SciPy, not by cadt", QhullWarning, stacklevel=stacklevel)


def options_of(qhull_options: Any, incremental: bool, default: str) -> tuple[frozenset[str], str]:
    """The set of Qhull options, and why Qhull must do it ("": cadt can)."""
    if qhull_options is None:
        qhull_options = "Qc" if incremental else default
    if not isinstance(qhull_options, str):
        raise TypeError(f"qhull_options must be a str, not {type(qhull_options).__name__}")
    options = frozenset(qhull_options.split())
    foreign = sorted(options - _OURS)
    if foreign:
        return options, f"Qhull option {' '.join(foreign)}"
    if incremental and options & _NOT_INCREMENTAL:
        return options, f"Qhull option {' '.join(sorted(options & _NOT_INCREMENTAL))} with incremental=True"
    return options, ""


def as_doubles(points: Any) -> np.ndarray:
    """Points as SciPy takes them: contiguous doubles of two dimensions."""
    if type(points) is not np.ndarray or points.dtype != np.float64:
        if np.ma.isMaskedArray(points):
            raise ValueError("Input points cannot be a masked array")
        points = np.asarray(points)
        if points.dtype.kind == "c":
            raise TypeError("points must be real numbers, not complex ones")
    points = contiguous(points, np.double)
    if points.ndim != 2:
        raise ValueError("Input points array must have 2 dimensions.")
    return points
