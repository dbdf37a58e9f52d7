# SPDX-License-Identifier: Apache-2.0
"""Where something is missing, the other tests of this folder are left out, and this one says so."""

import os

import pytest
from scale_needed import MISSING


def test_packages_are_there() -> None:
    if MISSING:
        give_up = pytest.fail if os.environ.get("CADT_REQUIRE_PACKAGES") else pytest.skip
        give_up(
            f"cadt.mpi and cadt.dask are not tested: {', '.join(MISSING)} not there: scripts/setup --tests; "
            "scripts/python_env scale"
        )
