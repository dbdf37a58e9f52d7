# SPDX-License-Identifier: Apache-2.0
"""Where the packages are missing, the other tests of this folder are left out, and this one says so."""

import os

import pytest
from needed import MISSING


def test_packages_are_there():
    if MISSING:
        give_up = pytest.fail if os.environ.get("CADT_REQUIRE_PACKAGES") else pytest.skip
        give_up(f"cadt.terrain is not tested: {', '.join(MISSING)} not installed: scripts/python_env terrain")
