# SPDX-License-Identifier: Apache-2.0
"""The tree of tiles."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt
from cadt._errors import InputError, OptionError
from cadt._points import as_points
from cadt.tiles import _module as _module

if TYPE_CHECKING:
    from collections.abc import Callable

TILE_POINTS: int = _cadt.default_tile_points


class Tree:
    """A k-d tree of half-open boxes, of which each leaf has at most `tile_points` points.

    It is a function of the points in their order and of `tile_points` alone: the same for any number of processes,
    threads and devices, and in every program of cadt. More points than `tile_points` of one place stay in one leaf.
    Nodes are numbered with children before their parents and leaves from left to right; the last is the root. Can be
    pickled.

    >>> tree = cadt.tiles.Tree.of([[0, 0], [1, 0], [2, 0], [3, 0]], tile_points=3)
    >>> tree.boxes
    array([[-inf, -inf,   2.,  inf],
           [  2., -inf,  inf,  inf],
           [-inf, -inf,  inf,  inf]])
    >>> tree.children.tolist(), tree.counts.tolist(), tree.leaves.tolist()
    ([[-1, -1], [-1, -1], [0, 1]], [2, 2, 4], [0, 1])
    """

    def __init__(self, tree: _cadt.TileTree) -> None:
        self._tree = tree

    @classmethod
    def of(cls, xy: Any, tile_points: int = TILE_POINTS) -> Tree:
        """The tree of points in memory. O(n log(n / tile_points)).

        Raises
        ------
        InputError
            NaN or infinity.
        LimitError
            More than 2**24 - 1 nodes.
        """
        points = normalized(xy)
        bad = first_not_finite(points)
        if bad is not None:
            raise not_finite(points[bad], bad)
        builder = new_builder(len(points), tile_points)
        while not builder.done:
            found = builder.new_pass()
            builder.look_at(found, 0, points)
            builder.finish_pass(found)
        return cls(builder.take())

    @functools.cached_property
    def boxes(self) -> np.ndarray:
        """(nodes, 4) float64: min_x, min_y, max_x, max_y, infinite on the outside."""
        return self._tree.boxes

    @functools.cached_property
    def children(self) -> np.ndarray:
        """(nodes, 2) int64: the left and the right child, -1 of leaves."""
        return self._tree.children

    @functools.cached_property
    def counts(self) -> np.ndarray:
        """(nodes,) uint64: points of the input in each box."""
        return self._tree.counts

    @functools.cached_property
    def leaves(self) -> np.ndarray:
        """Numbers of the leaves, ascending: int64."""
        return np.flatnonzero(self.children[:, 0] < 0)

    @functools.cached_property
    def parents(self) -> np.ndarray:
        """(nodes,) int64: -1 of the root."""
        parents = np.full(len(self), -1, np.int64)
        inner = np.flatnonzero(self.children[:, 0] >= 0)
        parents[self.children[inner].ravel()] = np.repeat(inner, 2)
        return parents

    @functools.cached_property
    def heights(self) -> np.ndarray:
        """(nodes,) int64: 0 of leaves, else one more than that of the higher child."""
        heights = np.zeros(len(self), np.int64)
        for node, (left, right) in enumerate(self.children.tolist()):
            if left >= 0:
                heights[node] = 1 + max(heights[left], heights[right])
        return heights

    def leaf_of(self, xy: Any) -> np.ndarray:
        """(n,) int64: the leaf of each point. O(n depth)."""
        return self._tree.leaf_of(normalized(xy))

    def __len__(self) -> int:
        return len(self._tree)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Tree) and self._tree == other._tree

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple:
        return Tree, (self._tree,)

    def __repr__(self) -> str:
        return f"<cadt.tiles.Tree: {len(self):,} nodes, {len(self.leaves):,} leaves, {int(self.counts[-1]):,} points>"


def normalized(xy: Any) -> np.ndarray:
    """float64, in C's order, -0 as 0: as points are read for tiles. A copy."""
    return np.add(as_points(xy), 0.0, dtype=np.float64, order="C")


def first_not_finite(points: np.ndarray) -> int | None:
    """The first row with NaN or infinity."""
    finite = np.isfinite(points).all(axis=1)
    return None if finite.all() else int(np.argmin(finite))


def not_finite(point: np.ndarray, index: int, where: str = "") -> InputError:
    x, y = (float(v) for v in point)
    return InputError(f"point {index}{where} is ({x}, {y}): coordinates must be finite; remove it or repair it", index)


def new_builder(points: int, tile_points: int) -> _cadt.TreeBuilder:
    if not hasattr(tile_points, "__index__"):
        raise TypeError(f"tile_points must be a whole number, not {tile_points!r}")
    if tile_points < _cadt.least_tile_points:
        raise OptionError(f"a tile has at least {_cadt.least_tile_points} points, not {tile_points}", "tile_points")
    return _cadt.TreeBuilder(points, tile_points)


def build_tree(points: int, tile_points: int, look: Callable[[_cadt.TreeBuilder], _cadt.TreePass]) -> Tree:
    """The tree of points elsewhere: `look` looks at all of them with the builder."""
    builder = new_builder(points, tile_points)
    while not builder.done:
        builder.finish_pass(look(builder))
    return Tree(builder.take())
