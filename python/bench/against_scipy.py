# SPDX-License-Identifier: Apache-2.0
"""Times cadt.scipy against SciPy in one run.

usage: python python/bench/against_scipy.py [--points 1000000] [--queries 10000000] [--cells 2000]

Ratios are of wall time; times of the processor are beside them, as other work on the machine stretches the former. SciPy
locates a ten-thousandth of the queries and interpolates a tenth of the rows, and what it takes is multiplied.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import cadt.scipy
import numpy as np
import scipy.interpolate
import scipy.spatial


def timed(work: Callable[[], object], repeat: int = 1) -> tuple[float, float]:
    """The best wall and processor time."""
    best = (float("inf"), float("inf"))
    for _ in range(repeat):
        wall, cpu = time.perf_counter(), time.process_time()
        work()
        best = min(best[0], time.perf_counter() - wall), min(best[1], time.process_time() - cpu)
    return best


def report(name: str, ours: tuple[float, float], theirs: tuple[float, float], times: float = 1) -> None:
    wall, cpu = times * theirs[0], times * theirs[1]
    print(
        f"{name:34s} cadt {ours[0]:9.4f} s ({ours[1]:9.4f} of processors)   SciPy {wall:9.4f} s ({cpu:9.4f})   "
        f"{wall / ours[0]:6.1f} x",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--queries", type=int, default=10_000_000)
    parser.add_argument("--cells", type=int, default=2000, help="rows and columns of the grid")
    a = parser.parse_args()
    rng = np.random.default_rng(1)

    few = rng.random((10, 2))
    ours = timed(lambda: cadt.scipy.Delaunay(few), 3000)
    report("10 points", ours, timed(lambda: scipy.spatial.Delaunay(few), 3000))

    def use(kind: type) -> None:
        tri = kind(few)
        assert len(tri.simplices) == len(tri.neighbors)

    ours = timed(lambda: use(cadt.scipy.Delaunay), 3000)
    report("10 points, simplices, neighbors", ours, timed(lambda: use(scipy.spatial.Delaunay), 3000))

    points = rng.random((a.points, 2))
    ours = timed(lambda: cadt.scipy.Delaunay(points).simplices, 3)
    theirs = timed(lambda: scipy.spatial.Delaunay(points).simplices)
    report(f"{a.points:,} points", ours, theirs)

    mine, other = cadt.scipy.Delaunay(points), scipy.spatial.Delaunay(points)
    queries = rng.random((a.queries, 2))
    mine.find_simplex(queries[:1])
    other.find_simplex(queries[:1])
    ours = timed(lambda: mine.find_simplex(queries))
    some = queries[: max(1, a.queries // 10_000)]
    report(f"find_simplex of {a.queries:,}", ours, timed(lambda: other.find_simplex(some)), a.queries / len(some))

    z = np.hypot(*points.T)
    x = (np.arange(a.cells) + 0.5) / a.cells
    grid = np.meshgrid(x, x)
    ours = timed(lambda: cadt.scipy.griddata(points, z, tuple(grid)), 3)
    rows = max(1, a.cells // 10)
    linear = scipy.interpolate.LinearNDInterpolator(other, z)
    part = timed(lambda: linear(grid[0][:rows], grid[1][:rows]))
    transform = timed(lambda: scipy.spatial._qhull._get_barycentric_transforms(points, other.simplices, 2.2e-16))
    whole = [theirs[k] + transform[k] + part[k] * a.cells / rows for k in range(2)]
    report(f"griddata to {a.cells * a.cells:,} cells", ours, (whole[0], whole[1]))


if __name__ == "__main__":
    main()
