# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pickle

import cadt
import numpy as np
import pytest
from cadt import _cadt
from tile_meshes import families

if not hasattr(_cadt, "TileTree"):
    pytest.skip("this build of cadt has no tiles", allow_module_level=True)

FAMILIES = families()


@pytest.mark.parametrize("tile_points", [3, 50])
@pytest.mark.parametrize("name", FAMILIES)
def test_leaves_have_their_points(name: str, tile_points: int) -> None:
    xy = FAMILIES[name]
    tree = cadt.tiles.Tree.of(xy, tile_points)
    leaf = tree.leaf_of(xy)
    low, high = tree.boxes[leaf, :2], tree.boxes[leaf, 2:]
    assert (low <= xy).all() and (xy < high).all()
    counts = np.bincount(leaf, minlength=len(tree))
    np.testing.assert_array_equal(tree.counts[tree.leaves], counts[tree.leaves])
    for node in tree.leaves:
        assert counts[node] <= tile_points or len(np.unique(xy[leaf == node] + 0.0, axis=0)) == 1
    assert tree.counts[-1] == len(xy)
    assert (tree.boxes[-1] == cadt.tiles.PLANE).all()


def test_numbers_of_nodes() -> None:
    tree = cadt.tiles.Tree.of(FAMILIES["uniform"], 30)
    for node, (left, right) in enumerate(tree.children.tolist()):
        if left < 0:
            assert right < 0 and tree.heights[node] == 0
            continue
        assert left < right < node
        assert tree.parents[left] == tree.parents[right] == node
        assert tree.heights[node] == 1 + max(tree.heights[left], tree.heights[right])
        np.testing.assert_array_equal(tree.counts[node], tree.counts[left] + tree.counts[right])
        np.testing.assert_array_equal(tree.boxes[node, :2], tree.boxes[left, :2])
        np.testing.assert_array_equal(tree.boxes[node, 2:], tree.boxes[right, 2:])
    assert tree.parents[-1] == -1 and len(tree) == 2 * len(tree.leaves) - 1


def test_pickle_and_equality() -> None:
    tree = cadt.tiles.Tree.of(FAMILIES["uniform"], 30)
    again = pickle.loads(pickle.dumps(tree))
    assert again == tree and repr(again) == repr(tree)
    np.testing.assert_array_equal(again.leaf_of([[0.5, 0.5]]), tree.leaf_of([[0.5, 0.5]]))
    assert tree != cadt.tiles.Tree.of(FAMILIES["uniform"], 10) and tree != 3


def test_passes_may_be_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Builders that were pickled look at parts of the points; the sum is that of one look at all."""
    xy = np.random.default_rng(3).random((3_000, 2)) ** 4
    builder = _cadt.TreeBuilder(len(xy), 100)
    rounds = 0
    while not builder.done:
        other = pickle.loads(pickle.dumps(builder))
        found = builder.new_pass()
        builder.look_at(found, 0, xy[:1000])
        more = other.new_pass()
        other.look_at(more, 1000, xy[1000:])
        found += pickle.loads(pickle.dumps(more))
        builder.finish_pass(found)
        rounds += 1
    assert rounds >= 2
    assert cadt.tiles.Tree(builder.take()) == cadt.tiles.Tree.of(xy, 100)


def test_minus_zero_is_zero() -> None:
    xy = np.array([[-0.0, 1.0], [0.0, 1.0], [1.0, 1.0], [2.0, -0.0]])
    assert cadt.tiles.Tree.of(xy, 3) == cadt.tiles.Tree.of(xy + 0.0, 3)


def test_errors() -> None:
    with pytest.raises(cadt.OptionError, match="at least 3"):
        cadt.tiles.Tree.of([[0, 0]], 2)
    with pytest.raises(cadt.InputError, match="point 1 ") as e:
        cadt.tiles.Tree.of([[0, 0], [np.nan, 1], [np.inf, 0]])
    assert e.value.index == 1
    with pytest.raises(ValueError, match="builder"):
        _cadt.TreeBuilder(100, 10).finish_pass(_cadt.TreeBuilder(3, 10).new_pass())
    with pytest.raises(cadt.Error, match="not a tree"):
        box = np.array([[0.0, 0, 1, 1]])
        _cadt.TileTree.__new__(_cadt.TileTree).__setstate__((box, np.array([[-1, -1]]), np.array([3], np.uint64)))
