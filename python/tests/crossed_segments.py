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
    compare_arrays(mesh, host, get)
    for member in ("points", "added_points", "added_parents"):
        got, wanted = get(getattr(mesh, member)), getattr(host, member)
        assert got.dtype == wanted.dtype, member
        np.testing.assert_array_equal(got, wanted, member)
    assert mesh.rounded_valid == host.rounded_valid
    assert mesh.hash == host.hash == pickle.loads(pickle.dumps(mesh)).hash
    assert bool(mesh.verify()) == bool(host.verify())
    of_given = np.arange(len(xy)) * 0.5
    for values in (put(of_given), of_given):
        np.testing.assert_array_equal(get(mesh.at_crossings(values)), host.at_crossings(of_given))

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
    np.testing.assert_allclose(get(mesh.interpolate(put(of_given), put(q))), host.interpolate(of_given, q), rtol=1e-9)
    with pytest.raises(cadt.InputError):
        mesh.at_crossings(put(z))
    with pytest.raises(cadt.InputError):
        mesh.interpolate(put(z[:5].copy()), q)
    return mesh


def compare_arrays(mesh: cadt.ConstrainedDelaunay, host: cadt.ConstrainedDelaunay, get: Callable) -> None:
    """All that a mesh tells of its triangles, segments and regions."""
    for member in ("simplices", "neighbors", "hull", "duplicate_of", "edge_flags", "constrained_edges", "inside"):
        np.testing.assert_array_equal(get(getattr(mesh, member)), getattr(host, member), member)
    for member in ("degenerate_segments", "triangles_inside", "region", "region_value", "region_attribute"):
        np.testing.assert_array_equal(get(getattr(mesh, member)), getattr(host, member), member)
    for member in ("chains", "edge_sources"):
        for own, wanted in zip(getattr(mesh, member), getattr(host, member)):
            np.testing.assert_array_equal(get(own), wanted, member)
    assert mesh.n_regions == host.n_regions and str(mesh.inside.dtype).endswith(("bool", "int8"))
    assert repr(mesh).rpartition(", ")[0] == repr(host).rpartition(", ")[0]


def compare_grid_and_seeds(put: Callable, get: Callable) -> None:
    """What is made on the host: meshes on a grid, and places of seeds; and segments on a line."""
    xy, segments = chords(300, 40)
    how = {"crossing": ("grid", 2.0**-6), "domain": "seeds", "holes": [[0.5, 0.5]], "regions": [[0.2, 0.3, 7.5]]}
    mesh = cadt.ConstrainedDelaunay(put(xy), put(segments), **how)
    host = cadt.ConstrainedDelaunay(xy, segments, backend="host", **how)
    compare_arrays(mesh, host, get)
    for member in ("points", "added_points", "added_parents"):
        np.testing.assert_array_equal(get(getattr(mesh, member)), getattr(host, member), member)
    assert mesh.hash == host.hash == pickle.loads(pickle.dumps(mesh)).hash and mesh.verify()
    z = (xy * [2, 3]).sum(axis=1)
    image = get(mesh.rasterize(put(z), shape=(9, 13)))  # within the bounds of where points have moved
    np.testing.assert_allclose(image, host.rasterize(z, shape=(9, 13)), rtol=1e-9)

    xy = np.array([[0.0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]])
    how = {"rings": [0, 4, 8], "domain": "seeds", "holes": [[1.5, 1.5]], "regions": [[0.5, 0.5, 7]]}
    mesh, host = cadt.ConstrainedDelaunay(put(xy), **how), cadt.ConstrainedDelaunay(xy, backend="host", **how)
    compare_arrays(mesh, host, get)
    assert len(host.triangles_inside) == 8 and sorted(get(mesh.region_attribute)) == [0, 7]
    with pytest.raises(cadt.OptionError):
        cadt.ConstrainedDelaunay(put(xy), **(how | {"holes": [[np.nan, 0]]}))

    xy, on_line = np.array([[3.0, 0], [1, 0], [2, 0], [0, 0], [2, 0]]), np.array([[0, 3], [3, 4], [2, 2], [4, 2]])
    mesh, host = cadt.ConstrainedDelaunay(put(xy), put(on_line)), cadt.ConstrainedDelaunay(xy, on_line, backend="host")
    compare_arrays(mesh, host, get)


def compare_rare_questions(put: Callable, get: Callable) -> None:
    """Queries in two arrays, meshes without triangles, values of no numbers, attributes and limits that are odd."""
    xy = np.random.default_rng(31).random((300, 2))
    mesh, host = cadt.Delaunay(put(xy)), cadt.Delaunay(xy, backend="host")
    x, y = np.random.default_rng(32).random((2, 2)) * 1.2
    for ask in ((put(x), put(y)), (x, y), (put(x), y), (x, 0.5)):
        wanted = host.find_simplex(tuple(get(a) if not isinstance(a, (np.ndarray, float)) else a for a in ask))
        np.testing.assert_array_equal(get(mesh.find_simplex(ask)), wanted)
    q = np.stack([x, y], axis=1)
    np.testing.assert_array_equal(get(mesh.within_hull(put(q))), host.within_hull(q))
    assert get(mesh.interpolate(put(np.empty((300, 0))), put(q))).shape == (2, 0)
    assert get(mesh.rasterize(put(np.empty((300, 0))), shape=(3, 4))).shape == (3, 4, 0)
    with pytest.raises(TypeError, match="real numbers, not bool"):
        mesh.interpolate(put(np.ones(300, dtype=bool)), put(q))

    line, z = np.stack([np.arange(5.0), np.arange(5.0)], axis=1), np.arange(5.0)
    of_line, on_host = cadt.Delaunay(put(line)), cadt.Delaunay(line, backend="host")
    for ask in (
        lambda m, p: (m.find_simplex(p(q)), *m.barycentric(p(q)), m.within_hull(p(q)), m.circumcenters()),
        lambda m, p: (m.nearest_vertex(p(q)), m.nearest_vertex(p(q), 3), m.rasterize(p(z), shape=(2, 3))),
        lambda m, p: tuple(m.interpolate(p(z), p(q), how) for how in ("linear", "nearest", "natural")),
    ):
        for own, wanted in zip(ask(of_line, put), ask(on_host, np.asarray)):
            np.testing.assert_array_equal(get(own), wanted)

    square = {"rings": [0, 4], "domain": "seeds", "regions": [[1, 1, np.nan]]}
    corners = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    mesh = cadt.ConstrainedDelaunay(put(corners), **square)
    assert mesh.verify() and mesh.hash == cadt.ConstrainedDelaunay(corners, backend="host", **square).hash
    for few in (np.empty((0, 2)), line):
        for wrong in ({"holes": [[np.nan, 0]]}, {"regions": [[0, np.inf, 1]]}):
            with pytest.raises(cadt.OptionError, match="not finite"):
                cadt.ConstrainedDelaunay(put(few), domain="seeds", **wrong)
    with pytest.raises(cadt.InputError, match="read on the host"):
        cadt.ConstrainedDelaunay(put(corners), rings=[0, 4], domain="seeds", holes=put(corners))
    # The limit of a call is not that of what earlier meshes are asked.
    mesh = cadt.ConstrainedDelaunay(put(xy), [[0, 1]])
    with pytest.raises(cadt.OutOfMemory):
        cadt.ConstrainedDelaunay(put(xy), [[0, 1]], max_memory=1000)
    assert get(mesh.inside).all() and (get(mesh.find_simplex(put(q))) >= -1).all()


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
