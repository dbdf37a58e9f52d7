# SPDX-License-Identifier: Apache-2.0
"""Clouds for the tests of cadt.terrain."""

from __future__ import annotations

import pathlib
from typing import Any

import cadt
import laspy
import numpy as np
import pyproj
from cadt.terrain.grid import Grid

PACKAGES = str(pathlib.Path(cadt.__file__).parents[1])
ROOT = pathlib.Path(__file__).parents[3]


def make_las(
    path: pathlib.Path,
    xyz: np.ndarray,
    classes: Any = 2,
    crs: str | None = "EPSG:25832",
    scale: float = 0.001,
    offset: tuple[float, float, float] = (500_000.0, 5_400_000.0, 0.0),
) -> str:
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [scale] * 3, list(offset)
    if crs is not None:
        header.add_crs(pyproj.CRS.from_user_input(crs))
    las = laspy.LasData(header)
    las.x, las.y, las.z = np.asarray(xyz, float).reshape(-1, 3).T
    las.classification = np.broadcast_to(classes, len(las.x)).astype(np.uint8)
    las.write(str(path))
    return str(path)


def hills(n: int, size: float = 100.0, seed: int = 1, at: tuple[float, float] = (500_000.0, 5_400_000.0)) -> np.ndarray:
    """n points on a millimetre grid, scattered, of a smooth surface."""
    xy = np.random.default_rng(seed).uniform(0, size, (n, 2))
    z = 300 + 20 * np.sin(xy[:, 0] / size * 7) * np.cos(xy[:, 1] / size * 5)
    return np.round(np.column_stack((xy[:, 0] + at[0], xy[:, 1] + at[1], z)), 3)


def lattice(columns: int, rows: int) -> np.ndarray:
    return np.stack(np.meshgrid(np.arange(float(columns)), np.arange(float(rows))), axis=-1).reshape(-1, 2)


def many() -> dict[str, np.ndarray]:
    """Points of many kinds, about 100 across."""
    random = np.random.default_rng(5)
    strips = random.uniform(0, 100, (4000, 2)) * [1, 0.04] + [0, 1] * (25.0 * random.integers(0, 5, (4000, 1)))
    ring = 50 + 40 * np.column_stack([f(np.linspace(0, 6.28, 900)) for f in (np.cos, np.sin)])
    return {
        "scattered": random.uniform(0, 100, (6000, 2)),
        "lattice": lattice(40, 30),
        "strips": strips,
        "ring": ring,
        "lake": (p := random.uniform(0, 100, (6000, 2)))[np.hypot(*(p - 50).T) > 30],
        "dense corner": random.uniform(0, 1, (6000, 2)) ** 4 * 100,
        "twice": np.repeat(random.uniform(0, 100, (1500, 2)), 2, axis=0),
        "far point": np.concatenate((random.uniform(0, 100, (3000, 2)), [[4000.0, 3000.0]])),
        "thin": random.uniform(0, 1, (3000, 2)) * [1000, 0.1],
    }


def hull_on_centres(grid: Grid, column: int) -> np.ndarray:
    """3000 points whose hull ends on the right at the centres of a column of cells, as tests of parts of grids need it."""
    place = np.random.default_rng(1).uniform(0, 1, (3000, 2))
    place[:4] = [[0, 0], [1, 0], [0, 1], [1, 1]]
    right = grid.x0 + (column + 0.5) * grid.dx
    xy = np.column_stack((grid.x0 + place[:, 0] * (right - grid.x0), grid.y1 - grid.rows * grid.dy * place[:, 1]))
    xy[place[:, 0] == 1, 0] = right
    return xy
