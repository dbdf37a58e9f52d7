# SPDX-License-Identifier: Apache-2.0
"""Where the tiles or packages are missing, tests of this folder are left out, and this one says so."""

import importlib.util
import shutil

import pytest
from cadt import _cadt


def test_tiles_are_there() -> None:
    if not hasattr(_cadt, "TileTree"):
        pytest.skip("cadt.tiles, cadt.mpi and cadt.dask are not tested: this build has no tiles")


def test_packages_are_there() -> None:
    missing = [name for name in ("mpi4py", "distributed", "laspy", "lazrs") if importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"{', '.join(missing)} not installed: scripts/python_env scale")


def test_mpirun_is_there() -> None:
    if shutil.which("mpirun") is None:
        pytest.skip("cadt.mpi is tested with one rank alone: there is no mpirun (scripts/setup --tests)")
