# SPDX-License-Identifier: Apache-2.0
"""Breaklines: lines that triangles must not cross, such as banks, ridges, kerbs and the outlines of lakes."""

from __future__ import annotations

import argparse
import dataclasses
import json
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

import cadt
from cadt._wkb import LINE, MULTILINE, MULTIPOLYGON, POLYGON, lines_of_wkb

from ._files import check_input, suffix_of, why
from ._mesh import no_triangles, triangulate
from ._progress import ProgressLine
from ._vector import _pyogrio, errors_of, only_layer, parse_crs, truncated
from .cloud import Cloud, name_of, same_crs
from .errors import CrsError, FileError, UsageError

READ_FORMATS = ("gpkg", "geojson", "fgb", "shp")


@dataclasses.dataclass(frozen=True)
class Breaklines:
    """Line i has the points `xyz[offsets[i]]` to `xyz[offsets[i + 1] - 1]` and is of feature `feature[i]`; z is NaN where
    the file has none."""

    path: str
    xyz: NDArray[np.float64]
    offsets: NDArray[np.int64]
    feature: NDArray[np.int64]
    other_crs: str = ""  # the file's own reference system, if --crs is another one


def check_file(options: argparse.Namespace) -> None:
    if options.breaklines is None:
        return
    if suffix_of(options.breaklines) not in READ_FORMATS:
        raise UsageError(
            f"--breaklines {options.breaklines}: lines are read from files that end in: {', '.join(READ_FORMATS)}"
        )
    check_input(options.breaklines)


def inputs_of(options: argparse.Namespace) -> list[str]:
    """All files that are read, none of which the output may be."""
    return [*options.inputs, *([options.breaklines] if options.breaklines is not None else [])]


def read_breaklines(path: str, cloud: Cloud, asked: str | None) -> Breaklines:
    """Lines and the outlines of polygons of one file, in the reference system of the points; `asked`: --crs."""
    ogr = _pyogrio(f"reading {path}")
    layer = only_layer(ogr, path, "lines")
    try:
        _, _, geometry, _ = ogr.raw.read(layer.file, layer=layer.name, where=layer.where, columns=[])
    except errors_of(ogr) as error:
        raise FileError(path, f"cannot be read: {why(error)}") from error
    if len(geometry) < layer.count and suffix_of(path) != "shp":
        raise truncated(path, len(geometry), layer.count)
    if asked is None:
        crs = parse_crs(path, layer.crs)
        if not same_crs(crs, cloud.crs):
            raise CrsError(
                path,
                f"its reference system is {name_of(crs)}, that of the points is {name_of(cloud.crs)}; transform one of "
                "them, or name the one that is right with --crs",
            )
    given = np.flatnonzero([data is not None for data in geometry])  # without a geometry it is as with an empty one
    try:
        xyz, offsets, of_features = lines_of_wkb(geometry[given], (LINE, POLYGON, MULTILINE, MULTIPOLYGON))
    except cadt.InputError as error:
        said = f"feature {given[error.index]} (counted from 0) is neither lines nor polygons"
        raise FileError(path, said) from error
    feature = np.repeat(given, np.diff(of_features))
    lost = np.flatnonzero(~np.isfinite(xyz[:, :2]).all(axis=1) | np.isinf(xyz[:, 2]))  # NaN: without a height
    if len(lost):
        first = int(np.searchsorted(offsets, lost[0], side="right")) - 1
        raise FileError(path, f"feature {feature[first]} (counted from 0) has no finite coordinates")
    if suffix_of(path) == "geojson" and (xyz[:, 2] == 0).any():
        xyz[_without_height(path, given, len(xyz)), 2] = np.nan
    other_crs = "" if asked is None else _other_crs(path, layer.crs, cloud)
    return Breaklines(path, xyz, offsets, feature, other_crs)


def _other_crs(path: str, stated: str | None, cloud: Cloud) -> str:
    """The reference system that the file states, if it is another one than --crs. GDAL states WGS 84 for GeoJSON that
    states none."""
    try:
        crs = parse_crs(path, stated)
    except CrsError:
        return ""
    if crs is None or cloud.crs is None or same_crs(crs, cloud.crs):
        return ""
    return "" if suffix_of(path) == "geojson" and crs.to_epsg() in (4326, 4979) else name_of(crs)


def _without_height(path: str, features: NDArray[np.integer], count: int) -> NDArray[np.bool_]:
    """The positions of these features of a GeoJSON file that have no height; GDAL takes it for 0 where others of the
    feature have one."""
    found: list[bool] = []

    def add(coordinates: list[Any]) -> None:
        if coordinates and not isinstance(coordinates[0], list):
            found.append(len(coordinates) < 3)
        else:
            for part in coordinates:
                add(part)

    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            text = file.read()
        try:
            root = json.loads(text)
            all_features = root["features"] if root["type"] == "FeatureCollection" else [root]
        except ValueError:  # a feature a line
            all_features = [json.loads(line) for line in text.replace("\x1e", "").splitlines() if line.strip()]
        for i in features:
            add(all_features[i].get("geometry", all_features[i])["coordinates"])
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError):
        found = []  # what GDAL reads otherwise
    return np.array(found) if len(found) == count else np.zeros(count, bool)


def leave_out_far(lines: Breaklines, cloud: Cloud, line: ProgressLine) -> Breaklines:
    """Those whose box meets that of the points. Triangles would fill the space up to others."""
    counts = np.diff(lines.offsets)
    some = np.flatnonzero(counts)
    near = np.zeros(len(counts), bool)
    if len(some):
        begins, xy, (x0, y0, x1, y1) = lines.offsets[some], lines.xyz[:, :2], cloud.bounds
        low, high = np.minimum.reduceat(xy, begins), np.maximum.reduceat(xy, begins)
        near[some] = ((low <= (x1, y1)) & (high >= (x0, y0))).all(axis=1)
    far = len(some) - np.count_nonzero(near)
    if len(some) == 0:
        line.warn(f"{lines.path}: has no lines")
    if far == 0:
        return lines
    said = f"{far} of its {len(some)} lines lie outside of the points' extent and are left out"
    if far == len(some):
        said = "none of its lines reaches into the points' extent, all are left out: is its reference system that of the points?"
    line.warn(f"{lines.path}: {said}")
    offsets = np.concatenate([[0], np.cumsum(counts[near])])
    return Breaklines(lines.path, lines.xyz[np.repeat(near, counts)], offsets, lines.feature[near])


@dataclasses.dataclass(frozen=True)
class Terrain:
    """The mesh of points, and of breaklines if there are some, with a height for each vertex. The vertices of the lines come
    first, in the order of the file: the first height at a place counts, and where a point of the cloud lies on a line with
    heights, that of the line."""

    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay
    z: NDArray[np.float64]
    said: dict[str, object]  # of the lines, for the summary


def terrain_of(cloud: Cloud, options: argparse.Namespace, line: ProgressLine) -> Terrain:
    name = ", ".join(cloud.sources)
    if options.breaklines is None:
        return Terrain(triangulate(cloud.xy, name, options, line), cloud.z, {})
    lines = read_breaklines(options.breaklines, cloud, options.crs)
    if lines.other_crs:
        line.warn(f"{lines.path}: its reference system is {lines.other_crs}; it is taken for {name_of(cloud.crs)}, as --crs says")
    lines = leave_out_far(lines, cloud, line)
    terrain = add_breaklines(cloud, lines, options, line)
    if terrain.mesh.n_triangles == 0:
        raise no_triangles(name, len(cloud))
    return terrain


def add_breaklines(cloud: Cloud, lines: Breaklines, options: argparse.Namespace, line: ProgressLine) -> Terrain:
    """Raises FileError if lines cross; warns if they have several heights at a place."""
    z = lines.xyz[:, 2].copy()
    missing = np.flatnonzero(np.isnan(z))
    if len(missing):
        surface = triangulate(cloud.xy, ", ".join(cloud.sources), options, line)
        z[missing] = surface.interpolate(cloud.z, lines.xyz[missing, :2], outside="nearest")
        del surface
    line.step("triangulating")
    xy = np.concatenate([lines.xyz[:, :2], cloud.xy])
    try:
        mesh = cadt.ConstrainedDelaunay(
            xy,
            polylines=lines.offsets,
            backend=options.backend,
            device=options.device,
            threads=options.threads,
            statistics="none",
            progress=line.update,
        )
    except cadt.CrossingError as error:
        raise FileError(lines.path, _crossing(lines, error.pairs)) from error
    line.clear()
    all_z = np.concatenate([z, cloud.z])
    for said in (
        _far_heights(lines, cloud),
        _several_heights(lines, z, mesh.duplicate_of),
        _heights_on_segments(lines, mesh, all_z),
    ):
        if said:
            line.warn(f"{lines.path}: {said}")
    heights = "the points" if len(missing) == len(z) else "the file"
    if 0 < len(missing) < len(z):
        heights = f"the file, but {len(missing)} from the points"
    said = f"{len(lines.offsets) - 1}, with {len(lines.xyz)} points; heights of {heights}"
    return Terrain(mesh, all_z, {"breaklines": said})


def _feature_of(lines: Breaklines, points: NDArray[np.integer]) -> NDArray[np.int64]:
    return lines.feature[np.searchsorted(lines.offsets, points, side="right") - 1]


def _begins_of_segments(lines: Breaklines) -> NDArray[np.intp]:
    """The first point of each segment: all points that are not the last one of their line."""
    ends = np.zeros(len(lines.xyz), bool)
    ends[lines.offsets[1:][np.diff(lines.offsets) > 0] - 1] = True
    return np.flatnonzero(~ends)


def _far_heights(lines: Breaklines, cloud: Cloud) -> str:
    """The height of the file that is furthest from those of the points, in words, if it is likely to be none, such as 0
    or -9999: further than the points' are apart, and 0, or ten times as far."""
    low, high = float(cloud.z.min()), float(cloud.z.max())
    z = lines.xyz[:, 2]
    beyond = np.where(np.isnan(z), 0, np.maximum(low - z, z - high))
    far = np.flatnonzero((beyond > high - low) & ((z == 0) | (beyond > 10 * (high - low))))
    if len(far) == 0 or high == low:
        return ""
    worst = int(far[np.argmax(beyond[far])])
    x, y, height = lines.xyz[worst]
    more = f", and {len(far) - 1} more such points" if len(far) > 1 else ""
    return (
        f"feature {_feature_of(lines, np.array([worst]))[0]} (counted from 0) has the height {height:.12g} at {x:.12g} {y:.12g}"
        f"{more}; those of the points are {low:.12g} to {high:.12g}: does it stand for no height, or for another unit?"
    )


def _several_heights(lines: Breaklines, z: NDArray[np.float64], first_of: NDArray[np.integer]) -> str:
    """Of points of lines at the same place those whose heights differ, in words; `first_of`: the first one, or -1."""
    second = np.flatnonzero(first_of[: len(z)] >= 0)
    first = first_of[second]
    # Two that the file does not give differ by rounding at most.
    given = np.isfinite(lines.xyz[first, 2]) | np.isfinite(lines.xyz[second, 2])
    differ = np.flatnonzero(given & (np.abs(z[first] - z[second]) > 0))
    if len(differ) == 0:
        return ""
    pair = np.array([first[differ[0]], second[differ[0]]])
    a, b = _feature_of(lines, pair)
    who = f"feature {a} (counted from 0) has" if a == b else f"the features {a} and {b} (counted from 0) have"
    (x, y), (one, other) = lines.xyz[pair[0], :2], z[pair]
    others = len(np.unique(first[differ])) - 1  # a ring ends at the place where it began
    more = f", and so it is at {others} more place{'s' if others > 1 else ''}" if others else ""
    return f"{who} the heights {one:.12g} and {other:.12g} at {x:.12g} {y:.12g}{more}; the first in the file counts"


def _heights_on_segments(lines: Breaklines, mesh: cadt.ConstrainedDelaunay, z: NDArray[np.float64]) -> str:
    """Where points of lines lie between the ends of other segments, but not at their height, in words. Points of the
    cloud that do get that height in `z`, if the file gives it."""
    offsets, vertices = mesh.chains
    between = np.ones(len(vertices), bool)
    some = offsets[1:] > offsets[:-1]
    between[offsets[:-1][some]] = between[offsets[1:][some] - 1] = False
    segment = np.repeat(np.arange(len(some)), np.diff(offsets))[between]
    v, a, b = vertices[between], vertices[offsets[segment]], vertices[offsets[segment + 1] - 1]
    p = np.asarray(mesh.points)
    along = p[b] - p[a]
    height = z[a] + (z[b] - z[a]) * ((p[v] - p[a]) * along).sum(axis=1) / (along**2).sum(axis=1)
    given = np.isfinite(lines.xyz[:, 2])
    of_file = given[a] & given[b]
    n = len(lines.xyz)
    of_cloud = np.flatnonzero((v >= n) & of_file)[::-1]
    z[v[of_cloud]] = height[of_cloud]  # of several lines along each other the first one counts
    off = np.abs(z[v] - height)
    off[(v >= n) | ~(of_file | given[np.minimum(v, n - 1)])] = 0
    wrong = off > 1e-9 * (np.abs(z[v]) + np.abs(height))
    if not wrong.any():
        return ""
    worst = int(np.argmax(np.where(wrong, off, 0)))
    begins = _begins_of_segments(lines)
    point, other = _feature_of(lines, np.array([v[worst], begins[segment[worst]]]))
    x, y = p[v[worst]]
    others = len(np.unique(v[wrong])) - 1
    more = f"; {others} more place{'s differ' if others > 1 else ' differs'} by no more" if others else ""
    return (
        f"feature {point} (counted from 0) has the height {z[v[worst]]:.12g} at {x:.12g} {y:.12g}, on a segment of feature "
        f"{other} with the height {height[worst]:.12g} there{more}; the point keeps its height"
    )


def _crossing(lines: Breaklines, pairs: Sequence[Sequence[int]]) -> str:
    places = []
    for pair in pairs[:5]:
        begin = _begins_of_segments(lines)[list(pair)]
        first, last = lines.xyz[begin, :2], lines.xyz[begin + 1, :2]
        ax, ay, cx, cy, bx, by, dx, dy = (Fraction(v) for v in [*first.flat, *last.flat])
        ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
        along = ((cx - ax) * vy - (cy - ay) * vx) / (ux * vy - uy * vx)
        x, y = float(ax + along * ux), float(ay + along * uy)
        of = _feature_of(lines, begin)
        who = f"feature {of[0]} crosses itself" if of[0] == of[1] else f"features {of[0]} and {of[1]} cross"
        places.append(f"{who} at {x:.12g} {y:.12g}")
    others = len(pairs) - len(places)
    more = f", and so {'do' if others > 1 else 'does'} {others} more pair{'s' if others > 1 else ''} of segments" if others else ""
    return (
        f"{', '.join(places)}{more} (features counted from 0); breaklines may touch, but not cross: "
        "give both a point there, or remove one"
    )
