# SPDX-License-Identifier: Apache-2.0
"""The interpolators of cadt.scipy against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("scipy")

import cadt
import cadt.scipy as ours
import scipy.interpolate
from cadt.scipy import _interpolate


def test_interpolators(general: np.ndarray, rng: np.random.Generator) -> None:
    values = np.stack([np.sin(general[:, 0]), general[:, 1]], axis=1) + 1j * general
    x = general.min(axis=0) - 0.3 + rng.random((30, 20, 2)) * [3.6, 2.6]
    for name in ("LinearNDInterpolator", "CloughTocher2DInterpolator", "NearestNDInterpolator"):
        a, b = getattr(scipy.interpolate, name), getattr(ours, name)
        for v in (values, values.real, values[:, 0].real, values.real[:, :, None].astype(np.float32)):
            for how in ({}, {"rescale": True}):
                left, right = a(general, v, **how)(x), b(general, v, **how)(x)
                assert (left.shape, left.dtype) == (right.shape, right.dtype)
                assert np.allclose(left, right, rtol=1e-7, atol=1e-7, equal_nan=True), (name, how)
            assert np.allclose(
                b(general, v)(x[..., 0], x[..., 1]), b(general, v)((x[..., 0], x[..., 1])), equal_nan=True
            )
    tri = ours.Delaunay(general)
    z = values[:, 0].real
    for kind in (scipy.interpolate.LinearNDInterpolator, scipy.interpolate.CloughTocher2DInterpolator):
        assert np.allclose(kind(tri, z)(x), kind(general, z)(x), rtol=1e-7, atol=1e-7, equal_nan=True)
    filled = ours.LinearNDInterpolator(tri, values, fill_value=-1)(x)
    outside = tri.find_simplex(x) < 0
    assert (filled[outside] == -1).all() and not np.isnan(filled).any()
    z = z.copy()
    z[0] = np.nan
    with_nan = ours.LinearNDInterpolator(tri, z, fill_value=5)(x)
    expected = scipy.interpolate.LinearNDInterpolator(tri, z, fill_value=5)(x)
    assert np.allclose(with_nan, expected, equal_nan=True) and np.isnan(with_nan).any()
    assert np.isnan(ours.LinearNDInterpolator(tri, z)([[np.nan, 1]])).all()
    natural = ours.NaturalNeighborInterpolator(general, general @ [1.0, 2.0])(x)
    assert np.allclose(natural[~outside], (x @ [1.0, 2.0])[~outside]) and np.isnan(natural[outside]).all()


@pytest.mark.parametrize("rescale", [False, True])
@pytest.mark.parametrize("values", [np.float64, np.complex128])
def test_no_queries(values, rescale):
    p = np.random.default_rng(5).random((30, 2))
    for z in (p[:, 0].astype(values), np.zeros((30, 3), values), np.zeros((30, 0), values)):
        for q in (np.empty((0, 2)), np.empty((3, 0, 2))):
            got = ours.LinearNDInterpolator(p, z, rescale=rescale)(q)
            assert got.shape == (*q.shape[:-1], *z.shape[1:]) and got.dtype == values
    if values is np.float64 and not rescale:
        for method in ("linear", "natural", "nearest"):
            assert ours.griddata(p, p[:, 0], np.empty((0, 2)), method=method).shape == (0,)
        with pytest.raises(ValueError):
            ours.Delaunay(p).plane_distance(np.float64(0.5))


def test_grids_far_from_the_origin_are_as_one_by_one():
    p = np.random.default_rng(7).random((300, 2))
    z, at = np.sin(7 * p[:, 0]) + p[:, 1], 1e9
    x, y = np.meshgrid(at + np.linspace(-0.1, 1.1, 150), at + np.linspace(-0.1, 1.1, 101))
    ip = ours.LinearNDInterpolator(p + at, z, rescale=True)
    np.testing.assert_array_equal(ip(x, y).ravel(), ip(np.stack([x.ravel(), y.ravel()], axis=1)))


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_meshes_of_cadt(general: np.ndarray, dtype: type) -> None:
    p = general.astype(dtype)
    mesh, z, q = cadt.Delaunay(p), np.sin(p[:, 0]), np.array([[11.0, 11.0], [12.5, 10.5], [0, 0]])
    tri = ours.Delaunay(mesh, incremental=True)
    assert tri.mesh is mesh and tri.points.dtype == np.float64
    tri.add_points([[0, 0]])
    assert (tri.npoints, mesh.n_points) == (301, 300)
    assert np.array_equal(ours.Voronoi(mesh).vertices, ours.Voronoi(p).vertices)
    kinds = ("LinearND", "NaturalNeighbor", "NearestND", "CloughTocher2D")
    for make in (getattr(ours, kind + "Interpolator") for kind in kinds):
        assert np.array_equal(make(mesh, z)(q), make(p, z)(q), equal_nan=True), make


@pytest.mark.parametrize("rescale", [False, True])
def test_regular_grids(general: np.ndarray, rescale: bool) -> None:
    """Large grids are rasterized: the values are those of the same places one by one."""
    z = np.sin(general[:, 0])
    ip = ours.LinearNDInterpolator(general, z, fill_value=-7, rescale=rescale)
    xs, ys = np.linspace(9.9, 13.1, 130), np.linspace(12.1, 9.9, 110)
    for x, y in (
        np.meshgrid(xs, ys),
        np.meshgrid(xs, ys, indexing="ij"),
        (xs[:, None], ys[None]),
        (xs[None], ys[:, None]),
    ):
        flat = np.stack(np.broadcast_arrays(x, y), axis=-1).reshape(-1, 2)
        expected = ip(flat).reshape(np.broadcast(x, y).shape)
        assert np.allclose(ip(x, y), expected, rtol=0, atol=1e-12)
        assert np.allclose(ip((x, y)), expected, rtol=0, atol=1e-12)
        assert np.allclose(ip(np.stack(np.broadcast_arrays(x, y), axis=-1)), expected, rtol=0, atol=1e-12)
        assert (expected == -7).any() and (expected != -7).any()
        grid = _interpolate.regular_grid((x, y))
        assert grid is not None and ip._raster(*grid) is not None
    uneven = np.meshgrid(xs**2 / 13, ys)
    assert ip._raster(*_interpolate.regular_grid(uneven)) is None
    assert np.allclose(ip(*uneven), ip(np.stack(uneven, axis=-1).reshape(-1, 2)).reshape(110, 130), rtol=0, atol=1e-12)
    square = np.stack(np.meshgrid([0.0, 1, 2], [0.0, 1, 2]), axis=-1).reshape(-1, 2)
    border = ours.LinearNDInterpolator(square, square @ [1.0, 2.0])(
        *np.meshgrid(np.linspace(0, 2, 121), np.linspace(0, 2, 101))
    )
    assert not np.isnan(border).any()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("rescale", [False, True])
@pytest.mark.parametrize("at", [0.0, 1.0, np.inf, np.nan, 5e-324])
def test_grids_without_an_area(rescale: bool, at: float) -> None:
    """All of x or of y at one place, or at none."""
    p = np.random.default_rng(5).uniform(-1, 1, (300, 2))
    along, across = np.linspace(-0.4, 0.4, 5000), np.array([0.0, at])
    for queries in (np.meshgrid(across, along), np.meshgrid(along, across), np.meshgrid(across[::-1], along)):
        assert np.isnan(at) or _interpolate.regular_grid(queries) is not None
        found = ours.griddata(p, p[:, 0], tuple(queries), rescale=rescale)
        expected = scipy.interpolate.griddata(p, p[:, 0], tuple(queries), rescale=rescale)
        assert np.allclose(found, expected, rtol=0, atol=1e-12, equal_nan=True)
    assert np.isnan(ours.griddata(p, p[:, 0], tuple(np.meshgrid([-1.7e308, 1.7e308], along)))).all()


def test_nearest_without_triangles() -> None:
    line = np.stack([np.arange(5.0), np.arange(5.0)], axis=1)
    assert ours.NearestNDInterpolator(line, np.arange(5))([[3.2, 3]]) == [3]


@pytest.mark.parametrize("method", ["linear", "nearest", "cubic", "natural"])
def test_griddata(method: str, general: np.ndarray) -> None:
    z = np.hypot(*general.T)
    x, y = np.mgrid[10:13:20j, 10:12:15j]  # type: ignore[misc]
    out = ours.griddata(general, z, (x, y), method=method, fill_value=-9)
    assert out.shape == (20, 15)
    if method != "natural":
        expected = scipy.interpolate.griddata(general, z, (x, y), method=method, fill_value=-9)
        assert np.allclose(out, expected, rtol=1e-7, atol=1e-7)
    again = ours.griddata(tuple(general.T), z, np.stack([x, y], axis=-1), method=method, fill_value=-9)
    assert np.array_equal(out, again)
    with pytest.raises(ValueError):
        ours.griddata(general, z, (x, y), method="quintic")
    with pytest.raises(ValueError):
        ours.griddata(general, z[:-1], (x, y), method=method)
