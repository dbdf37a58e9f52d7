# SPDX-License-Identifier: Apache-2.0
"""A mesh in nodes as one mesh, and points that are hard to cut."""

from __future__ import annotations

import cadt
import numpy as np

# Numbers of triangles that mean something else: the hull, and what a later node would have told.
HULL = -1


def families() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(5)
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    lattice = np.stack(np.meshgrid(np.arange(24.0), np.arange(17.0)), axis=-1).reshape(-1, 2)
    return {
        "uniform": rng.random((900, 2)),
        "lattice": rng.permutation(lattice),
        "duplicates": rng.permutation(np.repeat(rng.random((150, 2)), 3, axis=0)),
        "few places": rng.integers(0, 5, (400, 2)).astype(float),
        "circle": np.concatenate([np.stack([np.cos(angle), np.sin(angle)], axis=1), rng.random((100, 2)) - 0.5]),
        "clusters": rng.integers(0, 4, (500, 1)) * [100.0, 37.0] + rng.normal(size=(500, 2)) * 1e-3,
        "line": np.stack([np.arange(100.0), 3 * np.arange(100.0)], axis=1),
        "one place": np.full((20, 2), -0.0),
        "one point": np.array([[3.0, 4.0]]),
        "no point": np.empty((0, 2)),
        "far": np.round(rng.random((300, 2)) * 100, 3) + [500_000, 5_300_000],
    }


def merged(parts, bases) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (by input indices, the smallest first, ascending) and their neighbours in this order."""
    parts = sorted(parts, key=lambda part: part.node)
    triangles = np.concatenate([part.vertices for part in parts]).astype(np.int64).reshape(-1, 3)
    neighbors = []
    for part in parts:
        near = part.neighbors.astype(np.int64)
        here = np.where(near >= 0, near + int(bases[part.node]), HULL)
        rows = -2 - near[near <= -2]
        ids = part.links[rows]
        assert not (ids == cadt.tiles.PENDING).any()
        node, row = ids >> np.uint64(cadt.tiles.LOCAL_BITS), ids & np.uint64(2**cadt.tiles.LOCAL_BITS - 1)
        outside = ids == cadt.tiles.OUTSIDE
        node[outside] = 0
        here[near <= -2] = np.where(outside, HULL, (bases[node.astype(np.int64)] + row).astype(np.int64))
        neighbors.append(here)
    return canonical(triangles, np.concatenate(neighbors).reshape(-1, 3))


def canonical(triangles: np.ndarray, neighbors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if len(triangles) == 0:
        return triangles, neighbors
    turn = (triangles.argmin(axis=1)[:, None] + np.arange(3)) % 3
    triangles, neighbors = np.take_along_axis(triangles, turn, 1), np.take_along_axis(neighbors, turn, 1)
    order = np.lexsort(triangles.T[::-1])
    place = np.empty(len(order) + 1, np.int64)
    place[order], place[-1] = np.arange(len(order)), HULL
    return triangles[order], place[neighbors[order]]


def require_same(xy: np.ndarray, parts, bases, sums) -> None:
    """That the nodes are the mesh of one call, array by array."""
    mesh = cadt.Delaunay(xy)
    cadt.tiles.check_complete(sums)
    assert cadt.tiles.mesh_hash(sums) == mesh.hash
    assert (sums.points, sums.triangles, sums.dimension) == (len(xy), mesh.n_triangles, mesh.dimension)
    triangles, neighbors = merged(parts, bases)
    wanted = canonical(mesh.simplices.astype(np.int64), mesh.neighbors.astype(np.int64))
    np.testing.assert_array_equal(triangles, wanted[0])
    np.testing.assert_array_equal(neighbors, wanted[1])
    duplicates = np.concatenate([np.empty((0, 2), np.uint64), *(part.duplicates for part in parts)])
    found = np.full(len(xy), -1)
    found[duplicates[:, 0].astype(np.int64)] = duplicates[:, 1]
    np.testing.assert_array_equal(found, mesh.duplicate_of)


def by_hand(xy: np.ndarray, tile_points: int, change=lambda node, part: part):
    """All nodes of a tree in this process: parts, bases, sums. `change` may tamper with what goes up."""
    tree = cadt.tiles.Tree.of(xy, tile_points)
    leaf = tree.leaf_of(xy)
    parts, opens, told, sums = [], {}, [], cadt.tiles.Sums()
    for node, children in enumerate(tree.children.tolist()):
        if children[0] < 0:
            ids = np.flatnonzero(leaf == node)
            part, above = cadt.tiles.finish_leaf(xy[ids], ids, tree.boxes[node], node)
        else:
            part, above, links = cadt.tiles.finish_join([opens.pop(c) for c in children], tree.boxes[node], node)
            told.append(links)
        opens[node] = change(node, above)
        parts.append(part)
        sums += part.sums
    told = np.concatenate([np.empty((0, 3), np.uint64), *told])
    for part in parts:
        part.apply_links(told[told[:, 0] >> np.uint64(40) == part.node])
    bases = np.cumsum([0, *(len(part.triangles) for part in parts)]).astype(np.uint64)
    assert len(opens.pop(len(tree) - 1)) == 0
    assert not opens
    return parts, bases, sums, tree
