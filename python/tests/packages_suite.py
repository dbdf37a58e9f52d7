# SPDX-License-Identifier: Apache-2.0
"""Runs tests of packages that build on SciPy's triangulations, with SciPy's classes and with those of cadt.scipy.

usage: python packages_suite.py [PACKAGE...]     scripts/python_env packages installs them

The tests are those of the installed packages and are not copied. The same ones must fail both times (some want data from
the network) but those of EXPECTED.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = {
    "adaptive": ("tests/test_learnernd.py", "tests/unit", "tests/test_triangulation.py"),
    "esda": ("tests/test_shape.py", "tests/test_topo.py", "tests/test_adbscan.py"),
    "libpysal": ("cg/tests/test_voronoi.py", "graph/tests/test_triangulation.py", "weights/tests/test_gabriel.py"),
    "momepy": ("tests/test_elements.py",),
    "verde": ("tests/test_mask.py", "tests/test_scipy.py", "tests/test_utils.py", "tests/test_minimal.py"),
}
EXPECTED = {"libpysal": {"TestVoronoi::test_voronoi": "asserts Qhull's order of vertices"}}
REPLACED = {
    "scipy.spatial": ("Delaunay", "Voronoi"),
    "scipy.interpolate": (
        "CloughTocher2DInterpolator",
        "LinearNDInterpolator",
        "NearestNDInterpolator",
        "griddata",
    ),
}


class Suite:
    """Prints what failed, and how often cadt was asked."""

    def __init__(self) -> None:
        self.asked = 0
        self.passed: set[str] = set()
        self.failed: set[str] = set()

    def replace(self) -> None:
        import cadt.scipy

        for module, names in REPLACED.items():
            for name in names:
                setattr(importlib.import_module(module), name, getattr(cadt.scipy, name))
        for kind in (cadt.scipy.Delaunay, cadt.scipy.Voronoi):
            self._count(kind)

    def _count(self, kind: type) -> None:
        made = kind.__init__

        def init(*arguments: object, **options: object) -> None:
            self.asked += 1
            made(*arguments, **options)

        kind.__init__ = init

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        name = report.nodeid.partition("::")[2]
        if report.failed:
            self.failed.add(name)
        elif report.when == "call" and report.passed:
            self.passed.add(name)

    def run(self, package: str) -> None:
        spec = importlib.util.find_spec(package)
        assert spec is not None and spec.origin is not None
        folder = Path(spec.origin).parent
        files = [str(folder / name) for name in TESTS[package]]
        missing = [name for name in files if not os.path.exists(name)]
        assert not missing, f"{package} has no {missing}"
        status = pytest.main([*files, "-q", "-p", "no:cacheprovider", "-W", "ignore"], plugins=[self])
        if status not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):  # such as a file that cannot be imported
            sys.exit(f"the tests of {package} have not run: {status!r}")
        for word, names in (("failed", self.failed), ("passed", self.passed)):
            for name in sorted(names):
                print(f"== {word} {name}")
        print(f"== asked {self.asked}")


def results(package: str, whose: str) -> tuple[set[str], set[str], int]:
    # momepy's work stays in this process, where the classes are replaced.
    environment = {**os.environ, "DASK_SCHEDULER": "threads"}
    command = [sys.executable, __file__, f"--{whose}", package]
    out = subprocess.run(command, capture_output=True, text=True, check=False, env=environment).stdout
    lines = [line.split(" ", 2)[1:] for line in out.splitlines() if line.startswith("== ")]
    asked = [int(rest) for word, rest in lines if word == "asked"]
    assert asked, f"the tests of {package} have not run:\n{out[-3000:]}"
    return (
        {rest for word, rest in lines if word == "failed"},
        {rest for word, rest in lines if word == "passed"},
        asked[0],
    )


def compare(package: str) -> bool:
    theirs, theirs_passed, _ = results(package, "scipy")
    ours, passed, asked = results(package, "cadt")
    expected = set(EXPECTED.get(package, {}))
    wrong = sorted(ours - theirs - expected) + sorted(expected - ours)
    print(f"{package}: {len(passed)} of {len(theirs_passed)} passed, cadt was asked {asked} times", *wrong, sep="\n  ")
    return not wrong and asked > 0 and len(passed) >= len(theirs_passed) - len(expected)


def main(arguments: list[str]) -> int:
    if arguments and arguments[0] in ("--scipy", "--cadt"):
        suite = Suite()
        if arguments[0] == "--cadt":
            suite.replace()
        suite.run(arguments[1])
        return 0
    return 0 if all([compare(package) for package in arguments or sorted(TESTS)]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
