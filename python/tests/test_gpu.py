# SPDX-License-Identifier: Apache-2.0
"""Arrays that are on a GPU: results of the same kind, equal to the host's, and nothing through the host."""
from __future__ import annotations

import cadt
import numpy as np
import pytest
from gpu_library import Library, library, needs_cuda, x64  # noqa: F401 (library is a fixture)

pytestmark = needs_cuda


def sets():
    rng = np.random.default_rng(1)
    yield "uniform", rng.random((20_000, 2))
    yield "float32", rng.random((20_000, 2)).astype(np.float32)
    yield "lattice", np.stack(np.meshgrid(np.arange(90.0), np.arange(110.0)), -1).reshape(-1, 2)
    yield "UTM", rng.random((20_000, 2)) * 1000 + [500_000, 5_600_000]
    points = rng.random((5_000, 2))
    yield "duplicates", np.concatenate([points, points[::7]])
    yield "three", np.array([[0.0, 0], [1, 0], [0, 1]])


@pytest.mark.parametrize("name,points", list(sets()), ids=[n for n, _ in sets()])
def test_equals_host(library, name, points):
    given = library.put(points)
    mesh, host = cadt.Delaunay(given), cadt.Delaunay(points, backend="host")
    assert mesh.device.startswith("cuda")
    assert mesh.hash == host.hash
    for member in ("simplices", "neighbors", "hull", "convex_hull", "edges", "duplicate_of", "half_edges"):
        np.testing.assert_array_equal(library.get(getattr(mesh, member)), getattr(host, member), member)
    for got, wanted in zip(mesh.vertex_neighbors, host.vertex_neighbors):
        np.testing.assert_array_equal(library.get(got), wanted)
    np.testing.assert_array_equal(library.get(given), points)
    assert mesh.verify()


def test_nothing_through_the_host(library):
    n = 200_000
    mesh = cadt.Delaunay(library.put(np.random.default_rng(2).random((n, 2))))
    moved = mesh.statistics["bytes_to_device"] + mesh.statistics["bytes_from_device"]
    assert moved < 64 * 1024, "words that steer the call, and no array"
    through_host = cadt.Delaunay(np.random.default_rng(2).random((n, 2)), backend="cuda").statistics
    assert through_host["bytes_to_device"] >= 16 * n
    assert through_host["bytes_from_device"] >= 24 * (2 * n - 100)


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_queries_equal_host(library, dtype):
    rng = np.random.default_rng(3)
    points = rng.random((30_000, 2)).astype(dtype)
    mesh, host = cadt.Delaunay(library.put(points)), cadt.Delaunay(points, backend="host")
    q = rng.random((50, 40, 2)) * 1.2 - 0.1
    z = np.stack([points[:, 0] ** 2, points.sum(axis=1)], axis=1)
    put, get = library.put, library.get
    for xi in (put(q), q):  # queries of the host are copied there
        np.testing.assert_array_equal(get(mesh.find_simplex(xi)), host.find_simplex(q))
        np.testing.assert_array_equal(get(mesh.nearest_vertex(xi)), host.nearest_vertex(q))
        np.testing.assert_array_equal(get(mesh.nearest_vertex(xi, 5)), host.nearest_vertex(q, 5))
        np.testing.assert_array_equal(get(mesh.within_hull(xi)), host.within_hull(q))
        for method in ("linear", "nearest", "natural"):
            for outside in ("nan", "nearest"):
                got = get(mesh.interpolate(put(z), xi, method, outside=outside))
                np.testing.assert_allclose(got, host.interpolate(z, q, method, outside=outside), rtol=1e-12, atol=1e-12)
    triangles, weights = mesh.barycentric(put(q))
    np.testing.assert_array_equal(get(triangles), host.barycentric(q)[0])
    np.testing.assert_allclose(get(weights), host.barycentric(q)[1], rtol=1e-12, atol=1e-12)
    image = mesh.rasterize(put(z[:, 0].copy()), shape=(60, 80), bounds=(0, 0, 1, 1))
    np.testing.assert_allclose(get(image), host.rasterize(z[:, 0], shape=(60, 80), bounds=(0, 0, 1, 1)), atol=1e-13)
    np.testing.assert_allclose(get(mesh.circumcenters()), host.circumcenters(), rtol=1e-12)
    both = mesh.rasterize(put(z), shape=(6, 8), bounds=(0, 0, 1, 1))
    np.testing.assert_allclose(get(both), host.rasterize(z, shape=(6, 8), bounds=(0, 0, 1, 1)), atol=1e-13)
    assert tuple(mesh.find_simplex(put(np.empty((0, 2)))).shape) == (0,)
    assert tuple(mesh.barycentric(put(np.empty((3, 0, 2))))[1].shape) == (3, 0, 3)


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_bounds_are_taken_on_the_device(library, dtype, monkeypatch):
    points = (np.random.default_rng(12).random((5_001, 2)) * [3, 2] - 1).astype(dtype)
    mesh, host = cadt.Delaunay(library.put(points)), cadt.Delaunay(points, backend="host")
    z = points[:, 0].astype(np.float64)
    monkeypatch.setattr(type(mesh._gpu.array), "to_host", None)
    image = mesh.rasterize(library.put(z), shape=(30, 40))
    np.testing.assert_allclose(library.get(image), host.rasterize(z, shape=(30, 40)), atol=1e-12)
    with pytest.raises(cadt.InputError, match="bounds"):
        cadt.Delaunay(library.put(np.empty((0, 2)))).rasterize(z[:0], shape=(2, 2))


def test_arrays_outlive_the_mesh(library):
    points = np.random.default_rng(4).random((10_000, 2))
    simplices = cadt.Delaunay(library.put(points)).simplices
    for seed in range(5):  # memory that was returned would be used again
        cadt.Delaunay(library.put(np.random.default_rng(seed).random((10_000, 2))))
    np.testing.assert_array_equal(library.get(simplices), cadt.Delaunay(points).simplices)


@pytest.mark.parametrize("name", ["cupy", "torch"])
def test_current_stream(name):
    library = Library(name)
    for seed in range(3):
        points = np.random.default_rng(seed).random((100_000 + seed, 2))
        there, given = library.put(points), library.put(np.zeros(points.shape))
        with library.stream():
            library.keep_busy()  # the points come later in this stream; a call in another one reads zeros
            given[:] = there
            mesh = cadt.Delaunay(given)
            assert mesh.hash == cadt.Delaunay(points, backend="host").hash


@pytest.mark.parametrize("name", ["cupy", "torch"])
def test_queries_in_another_stream(name):
    library = Library(name)
    points = np.random.default_rng(8).random((100_000, 2))
    there, q = library.put(points), library.put(np.zeros((1_000, 2)))
    mesh = cadt.Delaunay(there)
    with library.stream():
        library.keep_busy()
        q[:] = there[:1_000]
        np.testing.assert_array_equal(library.get(mesh.nearest_vertex(q)), np.arange(1_000))
    library.keep_busy()  # the mesh's stream, which the results wait for
    with library.stream():
        np.testing.assert_array_equal(library.get(mesh.nearest_vertex(there[-1_000:])), np.arange(99_000, 100_000))


def test_strides_and_dtypes(library):
    rng = np.random.default_rng(7)
    wide = rng.random((5_000, 5))
    given = library.put(wide)
    wanted = cadt.Delaunay(np.ascontiguousarray(wide[:, 1:3]), backend="host").hash
    assert cadt.Delaunay(given[:, 1:3]).hash == wanted
    assert cadt.Delaunay(library.put(np.asfortranarray(wide[:, 1:3]))).hash == wanted
    integers = 2**25 + rng.integers(0, 1_000, (5_000, 2))  # which floats would round
    for dtype in (np.int32, np.int64):
        given = integers.astype(dtype)
        assert cadt.Delaunay(library.put(given)).hash == cadt.Delaunay(given, backend="host").hash
    for dtype in (np.complex128, np.bool_):
        with pytest.raises(TypeError):
            cadt.Delaunay(library.put(np.ones((4, 2), dtype)))


def test_bad_input(library):
    put = library.put
    with pytest.raises(cadt.InputError):
        cadt.Delaunay(put(np.ones((4, 3))))
    with pytest.raises(cadt.InputError) as e:
        cadt.Delaunay(put(np.array([[0, 0], [1, 0], [np.nan, 1]])))
    assert e.value.index == 2
    with pytest.raises(cadt.OptionError):
        cadt.Delaunay(put(np.ones((4, 2))), backend="host")
    mesh = cadt.Delaunay(put(np.random.default_rng(8).random((100, 2))))
    with pytest.raises(cadt.InputError):
        mesh.find_simplex(put(np.array([[0, np.inf]])))
    with pytest.raises(cadt.InputError):
        mesh.interpolate(put(np.ones(99)), put(np.ones((4, 2))))
    assert cadt.Delaunay(put(np.empty((0, 2)))).n_triangles == 0
    line = cadt.Delaunay(put(np.array([[0.0, 0], [1, 1], [2, 2]])))
    assert line.dimension == 1 and tuple(line.simplices.shape) == (0, 3)


def test_jax_without_doubles():
    """JAX's default: its arrays are float32, but the library computes with the doubles that it was given."""
    library = Library("jax")
    points = np.random.default_rng(9).random((3_000, 2)).astype(np.float32)
    host = cadt.Delaunay(points)
    q = np.random.default_rng(10).random((500, 2))  # doubles, on no edge when they are not rounded
    z = points[:, 0] * (1 + 1e-9)
    with x64(library.xp, False):
        mesh = cadt.Delaunay(library.put(points))
        found, weights = mesh.barycentric(q)
        assert (found.dtype, weights.dtype) == (np.int32, np.float32)
        np.testing.assert_array_equal(library.get(found), host.find_simplex(q))
        np.testing.assert_allclose(library.get(weights), host.barycentric(q)[1], atol=1e-7)
        values = mesh.interpolate(z, q)
        np.testing.assert_allclose(library.get(values), host.interpolate(z, q), rtol=1e-7)
        assert values.dtype == mesh.interpolate(z, q[:0]).dtype == np.float32
        assert library.get(mesh.rasterize(z, shape=(3, 4))).shape == (3, 4)


def test_jax_reads_a_result_before_its_memory_is_used_again(library):
    """JAX returns memory that others own without waiting for its own stream."""
    if library.name != "jax":
        pytest.skip("of JAX alone")
    jax, jnp = library.xp, library.xp.numpy

    @jax.jit
    def late(simplices, a):
        for _ in range(60):
            a = a @ a / 2000
        _, simplices = jax.lax.optimization_barrier((a, simplices))  # not read before
        return jnp.sum(simplices.astype(jnp.int64) * jnp.arange(simplices.size).reshape(simplices.shape))

    a = library.put(np.ones((2_000, 2_000)))
    sets = [library.put(np.random.default_rng(seed).random((30_000, 2))) for seed in range(6)]
    wanted = [int(late(cadt.Delaunay(p).simplices, a)) for p in sets]
    assert [int(total) for total in [late(cadt.Delaunay(p).simplices, a) for p in sets]] == wanted


def test_threads(library):
    from concurrent.futures import ThreadPoolExecutor

    def work(seed: int) -> tuple[str, str]:
        points = np.random.default_rng(seed).random((20_000, 2))
        mesh = cadt.Delaunay(library.put(points))
        found = library.get(mesh.find_simplex(points[:100]))
        assert (found >= 0).all()
        return mesh.hash, cadt.Delaunay(points, backend="host").hash

    with ThreadPoolExecutor(8) as pool:
        for got, wanted in pool.map(work, range(24)):
            assert got == wanted


def test_options_of_each_call_on_an_open_device(library):
    points = np.random.default_rng(13).random((20_000, 2))
    wanted = cadt.Delaunay(points, backend="host").simplices
    for given in (points, library.put(points)):
        where = {"backend": "cuda"} if given is points else {}
        for _ in range(2):
            fast = cadt.Delaunay(given, order="fast", **where).simplices
            assert not np.array_equal(fast if given is points else library.get(fast), wanted)
            canonical = cadt.Delaunay(given, **where).simplices
            assert np.array_equal(canonical if given is points else library.get(canonical), wanted)
            with pytest.raises(cadt.OutOfMemory):
                cadt.Delaunay(given, max_memory=10_000, **where)


def test_release_memory(library):
    mesh = cadt.Delaunay(library.put(np.random.default_rng(10).random((10_000, 2))))
    before = library.get(mesh.simplices).copy()
    cadt.release_memory()
    np.testing.assert_array_equal(library.get(mesh.simplices), before)
    assert library.get(mesh.find_simplex([[0.5, 0.5]])) >= 0


def test_fork_is_refused():
    import os

    cadt.Delaunay(np.random.default_rng(11).random((1000, 2)), backend="cuda")
    child = os.fork()
    if child == 0:
        code = 1
        try:
            cadt.Delaunay(np.zeros((3, 2)), backend="cuda")
        except cadt.BackendUnavailable as e:
            code = 0 if "fork" in str(e) else 2
        except BaseException:  # noqa: BLE001 - a child must not come back
            code = 3
        os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
