# SPDX-License-Identifier: Apache-2.0
"""Arrays of PyOpenCL: results on the same queue, equal to the host's."""

from __future__ import annotations

import os
import pickle

import cadt
import numpy as np
import pytest
from crossed_segments import chords, compare, compare_arrays, compare_grid_and_seeds
from crossed_segments import compare_rare_questions, compare_without_crossings, sets as crossed_sets

cl = pytest.importorskip("pyopencl")
cl_array = pytest.importorskip("pyopencl.array")
opencl = [d for d in cadt.devices() if d.backend == "opencl"]
if not any(d.usable for d in opencl) and "opencl" not in os.environ.get("CADT_REQUIRE_BACKENDS", ""):
    pytest.skip(f"no OpenCL device: {opencl[0].reason}", allow_module_level=True)


@pytest.fixture(scope="module")
def queue():
    for platform in cl.get_platforms():
        for device in platform.get_devices():
            if "fp64" in device.extensions:
                return cl.CommandQueue(cl.Context([device]))
    pytest.skip("no OpenCL device with double precision")


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_equals_host(queue, dtype):
    points = np.random.default_rng(1).random((3_000, 2)).astype(dtype)
    given = cl_array.to_device(queue, points)
    mesh, host = cadt.Delaunay(given), cadt.Delaunay(points, backend="host")
    assert mesh.device.startswith("opencl")
    for member in ("simplices", "neighbors", "hull", "edges"):
        got = getattr(mesh, member)
        assert isinstance(got, cl_array.Array)
        np.testing.assert_array_equal(got.get(), getattr(host, member))
    q = np.random.default_rng(2).random((500, 2))
    np.testing.assert_array_equal(mesh.find_simplex(cl_array.to_device(queue, q)).get(), host.find_simplex(q))
    z = points[:, 0].astype(np.float64)
    np.testing.assert_allclose(mesh.interpolate(z, q).get(), host.interpolate(z, q), rtol=1e-12)
    both = np.stack([z, points[:, 1] ** 2], axis=1)
    image = mesh.rasterize(both, bounds=(0, 0, 1, 1), shape=(9, 13))
    assert isinstance(image, cl_array.Array)
    np.testing.assert_allclose(image.get(), host.rasterize(both, bounds=(0, 0, 1, 1), shape=(9, 13)), rtol=1e-12)


def test_queries_of_the_host_are_read_as_on_the_host(queue):
    points = np.random.default_rng(1).random((1_000, 2))
    mesh, host = cadt.Delaunay(cl_array.to_device(queue, points)), cadt.Delaunay(points, backend="host")
    x, y = np.random.default_rng(2).random((2, 5))
    np.testing.assert_array_equal(mesh.find_simplex((x, y.tolist())).get(), host.find_simplex((x, y)))
    np.testing.assert_array_equal(mesh.find_simplex((x[:, None], y)).get(), host.find_simplex((x[:, None], y)))
    np.testing.assert_array_equal(mesh.find_simplex((0.5, y)).get(), host.find_simplex((0.5, y)))
    np.testing.assert_array_equal(
        mesh.find_simplex((0.5, cl_array.to_device(queue, y))).get(), host.find_simplex((0.5, y))
    )
    with pytest.raises(cadt.InputError, match="two arrays x and y"):
        mesh.find_simplex(((0.1, 0.2), (5, 5)))
    with pytest.raises(cadt.InputError, match="queries are masked"):
        mesh.find_simplex(np.ma.array([x, y], mask=True).T)
    with pytest.raises(cadt.InputError, match="values are masked"):
        mesh.interpolate(np.ma.array(points[:, 0], mask=points[:, 0] > 0.5), [[0.5, 0.5]])


@pytest.mark.parametrize("n", [3, 100, 1_001])
def test_bounds_are_taken_on_the_device(queue, n, monkeypatch):
    points = np.random.default_rng(8).random((n, 2)) * [3, 2] - 1
    mesh, host = cadt.Delaunay(cl_array.to_device(queue, points)), cadt.Delaunay(points, backend="host")
    monkeypatch.setattr(type(mesh._gpu.array), "to_host", None)  # type: ignore[union-attr]
    z = points[:, 0].copy()
    image = mesh.rasterize(z, shape=(7, 5)).get()
    np.testing.assert_allclose(image, host.rasterize(z, shape=(7, 5)), rtol=1e-12, atol=1e-12)


def test_arrays_outlive_the_mesh(queue):
    points = np.random.default_rng(3).random((3_000, 2))
    simplices = cadt.Delaunay(cl_array.to_device(queue, points)).simplices
    for seed in range(3):
        cadt.Delaunay(cl_array.to_device(queue, np.random.default_rng(seed).random((3_000, 2))))
    np.testing.assert_array_equal(simplices.get(), cadt.Delaunay(points).simplices)


def test_each_queue_is_used_for_its_own_arrays(queue):
    points = np.random.default_rng(9).random((2_000, 2))
    other = cl.CommandQueue(cl.Context(queue.context.devices))
    wanted = cadt.Delaunay(points)
    for q in (queue, other, queue):
        mesh = cadt.Delaunay(cl_array.to_device(q, points))
        assert mesh.simplices.queue == mesh.find_simplex(points).queue == q
        np.testing.assert_array_equal(mesh.simplices.get(), wanted.simplices)


@pytest.mark.thorough  # PoCL compiles anew for the options
def test_options_of_each_call_on_an_open_device():
    points = np.random.default_rng(10).random((4_000, 2))
    wanted = cadt.Delaunay(points).simplices
    for _ in range(2):
        fast = cadt.Delaunay(points, backend="opencl", order="fast")
        assert not np.array_equal(fast.simplices, wanted)
        assert np.array_equal(cadt.Delaunay(points, backend="opencl").simplices, wanted)
        with pytest.raises(cadt.OutOfMemory):
            cadt.Delaunay(points, backend="opencl", max_memory=10_000)
        assert cadt.Delaunay(points, backend="opencl", statistics="timing").statistics["milliseconds"]
        assert not cadt.Delaunay(points, backend="opencl", statistics="none").statistics["milliseconds"]


def test_parts_of_buffers(queue):
    points = np.random.default_rng(4).random((1_000, 2))
    given = cl_array.to_device(queue, points)
    assert cadt.Delaunay(given[100:]).hash == cadt.Delaunay(points[100:]).hash


def test_a_progress_function_cannot_use_the_device_that_reports_to_it(queue):
    gpu = queue.device.type & cl.device_type.GPU
    points = np.random.default_rng(5).random((5_000_000 if gpu else 100_000, 2))  # longer than until there is a report
    asked = []

    def progress(phase: str, fraction: float) -> None:
        asked.append(phase)
        meshes[:] = []  # a mesh that ends meanwhile
        cadt.Delaunay(points[:100], backend="opencl")

    meshes = [cadt.Delaunay(cl_array.to_device(queue, points[:100]))]
    with pytest.raises(cadt.BackendUnavailable, match="progress function"):
        cadt.Delaunay(points, backend="opencl", progress=progress)
    assert len(asked) == 1
    assert cadt.Delaunay(points[:100], backend="opencl").n_triangles > 0


def test_a_query_reports_to_its_own_call(queue):
    """Queries once reported to the call that had opened them, which had ended."""
    points = np.random.default_rng(6).random((50_000, 2))
    mesh = cadt.Delaunay(cl_array.to_device(queue, points))
    q = np.random.default_rng(7).random((500_000, 2))  # longer than it takes until there is a report
    for _ in range(3):
        assert (mesh.find_simplex(q).get() >= -1).all()
        np.testing.assert_array_equal(mesh.circumcenters().get(), cadt.Delaunay(points).circumcenters())


def breaklines(n=3_000):
    """Points, and paths along two halves of them: no crossings."""
    xy = np.random.default_rng(11).random((n, 2))
    order = np.argsort(xy[:, 0])
    parts = [order[xy[order, 1] < 0.5], order[xy[order, 1] >= 0.5]]
    return xy, np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in parts])


CROSS = np.array([[0.0, 0], [2, 2], [0, 2], [2, 0]])
RINGS = np.array([[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2], [0.5, 0.25]])


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_segments_equal_host(queue, dtype):
    xy, segments = breaklines()
    given, of = cl_array.to_device(queue, xy), cl_array.to_device(queue, segments.astype(dtype))
    mesh = cadt.ConstrainedDelaunay(given, of, domain="outer")
    host = cadt.ConstrainedDelaunay(xy, segments, domain="outer", backend="host")
    assert mesh.device.startswith("opencl") and mesh.points is given
    moved = mesh.statistics["bytes_to_device"] + mesh.statistics["bytes_from_device"]
    assert moved < 8 * len(xy), "words that steer the call, and no array"
    for member in ("simplices", "neighbors", "edge_flags", "region", "triangles_inside", "segments", "hull", "edges"):
        got = getattr(mesh, member)
        assert isinstance(got, cl_array.Array), member
        np.testing.assert_array_equal(got.get(), getattr(host, member), member)
    assert mesh.verify() and mesh.hash == host.hash == pickle.loads(pickle.dumps(mesh)).hash
    assert repr(mesh).partition(" inside")[0] == repr(host).partition(" inside")[0]
    q = np.random.default_rng(2).random((500, 2))
    np.testing.assert_array_equal(mesh.find_simplex(q).get(), host.find_simplex(q))
    z = xy[:, 0] ** 2
    np.testing.assert_allclose(mesh.interpolate(z, q).get(), host.interpolate(z, q), rtol=1e-12)
    image = mesh.rasterize(z, bounds=(0, 0, 1, 1), shape=(9, 13))
    np.testing.assert_allclose(image.get(), host.rasterize(z, bounds=(0, 0, 1, 1), shape=(9, 13)), rtol=1e-12)
    with pytest.raises(cadt.NotDelaunay):
        mesh.nearest_vertex(q)


@pytest.mark.parametrize("domain", ["hull", "outer", "even_odd", "nonzero", "layers"])
@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_rings_of_the_host_and_domains(queue, domain, dtype):
    xy = RINGS.astype(dtype)
    mesh = cadt.ConstrainedDelaunay(cl_array.to_device(queue, xy), rings=[0, 4, 8], domain=domain)
    host = cadt.ConstrainedDelaunay(xy, rings=[0, 4, 8], domain=domain)
    compare_arrays(mesh, host, lambda a: a.get())
    assert f"{len(host.triangles_inside)} inside, opencl" in repr(mesh) and mesh.verify()


def test_segments_that_are_refused(queue):
    def put(a):
        return cl_array.to_device(queue, np.asarray(a))

    xy = CROSS
    there = put(xy)
    with pytest.raises(cadt.CrossingError) as caught:
        cadt.ConstrainedDelaunay(there, put([[0, 1], [2, 3]]))
    assert caught.value.pairs.tolist() == [[0, 1]]
    with pytest.raises(cadt.InputError, match="need points there"):
        cadt.ConstrainedDelaunay(xy, put([[0, 1]]))
    with pytest.raises(cadt.InputError, match="stand alone"):
        cadt.ConstrainedDelaunay(there, put([[0, 1]]), rings=[0, 3])
    with pytest.raises(cadt.InputError, match="read on the host"):
        cadt.ConstrainedDelaunay(there, rings=put([0, 3]))
    for wrong in ([[0, 1], [2, 4]], [[0, 1], [-1, 2]], [[0, 1], [0, 2**32 + 1]]):
        with pytest.raises(cadt.InputError) as refused:
            cadt.ConstrainedDelaunay(there, put(wrong))
        assert refused.value.index == 1
    for wrong in (put([[0.0, 1.0]]), put([0, 1]), put([[0, 1, 2]])):
        with pytest.raises(cadt.InputError):
            cadt.ConstrainedDelaunay(there, wrong)

def test_polygons_and_batches_are_of_the_host(queue):
    points = cl_array.to_device(queue, np.random.default_rng(1).random((30, 2)))
    for call in (cadt.triangulate_batch, cadt.polygons):
        with pytest.raises(cadt.InputError, match="points are read on the host: pass a copy there"):
            call(points, [0, 30])


def test_what_is_asked_on_the_host(queue):
    xy = np.random.default_rng(3).random((50, 2))
    edges = cadt.Delaunay(xy).edges[:9]  # Delaunay edges, so that there is a Voronoi diagram
    mesh = cadt.ConstrainedDelaunay(cl_array.to_device(queue, xy), edges)
    host = cadt.ConstrainedDelaunay(xy, edges)
    for own, wanted in zip(mesh.voronoi().__dict__.values(), host.voronoi().__dict__.values()):
        np.testing.assert_array_equal(own, wanted)
    pytest.importorskip("matplotlib")
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    drawn = []
    for of in (mesh, host):
        axes = of.plot(plt.figure().gca())
        drawn.append((len(axes.lines[0].get_xdata()), len(axes.collections[0].get_segments())))
        plt.close()
    assert drawn[0] == drawn[1] and drawn[0][1] == 9


def test_rare_questions_as_on_the_host(queue):
    compare_rare_questions(*put_and_get(queue))


def test_arrays_in_any_order(queue):
    """Columns first, every second row, backwards, parts of wider arrays."""
    put, get = put_and_get(queue)
    xy, segments = chords(200, 30)
    host = cadt.ConstrainedDelaunay(xy, segments, crossing="exact", backend="host")
    z = np.stack([xy[:, 0], xy[:, 1], xy.sum(axis=1)], axis=1)
    wide = np.concatenate([xy, z], axis=1)

    def ways(a):
        turned = put(np.asfortranarray(a))
        assert not turned.flags.c_contiguous
        yield turned
        yield put(np.repeat(a, 2, axis=0))[::2]
        yield put(a[::-1].copy())[::-1]
        yield put(np.concatenate([a, a], axis=1))[:, : a.shape[1]]
        yield put(np.concatenate([a[:3], a]))[3:]

    for points, pairs in zip(ways(xy), ways(segments)):
        mesh = cadt.ConstrainedDelaunay(points, pairs, crossing="exact")
        compare_arrays(mesh, host, get)
    np.testing.assert_array_equal(cadt.Delaunay(put(wide)[:, :2]).simplices.get(), cadt.Delaunay(xy).simplices)
    for pairs in ways(segments.astype(np.int64)):
        np.testing.assert_array_equal(get(cadt.ConstrainedDelaunay(put(xy), pairs, crossing="exact").simplices), host.simplices)
    q = np.random.default_rng(4).random((50, 2))
    for values, asked in zip(ways(z), ways(q)):
        np.testing.assert_array_equal(get(mesh.find_simplex(asked)), host.find_simplex(q))
        np.testing.assert_allclose(get(mesh.interpolate(values, asked)), host.interpolate(z, q), rtol=1e-12)


def test_arrays_of_another_queue(queue):
    """What is pending there is waited for."""
    xy, segments = chords(400, 30)
    there = cl_array.to_device(queue, xy)
    cadt.ConstrainedDelaunay(there, segments, crossing="exact")  # opens the device and builds the kernels
    other = cl.CommandQueue(queue.context)
    program = cl.Program(
        queue.context,
        """kernel void late(global int* to, global const int* from, int n) {
             float x = 1; for (int i = 0; i < 200000000; ++i) x = x * 1.0000001f + 1e-9f;
             for (int i = 0; i < n; ++i) to[i] = from[i] + (x < 0); }""",
    ).build()
    source, late = cl_array.to_device(other, segments), cl_array.zeros(other, segments.shape, np.int32)
    other.finish()
    program.late(other, (1,), None, late.base_data, source.base_data, np.int32(segments.size))
    mesh = cadt.ConstrainedDelaunay(there, late, crossing="exact")
    host = cadt.ConstrainedDelaunay(xy, segments, crossing="exact", backend="host")
    np.testing.assert_array_equal(mesh.simplices.get(), host.simplices)


def test_grids_and_seeds_equal_host(queue):
    compare_grid_and_seeds(*put_and_get(queue))


def put_and_get(queue):
    def get(a):
        assert isinstance(a, cl_array.Array) and a.queue == queue
        return a.get()

    return (lambda a: cl_array.to_device(queue, np.asarray(a))), get


@pytest.mark.parametrize("name", list(crossed_sets()))
def test_crossings_equal_host(queue, name, tmp_path):
    xy, segments = crossed_sets()[name]
    mesh = compare(xy, segments, *put_and_get(queue))
    assert mesh.rounded_valid == (name != "almost one place")
    mesh.save(tmp_path / "mesh.npz")
    np.testing.assert_array_equal(np.load(tmp_path / "mesh.npz")["points"], mesh.points.get())


def test_crossings_that_are_none(queue):
    compare_without_crossings(*put_and_get(queue))


def test_crossings_stay_on_the_device(queue, monkeypatch):
    xy, segments = chords(4_000, 60)
    given = cl_array.to_device(queue, xy)
    mesh = cadt.ConstrainedDelaunay(given, segments, crossing="exact")
    moved = mesh.statistics["bytes_to_device"] + mesh.statistics["bytes_from_device"]
    assert moved < 8 * len(xy), "words that steer the call, and no array"
    monkeypatch.setattr(type(mesh._gpu.array), "host_of", None)  # type: ignore[union-attr]
    added = mesh.added_points
    assert len(added) == len(mesh.added_parents) > 100
    assert mesh.points.base_data.int_ptr == added.base_data.int_ptr == mesh._gpu.mesh.all_points_handle
    assert len(mesh.interpolate(cl_array.to_device(queue, np.ones(mesh.n_points)), added)) == len(added)


def test_crossings_outlive_the_mesh(queue):
    xy, segments = chords(2_000, 100)
    mesh = cadt.ConstrainedDelaunay(cl_array.to_device(queue, xy), segments, crossing="exact")
    arrays = mesh.points[:], mesh.added_points, mesh.added_parents[:]  # parts keep the mesh as well
    del mesh
    for seed in range(3):
        other = cl_array.to_device(queue, np.random.default_rng(seed).random((2_000, 2)))
        cadt.ConstrainedDelaunay(other, segments, crossing="exact")
    host = cadt.ConstrainedDelaunay(xy, segments, crossing="exact", backend="host")
    for got, wanted in zip(arrays, (host.points, host.added_points, host.added_parents)):
        np.testing.assert_array_equal(got.get(), wanted)


@pytest.mark.parametrize("member", ["points", "added_points", "added_parents", "edge_flags"])
def test_a_mesh_that_is_not_the_hosts_is_noticed(queue, member):
    mesh = cadt.ConstrainedDelaunay(cl_array.to_device(queue, CROSS), [[0, 1], [2, 3]], crossing="exact")
    assert mesh.verify()
    getattr(mesh, member)[-1] = 3
    with pytest.raises(cadt.InternalError):
        mesh.verify()


def test_few_points_and_no_segments(queue):
    for xy in (np.empty((0, 2)), np.array([[0.0, 0], [1, 1], [2, 2]]), RINGS):
        segments = np.empty((0, 2), np.int32) if len(xy) != 3 else np.array([[0, 2]], np.int32)
        mesh = cadt.ConstrainedDelaunay(cl_array.to_device(queue, xy), segments, domain="outer")
        host = cadt.ConstrainedDelaunay(xy, segments, domain="outer")
        for member in ("simplices", "neighbors", "edge_flags", "region", "triangles_inside"):
            np.testing.assert_array_equal(getattr(mesh, member).get(), getattr(host, member), member)
        assert mesh.verify()
