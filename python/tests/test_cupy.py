# SPDX-License-Identifier: Apache-2.0
"""cadt.cupy's arguments and attributes, with arrays of NumPy in place of CuPy's; test_gpu.py has the others."""

from __future__ import annotations

import types

import cadt
import cadt.cupy
import numpy as np
import pytest
from cadt import _arrays


def test_attributes(points: np.ndarray) -> None:
    tri, mesh = cadt.cupy.Delaunay(points), cadt.Delaunay(points)
    assert np.array_equal(tri.simplices, mesh.simplices) and np.array_equal(tri.neighbors, mesh.neighbors)
    assert tri.points is points and tri.npoints == len(points) and tri.nsimplex == mesh.n_triangles
    assert (tri.ndim, tri.furthest_site) == (2, False) and "cadt.cupy" in repr(tri)
    indptr, indices = tri.vertex_neighbor_vertices
    assert indptr.dtype == indices.dtype == np.int32
    assert all(a is b for a, b in zip(tri.vertex_neighbor_vertices(), (indptr, indices)))  # CuPy's method
    assert np.array_equal(indptr, mesh.vertex_neighbors[0]) and np.array_equal(indices, mesh.vertex_neighbors[1])
    assert np.array_equal(tri.convex_hull, mesh.convex_hull)
    assert len(tri.coplanar) == (mesh.duplicate_of >= 0).sum() and tri.coplanar.dtype == np.int32
    for point, simplex, vertex in tri.coplanar.tolist():
        assert mesh.duplicate_of[point] == vertex and vertex in tri.simplices[simplex]
    for v, t in enumerate(tri.vertex_to_simplex.tolist()):
        assert mesh.duplicate_of[v] in tri.simplices[t] if mesh.duplicate_of[v] >= 0 else v in tri.simplices[t]
    q = points[:10].astype(np.float64).reshape(2, 5, 2)
    assert np.array_equal(tri.find_simplex(q, bruteforce=True, tol=0), mesh.find_simplex(q))


def test_offsets_beyond_int32() -> None:
    tri = cadt.cupy.Delaunay(np.eye(3)[:, :2])
    begins = np.array([0, 6, 2**31, 2**31 + 6])  # as of 360 million points
    tri.mesh._cache["vertex_neighbors"] = begins, np.zeros(3, np.int32)
    indptr, _ = tri.vertex_neighbor_vertices
    assert indptr.dtype == np.int64 and np.array_equal(indptr, begins)


def test_streams_of_another_device_than_the_current() -> None:
    """Events belong to the current device, and the default stream is that of the current device: as in CUDA."""
    current, waits = [0], []

    class Device:
        def __init__(self, number: int) -> None:
            self.number = number

        def __enter__(self) -> None:
            self.before, current[0] = current[0], self.number

        def __exit__(self, *_: object) -> None:
            current[0] = self.before

    class Stream:
        def __init__(self, ptr: int, device: int | None = None) -> None:
            self.ptr, self.device = ptr, device

        def place(self) -> tuple[int, int]:
            return current[0] if self.device is None else self.device, self.ptr

        def record(self) -> tuple[int, int]:
            assert self.place()[0] == current[0], "an event of another device than its stream"
            return self.place()

        def wait_event(self, event: tuple[int, int]) -> None:
            waits.append((self.place(), event))

    default = Stream(0)
    cuda = types.SimpleNamespace(Device=Device, get_current_stream=lambda: default)
    arrays = _arrays.CuPy.__new__(_arrays.CuPy)
    arrays.xp, arrays.device, arrays.stream = types.SimpleNamespace(cuda=cuda), 1, Stream(7, 1)
    arrays.begin()
    arrays.finished(None)
    assert waits == [((1, 7), (1, 0)), ((1, 0), (1, 7))]


def test_arguments(rng: np.random.Generator) -> None:
    p = rng.random((10, 2))
    for bad in (rng.random((10, 3)), rng.random(10), rng.random((2, 5, 2))):
        with pytest.raises(ValueError):
            cadt.cupy.Delaunay(bad)
    with pytest.raises(ValueError, match="furthest_site"):
        cadt.cupy.Delaunay(p, furthest_site=True)
    with pytest.raises(ValueError, match="incremental"):
        cadt.cupy.Delaunay(p, incremental=True)
    tri = cadt.cupy.Delaunay(p)
    with pytest.raises(cadt.OptionError):
        tri.find_simplex(p, tol=1e-3)
    with pytest.raises(ValueError):
        tri.find_simplex(rng.random((4, 3)))
