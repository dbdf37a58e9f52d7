# SPDX-License-Identifier: Apache-2.0
"""The examples of the documentation, and the types."""

from __future__ import annotations

import doctest
import importlib
import os
import pkgutil
import subprocess
import sys
from pathlib import Path

import cadt
import numpy as np
import pytest
from cadt import _cadt

MODULES = sorted(m.name for m in pkgutil.walk_packages(cadt.__path__, "cadt.") if not m.name.startswith("cadt._cadt"))
# What needs packages of its own and is tested beside them.
EXTRA = {"cadt.terrain": "laspy", "cadt.scipy": "scipy"}


@pytest.mark.parametrize("name", ["cadt", *MODULES])
def test_examples(name: str) -> None:
    for prefix, package in EXTRA.items():
        if name.startswith(prefix):
            pytest.importorskip(package)
    if name.startswith(("cadt.tiles", "cadt.mpi", "cadt.dask")) and not hasattr(_cadt, "TileTree"):
        pytest.skip("this build of cadt has no tiles")
    if name.startswith("cadt.mpi"):
        try:
            importlib.import_module("mpi4py.MPI")
        except (ImportError, RuntimeError) as e:  # the package, or a library of MPI
            pytest.skip(f"there is no MPI: {e}")
    if name.endswith("__main__"):
        pytest.skip("a program")
    names = {"cadt": cadt, "np": np, "Delaunay": cadt.Delaunay}
    if name.startswith("cadt.scipy"):
        names["scipy"] = pytest.importorskip("scipy")
        importlib.import_module("scipy.spatial")
    module = importlib.import_module(name)
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    result = doctest.testmod(
        module, extraglobs={k: v for k, v in names.items() if not hasattr(module, k)}, optionflags=flags
    )
    assert result.failed == 0


@pytest.mark.skipif(sys.platform != "linux", reason="LD_BIND_NOW is a variable of Linux")
def test_the_extension_module_finds_all_functions_that_it_calls() -> None:
    def starts(code: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-c", code]
        return subprocess.run(command, check=False, capture_output=True, text=True, env={**os.environ, "LD_BIND_NOW": "1"})

    if (bare := starts("pass")).returncode != 0:
        pytest.skip(f"this Python itself does not find all: {bare.stderr}")
    assert (done := starts("import cadt._cadt")).returncode == 0, done.stderr


def test_there_are_examples() -> None:
    finder = doctest.DocTestFinder()
    with_examples = sum(
        bool(t.examples)
        for n in ("cadt._constrained", "cadt._delaunay", "cadt._mesh", "cadt._queries", "cadt._segments", "cadt.scipy._interpolate")
        for t in finder.find(importlib.import_module(n))
    )
    assert with_examples >= 13


def test_types() -> None:
    pytest.importorskip("mypy")
    folder = Path(cadt.__path__[0])
    assert (folder / "_cadt.pyi").exists() and (folder / "py.typed").exists()
    config = Path(__file__).parents[2] / "pyproject.toml"
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--config-file",
        str(config),
        "--cache-dir",
        str(folder.parent / ".mypy_cache"),
    ]
    done = subprocess.run([*command, "-p", "cadt"], check=False, cwd=folder.parent, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
