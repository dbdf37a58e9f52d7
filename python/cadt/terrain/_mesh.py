# SPDX-License-Identifier: Apache-2.0
"""What the commands share: reading, triangulating, and which triangles are kept."""

from __future__ import annotations

import argparse
import math

import numpy as np
from numpy.typing import NDArray

import cadt

from ._progress import ProgressLine
from .cloud import Cloud, read_cloud
from .errors import FileError, UsageError
from .grid import Grid


def check_max_edge(length: float | None) -> None:
    if length is not None and not length >= 0:
        raise UsageError(f"--max-edge {length:g}: a length is needed, 0 or more")


def read(options: argparse.Namespace, line: ProgressLine) -> Cloud:
    cloud = read_cloud(
        options.inputs,
        classes=options.classes,
        values=options.values,
        columns=options.columns,
        crs=options.crs,
        progress=line.update,
    )
    line.clear()
    return cloud


def triangulate(xy: NDArray[np.float64], name: str, options: argparse.Namespace, line: ProgressLine) -> cadt.Delaunay:
    line.step("triangulating")
    mesh = cadt.Delaunay(
        xy,
        backend=options.backend,
        device=options.device,
        threads=options.threads,
        statistics="none",
        progress=line.update,
    )
    line.clear()
    if mesh.n_triangles == 0:
        raise no_triangles(name, len(xy))
    return mesh


def no_triangles(name: str, points: int) -> FileError:
    return FileError(name, f"no triangles: the {points} points are fewer than three, or all on one line")


def rasterize(
    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay,
    z: NDArray[np.float64],
    grid: Grid,
    method: str = "linear",
    max_edge: float | None = None,
) -> NDArray[np.float64]:
    """The cells of a grid or a part of one, with its very cell size: `Delaunay.rasterize` derives that from the bounds."""
    longest = math.inf if max_edge is None else float(max_edge)
    values = np.ascontiguousarray(z, np.float64)[:, None]
    cells = mesh._queries().rasterize(
        grid.corner, grid.columns, grid.rows, values, method, longest, grid.first_column, grid.first_row
    )
    return np.asarray(cells).reshape(grid.rows, grid.columns)


def kept_triangles(
    mesh: cadt.Delaunay | cadt.ConstrainedDelaunay, max_edge: float | None, name: str | None = None
) -> NDArray[np.int64] | None:
    """Triangles without an edge longer than `max_edge`; None: all of them.

    Raises
    ------
    FileError
        There are none; `name` is that of the points. Without a name none are an answer.
    """
    if max_edge is None or math.isinf(max_edge):
        return None
    kept = np.asarray(mesh.alpha_shape(math.inf, max_edge=max_edge)[0], dtype=np.int64)
    if len(kept) == 0 and name is not None:
        raise FileError(name, f"every triangle has an edge longer than --max-edge {max_edge:g}; take a larger one")
    return kept
