# SPDX-License-Identifier: Apache-2.0
"""Which of the packages that all tests of cadt.terrain need are not there."""

import importlib.util

NEEDED = ("laspy", "lazrs", "rasterio", "pyogrio", "pyproj")
MISSING = [name for name in NEEDED if importlib.util.find_spec(name) is None]
