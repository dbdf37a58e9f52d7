# SPDX-License-Identifier: Apache-2.0
"""One mesh of more points than a device or a memory takes: tiles that are triangulated alone, and joined.

A tree of boxes halves the plane until each leaf has few enough points. `finish_leaf` triangulates the points of a leaf
alone: triangles whose circles lie in the box are final, and only the few vertices with others are passed up (about
six times the square root of the points). `finish_join` triangulates what its children passed up. All final triangles
together are the mesh of all points in one call, and each is final in one node alone. ``cadt.mpi`` and ``cadt.dask`` do
this on many machines.

>>> xy = np.random.default_rng(0).random((3000, 2))
>>> tree = cadt.tiles.Tree.of(xy, tile_points=1000)
>>> leaf = tree.leaf_of(xy)
>>> sums, opens = cadt.tiles.Sums(), {}
>>> for node in range(len(tree)):  # children come before their parents
...     box, children = tree.boxes[node], tree.children[node]
...     if children[0] < 0:
...         ids = np.flatnonzero(leaf == node)
...         part, opens[node] = cadt.tiles.finish_leaf(xy[ids], ids, box, node)
...     else:
...         below = [opens.pop(c) for c in children]
...         part, opens[node], links = cadt.tiles.finish_join(below, box, node)
...     sums += part.sums
>>> cadt.tiles.check_complete(sums)
>>> mesh = cadt.Delaunay(xy)
>>> sums.triangles == mesh.n_triangles, cadt.tiles.mesh_hash(sums) == mesh.hash
(True, True)
"""

from __future__ import annotations

from cadt.tiles._nodes import (
    LOCAL_BITS,
    OUTSIDE,
    PENDING,
    PLANE,
    Open,
    Part,
    Sums,
    check_complete,
    finish_join,
    finish_leaf,
    mesh_hash,
)
from cadt.tiles._tree import TILE_POINTS, Tree

__all__ = [
    "LOCAL_BITS",
    "OUTSIDE",
    "PENDING",
    "PLANE",
    "TILE_POINTS",
    "Open",
    "Part",
    "Sums",
    "Tree",
    "check_complete",
    "finish_join",
    "finish_leaf",
    "mesh_hash",
]
