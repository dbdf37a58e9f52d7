# SPDX-License-Identifier: Apache-2.0
"""cadt contour: lines of equal height on the triangles.

Heights are linear in a triangle, so that a contour line is a straight segment there, and its ends are shared with the
neighbours: chaining them needs no search and no tolerance, only the neighbours that the mesh has. contourpy and
gdal_contour take grids, and matplotlib keeps its contours of triangles private.
"""

from __future__ import annotations

import argparse
import math
import time

import numpy as np
from numpy.typing import NDArray

import cadt

from ._breaklines import check_file, inputs_of, terrain_of
from ._features import lines_wkb
from ._files import check_output
from ._mesh import check_max_edge, kept_triangles, read
from ._progress import ProgressLine
from ._vector import check_features, write_features
from .cloud import require_crs
from .errors import FileError, UsageError

WRITE_FORMATS = ("gpkg", "fgb", "geojson")
MOST_SEGMENTS = 1 << 29

Lines = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]


def contour_lines(
    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay,
    z: NDArray[np.float64],
    interval: float,
    base: float = 0.0,
    max_edge: float | None = None,
) -> Lines:
    """Contour lines at base + k interval.

    Returns
    -------
    xy : (m, 2)
        The corners of all lines.
    begin : (lines + 1,)
        Line k is ``xy[begin[k]:begin[k + 1]]``. A closed one ends with its first corner. Higher ground is on the left.
    level : (lines,)
        Their heights, ascending.

    Raises
    ------
    InputError
        `z` has not one finite height for each of the mesh's points.

    Notes
    -----
    A vertex whose height is that of a line counts as above it: no case is special, and lines neither branch nor cross.
    """
    corners = np.asarray(mesh.simplices)
    neighbors = np.asarray(mesh.neighbors)
    points = np.asarray(mesh.points)
    z = np.asarray(z, np.float64)
    if z.shape != (len(points),) or not np.isfinite(z).all():
        raise cadt.InputError(f"z must have shape ({len(points)},): a finite height for each point of the mesh", 0)
    if not float(z.max() - z.min()) / interval < 1 << 31:
        raise UsageError(f"--interval {interval:g}: the heights span {z.max() - z.min():g}; take a larger one")
    # The level of a vertex: the highest line at or below it. A triangle has the lines above its lowest level, up to its
    # highest.
    level = np.floor((z - base) / interval)
    level += base + (level + 1) * interval <= z  # the division is rounded
    level -= base + level * interval > z
    apart = 2 * np.spacing(np.abs(base + level * interval).max()) <= interval  # whatever is rounded
    if not (np.abs(level).max() < 1 << 50 and apart):
        raise UsageError(f"--base {base:g} is too many steps of {interval:g} from the heights for lines to differ")
    low, high = level[corners].min(axis=1), level[corners].max(axis=1)
    count = (high - low).astype(np.int64)
    kept = kept_triangles(mesh, max_edge)
    if kept is not None:
        outside = np.ones(len(corners), bool)
        outside[kept] = False
        count[outside] = 0
    first = np.concatenate(([0], np.cumsum(count)))
    total = int(first[-1])
    if total > MOST_SEGMENTS:
        raise UsageError(
            f"--interval {interval:g}: {total} pieces of lines, at most {MOST_SEGMENTS}: take a larger one"
        )
    if total == 0:
        return np.empty((0, 2)), np.zeros(1, np.int64), np.empty(0)
    triangle = np.repeat(np.arange(len(corners)), count)
    at = low[triangle] + 1 + (np.arange(total) - first[triangle])

    # Counterclockwise, a line enters where the boundary comes down to below and leaves where it goes up again, so that
    # what is above is on its left. Edge k is opposite corner k.
    above = level[corners[triangle]] >= at[:, None]
    start, end = above[:, [1, 2, 0]], above[:, [2, 0, 1]]
    enters = np.argmax(start & ~end, axis=1)
    leaves = np.argmax(~start & end, axis=1)

    other = neighbors[triangle, leaves].astype(np.int64)
    inside = (other >= 0) & (count[other] > 0)
    following = np.where(inside, first[other] + (at - low[other]).astype(np.int64) - 1, -1)
    order, begin = chains(following, at)

    # A line has the entries of its pieces and the exit of the last one.
    heights = base + at * interval
    lines = len(begin) - 1
    xy = np.empty((total + lines, 2))
    xy[np.arange(total) + np.repeat(np.arange(lines), np.diff(begin))] = _crossing(
        points, z, corners[triangle], enters, heights
    )[order]
    last = order[begin[1:] - 1]
    xy[begin[1:] + np.arange(lines)] = _crossing(points, z, corners[triangle[last]], leaves[last], heights[last])
    return _without_repeats(xy, begin + np.arange(lines + 1), heights[last])


def _without_repeats(xy: NDArray[np.float64], begin: NDArray[np.int64], level: NDArray[np.float64]) -> Lines:
    """Lines through a vertex of their height meet it in several triangles: once is enough. What is left of a line around
    a single such vertex is a point, and no line."""
    line = np.repeat(np.arange(len(level)), np.diff(begin))
    new = np.ones(len(xy), bool)
    new[1:] = (line[1:] != line[:-1]) | (xy[1:] != xy[:-1]).any(axis=1)
    size = np.bincount(line[new], minlength=len(level))
    long = size > 1
    return xy[new & long[line]], np.concatenate(([0], np.cumsum(size[long]))), level[long]


def _crossing(
    points: NDArray[np.float64],
    z: NDArray[np.float64],
    corners: NDArray[np.int32],
    edge: NDArray[np.int64],
    height: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Where the height is reached on an edge: the same doubles from both of its triangles."""
    rows = np.arange(len(corners))
    a, b = corners[rows, (edge + 1) % 3], corners[rows, (edge + 2) % 3]
    a, b = np.minimum(a, b), np.maximum(a, b)
    share = ((height - z[a]) / (z[b] - z[a])).clip(0.0, 1.0)[:, None]
    return np.where(share < 1.0, points[a] + share * (points[b] - points[a]), points[b])


def chains(following: NDArray[np.int64], key: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Lines from pieces that know the next one (-1: none): all pieces in the order of their lines, and where each line
    begins; the last one ends at the end. Lines ascend by the `key` of their first piece; closed ones begin with their
    lowest piece. Each pass looks twice as far as the one before: the logarithm of the longest line is their number."""
    n = len(following)
    pieces = np.arange(n)
    before = np.full(n, -1, np.int64)
    has = following >= 0
    before[following[has]] = pieces[has]
    lowest, jump = pieces.copy(), np.where(before >= 0, before, pieces)
    while True:
        further, lower = jump[jump], np.minimum(lowest, lowest[jump])
        if np.array_equal(lower, lowest):  # then no look further changes it: lines of all lengths are known
            break
        jump, lowest = further, lower
    # An open line begins with the piece that has none before it. The lowest piece of a closed one has itself as the
    # lowest of all that come before, once round; there it is cut.
    before[(before >= 0) & (lowest[before] == pieces)] = -1
    first = before < 0

    jump, rank = np.where(first, pieces, before), np.where(first, 0, 1)
    while not first[jump].all():
        rank += rank[jump]
        jump = jump[jump]
    starts = np.flatnonzero(first)
    starts = starts[np.argsort(key[starts], kind="stable")]
    length = np.bincount(jump, minlength=n)[starts]
    begin = np.concatenate(([0], np.cumsum(length)))
    place = np.empty(n, np.int64)
    place[starts] = begin[:-1]
    order = np.empty(n, np.int64)
    order[place[jump] + rank] = pieces
    return order, begin


def contour_command(options: argparse.Namespace, line: ProgressLine) -> dict[str, object]:
    start = time.monotonic()
    if not (options.interval > 0 and math.isfinite(options.interval)):
        raise UsageError(f"--interval {options.interval:g}: a finite height above 0 is needed")
    if not math.isfinite(options.base):
        raise UsageError(f"--base {options.base:g}: a finite height is needed")
    check_max_edge(options.max_edge)
    check_file(options)
    check_output(options.output, WRITE_FORMATS, inputs_of(options))
    check_features(options.output)
    cloud = read(options, line)
    require_crs(cloud, options.crs, options.output)
    name = ", ".join(cloud.sources)
    terrain = terrain_of(cloud, options, line)
    mesh, z = terrain.mesh, terrain.z
    line.step("following the lines")
    xy, begin, level = contour_lines(mesh, z, options.interval, options.base, options.max_edge)
    if len(level) == 0:
        kept_triangles(mesh, options.max_edge, name)  # says so, if there are none
        low, high = float(z.min()), float(z.max())
        raise FileError(
            name,
            f"no line at {options.base:g} + k {options.interval:g}: the heights are {low:g} to {high:g}; take a smaller --interval",
        )
    line.step(f"writing {options.output}")
    write_features(options.output, lines_wkb(xy, begin), "LineString", {"elevation": level}, cloud.crs, "contour")
    return {
        "points": len(cloud),
        **terrain.said,
        "triangles": mesh.n_triangles,
        "lines": len(level),
        "heights": f"{level[0]:g} to {level[-1]:g}",
        "time": f"{time.monotonic() - start:.3f} s",
        "back end": mesh.device,
        "written": options.output,
    }
