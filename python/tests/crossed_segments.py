# SPDX-License-Identifier: Apache-2.0
"""Segments that cross, and meshes of them in device memory beside the host's: for each array library the same."""

from __future__ import annotations

import pickle
from collections.abc import Callable

import cadt
import numpy as np
import pytest


def chords(n: int, segments: int, seed: int = 21) -> tuple[np.ndarray, np.ndarray]:
    """Points, and segments between some of them, many of which cross, two at a place."""
    rng = np.random.default_rng(seed)
    return rng.random((n, 2)), rng.permutation(n)[: 2 * segments].reshape(-1, 2).astype(np.int32)


def sets() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    xy, segments = chords(600, 60)
    result = {"chords": (xy, segments), "float32": (xy.astype(np.float32), segments)}
    # Points on segments, and points that equal others.
    on = (xy[segments[:9, 0]] + xy[segments[:9, 1]]) / 2
    lattice = np.round(np.concatenate([xy, on, xy[:9]]) * 64)
    result["lattice"] = (lattice, segments)
    angles = np.arange(9) * 0.7
    ends = np.round(1000 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    star = np.stack([np.arange(9), np.arange(9) + 9], axis=1).astype(np.int32)
    result["through one place"] = (np.concatenate([ends, -ends, 100 * xy]), star)
    # Crossings within less than a last place of one another: rounding turns triangles over.
    near = [[0, 0], [1, 1], [0, 1], [1, 0], [0, 0.5], [1, 0.5 + 2**-52], [0.25, 0], [0.75, 1]]
    result["almost one place"] = (np.array(near), np.arange(8, dtype=np.int32).reshape(4, 2))
    return result


def compare(xy: np.ndarray, segments: np.ndarray, put: Callable, get: Callable) -> cadt.ConstrainedDelaunay:
    """The mesh in device memory, equal to the host's array by array. `get` checks what kind of array it gets."""
    how = {"crossing": "exact", "domain": "layers"}
    mesh = cadt.ConstrainedDelaunay(put(xy), put(segments), **how)
    host = cadt.ConstrainedDelaunay(xy, segments, backend="host", **how)
    added = len(host.added_points)
    assert added and mesh.n_points == host.n_points == len(xy) + added
    for member in ("simplices", "neighbors", "edge_flags", "region", "triangles_inside", "hull", "duplicate_of"):
        np.testing.assert_array_equal(get(getattr(mesh, member)), getattr(host, member), member)
    for member in ("points", "added_points", "added_parents"):
        got, wanted = get(getattr(mesh, member)), getattr(host, member)
        assert got.dtype == wanted.dtype, member
        np.testing.assert_array_equal(got, wanted, member)
    assert mesh.rounded_valid == host.rounded_valid
    assert repr(mesh).rpartition(", ")[0] == repr(host).rpartition(", ")[0]
    assert mesh.hash == host.hash == pickle.loads(pickle.dumps(mesh)).hash
    assert bool(mesh.verify()) == bool(host.verify())
    for name in ("chains", "constrained_edges", "edge_sources", "inside", "region_value"):
        with pytest.raises(cadt.OptionError):
            getattr(mesh, name)

    z = (host.points * [2, 3]).sum(axis=1)
    q = np.random.default_rng(22).random((300, 2)) * np.ptp(xy, axis=0) + xy.min(axis=0)
    if not host.rounded_valid:
        for of in (mesh, host):
            with pytest.raises(cadt.InvalidMesh):
                of.find_simplex(q)
        return mesh
    np.testing.assert_array_equal(get(mesh.find_simplex(put(q))), host.find_simplex(q))
    np.testing.assert_allclose(get(mesh.interpolate(put(z), put(q))), host.interpolate(z, q), rtol=1e-12)
    for own, wanted in zip(mesh.barycentric(put(q)), host.barycentric(q)):
        np.testing.assert_allclose(get(own), wanted, rtol=1e-12, atol=1e-12)
    image = get(mesh.rasterize(put(z), shape=(9, 13)))
    np.testing.assert_allclose(image, host.rasterize(z, shape=(9, 13)), rtol=1e-12)
    with pytest.raises(cadt.NotDelaunay):
        mesh.nearest_vertex(put(q))
    of_given = put(z[: len(xy)].copy())
    for ask in (lambda: mesh.interpolate(of_given, q), *(lambda v=v: mesh.at_crossings(v) for v in (of_given, z))):
        with pytest.raises(cadt.OptionError, match="at_crossings"):
            ask()
    with pytest.raises(cadt.InputError):
        mesh.interpolate(put(z[:5].copy()), q)
    return mesh


def compare_without_crossings(put: Callable, get: Callable) -> None:
    xy = np.array([[0.0, 0], [2, 2], [0, 2], [2, 0], [1, 1]])
    given = put(xy)
    mesh = cadt.ConstrainedDelaunay(given, put(np.array([[0, 1], [2, 3]])), crossing="exact")
    assert mesh.points is given and mesh.rounded_valid and mesh.n_points == 5
    for member, kind in (("added_points", np.float64), ("added_parents", np.int32)):
        got = get(getattr(mesh, member))
        assert got.shape == (0, 2) and got.dtype == kind
    z = np.arange(5.0)
    np.testing.assert_array_equal(get(mesh.at_crossings(put(z))), z)
    assert mesh.verify()
