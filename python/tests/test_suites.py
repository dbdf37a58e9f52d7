# SPDX-License-Identifier: Apache-2.0
"""The tests of SciPy, of matplotlib and of packages that build on them, with cadt in place of Qhull."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import packages_suite
import pytest

HERE = Path(__file__).parent


def run(name: str, folder: Path, *arguments: str) -> str:
    command = [sys.executable, str(HERE / f"{name}.py"), *arguments]
    done = subprocess.run(command, check=False, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
    return done.stdout


def failures_expected() -> str:
    scipy = pytest.importorskip("scipy")
    version = tuple(int(part) for part in scipy.__version__.split(".")[:2])
    return "11 xfailed" if version >= (1, 18) else "5 xfailed"


def test_scipy(tmp_path: Path) -> None:
    assert failures_expected() in run("scipy_suite", tmp_path, "--quick")


@pytest.mark.thorough
def test_scipy_in_all_dimensions(tmp_path: Path) -> None:
    assert failures_expected() in run("scipy_suite", tmp_path)


def test_matplotlib(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    run("matplotlib_suite", tmp_path)


@pytest.mark.thorough
@pytest.mark.parametrize("package", sorted(packages_suite.TESTS))
def test_packages_that_build_on_scipy(tmp_path: Path, package: str) -> None:
    """scripts/python_env packages installs them."""
    pytest.importorskip(package)
    run("packages_suite", tmp_path, package)


def test_tests_of_a_package_that_cannot_be_imported_fail(tmp_path: Path) -> None:
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "__init__.py").touch()
    (tmp_path / "broken" / "test_it.py").write_text("import no_such_module\n")
    script = "import packages_suite as s; s.TESTS = {'broken': ('test_it.py',)}; s.Suite().run('broken')"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path[1:]])}
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, check=False, cwd=HERE, env=environment, capture_output=True, text=True)
    assert done.returncode != 0 and "no_such_module" in done.stdout and "== asked" not in done.stdout


@pytest.mark.thorough
def test_a_suite_that_does_not_use_cadt_fails(tmp_path: Path) -> None:
    """What a runner must notice: that it tested SciPy's own classes."""
    script = "import scipy_suite as s; s.REPLACED = {}; raise SystemExit(s.main(['--quick', '-k', 'TestGriddata and linear']))"
    done = subprocess.run([sys.executable, "-c", script], check=False, cwd=HERE, capture_output=True, text=True)
    assert done.returncode != 0
