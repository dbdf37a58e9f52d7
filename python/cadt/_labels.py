# SPDX-License-Identifier: Apache-2.0
"""The boundaries between the labels of an image."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cadt import _cadt
from cadt._errors import InputError
from cadt._points import as_array, as_indices, as_points, contiguous

_OUTSIDE = np.iinfo(np.int32).min


class LabelSegments(NamedTuple):
    """Boundaries between labels: ``ConstrainedDelaunay(b.points, b.segments)`` meshes the image.

    Attributes
    ----------
    points : (n, 2) float64
        Corners of boundaries, in pixels: pixel i of row j, counted from the top, is the square from (i, rows - 1 - j)
        to (i + 1, rows - j).
    segments : (m, 2) int32
        They have no point in common but their ends.
    sides : (m, 2) int32
        The labels left and right of each segment; -2**31 outside of the image.
    """

    points: np.ndarray
    segments: np.ndarray
    sides: np.ndarray


def label_segments(labels: Any) -> LabelSegments:
    """The boundaries between pixels of different labels, and the border of the image, as segments.

    Parameters
    ----------
    labels : array_like of int, shape (rows, columns)
        Row 0 is the top. They must fit in 32 bits; -2**31 is none.

    Notes
    -----
    Boundaries have the steps of the pixels; docs/constrained.md shows how to simplify them first.

    Examples
    --------
    >>> labels = [[1, 1, 2], [1, 1, 2]]
    >>> b = cadt.label_segments(labels)
    >>> mesh = cadt.ConstrainedDelaunay(b.points, b.segments)
    >>> mesh.n_regions, len(b.segments)
    (2, 7)
    >>> sorted(set(cadt.triangle_labels(b.points, mesh.simplices, labels).tolist()))
    [1, 2]
    """
    image = _as_labels(labels)
    xy, segments, sides = _cadt.label_segments(image)
    return LabelSegments(xy, segments, sides)


def triangle_labels(points: Any, simplices: Any, labels: Any) -> np.ndarray:
    """The label of the pixel in which the centroid of each triangle lies: (t,) int32.

    It is the label of all of the triangle where triangles have the segments of `label_segments` as edges. A centroid
    outside of the image has the label of the nearest pixel.
    """
    xy = contiguous(as_points(points), np.float64)
    return _cadt.triangle_labels(xy, as_indices(simplices, "simplices"), _as_labels(labels))


def _as_labels(labels: Any) -> np.ndarray:
    form = "integers of shape (rows, columns)"
    a = as_array(labels, "labels", form, "fill them: a label of its own says that there is none")
    if a.ndim != 2 or a.dtype.kind not in "iub":
        hint = ""
        if a.ndim == 3 and a.shape[2] in (3, 4) and a.dtype == np.uint8:
            hint = "; of colours make numbers: labels[..., :3] @ [65536, 256, 1]"
        raise InputError(f"labels must be {form}, not {a.dtype} of {a.shape}{hint}", 0)
    if a.dtype.itemsize > 4 or a.dtype == np.uint32:
        wrong = (a > np.iinfo(np.int32).max) | (a < _OUTSIDE if a.dtype.kind == "i" else False)
        if wrong.any():
            first = int(np.argmax(wrong))
            row, column = divmod(first, a.shape[1])
            raise InputError(f"the label {a.flat[first]} of pixel ({row}, {column}) does not fit in 32 bits", first)
    return contiguous(a, np.int32)
