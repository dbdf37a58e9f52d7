# SPDX-License-Identifier: Apache-2.0
"""Runs matplotlib's tests of triangulations, their interpolators and refiners, on triangulations of cadt.

usage: python matplotlib_suite.py [arguments of pytest]

The tests are those of the installed package. Those that compare pictures are left out: wheels have no pictures.
"""

from __future__ import annotations

import sys
import types
from pathlib import Path

import cadt
import matplotlib
import matplotlib._qhull as qhull
import numpy as np
import pytest

FOLDER = Path(matplotlib.__file__).parent / "tests"


class Suite:
    def __init__(self) -> None:
        self.asked = self.passed = 0

    def replace(self) -> None:
        qhull.delaunay = self.delaunay
        # The package of the tests refuses to be imported without pictures.
        package = types.ModuleType("matplotlib.tests")
        package.__path__ = [str(FOLDER)]
        package.__file__ = str(FOLDER / "__init__.py")
        sys.modules["matplotlib.tests"] = package

    def delaunay(self, x: np.ndarray, y: np.ndarray, verbose: int) -> tuple[np.ndarray, np.ndarray]:
        """What matplotlib asks Qhull for: triangles, and neighbours across the edge from each corner to the next."""
        self.asked += 1
        xy = np.stack([x, y], axis=1)
        if len(np.unique(xy, axis=0)) < 3:
            raise ValueError("x and y arrays must consist of at least 3 unique points")
        mesh = cadt.Delaunay(xy)
        if mesh.n_triangles == 0:
            raise RuntimeError("the points are on one line")
        triangulation = mesh.to_matplotlib()
        return triangulation.triangles, triangulation.neighbors

    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        drop = [i for i in items if "[png" in i.nodeid]
        config.hook.pytest_deselected(items=drop)
        items[:] = [i for i in items if i not in drop]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.passed += report.when == "call" and report.passed


def main(arguments: list[str]) -> int:
    suite = Suite()
    suite.replace()
    tests = str(FOLDER / "test_triangulation.py")
    code = int(pytest.main([tests, "-q", "-p", "no:cacheprovider", "-W", "ignore", *arguments], plugins=[suite]))
    print(f"cadt triangulated {suite.asked} times in {suite.passed} tests")
    if code == 0 and (suite.passed < 30 or suite.asked < 20):
        print("too few: matplotlib's triangulation was not replaced", file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
