# SPDX-License-Identifier: Apache-2.0
"""finish_leaf and finish_join give the mesh of one call."""

from __future__ import annotations

import copy
import os
import pickle
import threading

import cadt
import numpy as np
import pytest
from cadt import _cadt
from tile_meshes import by_hand, families, require_same

if not hasattr(_cadt, "TileTree"):
    pytest.skip("this build of cadt has no tiles", allow_module_level=True)

FAMILIES = families()


@pytest.mark.parametrize("tile_points", [3, 10, 64, 10_000])
@pytest.mark.parametrize("name", FAMILIES)
def test_all_nodes_are_one_mesh(name: str, tile_points: int) -> None:
    xy = FAMILIES[name]
    parts, bases, sums, _ = by_hand(xy, tile_points)
    require_same(xy, parts, bases, sums)


def test_pickled_between_nodes() -> None:
    xy = FAMILIES["uniform"]
    sizes = []

    def through_a_pickle(node: int, above: cadt.tiles.Open) -> cadt.tiles.Open:
        data = pickle.dumps(above, protocol=5)
        sizes.append(len(data) - 24 * len(above) - 40 * above.number_of_sides)
        again = pickle.loads(data)
        np.testing.assert_array_equal(again.ids, above.ids)
        np.testing.assert_array_equal(again.xy, above.xy)
        return again

    parts, bases, sums, _ = by_hand(xy, 50, through_a_pickle)
    require_same(xy, pickle.loads(pickle.dumps(parts)), bases, pickle.loads(pickle.dumps(sums)))
    assert max(sizes) < 400, "beside 24 bytes a vertex and 40 a side"
    assert copy.copy(sums) == sums


def test_nothing_is_copied_out_of_band() -> None:
    _, above = cadt.tiles.finish_leaf(FAMILIES["uniform"], None, (-1, -1, 2, 2))
    buffers: list[pickle.PickleBuffer] = []
    data = pickle.dumps(above, protocol=5, buffer_callback=buffers.append)
    assert len(data) < 400 < sum(b.raw().nbytes for b in buffers)
    np.testing.assert_array_equal(pickle.loads(data, buffers=buffers).ids, above.ids)


def test_a_lost_side_is_noticed() -> None:
    def lose(node: int, above: cadt.tiles.Open) -> cadt.tiles.Open:
        if node != 0:
            return above
        words = above.__getstate__().copy()
        words[1] -= 1
        words = words[:-5]
        return type(above).__new__(type(above)) if len(words) == 0 else _cadt.open_of_words(words)

    with pytest.raises(cadt.InternalError):
        by_hand(FAMILIES["uniform"], 100, lose)


def test_a_missing_node_is_noticed() -> None:
    parts, _, _, _ = by_hand(FAMILIES["uniform"], 100)
    with pytest.raises(cadt.InternalError):
        cadt.tiles.check_complete(sum((part.sums for part in parts[1:]), cadt.tiles.Sums()))


def test_arrays() -> None:
    xy = FAMILIES["duplicates"]
    part, above = cadt.tiles.finish_leaf(xy.tolist(), np.arange(len(xy)) + 2**40, node=5)
    assert len(above) == 0 and above.number_of_sides == 0
    dtypes = [part.points.dtype, part.ids.dtype, part.triangles.dtype, part.neighbors.dtype, part.links.dtype]
    assert dtypes == [np.float64, np.uint64, np.int32, np.int32, np.uint64]
    assert part.duplicates.dtype == np.uint64 and part.duplicates.shape == (300, 2)
    assert part.ids[0] == 2**40 and part.vertices.min() >= 2**40 and part.vertices.dtype == np.uint64
    assert part.statistics["points"] == len(xy)
    with pytest.raises(ValueError, match="read-only"):
        part.triangles[0] = 0
    mesh = cadt.Delaunay(xy)
    np.testing.assert_array_equal(part.triangles, mesh.simplices)
    np.testing.assert_array_equal(part.neighbors, mesh.neighbors)
    again = pickle.loads(pickle.dumps(part))
    np.testing.assert_array_equal(again.neighbors, part.neighbors)
    assert repr(again) == repr(part)


def test_final_triangles_do_not_depend_on_what_is_outside() -> None:
    xy = FAMILIES["uniform"]
    box = (0.25, 0.25, 0.75, 0.75)
    inside = np.flatnonzero((xy >= 0.25).all(axis=1) & (xy < 0.75).all(axis=1))
    part, above = cadt.tiles.finish_leaf(xy[inside], inside, box)
    of_all = {tuple(sorted(t)) for t in cadt.Delaunay(xy).simplices.tolist()}
    found = {tuple(sorted(t)) for t in part.vertices.tolist()}
    assert 100 < len(found) and found <= of_all
    assert 0 < len(above) < len(inside)


@pytest.mark.parametrize(
    ("arguments", "error", "says"),
    [
        (([[0, 0], [1, np.nan]],), cadt.InputError, "nan|NaN|finite"),
        (([[0, 0], [1, 1]], [5, 5]), cadt.InputError, "not above"),
        (([[0, 0], [1, 1]], [0]), cadt.InputError, "shape"),
        (([[0, 0], [1, 1]], [-1, 0]), cadt.InputError, "negative"),
        (([[0, 0], [1, 1]], [0.5, 1]), cadt.InputError, "integers"),
        (([[0, 0], [2, 1]], None, (0, 0, 2, 2)), cadt.InputError, "box"),
        (([[0, 0]], None, (0, 0, 0, 2)), cadt.InputError, "minimum"),
        (([[0, 0]], None, (0, 0, 1)), cadt.InputError, "min_x"),
        (([[0, 0]], None, cadt.tiles.PLANE, 2**24), cadt.InputError, "2\\*\\*24"),
        (([[0, 0, 0]],), cadt.InputError, "shape"),
        ((np.zeros((2, 2), complex),), TypeError, "complex"),
    ],
)
def test_bad_leaves(arguments: tuple, error: type, says: str) -> None:
    with pytest.raises(error, match=says):
        cadt.tiles.finish_leaf(*arguments)


def test_the_index_of_a_bad_point_is_its_id() -> None:
    with pytest.raises(cadt.InputError) as e:
        cadt.tiles.finish_leaf([[0, 0], [1, np.inf]], [7, 70])
    assert e.value.index == 70


def test_bad_joins() -> None:
    _, above = cadt.tiles.finish_leaf([[0, 0], [1, 0], [0, 1]], None, (-1, -1, 2, 2))
    with pytest.raises(TypeError, match="finish_leaf"):
        cadt.tiles.finish_join([above, 3])  # type: ignore[list-item]
    with pytest.raises(cadt.InputError, match="not above"):
        cadt.tiles.finish_join([above, above])
    with pytest.raises(cadt.Error):
        _cadt.open_of_words(np.array([2, 0, 1], np.uint64))


def test_bad_links() -> None:
    _, _, _, tree = by_hand(FAMILIES["uniform"], 100)
    leaf = tree.leaf_of(FAMILIES["uniform"])
    ids = np.flatnonzero(leaf == 0)
    part, _ = cadt.tiles.finish_leaf(FAMILIES["uniform"][ids], ids, tree.boxes[0], 0)
    with pytest.raises(cadt.InternalError, match="never told"):
        part.apply_links(np.empty((0, 3), np.uint64))
    with pytest.raises(cadt.InternalError, match="does not exist"):
        part.apply_links([[0, 10**6, 0]])


@pytest.mark.parametrize("backend", ["host", "opencl", "cuda"])
def test_back_ends_agree(backend: str) -> None:
    if not any(d.backend == backend and d.usable and d.fp64 for d in cadt.devices()):
        pytest.skip(f"{backend} has no device with double precision here")
    xy = FAMILIES["uniform"]
    box = (0, 0, 1, np.inf)
    here, above = cadt.tiles.finish_leaf(xy, None, box)
    there, above_there = cadt.tiles.finish_leaf(xy, None, box, backend=backend)
    assert pickle.dumps(above) == pickle.dumps(above_there)
    for name in ("triangles", "neighbors", "links", "duplicates"):
        np.testing.assert_array_equal(getattr(here, name), getattr(there, name))
    up, _, links = cadt.tiles.finish_join([above], node=1)
    up_there, _, links_there = cadt.tiles.finish_join([above], node=1, backend=backend)
    np.testing.assert_array_equal(links, links_there)
    np.testing.assert_array_equal(up.triangles, up_there.triangles)
    assert here.sums == there.sums and up.sums == up_there.sums


def test_unknown_back_end() -> None:
    with pytest.raises(cadt.OptionError):
        cadt.tiles.finish_leaf([[0, 0]], device=1)


def test_threads_share_a_device() -> None:
    xy = FAMILIES["uniform"]
    wanted, _ = cadt.tiles.finish_leaf(xy)
    found: list[cadt.tiles.Part] = []
    threads = [threading.Thread(target=lambda: found.append(cadt.tiles.finish_leaf(xy)[0])) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 and all((part.triangles == wanted.triangles).all() for part in found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_child_of_a_fork_opens_its_own_host() -> None:
    xy = FAMILIES["uniform"]
    wanted, _ = cadt.tiles.finish_leaf(xy)
    child = os.fork()
    if child == 0:
        part, _ = cadt.tiles.finish_leaf(xy)
        os._exit(0 if (part.triangles == wanted.triangles).all() else 3)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
