# SPDX-License-Identifier: Apache-2.0
"""Transforms and planes of cadt.scipy where triangles are nearly degenerate."""

from __future__ import annotations

import importlib
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("scipy")

import cadt
import cadt.scipy as ours
import scipy.interpolate
import scipy.spatial
from exact import exact

EPS = np.finfo(np.double).eps


def exact_transform(corners: np.ndarray) -> tuple[np.ndarray, float]:
    """The inverse of [a - c, b - c], rounded once, and the reciprocal of its condition number."""
    a, b, c = exact(corners)
    (ux, uy), (vx, vy) = (a[0] - c[0], a[1] - c[1]), (b[0] - c[0], b[1] - c[1])
    determinant = ux * vy - uy * vx
    inverse = [[vy / determinant, -vx / determinant], [-uy / determinant, ux / determinant]]
    norm = max(abs(ux) + abs(uy), abs(vx) + abs(vy))
    of_inverse = max(abs(inverse[0][k]) + abs(inverse[1][k]) for k in range(2))
    return np.array(inverse, dtype=np.float64), float(1 / (norm * of_inverse))


def turned(n: int, angle: float) -> np.ndarray:
    """A lattice whose border is no line any more but for rounding: the hull has flat triangles."""
    square = np.stack(np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)), axis=-1).reshape(-1, 2)
    return square @ [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]


def needles(rng: np.random.Generator) -> np.ndarray:
    """Pairs of points from close to very close."""
    p = rng.random((150, 2))
    return np.concatenate([p, p + np.stack([np.zeros(150), 10.0 ** -rng.integers(9, 16, 150)], axis=1)])


def degenerate() -> np.ndarray:
    folder = Path(importlib.import_module("scipy.spatial.tests").__path__[0])
    with np.load(folder / "data" / "degenerate_pointset.npz") as f:
        return f["c"]


@pytest.mark.parametrize("scale", [1.0, 1e-250, 1e250])
def test_transform_is_exact(scale: float, rng: np.random.Generator) -> None:
    kinds = {"thin": 0, "usual": 0, "thinnest": 1.0}
    for points in (turned(15, 0.3), needles(rng), rng.random((50, 2)) + [500_000, 5_600_000]):
        tri = ours.Delaunay(points * scale)
        for found, corners in zip(tri.transform, tri.points[tri.simplices]):
            inverse, condition = exact_transform(corners)
            if condition < 1000 * EPS:
                kinds["thin"] += 1
                assert np.isnan(found).all()
            else:
                kinds["usual"] += 1
                kinds["thinnest"] = min(kinds["thinnest"], condition)
                assert np.allclose(found[:2], inverse, rtol=4 * EPS, atol=0)
                assert np.array_equal(found[2], corners[2])
    assert kinds["thin"] > 50 and kinds["usual"] > 500 and kinds["thinnest"] < 1e-11, "these sets test nothing"


def exact_equation(corners: np.ndarray, scale: float, shift: float) -> list[Decimal]:
    """Unit normal and offset of the plane of three points on the paraboloid."""
    a, b, c = ([x, y, Fraction(scale) * (x * x + y * y) + Fraction(shift)] for x, y in exact(corners))
    u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
    normal = [u[2] * v[1] - u[1] * v[2], u[0] * v[2] - u[2] * v[0], u[1] * v[0] - u[0] * v[1]]
    plane = [*normal, -sum(n * x for n, x in zip(normal, a))]
    with localcontext() as context:
        context.prec = 40
        decimals = [Decimal(x.numerator) / Decimal(x.denominator) for x in plane]
        length = sum(x * x for x in decimals[:3]).sqrt()
        return [x / length for x in decimals]


@pytest.mark.parametrize("scale", [1.0, 1e-80, 1e-150, 1e-300, 1e150, 1e300])
@pytest.mark.parametrize("options", [None, "Qc"])
def test_equations_are_exact(scale: float, options: str | None, rng: np.random.Generator) -> None:
    tri = ours.Delaunay((rng.random((30, 2)) + [1, -0.5]) * scale, qhull_options=options)
    for found, corners in zip(tri.equations, tri.points[tri.simplices]):
        plane = exact_equation(corners, tri.paraboloid_scale, tri.paraboloid_shift)
        error = [abs(Decimal(float(x)) - y) for x, y in zip(found, plane)]
        assert max(error[:3]) < 1e-14 and error[3] < Decimal(1e-14) * Decimal(scale)


@pytest.mark.parametrize("exponent", [-1000, -500, 500, 900])
def test_powers_of_two_scale_all_results(exponent: int, rng: np.random.Generator) -> None:
    turn = [[0.8, 0.6], [-0.6, 0.8]]
    lattice = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), axis=-1).reshape(-1, 2) @ turn + 5
    for points in (rng.random((40, 2)), lattice):
        hull = points[ours.Delaunay(points).mesh.hull]
        t = rng.random((50, 1, 1))
        border = (hull * (1 - t) + np.roll(hull, 1, axis=0) * t).reshape(-1, 2)
        x = np.concatenate([border, border + rng.normal(size=border.shape) * 0.1])
        values = rng.random(len(points))

        def numbers(e: int) -> list[np.ndarray | list]:
            p, q = np.ldexp(points, e), np.ldexp(x, e)
            tri, diagram = ours.Delaunay(p), ours.Voronoi(p)
            return [
                *(tri.find_simplex(q), tri.simplices, tri.equations[:, :3]),
                *(np.ldexp(a, -e) for a in (tri.equations[:, 3], tri.plane_distance(q), tri.lift_points(q))),
                *(np.ldexp(diagram.vertices, -e), diagram.ridge_points, diagram.ridge_vertices, diagram.regions),
                *(kind(p, values)(q) for kind in (ours.LinearNDInterpolator, ours.NaturalNeighborInterpolator)),
            ]

        for usual, scaled in zip(numbers(0), numbers(exponent)):
            if isinstance(usual, list):
                assert usual == scaled
            else:
                assert np.array_equal(usual, scaled, equal_nan=usual.dtype.kind == "f")


def test_numbers_at_the_ends_of_the_range() -> None:
    square = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])
    assert np.isnan(ours.Delaunay(square * 5e-324).transform).all()  # its inverse overflows
    largest = ours.Delaunay(square * 1.7e308)
    assert np.allclose(largest.transform[0, :2] * 1.7e308, [[-1, -1], [1, 0]])
    assert ours.Delaunay(square, qhull_options="Qc").paraboloid_scale == 1
    assert ours.Delaunay(square * 5e-324).paraboloid_scale == 1  # 1 / 5e-324 overflows
    assert np.isfinite(largest.equations).all() and (largest.find_simplex([[1.7e308, 8e307]]) >= 0).all()


def test_points_of_another_mesh_are_refused() -> None:
    from cadt import _cadt

    mesh = cadt.Delaunay(np.eye(3)[:, :2])._host_mesh
    for numbers in (lambda p: _cadt.transforms(p, mesh), lambda p: _cadt.equations(p, mesh, 1.0, 0.0)):
        with pytest.raises(ValueError, match="points"):
            numbers(np.zeros((2, 2)))


def test_degenerate_set_of_scipy() -> None:
    """SciPy's test_degenerate_barycentric_transforms, and why it cannot pass: see scipy_suite.py."""
    points = degenerate()
    tri = ours.Delaunay(points)
    assert tri.mesh is not None and tri.mesh.verify()
    thin = np.isnan(tri.transform[:, 0, 0])
    assert thin.sum() == 31
    centers = points[tri.simplices].sum(axis=1) / 3
    c = np.einsum("ijk,ik->ij", tri.transform[:, :2], centers - tri.transform[:, 2])
    assert (np.abs(c[~thin] * 3 - 1) < 0.1).all()
    assert (tri.find_simplex(centers[~thin]) >= 0).all()
    # What it asserts of a transform that is not NaN is wrong with the exact one of each of these.
    for t in np.flatnonzero(thin):
        corners = points[tri.simplices[t]]
        assert not (np.abs(exact_transform(corners)[0] @ (centers[t] - corners[2]) * 3 - 1) < 0.1).all()


@pytest.mark.parametrize("name", ["turned", "degenerate"])
def test_interpolators_of_scipy_on_flat_triangles(name: str, rng: np.random.Generator) -> None:
    """As good as on Qhull's triangulation: no more values that are missing, and none that are wrong."""
    points = turned(25, 0.3) if name == "turned" else degenerate()
    hull = points[scipy.spatial.ConvexHull(points).vertices]
    k, t = rng.integers(len(hull), size=2000), rng.random((2000, 1))
    border = hull[k] * (1 - t) + hull[(k + 1) % len(hull)] * t
    inside = points[rng.integers(len(points), size=2000)] * t + points[rng.integers(len(points), size=2000)] * (1 - t)
    tri, theirs = ours.Delaunay(points), scipy.spatial.Delaunay(points)
    plane, wave = (lambda x: x @ [2.0, -1.0]), (lambda x: np.sin(7 * x[:, 0]) + x[:, 1])
    for x in (border, inside, points, points[tri.simplices].mean(axis=1)):
        got, other = (scipy.interpolate.LinearNDInterpolator(d, plane(points))(x) for d in (tri, theirs))
        assert np.isnan(got).sum() <= np.isnan(other).sum()
        assert np.nanmax(np.abs(got - plane(x))) < 1e-14
    got, other = (scipy.interpolate.CloughTocher2DInterpolator(d, wave(points))(inside) for d in (tri, theirs))
    assert not np.isnan(got).any()
    assert np.abs(got - wave(inside)).max() <= 1.1 * np.abs(other - wave(inside)).max()
