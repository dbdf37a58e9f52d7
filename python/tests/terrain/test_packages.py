# SPDX-License-Identifier: Apache-2.0
"""Where the packages are missing, the other tests of this folder are left out, and this one says so."""

import pytest
from needed import MISSING


def test_packages_are_there():
    if MISSING:
        pytest.skip(f"cadt.terrain is not tested: {', '.join(MISSING)} not installed: scripts/python_env terrain")
