# SPDX-License-Identifier: Apache-2.0
"""What the tests of cadt.mpi and cadt.dask need that is not there."""

from __future__ import annotations

import importlib.util
import shutil

from cadt import _cadt

MISSING = [name for name in ("mpi4py", "distributed", "laspy", "lazrs") if importlib.util.find_spec(name) is None]
if not hasattr(_cadt, "TileTree"):
    MISSING.append("tiles in this build of cadt")
if shutil.which("mpirun") is None:
    MISSING.append("mpirun")
