# SPDX-License-Identifier: Apache-2.0
"""cadt.cupy's arguments and attributes, with arrays of NumPy in place of CuPy's; test_gpu.py has the others."""

from __future__ import annotations

import cadt
import cadt.cupy
import numpy as np
import pytest


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
