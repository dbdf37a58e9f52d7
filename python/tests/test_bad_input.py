# SPDX-License-Identifier: Apache-2.0
"""What cannot be triangulated or asked ends in an exception of Python, and what is merely unusual works."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cadt
import numpy as np
import pytest
from cadt import InputError, LimitError
from cadt._points import as_points, as_values, contiguous
from cadt._queries import cells_along

P = np.random.default_rng(0).random((50, 2))
SQUARE = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])
MESH = cadt.Delaunay(P)
Z = P[:, 0]


def unaligned(dtype: str) -> np.ndarray:
    memory = np.zeros(1 + 100 * np.dtype(dtype).itemsize, dtype=np.uint8)
    a = memory[1:].view(dtype).reshape(50, 2)
    a[:] = P
    return a


def packed_fields() -> np.ndarray:
    record = np.zeros(50, dtype=[("flag", "i1"), ("x", "f8"), ("y", "f8")])
    record["x"], record["y"] = P.T
    return np.lib.stride_tricks.as_strided(record["x"], shape=(50, 2), strides=(17, 8))


def read_only() -> np.ndarray:
    a = P.copy()
    a.flags.writeable = False
    return a


class WithArray:
    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return P


SAME: dict[str, Any] = {
    "read-only": read_only(),
    "rows backwards": P[::-1][::-1],
    "negative row stride": np.ascontiguousarray(P[::-1])[::-1],
    "negative column stride": np.ascontiguousarray(P[:, ::-1])[:, ::-1],
    "every second row": np.repeat(P, 2, axis=0)[::2],
    "columns of a wider array": np.insert(P, [1, 2], 0, axis=1)[:, ::2],
    "Fortran's order": np.asfortranarray(P),
    "byte-swapped": P.astype(">f8"),
    "not aligned": unaligned("f8"),
    "packed fields": packed_fields(),
    "memoryview": memoryview(P),
    "list": P.tolist(),
    "tuples": tuple(map(tuple, P)),
    "masked, but nothing is": np.ma.array(P),
    "__array__": WithArray(),
}


def test_one_row_of_any_strides() -> None:
    """NumPy takes an array of one row for contiguous, whatever its strides are."""
    for row in (P[:1][::-1], packed_fields()[:1], P[:10:2][:1]):
        assert cadt.Delaunay(row).hash == cadt.Delaunay(row.tolist()).hash
        assert MESH.find_simplex(row).tolist() == MESH.find_simplex(row.tolist()).tolist()


@pytest.mark.parametrize("name", SAME)
def test_any_memory(name: str) -> None:
    assert cadt.Delaunay(SAME[name]).hash == cadt.Delaunay(P).hash
    mesh = cadt.Delaunay(P)
    assert (mesh.find_simplex(SAME[name]) == mesh.find_simplex(P)).all()


def test_memory_that_is_not_aligned_is_copied() -> None:
    """A processor may refuse to read it, or the compiler assume that it is not there."""
    points = unaligned("f8")
    assert points.flags.c_contiguous and not points.flags.aligned
    offsets = np.zeros(25, dtype=np.uint8)[1:].view(np.int64)
    offsets[:] = (0, 20, 50)
    assert not offsets.flags.aligned
    assert as_points(points).flags.aligned and as_points(unaligned("f4")).flags.aligned
    assert as_values(points[:, 0], 50)[0].flags.aligned and as_values(points, 50)[0].flags.aligned
    assert contiguous(offsets, np.int64).flags.aligned
    assert cadt.triangulate_batch(points, offsets)[1].n_points == 30
    assert np.allclose(cadt.Delaunay(P).interpolate(points, P), P)


@pytest.mark.parametrize("dtype", ["f4", ">f4", "f2", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4"])
def test_dtypes(dtype: str) -> None:
    p = (100 * P).astype(dtype)
    assert cadt.Delaunay(p).hash == cadt.Delaunay(p.astype(np.float64)).hash


@pytest.mark.parametrize(
    "points",
    [
        P.astype(complex),
        P.astype(np.longdouble),
        P > 0.5,
        P.astype(object),
        P.astype(str),
        P.astype("S8"),
        {},
        {1, 2},
        None,
    ]
    + [
        np.ones((3, 2), "m8[s]"),
        np.ones((3, 2), "M8[s]"),
        np.zeros((3, 2), [("x", "f8")]),
        (p for p in P),
        [[10**400, 0]],
    ],
    ids=lambda p: getattr(getattr(p, "dtype", None), "name", type(p).__name__),
)
def test_types_that_are_refused(points: Any) -> None:
    if np.longdouble == np.float64 and getattr(points, "dtype", None) == np.longdouble:
        pytest.skip("long doubles are doubles here")
    with pytest.raises(TypeError):
        cadt.Delaunay(points)


@pytest.mark.parametrize("shape", [(6,), (5, 3), (5, 0), (5, 1), (2, 3, 2), (0, 3), ()])
def test_shapes_that_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="shape"):
        cadt.Delaunay(np.zeros(shape))
    with pytest.raises(ValueError):
        cadt.Delaunay([[1, 2], [3]])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_coordinates_that_are_not_finite(bad: float, dtype: type) -> None:
    p = P.astype(dtype)
    p[17, 1] = bad
    with pytest.raises(InputError) as caught:
        cadt.Delaunay(p)
    assert caught.value.index == 17
    with pytest.raises(InputError):
        cadt.triangulate_batch(p, [0, 20, 50])


@pytest.mark.parametrize("huge", [2**53 + 1, -(2**53) - 1, 2**60 + 1, 2**63 - 1, 2**63 - 512, -(2**63) + 1])
def test_integers_without_a_double(huge: int) -> None:
    with pytest.raises(InputError, match="2\\*\\*53") as caught:
        cadt.Delaunay(np.array([[0, 0], [1, 0], [0, huge]]))
    assert caught.value.index == 2
    for unsigned in (2**64 - 1, 2**64 - 1024, 2**63 + 1):
        with pytest.raises(InputError):
            cadt.Delaunay(np.array([[0, unsigned]], dtype=np.uint64))


@pytest.mark.parametrize("huge", [2**53, -(2**53), 2**53 + 2, 2**54, 2**62, 2**63 - 1024, -(2**63)])
@pytest.mark.parametrize("dtype", ["i8", ">i8"])
def test_large_integers_with_a_double(huge: int, dtype: str) -> None:
    p = np.array([[0, 0], [1, 0], [0, huge]], dtype=dtype)
    assert as_points(p).tolist() == p.tolist()
    assert cadt.Delaunay(p).n_triangles == 1
    unsigned = np.array([[2**63, 2**64 - 2048]], dtype=np.uint64)
    assert [list(map(int, row)) for row in as_points(unsigned)] == unsigned.tolist()


@pytest.mark.parametrize("kind", ["Float64", "Float32", "Int64", "UInt8", "float64[pyarrow]", "int64[pyarrow]"])
def test_columns_that_can_have_gaps(kind: str) -> None:
    pandas = pytest.importorskip("pandas")
    if "pyarrow" in kind:
        pytest.importorskip("pyarrow")
    plain = pandas.DataFrame(np.round(P * 200), columns=["x", "y"])
    table = plain.astype(kind)
    mesh = cadt.Delaunay(table)
    assert mesh.hash == cadt.Delaunay(plain).hash and (mesh.find_simplex(table) == mesh.find_simplex(plain)).all()
    for values, same in ((table, plain), (table["x"], plain["x"])):
        assert np.array_equal(mesh.interpolate(values, plain), same.to_numpy())
    if "nt64" in kind:
        table.iloc[7, 1] = 2**53 + 1
        with pytest.raises(InputError, match="row 7 exceed") as caught:
            cadt.Delaunay(table)
        assert caught.value.index == 7
    table.iloc[5, 0] = pandas.NA
    for call in (cadt.Delaunay, MESH.find_simplex):
        with pytest.raises(InputError, match=r"row 5 has a missing value \(NA\)") as caught:
            call(table)
        assert caught.value.index == 5
    with pytest.raises(TypeError):
        cadt.Delaunay(plain.astype(object))
    with pytest.raises(TypeError):
        cadt.Delaunay(plain.astype("string"))


def test_no_simplices() -> None:
    for points in ([], P[:1], P[:2], [[0, 0], [1, 1], [2, 2]]):
        for none in ([], (), np.empty((0, 3)), np.empty((0, 3), np.int64)):
            mesh = cadt.Delaunay.from_simplices(points, none)
            assert mesh.n_triangles == 0 and mesh.hash == cadt.Delaunay(points).hash
            assert cadt.verify(points, none) and cadt.verify(points, none, none)
    with pytest.raises(cadt.InvalidMesh):
        cadt.Delaunay.from_simplices(SQUARE, [])
    for wrong in ([[]], np.empty((0, 2))):
        with pytest.raises(InputError, match="shape"):
            cadt.Delaunay.from_simplices(P[:2], wrong)


def test_extreme_doubles() -> None:
    for scale in (5e-324, 1e-308, 1e154, 1.7e308):
        mesh = cadt.Delaunay(SQUARE * scale)
        assert mesh.n_triangles == 2 and mesh.verify()
        assert mesh.find_simplex([[0, 0], [scale, scale], [-scale, 0]]).tolist() == [0, 1, -1]


@pytest.mark.parametrize("masked", [np.ma.array(P, mask=P > 0.9), np.ma.masked_all((4, 2)), np.ma.masked_all(1)])
def test_masked(masked: Any) -> None:
    with pytest.raises(InputError, match="masked"):
        cadt.Delaunay(masked)
    with pytest.raises(InputError, match="masked"):
        cadt.Delaunay(P).find_simplex(masked)
    with pytest.raises(InputError, match="masked"):
        cadt.Delaunay(P).interpolate(np.ma.array(P[:, 0], mask=P[:, 0] > 0.5), P)


def test_masked_indices() -> None:
    two = [[0, 1, 2], [1, 3, 2]]
    masked = np.ma.array(two, mask=[[False] * 3, [True] * 3])
    for call in (cadt.Delaunay.from_simplices, cadt.verify):
        with pytest.raises(InputError, match="simplices are masked"):
            call(SQUARE, masked)
        with pytest.raises(InputError, match="neighbors are masked"):
            call(SQUARE, two, np.ma.array([[1, -1, -1], [-1, 0, -1]], mask=True))
        assert call(SQUARE, np.ma.array(two))
    with pytest.raises(InputError, match="labels are masked"):
        cadt.label_segments(np.ma.array([[1, 2]], mask=[[False, True]]))
    assert len(cadt.label_segments(np.ma.array([[1, 2]])).segments) == 7
    with pytest.raises(InputError, match="offsets are masked"):
        cadt.triangulate_batch(P, np.ma.array([0, 20, 50], mask=[False, True, False]))


def test_queries_as_x_and_y() -> None:
    x, y = P[:2].T
    for xi in ((x, y), (x, y.tolist()), (x.tolist(), y)):
        assert (MESH.find_simplex(xi) == MESH.find_simplex(P[:2])).all()
    assert MESH.find_simplex(tuple(map(tuple, P[:3].T))).shape == (3,) and MESH.find_simplex((0.5, 0.5)).shape == ()
    assert MESH.find_simplex((x[:, None], y)).shape == (2, 2)
    for number in (0.5, 1, np.float32(0.5), np.array(0.5)):  # all of x, or of y, at one place
        for xi, rows in (((number, y), [(number, v) for v in y]), ((x, number), [(v, number) for v in x])):
            assert (MESH.nearest_vertex(xi) == MESH.nearest_vertex(np.array(rows, float))).all()
    for xi in (((0.1, 0.2), (5, 5)), ([0.1, 0.2], [5, 5]), ((0.1, 0.2), [5, 5]), ([x, x], [y, y])):
        for ask in (MESH.find_simplex, MESH.within_hull, MESH.nearest_vertex, lambda xi: MESH.interpolate(Z, xi)):
            with pytest.raises(InputError, match=r"pass an array of shape \(n, 2\), or two arrays x and y"):
                ask(xi)
    with pytest.raises(InputError, match="do not fit together"):
        MESH.find_simplex((P[:3, 0], y))
    with pytest.raises(InputError, match="masked"):
        MESH.find_simplex((np.ma.array(x, mask=[True, False]), y))


def test_more_than_a_call_takes() -> None:
    """Refused before there is a copy: the arrays have the memory of one number."""
    points = np.broadcast_to(np.int64(0), (2**34, 2))
    column = points[:, 0]
    calls: list[Callable[[], object]] = [
        lambda: cadt.Delaunay(points),
        lambda: cadt.ConstrainedDelaunay(points),
        lambda: MESH.find_simplex(points),
        lambda: MESH.find_simplex((column, column)),
        lambda: MESH.find_simplex((column, 0.5)),
        lambda: MESH.nearest_vertex(np.zeros((2, 2)), 2**30),
    ]
    for call in calls:
        with pytest.raises(LimitError):
            call()


def test_sizes_of_cells() -> None:
    mesh = cadt.Delaunay([[0, 0], [100000.000045, 0], [0, 1]])  # 100,000 cells and what is left by rounding
    assert mesh.rasterize(np.zeros(3), resolution=1).shape == (1, 100_000)
    mesh = cadt.Delaunay([[0, 0], [1.00000001, 0], [0, 1]])
    assert mesh.rasterize(np.zeros(3), resolution=1).shape == (1, 2)
    for size in (1e-320, 1e-300, (1e-320, 1)):
        with pytest.raises(LimitError) as caught:
            MESH.rasterize(Z, resolution=size)  # type: ignore[arg-type]
        assert len(str(caught.value)) < 150
    with pytest.raises(LimitError) as caught:
        MESH.rasterize(Z, shape=(10**5000, 1))
    assert len(str(caught.value)) < 150
    half = MESH.rasterize(Z, resolution=(0.5, 0.25))
    for same in (np.array([0.5, 0.25]), [0.5, 0.25], np.array([0.5, 0.25], np.float32)):
        assert np.array_equal(MESH.rasterize(Z, resolution=same), half, equal_nan=True)  # type: ignore[arg-type]
    assert MESH.rasterize(Z, resolution=np.float32(0.5)).shape == (2, 2)
    for length, cell, cells in ((2.1, 0.3, 7), (1e9 + 0.4, 1, 1e9 + 1), (1e8 + 0.09, 1, 1e8 + 1), (2**31 * 0.1, 0.1, 2**31), (0, 1, 0)):
        assert cells_along(length, cell) == cells, length
    for wrong in ((1, 2, 3), [1], np.ones((2, 2)), "a", 1j):
        with pytest.raises(InputError, match="one number or two"):
            MESH.rasterize(Z, resolution=wrong)  # type: ignore[arg-type]
    for points in (P[:1], [[0, 0], [0, 1], [0, 2]]):
        with pytest.raises(InputError, match="pass bounds="):
            cadt.Delaunay(points).rasterize(np.zeros(len(points)), shape=(2, 2))


def test_lengths_beyond_all_doubles() -> None:
    assert all(map(np.array_equal, MESH.alpha_shape(10**400), MESH.alpha_shape(np.inf)))


def test_more_circles_than_there_are() -> None:
    assert all(map(np.array_equal, MESH.largest_empty_circles(2**70), MESH.largest_empty_circles(MESH.n_triangles)))
    assert 0 < len(MESH.largest_empty_circles(2**70)[1]) <= MESH.n_triangles


def test_suffixes_without_meshio(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "meshio", None)
    for name in ("mesh.ply", "mesh.foo"):
        with pytest.raises(ImportError, match=rf"{name}: .*\.ply \.vtk .* \.npz alone: pip install meshio"):
            MESH.save(name)


def test_matplotlib_without_triangles() -> None:
    pytest.importorskip("matplotlib").use("agg")
    for points in ([], P[:2], P[:3]):
        for made in (cadt.Delaunay(points), cadt.ConstrainedDelaunay(points)):
            axes = __import__("matplotlib.figure").figure.Figure().add_subplot()
            assert made.plot(axes) is axes and len(axes.lines) == (2 if len(points) == 3 else 0)
    with pytest.raises(InputError, match="no triangles"):
        cadt.Delaunay(P[:2]).to_matplotlib()


FLAT = {
    "none": np.empty((0, 2)),
    "one": P[:1],
    "two": P[:2],
    "equal": np.ones((4, 2)),
    "line": np.arange(10.0).reshape(5, 2),
}
MEMBERS = "simplices neighbors hull convex_hull edges vertex_neighbors incident_triangles half_edges vertex_to_simplex"


@pytest.mark.parametrize("name", FLAT)
def test_without_triangles(name: str) -> None:
    mesh = cadt.Delaunay(FLAT[name])
    assert mesh.n_triangles == 0 and mesh.n_points == len(FLAT[name]) and mesh.dimension < 2
    for member in (*MEMBERS.split(), "duplicate_of", "hash", "statistics", "device"):
        getattr(mesh, member)
    assert mesh.simplices.shape == (0, 3) and mesh.convex_hull.shape == (0, 2) and "0 triangles" in repr(mesh)
    q, z = [[0.5, 0.5], [9, 9]], np.zeros(mesh.n_points)
    assert mesh.find_simplex(q).tolist() == [-1, -1] and not mesh.within_hull(q).any()
    assert np.isnan(mesh.barycentric(q)[1]).all() and np.isnan(mesh.interpolate(z, q)).all()
    assert mesh.nearest_vertex(q, 3).tolist() == [[-1] * 3] * 2
    assert np.isnan(mesh.rasterize(z, bounds=(0, 0, 1, 1), shape=(2, 3))).all()
    assert mesh.circumcenters().shape == (0, 2) and len(mesh.largest_empty_circles(2)[1]) == 0
    assert len(mesh.voronoi().vertices) == 0 and len(mesh.voronoi_polygons((0, 0, 1, 1))[1]) == 0
    assert len(mesh.alpha_shape(1)[0]) == 0 and mesh.verify()
    for f in (mesh.find_simplex, mesh.barycentric, mesh.within_hull, mesh.nearest_vertex):
        with pytest.raises(InputError, match="finite"):
            f([[0, 0], [np.nan, 0]])
    for values in (z, np.zeros((mesh.n_points, 3))):
        found = mesh.interpolate(values, [[0, 0], [1, 1], [2, 2]])
        assert found.shape == (3, *values.shape[1:]) and np.isnan(found).all()
        with pytest.raises(InputError, match="finite"):
            mesh.interpolate(values, [[np.inf, 0]])


def test_no_queries_and_no_values() -> None:
    none = np.empty((0, 2))
    assert MESH.find_simplex(none).shape == MESH.nearest_vertex(none).shape == MESH.interpolate(Z, none).shape == (0,)
    assert MESH.nearest_vertex(none, 4).shape == (0, 4) and MESH.barycentric(none)[1].shape == (0, 3)
    assert MESH.interpolate(np.empty((50, 0)), P).shape == (50, 0)
    assert MESH.rasterize(np.empty((50, 0)), shape=(2, 3)).shape == (2, 3, 0)
    assert len(cadt.triangulate_batch(none, [0])) == 0


def test_arrays_of_a_mesh_outlive_it() -> None:
    mesh = cadt.Delaunay(P)
    copies = mesh.simplices.copy(), mesh.edges.copy()
    kept, ask = (mesh.simplices, mesh.edges), mesh.find_simplex
    expected = ask(P)
    del mesh
    _ = [cadt.Delaunay(P + k).simplices for k in range(50)]  # memory is used again
    assert all(np.array_equal(a, b) for a, b in zip(kept, copies)) and np.array_equal(ask(P), expected)
    with pytest.raises(ValueError):
        kept[0][0, 0] = 99  # it is the mesh's
