# SPDX-License-Identifier: Apache-2.0
"""From LAS, LAZ and GIS files to terrain: rasters, contour lines, meshes. ``pip install "cadt[terrain]"``.

>>> import cadt, cadt.terrain
>>> cloud = cadt.terrain.read_cloud(["scan.laz"], classes=[2])           # doctest: +SKIP
>>> mesh = cadt.Delaunay(cloud.xy)                                       # doctest: +SKIP
>>> xy, begin, level = cadt.terrain.contour_lines(mesh, cloud.z, 5.0)    # doctest: +SKIP

The commands ``cadt raster``, ``cadt contour`` and ``cadt tin`` are made of these functions.
"""

from __future__ import annotations

import importlib

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .cloud import Cloud, read_cloud
    from .cog import open_cog
    from .contour import contour_lines
    from .errors import CrsError, FileError, TerrainError, Unavailable, UsageError
    from .grid import Grid, grid_of, grid_of_file
    from .tin import write_tin

# Where a name stands: it is imported when it is first asked for, so that the program starts at once.
_MODULE_OF = {
    "Cloud": "cloud",
    "CrsError": "errors",
    "FileError": "errors",
    "Grid": "grid",
    "TerrainError": "errors",
    "Unavailable": "errors",
    "UsageError": "errors",
    "contour_lines": "contour",
    "grid_of": "grid",
    "grid_of_file": "grid",
    "open_cog": "cog",
    "read_cloud": "cloud",
    "write_tin": "tin",
}

__all__ = [
    "Cloud",
    "CrsError",
    "FileError",
    "Grid",
    "TerrainError",
    "Unavailable",
    "UsageError",
    "contour_lines",
    "grid_of",
    "grid_of_file",
    "open_cog",
    "read_cloud",
    "write_tin",
]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'cadt.terrain' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"cadt.terrain.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
