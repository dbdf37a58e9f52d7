# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pathlib

from cadt import _cadt

TILES = hasattr(_cadt, "TileTree")


def pytest_ignore_collect(collection_path: pathlib.Path) -> bool | None:
    """Where there are no tiles, test_packages.py alone is left, and says so."""
    return (not TILES and collection_path.match("test_*.py") and collection_path.name != "test_packages.py") or None
