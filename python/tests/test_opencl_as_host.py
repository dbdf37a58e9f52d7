# SPDX-License-Identifier: Apache-2.0
"""What meshes of PyOpenCL's arrays are given is read as it is on the host, and refused as it is there."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import cadt
import numpy as np
import pytest
from test_opencl_arrays import cl_array, queue  # noqa: F401 - a fixture

POINTS = np.random.default_rng(0).random((20, 2))
Z = POINTS[:, 0].copy()


def outcome(ask):
    """The answer, as an array of the host, or the error."""
    try:
        answer = ask()
    except (cadt.InputError, TypeError) as e:
        return type(e), str(e)
    return answer.get() if isinstance(answer, cl_array.Array) else answer


def same(a, b):
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and np.allclose(a, b, equal_nan=True)
    return a == b


@pytest.mark.parametrize(
    "values",
    [
        *(Z.astype(t) for t in ("float16", ">f8", "longdouble", "object", "complex128")),
        *(Z.tolist(), np.arange(20), Z > 0, None, ["a"] * 20, [[1], [1, 2]] * 10, Z[:3], np.float64(3)),
    ],
    ids=lambda v: str(getattr(v, "dtype", type(v).__name__)),
)
def test_values_of_the_host(queue, values):  # noqa: F811
    there, host = cadt.Delaunay(cl_array.to_device(queue, POINTS)), cadt.Delaunay(POINTS)
    expected = outcome(lambda: host.interpolate(values, [[0.5, 0.5]]))
    assert same(outcome(lambda: there.interpolate(values, [[0.5, 0.5]])), expected)


def test_values_on_the_device(queue):  # noqa: F811
    there, host = cadt.Delaunay(cl_array.to_device(queue, POINTS)), cadt.Delaunay(POINTS)
    for values in (Z, Z.astype(np.float16), Z[:3].copy()):
        expected = outcome(lambda: host.interpolate(values, [[0.5, 0.5]]))
        assert same(outcome(lambda: there.interpolate(cl_array.to_device(queue, values), [[0.5, 0.5]])), expected)


def test_points_of_other_types(queue):  # noqa: F811
    for dtype in ("float16", "int16", "int64", "uint64"):
        points = (POINTS * 100).astype(dtype)
        assert cadt.Delaunay(cl_array.to_device(queue, points)).hash == cadt.Delaunay(points).hash
    large = np.array([[0, 0], [1, 0], [0, 2**53 + 1]])
    assert outcome(lambda: cadt.Delaunay(cl_array.to_device(queue, large))) == outcome(lambda: cadt.Delaunay(large))


ASKED = {
    "one": lambda m, z: m.find_simplex([0.5, 0.5]),
    "several": lambda m, z: m.within_hull([[[0.5, 0.5]], [[1, 1]]]),
    "NaN": lambda m, z: m.find_simplex([[0, 0], [np.nan, 0]]),
    "weights": lambda m, z: m.barycentric([0.5, 0.5])[1],
    "nearest": lambda m, z: m.nearest_vertex([0.5, 0.5], 2),
    "values": lambda m, z: m.interpolate(np.stack([z, z, z], axis=1), [[0, 0], [1, 1], [2, 2]]),
    "infinite": lambda m, z: m.interpolate(z, [np.inf, 0.5]),
    "raster": lambda m, z: m.rasterize(z, bounds=(0, 0, 1, 1), shape=(2, 3)),
    "no cells": lambda m, z: m.rasterize(z, bounds=(0, 0, 0, 1), shape=(2, 3)),
}


@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("points", [np.empty((0, 2)), POINTS[:1], np.arange(6.0).reshape(3, 2)], ids=["0", "1", "line"])
def test_meshes_without_triangles(queue, points, asked):  # noqa: F811
    z, ask = np.zeros(len(points)), ASKED[asked]
    there, host = cadt.Delaunay(cl_array.to_device(queue, points)), cadt.Delaunay(points)
    answer, expected = outcome(lambda: ask(there, z)), outcome(lambda: ask(host, z))
    if isinstance(expected, np.ndarray) and expected.dtype == bool:
        answer = answer.astype(bool)  # PyOpenCL has int8 in its place
    assert same(answer, expected)


def test_threads_verify_one_mesh():
    script = """
        import cadt, numpy as np, pyopencl as cl, pyopencl.array, threading
        devices = [d for p in cl.get_platforms() for d in p.get_devices() if "fp64" in d.extensions]
        points = np.random.default_rng(0).random((5000, 2)); good = []
        mesh = cadt.Delaunay(cl.array.to_device(cl.CommandQueue(cl.Context(devices[:1])), points))
        def work(): good.extend(bool(mesh.verify()) for _ in range(40))
        threads = [threading.Thread(target=work) for _ in range(8)]
        for t in threads: t.start()
        for t in threads: t.join()
        assert len(good) == 320 and all(good)
    """
    command = [sys.executable, "-c", textwrap.dedent(script)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
