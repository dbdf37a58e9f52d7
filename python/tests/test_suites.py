# SPDX-License-Identifier: Apache-2.0
"""The tests of SciPy and matplotlib, with cadt in place of Qhull."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


def run(name: str, folder: Path, *arguments: str) -> str:
    pytest.importorskip(name.partition("_")[0])
    command = [sys.executable, str(HERE / f"{name}.py"), *arguments]
    done = subprocess.run(command, check=False, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
    return done.stdout


def test_scipy(tmp_path: Path) -> None:
    assert "5 xfailed" in run("scipy_suite", tmp_path, "--quick")


@pytest.mark.thorough
def test_scipy_in_all_dimensions(tmp_path: Path) -> None:
    assert "5 xfailed" in run("scipy_suite", tmp_path)


def test_matplotlib(tmp_path: Path) -> None:
    run("matplotlib_suite", tmp_path)


@pytest.mark.thorough
def test_a_suite_that_does_not_use_cadt_fails(tmp_path: Path) -> None:
    """What a runner must notice: that it tested SciPy's own classes."""
    script = "import scipy_suite as s; s.REPLACED = {}; raise SystemExit(s.main(['--quick', '-k', 'TestGriddata and linear']))"
    done = subprocess.run([sys.executable, "-c", script], check=False, cwd=HERE, capture_output=True, text=True)
    assert done.returncode != 0
