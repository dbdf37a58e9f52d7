# SPDX-License-Identifier: Apache-2.0
"""Every member of cadt.Delaunay against exact brute force and against each other."""

from __future__ import annotations

import copy
import itertools
import pickle
import sys

import cadt
import numpy as np
import pytest
from exact import distance2, exact, in_circle, turn


@pytest.fixture
def mesh(points: np.ndarray) -> cadt.Delaunay:
    return cadt.Delaunay(points)


@pytest.fixture
def queries(points: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Places in and around the points, the points themselves, and the middles of some."""
    p = points.astype(np.float64)
    low, size = p.min(axis=0), np.ptp(p, axis=0)
    return np.concatenate([low + size * (1.4 * rng.random((60, 2)) - 0.2), p[:20], (p[:20] + p[1:21]) / 2])


def test_nearly_flat_triangles_of_others_are_turned_exactly():
    """Where the determinant of doubles has the wrong sign, or is 0."""
    rng = np.random.default_rng(1)
    made = 0
    for _ in range(600):
        a, b, t = rng.random(2) * 9, rng.random(2) * 9, rng.random()
        p = np.array([a, b, a + t * (b - a)])
        mesh = cadt.Delaunay(p)
        made += mesh.n_triangles
        for turned in (mesh.simplices, mesh.simplices[:, [0, 2, 1]]):
            for verify in (True, False):
                same = cadt.Delaunay.from_simplices(p, turned, verify=verify)
                np.testing.assert_array_equal(same.simplices, mesh.simplices)
    assert made > 200
    square = np.array([[0, 0], [1, 0], [0, 1], [1, 1.0]])
    for scale in (1e-200, 1e-310, 1e300):
        mesh = cadt.Delaunay(square * scale)
        assert cadt.Delaunay.from_simplices(square * scale, mesh.simplices[:, [0, 2, 1]]).hash == mesh.hash


def test_batches_copy_their_offsets_and_refuse_other_indices():
    offsets = np.array([0, 3, 7])
    batch = cadt.triangulate_batch(np.random.default_rng(2).random((7, 2)), offsets)
    offsets[1] = 5
    assert [len(of.points) for of in batch] == [3, 4] and len(batch[-1].points) == 4
    for wrong, error in ((2, "there is no set 2: there are 2"), (-3, "no set -3")):
        with pytest.raises(IndexError, match=error):
            batch[wrong]
    for wrong in (slice(0, 1), "a", 1.0):
        with pytest.raises(TypeError):
            batch[wrong]


def test_triangles_are_delaunay(mesh: cadt.Delaunay) -> None:
    p = exact(mesh.points)
    unique = [i for i in range(mesh.n_points) if mesh.duplicate_of[i] < 0]
    for a, b, c in mesh.simplices.tolist():
        assert turn(p[a], p[b], p[c]) > 0
    for t, corners in enumerate(mesh.simplices.tolist()[:40]):
        a, b, c = (p[i] for i in corners)
        assert all(in_circle(a, b, c, p[i]) <= 0 for i in unique), t
    assert set(mesh.simplices.ravel().tolist()) == set(unique)
    assert mesh.n_triangles == len(mesh.simplices) == 2 * len(unique) - 2 - len(mesh.hull)
    assert mesh.verify()
    assert mesh.verify().checks and "ok" in str(mesh.verify())


def test_area_is_that_of_the_hull(mesh: cadt.Delaunay) -> None:
    p = exact(mesh.points)
    area = sum(turn(*(p[i] for i in t)) for t in mesh.simplices.tolist())
    loop = mesh.hull.tolist()
    around = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip([p[i] for i in loop], [p[i] for i in loop[1:] + loop[:1]]))
    assert area == around
    assert mesh.convex_hull.tolist() == [[a, b] for a, b in zip(loop, loop[1:] + loop[:1])]


def test_neighbors_are_opposite(mesh: cadt.Delaunay) -> None:
    s, n = mesh.simplices.tolist(), mesh.neighbors.tolist()
    hull = set()
    for t in range(mesh.n_triangles):
        for k in range(3):
            edge = (s[t][(k + 1) % 3], s[t][(k + 2) % 3])
            if n[t][k] < 0:
                hull.add(edge)
            else:
                back = n[n[t][k]].index(t)
                assert {edge[0], edge[1]} == set(s[n[t][k]]) - {s[n[t][k]][back]}
    assert hull == set(map(tuple, mesh.convex_hull.tolist()))


def test_canonical_order(mesh: cadt.Delaunay) -> None:
    s = mesh.simplices
    assert (s[:, 0] == s.min(axis=1)).all()
    assert s.tolist() == sorted(s.tolist())
    fast = cadt.Delaunay(mesh.points, order="fast")
    assert fast.hash == mesh.hash and len(mesh.hash) == 32
    assert sorted(map(sorted, fast.simplices.tolist())) == sorted(map(sorted, s.tolist()))


def test_edges_and_rows(mesh: cadt.Delaunay) -> None:
    s = mesh.simplices.tolist()
    edges = sorted({tuple(sorted((t[k], t[k - 1]))) for t in s for k in range(3)})
    assert list(map(tuple, mesh.edges.tolist())) == edges
    indptr, indices = mesh.vertex_neighbors
    begin, triangles = mesh.incident_triangles
    for v in range(mesh.n_points):
        around = indices[indptr[v] : indptr[v + 1]].tolist()
        assert sorted(around) == sorted({a + b - v for a, b in edges if v in (a, b)})
        assert sorted(triangles[begin[v] : begin[v + 1]].tolist()) == [t for t in range(len(s)) if v in s[t]]
        in_turn = zip(around, around[1:] + around[:1]) if v not in mesh.hull else itertools.pairwise(around)
        p = exact(mesh.points[[v]])[0]
        assert all(turn(p, *exact(mesh.points[[a, b]])) > 0 for a, b in in_turn)
        lowest = min((t for t in range(len(s)) if v in s[t]), default=-1)
        if mesh.duplicate_of[v] < 0:
            assert mesh.vertex_to_simplex[v] == lowest
    half = mesh.half_edges.reshape(-1)
    twin = np.flatnonzero(half >= 0)
    assert (half[half[twin]] == twin).all() and (half < 0).sum() == len(mesh.hull)


def test_duplicates(mesh: cadt.Delaunay) -> None:
    first: dict[tuple[float, ...], int] = {}
    for i, p in enumerate(map(tuple, mesh.points.tolist())):
        assert mesh.duplicate_of[i] == first.get(p, -1)
        first.setdefault(p, i)


def test_find_simplex(mesh: cadt.Delaunay, queries: np.ndarray) -> None:
    p, q = exact(mesh.points), exact(queries)
    found = mesh.find_simplex(queries)
    assert found.dtype == np.int32
    s = mesh.simplices.tolist()
    for i, x in enumerate(q):
        inside = (
            t
            for t, (a, b, c) in enumerate(s)
            if min(turn(p[a], p[b], x), turn(p[b], p[c], x), turn(p[c], p[a], x)) >= 0
        )
        assert found[i] == next(inside, -1)
    assert (mesh.within_hull(queries) == (found >= 0)).all()
    assert mesh.find_simplex(queries[0]).shape == ()
    assert (mesh.find_simplex(queries.reshape(2, -1, 2)).ravel() == found).all()
    assert (mesh.find_simplex((queries[:, 0], queries[:, 1])) == found).all()
    triangles, weights = mesh.barycentric(queries)
    assert (triangles == found).all()
    inside = found >= 0
    assert np.isnan(weights[~inside]).all() and (weights[inside] >= 0).all()
    corners = mesh.points.astype(np.float64)[mesh.simplices[found[inside]]]
    scale = np.abs(mesh.points).max()
    assert np.allclose(np.einsum("ik,ikj->ij", weights[inside], corners), queries[inside], rtol=0, atol=1e-12 * scale)


def test_nearest_vertex(mesh: cadt.Delaunay, queries: np.ndarray) -> None:
    p, q = exact(mesh.points), exact(queries)
    unique = [i for i in range(mesh.n_points) if mesh.duplicate_of[i] < 0]
    nearest = mesh.nearest_vertex(queries)
    three = mesh.nearest_vertex(queries, 3)
    for i, x in enumerate(q):
        order = sorted(unique, key=lambda v: (distance2(p[v], x), v))
        assert nearest[i] == order[0] == three[i, 0]
        assert [distance2(p[v], x) for v in three[i]] == [distance2(p[v], x) for v in order[:3]]
    many = mesh.nearest_vertex(queries[:2], mesh.n_points + 5)
    assert many.shape == (2, mesh.n_points + 5) and (many[:, len(unique) :] == -1).all()
    assert sorted(many[0, : len(unique)].tolist()) == unique


@pytest.mark.parametrize("method", ["linear", "nearest", "natural"])
def test_interpolate(mesh: cadt.Delaunay, queries: np.ndarray, method: str) -> None:
    p = mesh.points.astype(np.float64)
    plane = (p - p.mean(axis=0)) @ [2.0, -3.0] + 1
    out = mesh.interpolate(plane, queries, method)
    inside = mesh.within_hull(queries)
    assert np.isnan(out[~inside]).all()
    if method == "nearest":
        assert (out[inside] == plane[mesh.nearest_vertex(queries[inside])]).all()
    else:
        expected = (queries - p.mean(axis=0)) @ [2.0, -3.0] + 1
        assert np.allclose(out[inside], expected[inside], rtol=0, atol=1e-9 * max(1, np.ptp(plane)))
    both = mesh.interpolate(np.stack([plane, -plane], axis=1), queries, method, outside="nearest")
    assert both.shape == (len(queries), 2)
    assert (both[~inside, 0] == plane[mesh.nearest_vertex(queries[~inside])]).all()
    assert np.array_equal(both[inside], np.stack([out, -out], axis=1)[inside])
    assert mesh.interpolate(np.zeros((len(p), 2, 3)), queries, method).shape == (len(queries), 2, 3)


@pytest.mark.parametrize("origin", ["upper", "lower"])
def test_rasterize(mesh: cadt.Delaunay, origin: str) -> None:
    p = mesh.points.astype(np.float64)
    values = p[:, 0] - p[:, 0].min()
    low, high = p.min(axis=0), p.max(axis=0)
    picture = mesh.rasterize(values, shape=(5, 7), origin=origin)
    dx, dy = (high - low) / (7, 5)
    x = low[0] + (np.arange(7) + 0.5) * dx
    y = high[1] - (np.arange(5) + 0.5) * dy if origin == "upper" else low[1] + (np.arange(5) + 0.5) * dy
    centers = np.stack(np.meshgrid(x, y), axis=-1)
    expected = mesh.interpolate(values, centers)
    assert picture.shape == (5, 7)
    assert np.allclose(picture, expected, rtol=0, atol=1e-9 * max(1.0, float(np.abs(p).max())), equal_nan=True)
    cells = mesh.rasterize(values, bounds=(*low, *high), resolution=(float(dx), float(dy)), origin=origin)
    assert cells.shape == (5, 7)
    assert np.isnan(mesh.rasterize(values, shape=(5, 7), max_edge=0)).all()
    assert mesh.rasterize(np.stack([values, values], axis=1), shape=(2, 2), method="natural").shape == (2, 2, 2)


def test_circumcenters_and_circles(mesh: cadt.Delaunay) -> None:
    centers = mesh.circumcenters()
    p = mesh.points.astype(np.float64)
    d = np.linalg.norm(p[mesh.simplices] - centers[:, None], axis=2)
    usual = np.isfinite(d).all(axis=1) & (d.max(axis=1) < 100 * np.ptp(p))
    assert np.allclose(d[usual].max(axis=1), d[usual].min(axis=1), rtol=1e-4)
    at, radii, triangles = mesh.largest_empty_circles(5)
    assert (np.diff(radii) <= 0).all() and (mesh.within_hull(at)).all()
    assert np.allclose(at, centers[triangles]) and np.allclose(radii, d[triangles, 0], rtol=1e-4)
    kept, edges = mesh.alpha_shape(float(np.median(d[:, 0])))
    assert (np.diff(kept) > 0).all() and 0 < len(kept) <= mesh.n_triangles
    assert (d[kept].max(axis=1) <= np.median(d[:, 0]) * (1 + 1e-4)).all()
    sides = {(t[k], t[(k + 1) % 3]) for t in mesh.simplices[kept].tolist() for k in range(3)}
    assert set(map(tuple, edges.tolist())) == {e for e in sides if e[::-1] not in sides}
    everything, outline = mesh.alpha_shape(np.inf)
    assert len(everything) == mesh.n_triangles
    assert set(map(tuple, outline.tolist())) == set(map(tuple, mesh.convex_hull.tolist()))


def test_voronoi(mesh: cadt.Delaunay) -> None:
    v = mesh.voronoi()
    assert np.array_equal(v.vertices, mesh.circumcenters(), equal_nan=True)
    begin, triangles = mesh.incident_triangles
    for p in range(mesh.n_points):
        assert sorted(v.cell(p).tolist()) == sorted(triangles[begin[p] : begin[p + 1]].tolist())
    assert sorted(map(sorted, v.ridge_points.tolist())) == sorted(map(list, mesh.edges.tolist()))
    assert (v.ridge_vertices[:, 1] < 0).sum() == len(mesh.hull)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    indptr, xy = mesh.voronoi_polygons((*low, *high))
    area = 0.0
    for p in range(mesh.n_points):
        x, y = (xy[indptr[p] : indptr[p + 1]] - low).T
        area += 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    assert np.isclose(area, np.prod((high - low).astype(float)), rtol=1e-9)


def test_copies(mesh: cadt.Delaunay, queries: np.ndarray) -> None:
    found = mesh.find_simplex(queries)
    for other in (pickle.loads(pickle.dumps(mesh)), copy.copy(mesh), copy.deepcopy(mesh)):
        assert other.hash == mesh.hash and np.array_equal(other.points, mesh.points)
        assert (other.find_simplex(queries) == found).all()
    adopted = cadt.Delaunay.from_simplices(mesh.points, mesh.simplices[:, [0, 2, 1]])
    assert adopted.hash == mesh.hash
    assert cadt.verify(mesh.points, mesh.simplices, mesh.neighbors)
    assert not cadt.verify(mesh.points, mesh.simplices[1:])
    with pytest.raises(cadt.InvalidMesh):
        cadt.Delaunay.from_simplices(mesh.points, mesh.simplices[1:])


@pytest.mark.parametrize(
    ("points", "simplices"),
    [
        ([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]]),  # the other diagonal of a square
        ([[0, 0], [4, 0], [0, 4], [0, 0]], [[3, 1, 2]]),  # the second of two equal points
        ([[0, 0], [1, 1]], np.empty((0, 3), int)),
    ],
)
def test_meshes_of_others_are_verified_as_such(points: list, simplices: list) -> None:
    adopted = cadt.Delaunay.from_simplices(points, simplices)
    assert adopted.simplices.tolist() == np.asarray(simplices).tolist()
    for mesh in (adopted, copy.copy(adopted), pickle.loads(pickle.dumps(adopted))):
        assert mesh.verify(), mesh.verify()
    assert cadt.verify(points, simplices)


def test_meshes_of_others_that_are_wrong() -> None:
    wrong = cadt.Delaunay.from_simplices([[0, 0], [4, 0], [4, 1], [0, 3]], [[0, 1, 3], [1, 2, 3]], verify=False)
    for mesh in (wrong, pickle.loads(pickle.dumps(wrong))):
        assert not mesh.verify() and "delaunay failed" in str(mesh.verify())


def test_matplotlib(mesh: cadt.Delaunay) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    pytest.importorskip("matplotlib.pyplot")
    t = mesh.to_matplotlib()
    assert np.array_equal(t.triangles, mesh.simplices)
    fresh = matplotlib.tri.Triangulation(t.x, t.y, t.triangles)
    assert np.array_equal(t.neighbors, fresh.neighbors)
    assert len(t.edges) == len(mesh.edges)
    assert mesh.plot(matplotlib.pyplot.figure().gca()).lines


def test_options(points: np.ndarray) -> None:
    hashes = {
        cadt.Delaunay(points, threads=n, statistics=s).hash for n in (1, 2, 3) for s in ("none", "counters", "timing")
    }
    assert len(hashes) == 1
    assert cadt.Delaunay(points, backend="host").device == "host"
    statistics = cadt.Delaunay(points).statistics
    assert statistics["points"] == len(points)
    assert statistics["stabilized_edges"] == statistics["illegal_edges"] == 0
    seen: list[tuple[str, float]] = []
    many = np.random.default_rng(0).random((400_000, 2))
    # On a GPU, or many processors, it would have ended before the first report.
    cadt.Delaunay(many, backend="host", threads=1, progress=lambda phase, fraction: seen.append((phase, fraction)))
    assert seen and all(0 <= f <= 1 for _, f in seen)


@pytest.mark.parametrize("tqdm", [False, True])
def test_progress_without_a_standard_error(monkeypatch: pytest.MonkeyPatch, tqdm: bool) -> None:
    """As under pythonw, or with 2>&-; a terminal may go away, too."""

    class Gone:
        def isatty(self) -> bool:
            return True

        def write(self, text: str) -> int:
            raise OSError(5, "Input/output error")

        flush = write

    if not tqdm:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)  # type: ignore[arg-type]
    for stream in (None, Gone()) if not tqdm else (None,):
        monkeypatch.setattr(sys, "stderr", stream)
        assert cadt.Delaunay([[0, 0], [1, 0], [0, 1]], progress=True).n_triangles == 1


def test_batch(rng: np.random.Generator) -> None:
    p = rng.random((500, 2))
    offsets = [0, 0, 100, 103, 105, 500]
    batch = cadt.triangulate_batch(p, offsets)
    assert len(batch) == 5 == len(list(batch))
    for s, mesh in enumerate(batch):
        alone = cadt.Delaunay(p[offsets[s] : offsets[s + 1]])
        assert mesh.hash == alone.hash and np.array_equal(mesh.simplices, alone.simplices)
        a, b = batch.triangle_offsets[s : s + 2]
        assert np.array_equal(batch.simplices[a:b], alone.simplices)
        assert np.array_equal(batch.neighbors[a:b], alone.neighbors)
    assert batch[-1].n_points == 395
    with pytest.raises(IndexError):
        batch[5]


def test_devices() -> None:
    infos = cadt.devices()
    host = [d for d in infos if d.backend == "host"]
    assert host and host[0].usable
    assert all(d.usable or d.reason for d in infos)
    assert host[0].largest_buffer_bytes > 0 and host[0].atomics and not host[0].watchdog
    cadt.release_memory()
    assert all(hasattr(cadt, name) for name in dir(cadt)) and cadt.__version__.count(".") == 2


def test_statistics() -> None:
    points = np.random.default_rng(3).random((50_000, 2))
    plain = cadt.Delaunay(points, statistics="none").statistics
    timing = cadt.Delaunay(points, statistics="timing", threads=2).statistics
    assert plain["points"] == timing["points"] == 50_000
    assert plain["milliseconds"] == {} and timing["milliseconds"]["sort"] > 0
    assert len(timing["flips_per_edge"]) == 16
    assert plain["thread_time"] == {} and all(0 <= share <= 1 for share in timing["thread_time"].values())
