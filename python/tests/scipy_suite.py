# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of the installed SciPy with its classes replaced by those of cadt.scipy.

usage: python scipy_suite.py [--quick] [arguments of pytest]

All must pass but those of EXPECTED, each of which must fail, for the reason that it gives. The tests are those of the
installed package and are not copied. --quick leaves out other dimensions, which are SciPy's own work, and slow tests.
"""

from __future__ import annotations

import importlib
import sys

import cadt.scipy
import pytest

ORDER = "asserts Qhull's order of triangles, of their corners and of the hull's edges"
MISSED = "of SciPy 1.18: asserts that with its default tolerance SciPy's search finds no triangle for some places on edges"
EXPECTED = {
    "TestUtilities::test_find_simplex": ORDER,
    "TestUtilities::test_convex_hull": ORDER,
    "TestDelaunay::test_2d_square": ORDER,
    "TestVoronoi::test_simple": "asserts with which vertex, and in which sense, Qhull begins each region",
    "TestUtilities::test_degenerate_barycentric_transforms": "asserts that fewer than 23 transforms are NaN, and that the "
    "others have each triangle's rounded centroid inside: in the exact triangulation 31 triangles are lower than an ulp of "
    "their coordinates, so that no transform has, and Qhull leaves 9 of them out (test_scipy.py)",
    **{
        f"{test}[{interpolator}-1]": MISSED
        for test in (
            "test_interp_from_boundary",
            "test_reproduction_NaN_on_points_linear_combination",
            "test_reproduction_NaN_on_input_points",
        )
        for interpolator in ("LinearNDInterpolator", "CloughTocher2DInterpolator")
    },
}
# Not of the classes that are replaced.
OTHERS = ("Test_Qhull::test_swapping", "TestConvexHull", "Test_HalfspaceIntersection", "volume_area")
SLOW = ("test_more_barycentric_transforms", "test_threading", "3d", "4d", "5d", "6d", "7d", "8d", "-3-", "[3-")
TESTS = (
    "scipy.spatial.tests.test_qhull",
    "scipy.interpolate.tests.test_interpnd",
    "scipy.interpolate.tests.test_ndgriddata",
)
REPLACED = {
    "scipy.spatial": ("Delaunay", "Voronoi", "tsearch"),
    "scipy.interpolate": (
        "LinearNDInterpolator",
        "CloughTocher2DInterpolator",
        "NearestNDInterpolator",
        "griddata",
    ),
}
# Private names through which the tests reach the same classes, of SciPy 1.15 and before.
PRIVATE = {
    "scipy.spatial": ("scipy.spatial._qhull",),
    "scipy.interpolate": (
        "scipy.interpolate._interpnd",
        "scipy.interpolate.interpnd",
        "scipy.interpolate._ndgriddata",
    ),
}


class Suite:
    """Selects tests, marks those that must fail, and counts how often cadt was asked."""

    def __init__(self, quick: bool) -> None:
        self.quick = quick
        self.asked = self.passed = 0

    def replace(self) -> None:
        for public, names in REPLACED.items():
            for module in (public, *PRIVATE[public]):
                try:
                    loaded = importlib.import_module(module)
                except ImportError:
                    continue
                for name in names:
                    if name in vars(loaded):
                        setattr(loaded, name, getattr(cadt.scipy, name))
        made = cadt.Delaunay.__init__

        def counted(*args: object, **how: object) -> None:
            self.asked += 1
            made(*args, **how)  # type: ignore[arg-type]

        cadt.Delaunay.__init__ = counted  # type: ignore[method-assign, assignment]

    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        left_out = (*OTHERS, *SLOW) if self.quick else OTHERS
        drop = [i for i in items if any(name in i.nodeid for name in left_out)]
        config.hook.pytest_deselected(items=drop)
        items[:] = [i for i in items if i not in drop]
        for item in items:
            for name, reason in EXPECTED.items():
                if item.nodeid.endswith(name):
                    item.add_marker(pytest.mark.xfail(strict=True, raises=AssertionError, reason=reason))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.passed += report.when == "call" and report.passed


def main(arguments: list[str]) -> int:
    quick = "--quick" in arguments
    suite = Suite(quick)
    suite.replace()
    options = ["--pyargs", *TESTS, "-q", "-rxX", "-p", "no:cacheprovider", "-W", "ignore"]
    code = int(pytest.main([*options, *(a for a in arguments if a != "--quick")], plugins=[suite]))
    print(f"cadt triangulated {suite.asked} times in {suite.passed} tests")
    if code == 0 and (suite.passed < 100 or suite.asked < 300):
        print("too few: SciPy's classes were not replaced", file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
