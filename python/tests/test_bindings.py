# SPDX-License-Identifier: Apache-2.0
"""What the extension module hands through: options, the data of errors, the GIL, and memory that results share."""

from __future__ import annotations

import functools
import gc
import inspect
import pickle
import threading
import time
from collections.abc import Callable

import cadt
import numpy as np
import pytest

P = np.random.default_rng(0).random((4_000, 2))
SQUARE = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])


def arrays_of(points: np.ndarray) -> dict[str, np.ndarray]:
    mesh = cadt.Delaunay(points)
    batch = cadt.triangulate_batch(points, range(0, len(points) + 1, 1000))
    z = points[:, 0]
    return {
        "simplices": mesh.simplices,
        "neighbors": mesh.neighbors,
        "hull": mesh.hull,
        "edges": mesh.edges,
        "rows": mesh.vertex_neighbors[1],
        "duplicates": mesh._host_mesh.duplicates,
        "batch": batch.simplices,
        "neighbors of the batch": batch.neighbors,
        "set of the batch": batch[2].simplices,
        "weights": mesh.barycentric(points)[1],
        "raster": mesh.rasterize(z, shape=(50, 60)),
        "cells": mesh.voronoi().indices,
    }


def test_arrays_keep_their_memory() -> None:
    """Memory that was given back is used again by the next calls, for other meshes of the same size."""
    points = np.concatenate([P[:3_000], P[:1_000]])
    kept = arrays_of(points)
    copies = {name: a.copy() for name, a in kept.items()}
    gc.collect()
    for seed in range(1, 8):
        arrays_of(np.random.default_rng(seed).random((4_000, 2)))
    for name, a in kept.items():
        assert a.size and np.array_equal(a, copies[name], equal_nan=a.dtype == np.float64), name


def test_queries_keep_the_points() -> None:
    points = P.copy()
    mesh = cadt.Delaunay(points)
    ask = mesh._queries()
    expected = ask.locate(P)
    del mesh, points
    gc.collect()
    _ = [np.full((4_000, 2), k, dtype=np.float64) for k in range(20)]
    assert np.array_equal(ask.locate(P), expected)


CALLS: dict[str, Callable[[np.ndarray, cadt.Delaunay], object]] = {
    "Delaunay": lambda p, mesh: cadt.Delaunay(p),
    "batch": lambda p, mesh: cadt.triangulate_batch(p, [0, len(p)]),
    "verify": lambda p, mesh: mesh.verify(),
    "cadt.verify": lambda p, mesh: cadt.verify(p, mesh.simplices),
    "from_simplices": lambda p, mesh: cadt.Delaunay.from_simplices(p, mesh.simplices),
    "find_simplex": lambda p, mesh: mesh.find_simplex(np.concatenate([p] * 4)),
}


def share_waited(call: Callable[[], object]) -> float:
    """The longest time that another thread stands still, as a part of the call's."""
    ended, longest = threading.Event(), [0.0]

    def tick() -> None:
        last = time.perf_counter()
        while not ended.wait(0.001):
            now = time.perf_counter()
            longest[0], last = max(longest[0], now - last), now

    other = threading.Thread(target=tick)
    other.start()
    begin = time.perf_counter()
    call()
    whole = time.perf_counter() - begin
    ended.set()
    other.join()
    return longest[0] / whole


@pytest.mark.parametrize("name", CALLS)
def test_other_threads_run_meanwhile(name: str) -> None:
    points = np.random.default_rng(1).random((400_000, 2))
    mesh = cadt.Delaunay(points)
    mesh.find_simplex(points[:1])
    # On a busy machine it may be the processor that is missing, but not each time.
    assert any(share_waited(lambda: CALLS[name](points, mesh)) < 0.5 for _ in range(20))


def test_other_threads_run_during_the_first_query() -> None:
    points = np.random.default_rng(1).random((1_000_000, 2))
    meshes = (cadt.Delaunay(points) for _ in range(20))
    assert any(share_waited(functools.partial(mesh.find_simplex, points[:1])) < 0.2 for mesh in meshes)


def test_data_of_errors() -> None:
    many = np.broadcast_to(np.zeros((1, 2)), (2**30, 2))  # of 16 bytes
    with pytest.raises(cadt.LimitError) as limit:
        cadt.Delaunay(many, backend="host")
    assert limit.value.count == 2**30 > limit.value.limit >= 2**29 - 2
    with pytest.raises(cadt.OutOfMemory) as memory:
        cadt.Delaunay(P, backend="host", max_memory=10_000)
    assert isinstance(memory.value, MemoryError) and memory.value.needed > 10_000
    with pytest.raises(cadt.BackendUnavailable) as unavailable:
        cadt.Delaunay(P, backend="opencl", device="no such device")
    assert unavailable.value.backend == "opencl" and unavailable.value.reason
    with pytest.raises(cadt.InvalidMesh) as mesh:
        cadt.Delaunay.from_simplices([[0, 0], [4, 0], [4, 1], [0, 3]], [[0, 1, 3], [1, 2, 3]])
    assert (mesh.value.check, mesh.value.first) == ("delaunay", 0)
    for error in (limit.value, memory.value, unavailable.value, mesh.value):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)


def test_options_reach_the_library() -> None:
    many = np.random.default_rng(2).random((100_000, 2))
    for n in (1, 2, 3):
        assert cadt.Delaunay(many, threads=n, backend="host").statistics["threads"] == n
    canonical, fast = cadt.Delaunay(P), cadt.Delaunay(P, order="fast")
    assert fast.hash == canonical.hash and not np.array_equal(fast.simplices, canonical.simplices)
    diagonal = [[0, 1, 3], [0, 3, 2]]
    assert cadt.verify(SQUARE, diagonal) and not cadt.verify(SQUARE, diagonal, canonical_ties=True)


def test_long_edges_are_left_out() -> None:
    far = cadt.Delaunay(np.concatenate([SQUARE, [[9.0, 0.5]]]))
    kept, _ = far.alpha_shape(np.inf, max_edge=2)
    assert len(kept) == 2 and far.n_triangles > 2
    assert set(far.simplices[kept].ravel().tolist()) == {0, 1, 2, 3}
    picture = far.rasterize(np.zeros(5), bounds=(0, 0, 8, 1), shape=(2, 16), max_edge=2)
    assert np.isfinite(picture[:, :2]).all() and np.isnan(picture[:, 2:]).all()


def test_clockwise_triangles_are_turned_with_their_neighbors() -> None:
    mesh = cadt.Delaunay(P[:300])
    some = np.arange(mesh.n_triangles) % 3 == 0
    simplices, neighbors = mesh.simplices.copy(), mesh.neighbors.copy()
    simplices[some], neighbors[some] = simplices[some][:, ::-1], neighbors[some][:, ::-1]
    adopted = cadt.Delaunay.from_simplices(mesh.points, simplices, neighbors)
    assert adopted.hash == mesh.hash and adopted.verify()
    t, k = np.nonzero(adopted.neighbors >= 0)
    shared = [len({*a} & {*b}) for a, b in zip(adopted.simplices[t], adopted.simplices[adopted.neighbors[t, k]])]
    assert set(shared) == {2}
    assert not (adopted.simplices[t, k][:, None] == adopted.simplices[adopted.neighbors[t, k]]).any()


class Mine(cadt.Delaunay):
    pass


@pytest.mark.parametrize("order", ["canonical", "fast"])
def test_pickles_are_the_same_mesh(order: str) -> None:
    points = np.concatenate([P[:500], P[:100]]).astype(np.float32)
    mesh = Mine(points, order=order)
    again = pickle.loads(pickle.dumps(mesh))
    assert type(again) is Mine and again.points.dtype == np.float32
    for name in ("points", "simplices", "neighbors", "duplicate_of", "vertex_to_simplex"):
        assert np.array_equal(getattr(again, name), getattr(mesh, name)), name


@pytest.mark.parametrize("order", ["canonical", "fast"])
def test_pickles_are_the_same_batch(order: str) -> None:
    batch = cadt.triangulate_batch(P[:300], [0, 3, 3, 60, 60, 300], order=order)
    again = pickle.loads(pickle.dumps(batch))
    assert (len(again), repr(again), again.statistics) == (5, repr(batch), batch.statistics)
    for name in ("simplices", "neighbors", "triangle_offsets"):
        assert np.array_equal(getattr(again, name), getattr(batch, name)), name
    for a, b in zip(again, batch):
        assert np.array_equal(a.simplices, b.simplices) and np.array_equal(a.points, b.points) and a.verify()
        assert a.hash == b.hash and np.array_equal(a.hull, b.hull)


def test_batches_of_any_memory() -> None:
    wide = np.repeat(P[:300].astype(np.float32), 2, axis=0)[::2]
    offsets = np.array([0, 9, 100, 9, 300, 9], dtype=np.uint16)[::2]
    batch = cadt.triangulate_batch(wide, offsets)
    for s, (a, b) in enumerate(((0, 100), (100, 300))):
        assert batch[s].hash == cadt.Delaunay(P[a:b].astype(np.float32)).hash
        assert np.array_equal(batch[s].points, wide[a:b])


def test_arrays_that_a_mesh_keeps_are_read_only(rng: np.random.Generator) -> None:
    points, pairs = rng.random((60, 2)), np.arange(10, dtype=np.int32).reshape(-1, 2)
    crossed = cadt.ConstrainedDelaunay(points, pairs, crossing="exact", domain="outer")
    assert len(crossed.added_points) and not crossed.points.flags.writeable
    for mesh in (cadt.Delaunay(points), cadt.ConstrainedDelaunay(points), crossed):
        seen = 0
        for name, member in inspect.getmembers(type(mesh), lambda m: isinstance(m, property)):
            arrays = getattr(mesh, name) if name != "points" and not name.startswith("_") else ()
            for a in arrays if isinstance(arrays, tuple) else (arrays,):
                if isinstance(a, np.ndarray):
                    assert not a.flags.writeable, name
                    seen += 1
        assert seen >= 12
    assert points.flags.writeable and pairs.flags.writeable
