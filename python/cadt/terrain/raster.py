# SPDX-License-Identifier: Apache-2.0
"""cadt raster: values between the points, at the centres of a grid's cells, as a GeoTIFF."""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

import cadt

from ._breaklines import check_file, inputs_of, terrain_of
from ._buckets import Buckets, Floats
from ._files import check_output, check_utf8, suffix_of
from ._mesh import check_max_edge, no_triangles, rasterize, read, triangulate
from ._progress import ProgressLine
from ._tiles import TiledRaster
from .cloud import Cloud, Extent, require_crs
from .cog import BLOCK, check_nodata, open_cog
from .errors import UsageError
from .grid import Grid, check_resolution, grid_of, grid_of_file, parse_bounds

WRITE_FORMATS = ("tif", "tiff")
SMALL = 200_000  # points: the host has them done before a graphics card is opened


def choose_grid(cloud: Extent, options: argparse.Namespace) -> Grid:
    bounds = parse_bounds(options.bounds)
    if options.align is not None:
        return grid_of_file(options.align, cloud.crs, bounds)
    return grid_of(cloud, options.res, bounds)


def rows_at_a_time(grid: Grid, points: int) -> int:
    """So many that a pass over the triangles is worth it: as many cells as points, in whole tiles of the file, unless
    these are more cells than a call takes."""
    rows = max(points, 1 << 22) // grid.columns
    return min(grid.rows, ((1 << 31) - 1) // grid.columns, max(BLOCK, rows // BLOCK * BLOCK))


def fill_nearest(
    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay, z: NDArray[np.float64], cells: NDArray[np.float64], grid: Grid, first: int
) -> None:
    """Puts the nearest point's value where there is none."""
    for row in range(len(cells)):
        columns = np.flatnonzero(np.isnan(cells[row]))
        if len(columns):
            where = np.empty((len(columns), 2))
            where[:, 0] = grid.x0 + (columns + 0.5) * grid.dx
            where[:, 1] = grid.y1 - (first + row + 0.5) * grid.dy
            cells[row, columns] = z[mesh.nearest_vertex(where)]


def by_whole(
    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay,
    z: NDArray[np.float64],
    grid: Grid,
    options: argparse.Namespace,
    nearest: cadt.Delaunay | None = None,
) -> Iterator[Floats]:
    """The rows from a mesh of all points, some at a time. `nearest`: the mesh that finds nearest points, if another."""
    step = rows_at_a_time(grid, len(z))
    for first in range(0, grid.rows, step):
        last = min(first + step, grid.rows)
        part = grid.part(first, 0, last - first, grid.columns)
        cells = rasterize(mesh, z, part, options.method, options.max_edge)
        if options.fill == "nearest":
            fill_nearest(nearest or mesh, z, cells, grid, first)
        yield cells


def on_host(options: argparse.Namespace, points: int) -> bool:
    """Whether the host computes: it is asked for, or no graphics card is there."""
    if options.backend != "auto":
        return bool(options.backend == "host")
    return points < SMALL or not any(device.usable and device.gpu for device in cadt.devices())


def check_options(options: argparse.Namespace) -> None:
    if (options.res is None) == (options.align is None):
        raise UsageError("say the cells either with --res R or with --align GRID.tif")
    if options.res is not None:
        check_resolution(options.res)
    check_max_edge(options.max_edge)
    check_nodata(options.nodata, options.dtype)
    parse_bounds(options.bounds)
    if options.breaklines is not None and suffix_of(options.output) in ("asc", "npy", "png"):
        raise UsageError(f"{options.output}: with --breaklines a GeoTIFF is written, .tif; .asc, .npy and .png take --segments")
    if options.breaklines is not None and options.method != "linear":
        raise UsageError(f"--breaklines: --method {options.method} takes no notice of lines; leave it out")
    if options.breaklines is not None and options.scratch is not None:
        raise UsageError("--breaklines: with --scratch there are none; use fewer points, or leave one of both out")
    check_file(options)
    if options.scratch is not None:
        with_scratch().check_options(options)
    elif options.tile_points is not None:
        raise UsageError("--tile-points is for --scratch, which is missing")
    aligned = [options.align] if options.align is not None else []
    check_output(options.output, WRITE_FORMATS, inputs_of(options) + aligned)
    check_utf8(options.output)


def with_scratch() -> ModuleType:
    """What --scratch needs of a build of cadt."""
    try:
        from . import _scratch
    except ImportError as error:
        raise UsageError(f"--scratch: {error}") from error
    return _scratch


class InMemory:
    """All points at a time."""

    def __init__(self, options: argparse.Namespace, line: ProgressLine) -> None:
        self.options, self.line = options, line
        self.said: dict[str, object] = {}  # for the summary

    def read(self) -> Cloud:
        return read(self.options, self.line)

    def rows(self, cloud: Cloud, grid: Grid) -> tuple[Iterator[Floats], str]:
        """The rows of the raster, and what computes them. The cloud's arrays are sorted."""
        name, n, options = ", ".join(cloud.sources), len(cloud), self.options
        if options.breaklines is not None:
            return self._rows_with_breaklines(cloud, grid)
        self.line.step("sorting")
        points = Buckets(cloud, threads=options.threads)
        if options.method == "linear" and points.useful and on_host(options, n):
            if len(points.hull) == 0:
                raise no_triangles(name, n)
            tiled = TiledRaster(
                points,
                grid,
                max_edge=options.max_edge,
                fill=options.fill == "nearest",
                threads=options.threads,
                progress=lambda fraction: self.line.update("filling", fraction),
            )
            return tiled.rows(), "host, by tiles"
        mesh = triangulate(points.xy, name, options, self.line)
        return by_whole(mesh, points.z, grid, options), mesh.device

    def _rows_with_breaklines(self, cloud: Cloud, grid: Grid) -> tuple[Iterator[Floats], str]:
        options = self.options
        terrain = terrain_of(cloud, options, self.line)
        mesh, self.said = terrain.mesh, terrain.said
        nearest = None
        if options.fill == "nearest":
            nearest = triangulate(np.asarray(mesh.points), ", ".join(cloud.sources), options, self.line)
        return by_whole(mesh, terrain.z, grid, options, nearest), mesh.device


def raster_command(options: argparse.Namespace, line: ProgressLine) -> dict[str, object]:
    start = time.monotonic()
    check_options(options)
    with contextlib.ExitStack() as stack:
        way: Any = InMemory(options, line)
        if options.scratch is not None:
            way = with_scratch().InScratch(
                options, line, stack.enter_context(with_scratch().folder_in(options.scratch))
            )
        cloud = way.read()
        require_crs(cloud, options.crs, options.output)
        n, grid = len(cloud), choose_grid(cloud, options)
        read_at = time.monotonic()
        rows = stack.enter_context(
            open_cog(
                options.output, grid, cloud.crs, nodata=options.nodata, dtype=options.dtype, threads=options.threads
            )
        )
        made, device = way.rows(cloud, grid)
        said = way.said if options.breaklines is not None else {}
        del cloud
        for cells in made:
            rows.write(cells)
            line.update("filling", rows.next / grid.rows)
        del made
        line.step(f"compressing {options.output}")
    return {
        "points": n,
        **said,
        "cells": f"{grid.columns} x {grid.rows}",
        "no data": rows.blank if rows.blank < grid.rows * grid.columns else "every cell: see --bounds and --max-edge",
        "time": f"{time.monotonic() - start:.3f} s (read {read_at - start:.3f})",
        "back end": device,
        "written": options.output,
    }
