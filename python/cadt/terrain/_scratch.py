# SPDX-License-Identifier: Apache-2.0
"""cadt raster --scratch: what is asked of memory and disk, and the raster of the points in the folder."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from cadt import _cadt
from cadt.tiles._nodes import Where

from ._blocks import Blocks, side_for
from ._buckets import Floats
from ._mesh import no_triangles
from ._nodes import NodeRaster
from ._progress import ProgressLine
from ._store import LEAF_POINT, POINT, StoredCloud, check_room, folder_in, store_cloud
from .errors import UsageError
from .grid import Grid

__all__ = ["InScratch", "check_options", "folder_in"]

LEAST_TILE, MOST_TILE = 1 << 16, 1 << 22  # points, unless others are asked for: on the host larger tiles are not faster
BYTES_A_POINT = 300  # of memory while a tile is triangulated and drawn on the host


def check_options(options: argparse.Namespace) -> None:
    if options.method != "linear":
        raise UsageError(
            f"--method {options.method}: with --scratch a tile is drawn and forgotten, but a point's neighbours may be in "
            "another one: use --method linear, or leave out --scratch"
        )
    if options.fill != "none":
        raise UsageError(
            f"--fill {options.fill}: the nearest point of a cell may be in any tile, and --scratch holds one at a time: "
            "leave out one of both"
        )
    least = _cadt.least_tile_points
    if options.tile_points is not None and options.tile_points < least:
        raise UsageError(f"--tile-points {options.tile_points}: at least {least} are needed")


class InScratch:
    """Some points at a time, through files of a folder."""

    def __init__(self, options: argparse.Namespace, line: ProgressLine, folder: str) -> None:
        self.options, self.line, self.folder = options, line, folder

    def read(self) -> StoredCloud:
        options = self.options
        cloud = store_cloud(
            options.inputs,
            self.folder,
            classes=options.classes,
            values=options.values,
            columns=options.columns,
            crs=options.crs,
            progress=self.line.update,
        )
        self.line.clear()
        return cloud

    def rows(self, cloud: StoredCloud, grid: Grid) -> tuple[Iterator[Floats], str]:
        """The rows of the raster, and what computes them. The file of the cloud is removed."""
        n, most, options = len(cloud), self.tile_points(), self.options
        blocks = Blocks(grid, side_for(grid.cells * min(most / n, 1)), f"{self.folder}/cells", options.dtype)
        # The points as they were read are removed before cells are written, and are there already.
        leaves = n * LEAF_POINT.itemsize
        needed = max(leaves, leaves + blocks.bytes - n * POINT.itemsize)
        check_room(self.folder, needed, f"{n} points and {grid.columns} x {grid.rows} cells")
        where = Where(options.backend, options.device, options.threads)
        raster = NodeRaster(
            cloud,
            blocks,
            self.folder,
            tile_points=most,
            where=where,
            max_edge=options.max_edge,
            progress=self.line.update,
        )
        raster.sort()
        if raster.draw().triangles == 0:
            raise no_triangles(", ".join(cloud.sources), n)
        counts = raster.tree.counts[raster.tree.leaves]
        return blocks.rows(), f"{where._open(int(counts.max()))[1].backend}, {len(counts)} tiles"

    def tile_points(self) -> int:
        if self.options.tile_points is not None:
            return int(self.options.tile_points)
        return int(min(max(_cadt.available_memory() // 4 // BYTES_A_POINT, LEAST_TILE), MOST_TILE))
