# SPDX-License-Identifier: Apache-2.0
"""Well-known binary from arrays: one byte string for each line or polygon."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def lines_wkb(xy: NDArray[np.float64], begin: NDArray[np.int64]) -> NDArray[np.object_]:
    """LineStrings: line k is xy[begin[k]:begin[k + 1]]."""
    head = np.zeros(len(begin) - 1, np.dtype([("order", "u1"), ("kind", "<u4"), ("count", "<u4")]))
    head["order"], head["kind"], head["count"] = 1, 2, np.diff(begin)
    heads, body = head.tobytes(), np.ascontiguousarray(xy, "<f8").tobytes()
    result = np.empty(len(head), object)
    ends = (16 * begin).tolist()
    for k in range(len(head)):
        result[k] = heads[9 * k : 9 * k + 9] + body[ends[k] : ends[k + 1]]
    return result


def triangles_wkb(xy: NDArray[np.float64], z: NDArray[np.float64], corners: NDArray[np.int32]) -> NDArray[np.object_]:
    """Polygons with heights (ISO type 1003), closed by their first corner."""
    kind = np.dtype([("order", "u1"), ("kind", "<u4"), ("rings", "<u4"), ("count", "<u4"), ("ring", "<f8", (4, 3))])
    record = np.zeros(len(corners), kind)
    record["order"], record["kind"], record["rings"], record["count"] = 1, 1003, 1, 4
    closed = corners[:, [0, 1, 2, 0]]
    record["ring"][:, :, :2] = xy[closed]
    record["ring"][:, :, 2] = z[closed]
    data, size = record.tobytes(), kind.itemsize
    result = np.empty(len(corners), object)
    for k in range(len(corners)):
        result[k] = data[size * k : size * (k + 1)]
    return result
