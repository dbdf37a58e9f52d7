# SPDX-License-Identifier: Apache-2.0
"""cadt.scipy against SciPy, attribute by attribute."""

from __future__ import annotations

import copy
import itertools
import pickle
import warnings
from typing import Any

import numpy as np
import pytest

pytest.importorskip("scipy")

import cadt
import cadt.scipy as ours
import scipy.spatial
from cadt.scipy import _qhull

OPTIONS = [(None, False), ("Qbb Qc Q12", False), ("Qc", False), (None, True)]


def rows(a: np.ndarray) -> np.ndarray:
    """The order of triangles by their sorted corners."""
    return np.lexsort(np.sort(a, axis=1).T)


@pytest.mark.parametrize(("options", "incremental"), OPTIONS)
def test_attributes(general: np.ndarray, options: str | None, incremental: bool) -> None:
    a = scipy.spatial.Delaunay(general, incremental=incremental, qhull_options=options)
    b = ours.Delaunay(general, incremental=incremental, qhull_options=options)
    assert isinstance(b, scipy.spatial.Delaunay) and b.mesh is not None
    i, j = rows(a.simplices), rows(b.simplices)
    assert np.array_equal(np.sort(a.simplices[i]), np.sort(b.simplices[j]))
    assert np.allclose(a.equations[i], b.equations[j], rtol=0, atol=1e-9)
    assert b.paraboloid_scale == pytest.approx(a.paraboloid_scale, rel=1e-14)
    assert b.paraboloid_shift == pytest.approx(a.paraboloid_shift, rel=1e-14)
    public = {n for n in vars(a) if not n.startswith("_")}
    public |= {"points", "transform", "vertex_to_simplex", "convex_hull"}
    assert len(public) > 15
    for name in sorted(public):
        x, y = getattr(a, name), getattr(b, name)
        if isinstance(x, np.ndarray):
            assert (x.shape, x.dtype) == (y.shape, y.dtype), name
            assert y.flags.c_contiguous and y.flags.writeable, name
        else:
            assert y == pytest.approx(x), name
    assert np.array_equal(a.min_bound, b.min_bound) and np.array_equal(a.max_bound, b.max_bound)
    assert {frozenset(e) for e in a.convex_hull.tolist()} == {frozenset(e) for e in b.convex_hull.tolist()}
    for v, t in enumerate(b.vertex_to_simplex):
        assert v in b.simplices[t]
    (pa, ia), (pb, ib) = a.vertex_neighbor_vertices, b.vertex_neighbor_vertices
    assert (pa.dtype, ia.dtype) == (pb.dtype, ib.dtype) and np.array_equal(pa, pb)
    assert all(set(ia[pa[v] : pa[v + 1]]) == set(ib[pb[v] : pb[v + 1]]) for v in range(len(general)))


def test_offsets_beyond_int32() -> None:
    mesh = ours.Delaunay(np.random.default_rng(0).random((100, 2)))
    begins = np.array([0, 6, 2**31, 2**31 + 6])  # as of 360 million points
    mesh.mesh._cache["vertex_neighbors"] = begins, np.zeros(3, np.int32)
    indptr, _ = mesh.vertex_neighbor_vertices
    assert indptr.dtype == np.int64 and np.array_equal(indptr, begins)


def test_transform(general: np.ndarray) -> None:
    a = scipy.spatial.Delaunay(general)
    b = ours.Delaunay(general)
    corners = general[b.simplices]
    c = np.einsum("ijk,ilk->ilj", b.transform[:, :2], corners - b.transform[:, None, 2])
    assert np.allclose(c, [[1, 0], [0, 1], [0, 0]], atol=1e-9)
    thin = (
        scipy.spatial.Delaunay([[0, 0], [1, 0], [2, 1e-14], [1, 1]]),
        ours.Delaunay([[0, 0], [1, 0], [2, 1e-14], [1, 1]]),
    )
    assert np.isnan(thin[1].transform).all(axis=(1, 2)).sum() >= np.isnan(thin[0].transform).all(axis=(1, 2)).sum()
    x = general.mean(axis=0) + [[0.1, 0.2], [50, 50]]
    assert np.allclose(np.sort(a.plane_distance(x)), np.sort(b.plane_distance(x)), rtol=1e-9, atol=1e-9)
    assert np.allclose(a.lift_points(x), b.lift_points(x))


def test_find_simplex(general: np.ndarray, rng: np.random.Generator) -> None:
    a, b = scipy.spatial.Delaunay(general), ours.Delaunay(general)
    x = general.min(axis=0) - 0.3 + rng.random((40, 50, 2)) * [3.6, 2.6]
    fa, fb = a.find_simplex(x), b.find_simplex(x)
    assert fb.shape == (40, 50) and fb.dtype == fa.dtype
    assert np.array_equal(fa < 0, fb < 0) and (fb >= 0).any() and (fb < 0).any()
    inside = fa >= 0
    assert np.array_equal(np.sort(a.simplices[fa[inside]]), np.sort(b.simplices[fb[inside]]))
    # SciPy's own search on our arrays: planes, neighbours and transforms fit together.
    assert np.array_equal(b.find_simplex(x[0], bruteforce=True), fb[0])
    assert np.array_equal(b.find_simplex(x, tol=1e-13), fb)
    assert np.array_equal(b.find_simplex(x, tol=0), fb)
    assert np.array_equal(ours.tsearch(b, x), fb)
    assert (b.find_simplex([[np.nan, 0], [np.inf, 1], general[0]]) >= 0).tolist() == [False, False, True]
    assert b.find_simplex(np.empty((0, 2))).shape == (0,)
    with pytest.raises(ValueError):
        b.find_simplex([[1, 2, 3]])
    with pytest.raises(IndexError):
        b.find_simplex(3)
    with pytest.raises(TypeError):
        b.find_simplex([[1j, 2]])


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.1])
def test_tolerance_outside(angle: float) -> None:
    """Places that rounding puts outside of the hull are found at it, those further out are not."""
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 13), np.linspace(0, 1, 13)), axis=-1).reshape(-1, 2) @ turn
    tri = ours.Delaunay(grid)
    t = np.linspace(0, 1, 1001)[:, None]
    sides = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) @ turn
    border = np.concatenate([a * (1 - t) + b * t for a, b in itertools.pairwise(sides)])
    exactly = tri.find_simplex(border, tol=0)
    assert (tri.find_simplex(border) >= 0).all()
    if angle:
        assert (exactly < 0).any(), "rounding has put no query outside: this tests nothing"
    outwards = border + (border - [0.5, 0.5] @ turn) * 1e-9
    assert (tri.find_simplex(outwards) < 0).all()
    plane = grid @ [2.0, -1.0]
    for kind in (ours.LinearNDInterpolator, ours.NaturalNeighborInterpolator):
        assert np.allclose(kind(tri, plane)(border), border @ [2.0, -1.0], atol=1e-12)
        assert (kind(tri, plane, fill_value=7)(outwards) == 7).all()


def test_duplicates(rng: np.random.Generator) -> None:
    p = np.repeat(rng.random((10, 2)), 2, axis=0)
    tri = ours.Delaunay(p)
    assert tri.coplanar.shape == (10, 3) and tri.coplanar.dtype == np.int32
    for point, simplex, vertex in tri.coplanar.tolist():
        assert np.array_equal(p[point], p[vertex]) and vertex in tri.simplices[simplex] and vertex < point
        assert tri.vertex_to_simplex[point] == tri.vertex_to_simplex[vertex]
    bare = ours.Delaunay(p, qhull_options="Qbb Qz")
    assert len(bare.coplanar) == 0 and (bare.vertex_to_simplex[tri.coplanar[:, 0]] == -1).all()
    v = ours.Voronoi(p)
    assert (v.point_region[1::2] == v.point_region[::2]).all() and len(v.regions) == 11


def left_to_scipy(make: Any, match: str) -> Any:
    _qhull._said.clear()
    with pytest.warns(ours.QhullWarning, match=match):
        made = make()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make()  # once each
    return made


def test_what_is_left_to_scipy(rng: np.random.Generator) -> None:
    p3, p2 = rng.random((20, 3)), rng.random((20, 2))
    tri = left_to_scipy(lambda: ours.Delaunay(p3), "3 dimensions")
    assert tri.mesh is None and np.array_equal(tri.simplices, scipy.spatial.Delaunay(p3).simplices)
    assert tri.find_simplex(p3.mean(axis=0)) >= 0 and len(tri.transform) == tri.nsimplex
    assert tri.plane_distance(p3).shape == (20, tri.nsimplex)
    assert "cadt.scipy" in repr(tri) and len(tri.vertex_to_simplex) == 20 and len(tri.convex_hull)
    assert left_to_scipy(lambda: ours.Voronoi(p3), "3 dimensions").mesh is None
    assert left_to_scipy(lambda: ours.Delaunay(p2, furthest_site=True), "furthest_site").furthest_site
    assert left_to_scipy(lambda: ours.Voronoi(p2, furthest_site=True), "furthest_site").furthest_site
    left_to_scipy(lambda: ours.Delaunay(p2, qhull_options="Qt Qu"), "Qu")
    assert ours.Delaunay(p2, qhull_options="QJ").mesh is not None
    twice = np.concatenate([p2, p2])
    joggled = left_to_scipy(lambda: ours.Delaunay(twice, qhull_options="QJ Pp"), "QJ with duplicates")
    assert set(joggled.simplices.ravel()) == set(range(40))
    left_to_scipy(lambda: ours.griddata(p3, p3[:, 0], p3, "nearest"), "griddata in 3")
    left_to_scipy(lambda: ours.NearestNDInterpolator(p3, p3[:, 0]), "nearest neighbours in 3")
    near = ours.NearestNDInterpolator(p2, p2[:, 0])
    left_to_scipy(lambda: near(p2, distance_upper_bound=1e-9), "cKDTree.query")
    for wrong in (b"QJ", b"", 3):
        with pytest.raises(TypeError, match="qhull_options must be a str"):
            ours.Delaunay(p2, qhull_options=wrong)
    with pytest.raises(ValueError, match="incompatible"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ours.Delaunay(p2, incremental=True, qhull_options="Qbb")


def test_points_that_are_not_aligned(general: np.ndarray) -> None:
    memory = np.zeros(1 + general.nbytes, dtype=np.uint8)
    points = memory[1:].view(np.float64).reshape(-1, 2)
    points[:] = general
    assert not points.flags.aligned and ours.Delaunay(points).points.flags.aligned
    assert np.array_equal(ours.Delaunay(points).equations, ours.Delaunay(general).equations)


def test_flat_points() -> None:
    for points in ([[1, 2]], [[0, 0], [1, 1]], [[0, 0], [1, 1], [3, 3]], np.ones((5, 2))):
        for kind in (ours.Delaunay, ours.Voronoi):
            with pytest.raises(ours.FlatPointsError) as caught:
                kind(points)
            assert isinstance(caught.value, (scipy.spatial.QhullError, cadt.Error))
            with pytest.raises(scipy.spatial.QhullError):
                getattr(scipy.spatial, kind.__name__)(points)
    with pytest.raises(ValueError):
        ours.Delaunay(np.empty((0, 2)))


@pytest.mark.parametrize("kind", [ours.Delaunay, ours.Voronoi])
def test_incremental(kind: Any, general: np.ndarray) -> None:
    whole, parts = kind(general), kind(general[:50], incremental=True)
    given = general[50:].copy()
    parts.add_points(given)
    given[:] = 0
    assert parts.mesh.hash == whole.mesh.hash and parts.npoints == 300
    before = parts.mesh.hash
    for bad in ([[np.nan, 0]], [[1, 2, 3]], [1, 2]):
        with pytest.raises(ValueError):
            parts.add_points(bad)
    assert parts.mesh.hash == before
    parts.add_points(general[:1], restart=True)
    assert parts.npoints == 301
    parts.close()
    for closed in (parts, whole):
        with pytest.raises(RuntimeError):
            closed.add_points(general)


@pytest.mark.parametrize("change", [lambda o: pickle.loads(pickle.dumps(o)), copy.copy, copy.deepcopy])
def test_copies(change: Any, general: np.ndarray) -> None:
    tri = ours.Delaunay(general)
    tri.find_simplex(general.min(axis=0) - 1)
    other = change(tri)
    assert np.array_equal(other.simplices, tri.simplices) and np.array_equal(other.points, general)
    assert (other.find_simplex(general) == tri.find_simplex(general)).all()
    v = change(ours.Voronoi(general))
    assert v.regions == ours.Voronoi(general).regions
    ip = change(ours.LinearNDInterpolator(tri, general[:, 0]))
    assert np.allclose(ip(general), general[:, 0])
    nearest = ours.NearestNDInterpolator(general, general[:, 0])
    nearest(general[:2])
    assert np.array_equal(change(nearest)(general), general[:, 0])


@pytest.mark.parametrize("kind", [ours.Delaunay, ours.Voronoi])
def test_pickles_without_progress(kind: Any, general: np.ndarray) -> None:
    whole = kind(general, incremental=True, progress=lambda *about: None)
    other = pickle.loads(pickle.dumps(whole))
    for made in (whole, other):
        made.add_points(general[:1] + 1)
    assert other.mesh.hash == whole.mesh.hash


def as_sets(v: Any) -> tuple[list, list]:
    """Ridges and regions by coordinates, which order and numbers do not change."""
    place = [tuple(np.round(x, 6)) for x in v.vertices.tolist()] + [("infinity",)]
    ridges = sorted(
        (tuple(sorted(p)), sorted(map(str, (place[a] for a in r))))
        for p, r in zip(v.ridge_points.tolist(), v.ridge_vertices)
    )
    return ridges, [sorted(str(place[a]) for a in v.regions[r]) for r in v.point_region]


@pytest.mark.parametrize("which", ["general", "lattice", "turned", "linspace"])
def test_voronoi(which: str, general: np.ndarray) -> None:
    p = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), axis=-1).reshape(-1, 2)
    if which == "general":
        p = general[:60]
    elif which == "turned":
        p = p @ [[0.8, 0.6], [-0.6, 0.8]]
    elif which == "linspace":
        p = np.stack(np.meshgrid(np.linspace(0, 1, 7), np.linspace(3, 4, 6)), axis=-1).reshape(-1, 2)
    a, b = scipy.spatial.Voronoi(p), ours.Voronoi(p)
    assert isinstance(b, scipy.spatial.Voronoi)
    assert as_sets(a) == as_sets(b)
    for name in ("vertices", "ridge_points", "point_region", "points", "min_bound", "max_bound"):
        x, y = getattr(a, name), getattr(b, name)
        assert (x.shape, x.dtype) == (y.shape, y.dtype), name
    assert len(a.regions) == len(b.regions) and len(a.ridge_dict) == len(b.ridge_dict)
    assert (a.npoints, a.ndim, a.furthest_site) == (b.npoints, b.ndim, b.furthest_site)
    assert all(min(r) == r[0] or -1 not in r for r in b.ridge_vertices)


def test_plots(general: np.ndarray) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    pytest.importorskip("matplotlib.tri")
    assert scipy.spatial.delaunay_plot_2d(ours.Delaunay(general)).axes
    assert scipy.spatial.voronoi_plot_2d(ours.Voronoi(general)).axes
    tri = ours.Delaunay(general)
    plane = matplotlib.tri.Triangulation(*general.T, tri.simplices)
    at = matplotlib.tri.LinearTriInterpolator(plane, general[:, 0])(general[:5, 0], general[:5, 1])
    assert np.allclose(at, general[:5, 0])
