# SPDX-License-Identifier: Apache-2.0
"""From LAS, LAZ and GIS files to terrain: rasters, contour lines, meshes. ``pip install "cadt[terrain]"``.

>>> import cadt, cadt.terrain
>>> cloud = cadt.terrain.read_cloud(["scan.laz"], classes=[2])           # doctest: +SKIP
>>> mesh = cadt.Delaunay(cloud.xy)                                       # doctest: +SKIP
>>> xy, begin, level = cadt.terrain.contour_lines(mesh, cloud.z, 5.0)    # doctest: +SKIP

The commands ``cadt raster``, ``cadt contour`` and ``cadt tin`` are made of these functions.
"""

from .cloud import Cloud, read_cloud
from .cog import open_cog
from .contour import contour_lines
from .errors import CrsError, FileError, TerrainError, Unavailable, UsageError
from .grid import Grid, grid_of, grid_of_file
from .tin import write_tin

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
