# SPDX-License-Identifier: Apache-2.0
"""The raster of more points than memory takes: a tree of tiles (cadt.tiles), each drawn when its triangles are final.

Every triangle of the one mesh of all points is final in one node of the tree, so that each cell belongs to one node, unless
its centre lies exactly on an edge or a vertex that triangles of several nodes have. Without a longest edge all of them give
it the same value but for rounding, and the last node that has it writes it. With one, the lowest triangle decides whether
it has a value, as in a mesh of all points: the rim of a node remembers such cells until no later node can have them.
"""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cadt import _cadt, tiles
from cadt.tiles._nodes import Where
from cadt.tiles._tree import build_tree

from ._blocks import Block, Blocks
from ._buckets import Floats, Squares
from ._store import LEAF_POINT, ArrayFile, StoredCloud

Words = NDArray[np.uint64]


@dataclasses.dataclass(frozen=True)
class Rim:
    """Cells of the grid, ascending, that later nodes may have, too; the vertices of the lowest triangle so far, and the
    edge that the centre lies on: both its ends, or twice a vertex. Vertices are input indices."""

    cells: NDArray[np.int64]
    triangles: Words
    edges: Words

    @staticmethod
    def of(parts: list[Rim]) -> Rim:
        """Each cell once."""
        cells = np.concatenate([np.empty(0, np.int64), *(p.cells for p in parts)])
        triangles = np.concatenate([np.empty((0, 3), np.uint64), *(p.triangles for p in parts)])
        edges = np.concatenate([np.empty((0, 2), np.uint64), *(p.edges for p in parts)])
        order = np.lexsort((*triangles.T[::-1], cells))
        order = order[np.concatenate((np.ones(min(len(order), 1), bool), np.diff(cells[order]) > 0))]
        return Rim(cells[order], triangles[order], edges[order])

    def within(self, ids: Words) -> Rim:
        """Cells on edges between these vertices (ascending)."""
        kept = np.isin(self.edges, ids).all(axis=1)
        return Rim(self.cells[kept], self.triangles[kept], self.edges[kept])

    def beaten_by(self, earlier: Rim) -> NDArray[np.bool_]:
        """Cells that have a lower triangle there."""
        if len(earlier.cells) == 0:
            return np.zeros(len(self.cells), bool)
        at = np.minimum(np.searchsorted(earlier.cells, self.cells), len(earlier.cells) - 1)
        other, own = earlier.triangles[at], self.triangles
        # The first vertex that differs decides.
        first = np.argmax(other != own, axis=1)[:, None]
        lower = (np.take_along_axis(other, first, 1) < np.take_along_axis(own, first, 1))[:, 0]
        return (earlier.cells[at] == self.cells) & lower


@dataclasses.dataclass(frozen=True)
class Pending:
    """What a node passes to its parent."""

    open: tiles.Open
    z: Floats  # values of the open vertices
    rim: Rim


class NodeRaster:
    """Draws the linear raster of points in a file on the cells of `blocks`."""

    def __init__(
        self,
        cloud: StoredCloud,
        blocks: Blocks,
        folder: str,
        *,
        tile_points: int,
        where: Where,
        max_edge: float | None = None,
        progress: Callable[[str, float], None],
    ) -> None:
        self.cloud, self.blocks, self.where, self.progress = cloud, blocks, where, progress
        self.max_edge = math.inf if max_edge is None else float(max_edge)
        self.tree = build_tree(len(cloud), tile_points, self._look)
        counts = np.where(self.tree.children[:, 0] < 0, self.tree.counts, 0).astype(np.int64)
        self._begin = np.concatenate(([0], counts.cumsum()))  # of each leaf's points in the file
        self._leaves = ArrayFile(os.path.join(folder, "leaves"), LEAF_POINT)

    def _look(self, builder: _cadt.TreeBuilder) -> _cadt.TreePass:
        found = builder.new_pass()
        for first, xy, _ in self.cloud.pieces():
            builder.look_at(found, first, xy)
            self.progress("sorting", first / len(self.cloud) / 2)
        return found

    def sort(self) -> None:
        """Brings the points to their leaves, and removes the file of the cloud. Ties at cells between triangles are decided
        by the order of points in buckets, as if all were in memory: their numbers there are their ids."""
        squares = Squares(self.cloud.bounds, len(self.cloud))
        end = self._begin[:-1].copy()
        for first, xy, z in self.cloud.pieces():
            squares.sort(xy, z)
            counts, points = self._by_leaf(first, xy, z)
            at = 0
            for leaf in np.flatnonzero(counts).tolist():
                count = int(counts[leaf])
                self._leaves.write(int(end[leaf]), points[at : at + count])
                end[leaf] += count
                at += count
            self.progress("sorting", 0.5 + first / len(self.cloud) / 2)
        self.cloud.file.remove()

    def _by_leaf(self, first: int, xy: Floats, z: Floats) -> tuple[Words, NDArray[np.void]]:
        counts, xy, ids = _cadt.distribute(self.tree._tree, first, xy)
        points = np.empty(len(z), LEAF_POINT)
        points["xy"], points["id"] = xy, ids
        ids -= np.uint64(first)
        points["z"] = z[ids.view(np.int64)]
        return counts, points

    def draw(self) -> tiles.Sums:
        """Finishes all nodes, and removes the file of their points; the sums of the whole mesh.

        Raises
        ------
        InternalError
            The nodes do not make one mesh.
        """
        sums = tiles.Sums()
        pending: dict[int, Pending] = {}
        done = 0
        for node, (left, right) in enumerate(self.tree.children.tolist()):  # children come before their parents
            box = self.tree.boxes[node]
            if left < 0:
                points = self._leaves.read(int(self._begin[node]), int(self._begin[node + 1] - self._begin[node]))
                done += len(points)
                z = np.ascontiguousarray(points["z"])
                made = self.where.leaf(points["xy"], points["id"], box, node)
                earlier = Rim.of([])
                del points
            else:
                below = [pending.pop(left), pending.pop(right)]
                z = np.concatenate([p.z for p in below])
                z = z[np.argsort(np.concatenate([p.open.ids for p in below]))]
                made = self.where.join([p.open for p in below], box, node)
                earlier = Rim.of([p.rim for p in below])
            part, above = tiles.Part(made), made.open
            del made
            ids = above.ids
            rim = self._draw(part, z, earlier)
            pending[node] = Pending(above, z[np.searchsorted(part.ids, ids)], rim.within(ids))
            sums += part.sums
            self.progress("filling", done / len(self.cloud))
        tiles.check_complete(sums)
        self._leaves.remove()
        return sums

    def _draw(self, part: tiles.Part, z: Floats, earlier: Rim) -> Rim:
        """Draws a node's triangles; the cells on its rim and on those of its children."""
        if len(part.triangles) == 0:
            return earlier
        options, _ = self.where._open(len(z))
        drawn = _cadt.PartRaster(part.points, part.triangles, part.neighbors, options)
        grid, side = self.blocks.grid, self.blocks.side
        met = drawn.blocks(grid.corner, grid.columns, grid.rows, side)
        rims = [earlier]
        for number in np.flatnonzero(met).tolist():
            block = self.blocks.block(number)
            of = block.grid
            cells = drawn.rasterize(of.corner, of.columns, of.rows, z, self.max_edge, of.first_column, of.first_row)
            write = ~np.isnan(cells)
            if self.max_edge < math.inf:
                rim = self._rim(drawn, part, block)
                beaten = rim.beaten_by(earlier)
                row, column = np.divmod(rim.cells, grid.columns)
                write[row - of.first_row, column - of.first_column] = ~beaten
                rims.append(rim)
            if write.any():
                self.blocks.write(block, cells, write)
        return Rim.of(rims)

    def _rim(self, drawn: _cadt.PartRaster, part: tiles.Part, block: Block) -> Rim:
        grid, of = self.blocks.grid, block.grid
        cells, triangles, edges = drawn.rim(of.corner, of.columns, of.rows, of.first_column, of.first_row)
        row, column = np.divmod(cells, of.columns)
        cells = (row + of.first_row) * grid.columns + column + of.first_column
        return Rim.of([Rim(cells, part.ids[part.triangles[triangles]], part.ids[edges])])
