# SPDX-License-Identifier: Apache-2.0
"""Arguments that a function does not take end in an error of cadt that says what it expects."""

from __future__ import annotations

from collections.abc import Callable

import cadt
import numpy as np
import pytest
from cadt import InputError, LimitError, OptionError

P = np.random.default_rng(0).random((50, 2))
SQUARE = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])
MESH = cadt.Delaunay(P)
Z = P[:, 0]
REFUSED: list[tuple[type[Exception], Callable[[], object]]] = [
    (InputError, lambda: MESH.find_simplex([[1, 2, 3]])),
    (InputError, lambda: MESH.find_simplex(3)),
    (InputError, lambda: MESH.find_simplex([[0, np.nan]])),
    (TypeError, lambda: MESH.find_simplex(P.astype(complex))),
    (TypeError, lambda: MESH.find_simplex(None)),
    (OptionError, lambda: MESH.nearest_vertex(P, 0)),
    (OptionError, lambda: MESH.nearest_vertex(P, -1)),
    *[(OptionError, lambda k=k: MESH.nearest_vertex(P, k)) for k in (2**31, 10**20, 10**5000, -(10**5000))],
    (TypeError, lambda: MESH.nearest_vertex(P, 1.5)),  # type: ignore[arg-type]
    (InputError, lambda: MESH.interpolate(np.zeros(49), P)),
    (InputError, lambda: MESH.interpolate(3, P)),
    (TypeError, lambda: MESH.interpolate(Z + 1j, P)),
    (TypeError, lambda: MESH.interpolate(["a"] * 50, P)),
    (OptionError, lambda: MESH.interpolate(Z, P, "cubic")),
    (OptionError, lambda: MESH.interpolate(Z, P, outside="zero")),
    (OptionError, lambda: MESH.rasterize(Z)),
    (OptionError, lambda: MESH.rasterize(Z, shape=(2, 2), resolution=1)),
    (OptionError, lambda: MESH.rasterize(Z, shape=(0, 2))),
    (OptionError, lambda: MESH.rasterize(Z, shape=(2.5, 2))),  # type: ignore[arg-type]
    (OptionError, lambda: MESH.rasterize(Z, shape=5)),  # type: ignore[arg-type]
    (LimitError, lambda: MESH.rasterize(Z, shape=(2**20, 2**20))),
    (LimitError, lambda: MESH.rasterize(Z, resolution=1e-300)),
    (OptionError, lambda: MESH.rasterize(Z, resolution=0)),
    (OptionError, lambda: MESH.rasterize(Z, resolution=np.nan)),
    (InputError, lambda: MESH.rasterize(Z, shape=(2, 2), bounds=(0, 0, np.nan, 1))),
    (InputError, lambda: MESH.rasterize(Z, shape=(2, 2), bounds=(1, 1, 0, 0))),
    (InputError, lambda: MESH.rasterize(Z, shape=(2, 2), bounds=(0, 0, 1))),
    (OptionError, lambda: MESH.rasterize(Z, shape=(2, 2), max_edge=-1)),
    (OptionError, lambda: MESH.rasterize(Z, shape=(2, 2), max_edge=np.nan)),
    *[(OptionError, lambda e=e: MESH.rasterize(Z, shape=(2, 2), max_edge=e)) for e in ("a", [1, 2], 1j)],
    *[
        (InputError, lambda b=b: MESH.rasterize(Z, shape=(2, 2), bounds=b))
        for b in ("abcd", 3, (0, 0, 10**400, 1), [[0, 1]] * 4)
    ],
    *[(InputError, lambda b=b: MESH.voronoi_polygons(b)) for b in ("abcd", 3, (0, 0, 10**400, 1))],
    (OptionError, lambda: MESH.rasterize(Z, shape=(2, 2), method="cubic")),
    (OptionError, lambda: MESH.rasterize(Z, shape=(2, 2), origin="left")),
    (InputError, lambda: MESH.voronoi_polygons((0, 0, 0, 0))),
    (InputError, lambda: MESH.voronoi_polygons((0, 0, np.nan, 1))),
    (InputError, lambda: MESH.voronoi_polygons((0, 0, 1))),
    (OptionError, lambda: MESH.largest_empty_circles(-1)),
    (TypeError, lambda: MESH.largest_empty_circles(1.5)),  # type: ignore[arg-type]
    (OptionError, lambda: MESH.alpha_shape(-1)),
    (OptionError, lambda: MESH.alpha_shape(np.nan)),
    *[(OptionError, lambda r=r: MESH.alpha_shape(r)) for r in ("a", P, {}, -(10**400))],
    (OptionError, lambda: MESH.alpha_shape(1, max_edge="a")),  # type: ignore[arg-type]
    (cadt.BackendUnavailable, lambda: cadt.Delaunay(P, backend="opencl", device="no such device")),
    (cadt.BackendUnavailable, lambda: cadt.Delaunay(P, backend="metal")),
    (TypeError, lambda: cadt.Delaunay(P, backend=3)),  # type: ignore[arg-type]
    (OptionError, lambda: cadt.Delaunay(P, device=0)),
    (OptionError, lambda: cadt.Delaunay(P, order="random")),
    (OptionError, lambda: cadt.Delaunay(P, threads=-1)),
    (OptionError, lambda: cadt.Delaunay(P, threads=2**40)),
    (OptionError, lambda: cadt.Delaunay(P, max_memory=-1)),
    *[
        (OptionError, lambda n=n: cadt.Delaunay(P, max_memory=n))
        for n in (1e9, 2**70, 2**63, "2", np.zeros(2), 10**5000)
    ],
    *[(OptionError, lambda n=n: cadt.Delaunay(P, threads=n)) for n in (1.5, "2", 2**31, [2])],
    (OptionError, lambda: cadt.triangulate_batch(P, [0, 50], threads=2.0)),  # type: ignore[arg-type]
    (OptionError, lambda: cadt.ConstrainedDelaunay(P, [[0, 1]], max_memory=1e9)),  # type: ignore[arg-type]
    (OptionError, lambda: cadt.find_crossings(P, [[0, 1]], threads=2.0)),  # type: ignore[arg-type]
    (OptionError, lambda: cadt.find_crossings(P, [[0, 1]], threads=-1)),
    (OptionError, lambda: cadt.Delaunay(P, statistics="all")),
    (TypeError, lambda: cadt.Delaunay(P, progress=3)),  # type: ignore[arg-type]
    (InputError, lambda: cadt.triangulate_batch(P, [0, 60])),
    (InputError, lambda: cadt.triangulate_batch(P, [5, 50])),
    (InputError, lambda: cadt.triangulate_batch(P, [0, 30, 20, 50])),
    (InputError, lambda: cadt.triangulate_batch(P, [-1, 50])),
    (InputError, lambda: cadt.triangulate_batch(P, [])),
    (InputError, lambda: cadt.triangulate_batch(P, [0.0, 50.0])),
    (InputError, lambda: cadt.triangulate_batch(P, [[0], [1, 50]])),
    (InputError, lambda: cadt.triangulate_batch(P, np.array([0, 2**63], dtype=np.uint64))),
    (ValueError, lambda: cadt.Delaunay.from_simplices(P, [[0, 1, 99]])),
    (ValueError, lambda: cadt.Delaunay.from_simplices(P, [[0, 1, -1]])),
    (ValueError, lambda: cadt.Delaunay.from_simplices(P, [[0, 1]])),
    (ValueError, lambda: cadt.Delaunay.from_simplices(P, [[0, 1, 2**40]])),
    (ValueError, lambda: cadt.Delaunay.from_simplices(SQUARE, [[0, 1, 2], [0, 1, 2]], verify=False)),
    (
        ValueError,
        lambda: cadt.Delaunay.from_simplices(SQUARE, MESH.simplices[:2], [[7, 7, 7], [9, 9, 9]], verify=False),
    ),
    (ImportError, lambda: cadt.Delaunay(P).save("mesh.no_such_format")),
    (AttributeError, lambda: cadt.no_such_name),
]


@pytest.mark.parametrize("k", range(len(REFUSED)))
def test_arguments_that_are_refused(k: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "meshio", None)
    error, call = REFUSED[k]
    with pytest.raises(error) as caught:
        call()
    assert str(caught.value) and "incompatible function arguments" not in str(caught.value)
    if error in (InputError, OptionError):
        assert "could not convert" not in str(caught.value)


def test_numbers_of_options() -> None:
    for name in ("threads", "max_memory"):
        with pytest.raises(OptionError, match=f"{name} must be a whole number, not 1.5") as caught:
            cadt.Delaunay(P, **{name: 1.5})
        assert caught.value.option == name
    same = cadt.Delaunay(P, threads=np.int64(2), max_memory=np.uint64(2**62)).hash  # type: ignore[arg-type]
    assert same == cadt.Delaunay(P).hash


def test_the_way_out_of_a_mask_and_of_three_columns() -> None:
    a = np.ma.array(P, mask=P > 0.9)
    with pytest.raises(InputError, match=r"pass np.ma.compress_rows\(points\), which are the rows without"):
        cadt.Delaunay(a)
    assert cadt.Delaunay(np.ma.compress_rows(a)).n_points == (P <= 0.9).all(axis=1).sum()
    with pytest.raises(InputError, match="queries are masked: pass queries without a mask"):
        cadt.Delaunay(P).find_simplex(np.ma.array([0.5, 0.5], mask=[False, True]))
    for call in (cadt.Delaunay, lambda xyz: cadt.find_crossings(xyz, [[0, 1]])):
        with pytest.raises(InputError, match=r"not \(50, 3\); pass points\[:, :2\], and heights as values"):
            call(np.zeros((50, 3)))
        with pytest.raises(InputError, match=r"not \(2, 50\); pass points.T"):
            call(P[:50].T)
        with pytest.raises(InputError, match=r"not \(50, 4\); cadt.scipy.Delaunay takes more dimensions"):
            call(np.zeros((50, 4)))
        with pytest.raises(InputError, match=r"not \(50,\); np.reshape\(..., \(-1, 2\)\) makes rows of x and y in turn"):
            call(np.zeros(50))
        with pytest.raises(InputError, match=r"not \(51,\)$"):
            call(np.zeros(51))
    with pytest.raises(InputError, match=r"ring points must have shape \(n, 2\), not \(50, 3\); pass the first two columns"):
        cadt.polygons(np.zeros((50, 3)), [0, 50])
    with pytest.raises(InputError, match=r"; of colours make numbers: labels\[..., :3\] @ \[65536, 256, 1\]"):
        cadt.label_segments(np.zeros((4, 5, 3), np.uint8))
    colours = np.zeros((4, 5, 4), np.uint8)
    colours[1:, :2] = [1, 2, 3, 255]
    assert set(cadt.label_segments(colours[..., :3] @ [65536, 256, 1]).sides.flat) == {0, 0x010203, -(2**31)}
    with pytest.raises(InputError, match=r"the label 4294967296 of pixel \(1, 2\) does not fit"):
        cadt.label_segments([[0, 0, 0], [0, 0, 2**32]])
