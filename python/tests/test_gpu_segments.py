# SPDX-License-Identifier: Apache-2.0
"""ConstrainedDelaunay with arrays in the memory of a GPU: as on the host, and without a copy there."""
from __future__ import annotations

import pickle

import cadt
import numpy as np
import pytest
from crossed_segments import chords, compare, compare_arrays, compare_grid_and_seeds
from crossed_segments import compare_rare_questions, compare_without_crossings, sets as crossed_sets
from gpu_library import Library, library, needs_cuda, x64  # noqa: F401 (library is a fixture)

pytestmark = needs_cuda


def breaklines(n):
    """Points, and paths along two halves of them: no crossings."""
    xy = np.random.default_rng(14).random((n, 2))
    order = np.argsort(xy[:, 0])
    parts = [order[xy[order, 1] < 0.5], order[xy[order, 1] >= 0.5]]
    return xy, np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in parts])


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_segments_equal_host(library, dtype):
    xy, segments = breaklines(20_000)
    put, get = library.put, library.get
    mesh = cadt.ConstrainedDelaunay(put(xy), put(segments.astype(dtype)), domain="outer")
    host = cadt.ConstrainedDelaunay(xy, segments, domain="outer", backend="host")
    assert mesh.device.startswith("cuda") and repr(mesh).split(" inside")[0] == repr(host).split(" inside")[0]
    moved = mesh.statistics["bytes_to_device"] + mesh.statistics["bytes_from_device"]
    assert moved < 64 * 1024, "words that steer the call, and no array"
    for member in ("simplices", "neighbors", "edge_flags", "region", "triangles_inside", "segments", "hull"):
        np.testing.assert_array_equal(get(getattr(mesh, member)), getattr(host, member), member)
    assert mesh.verify() and mesh.hash == host.hash == pickle.loads(pickle.dumps(mesh)).hash
    q = np.random.default_rng(15).random((500, 2))
    z = xy[:, 0] ** 2
    np.testing.assert_array_equal(get(mesh.find_simplex(put(q))), host.find_simplex(q))
    np.testing.assert_allclose(get(mesh.interpolate(put(z), put(q))), host.interpolate(z, q), rtol=1e-12)
    image = mesh.rasterize(put(z), bounds=(0, 0, 1, 1), shape=(9, 13))
    np.testing.assert_allclose(get(image), host.rasterize(z, bounds=(0, 0, 1, 1), shape=(9, 13)), rtol=1e-12)
    with pytest.raises(cadt.NotDelaunay):
        mesh.nearest_vertex(put(q))


@pytest.mark.parametrize("domain", ["hull", "outer", "even_odd", "nonzero", "layers"])
def test_rings_of_the_host_and_domains(library, domain):
    xy = np.array([[0.0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2], [0.5, 0.25]])
    mesh = cadt.ConstrainedDelaunay(library.put(xy), rings=[0, 4, 8], domain=domain)
    host = cadt.ConstrainedDelaunay(xy, rings=[0, 4, 8], domain=domain)
    compare_arrays(mesh, host, library.get)
    assert mesh.verify()


def test_segments_that_are_refused(library):
    put = library.put
    xy = np.array([[0.0, 0], [2, 2], [0, 2], [2, 0]])
    with pytest.raises(cadt.CrossingError) as caught:
        cadt.ConstrainedDelaunay(put(xy), put(np.array([[0, 1], [2, 3]])))
    assert caught.value.pairs.tolist() == [[0, 1]]
    with pytest.raises(cadt.InputError, match="need points there"):
        cadt.ConstrainedDelaunay(xy, put(np.array([[0, 1]])))
    for wrong in ([[0, 1], [2, 4]], [[0, 1], [-1, 2]], [[0, 1], [0, 2**32 + 1]]):
        with pytest.raises(cadt.InputError) as refused:
            cadt.ConstrainedDelaunay(put(xy), put(np.array(wrong)))
        assert refused.value.index == 1
    empty = cadt.ConstrainedDelaunay(put(xy), domain="outer")
    for member in ("edge_flags", "region"):
        assert not library.get(getattr(empty, member)).any()


@pytest.mark.parametrize("name", list(crossed_sets()))
def test_crossings_equal_host(library, name):
    xy, segments = crossed_sets()[name]
    mesh = compare(xy, segments, library.put, library.get)
    assert mesh.rounded_valid == (name != "almost one place")


def test_crossings_that_are_none(library):
    compare_without_crossings(library.put, library.get)


def test_grids_and_seeds_equal_host(library):
    compare_grid_and_seeds(library.put, library.get)


def test_rare_questions_as_on_the_host(library):
    compare_rare_questions(library.put, library.get)


def test_crossings_stay_on_the_device(library, monkeypatch):
    n = 200_000
    xy, segments = chords(n, 200)
    mesh = cadt.ConstrainedDelaunay(library.put(xy), library.put(segments), crossing="exact")
    added = len(mesh.added_parents)
    moved = mesh.statistics["bytes_to_device"] + mesh.statistics["bytes_from_device"]
    assert added > 100 and moved < 8 * n, "no array"
    monkeypatch.setattr(type(mesh._gpu.array), "host_of", None)
    library.check(mesh.points)
    library.check(mesh.added_points)
    library.check(mesh.added_parents)
    for array in mesh.chains:
        library.check(array)
    library.check(mesh.interpolate(library.put(np.ones(n + added)), mesh.added_points))


def test_crossings_outlive_the_mesh(library):
    xy, segments = chords(4_000, 400)
    mesh = cadt.ConstrainedDelaunay(library.put(xy), library.put(segments), crossing="exact")
    arrays = mesh.points, mesh.added_points, mesh.added_parents
    del mesh
    for seed in range(5):  # memory that was returned would be used again
        cadt.ConstrainedDelaunay(library.put(np.random.default_rng(seed).random((4_000, 2))), segments, crossing="exact")
    host = cadt.ConstrainedDelaunay(xy, segments, crossing="exact", backend="host")
    for got, wanted in zip(arrays, (host.points, host.added_points, host.added_parents)):
        np.testing.assert_array_equal(library.get(got), wanted)


def test_crossings_in_jax_without_doubles():
    library = Library("jax")
    xy, segments = crossed_sets()["float32"]
    host = cadt.ConstrainedDelaunay(xy, segments, crossing="exact", backend="host")
    q = np.random.default_rng(24).random((500, 2))
    with x64(library.xp, False):
        mesh = cadt.ConstrainedDelaunay(library.put(xy), segments, crossing="exact")
        for member in ("points", "added_points"):
            got = getattr(mesh, member)
            assert got.dtype == np.float32
            np.testing.assert_array_equal(library.get(got), getattr(host, member).astype(np.float32))
        np.testing.assert_array_equal(library.get(mesh.find_simplex(q)), host.find_simplex(q))
        assert mesh.verify() and mesh.hash == host.hash
