# SPDX-License-Identifier: Apache-2.0
"""cadt.polygons from arrays, WKB and GeoSeries; cadt.label_segments."""

from __future__ import annotations

import struct
import textwrap
from pathlib import Path
from typing import Any

import cadt
import numpy as np
import pytest

SQUARE, HOLE = [[0, 0], [3, 0], [3, 3], [0, 3], [0, 0]], [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]
BOW_TIE = [[0, 0], [1, 1], [1, 0], [0, 1]]


def areas(result: cadt.Polygons) -> np.ndarray:
    a, b, c = result.points[result.triangles].transpose(1, 2, 0)
    doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    assert (doubled > 0).all()
    return np.bincount(result.polygon_of, doubled / 2, len(result))


def test_arrays() -> None:
    xy = np.array([*SQUARE, *HOLE, *BOW_TIE, *(np.array(SQUARE) + 10)], dtype=float)
    result = cadt.polygons(xy, [0, 5, 10, 14, 19], [0, 2, 3, 3, 4], backend="host")
    assert len(result) == 4 and areas(result).tolist() == [8, 0, 0, 9]
    assert [(p.polygon, p.reason) for p in result.problems] == [(1, "self-crossing"), (2, "too few points")]
    assert len(result[0]) == 8 and len(result[-1]) == 2 and result[3].min() >= 14
    assert cadt.polygons(xy[:5], [0, 5]).triangles.tolist() == [[0, 1, 2], [0, 2, 3]] or len(result[3]) == 2
    with pytest.raises(IndexError):
        result[4]
    with pytest.raises(cadt.InputError) as caught:
        cadt.polygons(xy, [0, 5, 20], [0, 2])
    assert caught.value.index == 2
    with pytest.raises(cadt.InputError):
        cadt.polygons(xy, None, [0, 1])
    with pytest.raises(cadt.InputError):
        cadt.polygons(xy, [0.5, 5])
    with pytest.raises(cadt.InputError, match=f"number 1 of ring_offsets is {2**63 + 5}, more than") as caught:
        cadt.polygons(xy, np.array([0, 2**63 + 5], dtype=np.uint64))
    assert caught.value.index == 1
    with pytest.raises(cadt.InputError, match=r"ring points must have shape \(n, 2\), not \(19, 3\); pass"):
        cadt.polygons(np.c_[xy, xy[:, 0]], [0, 5])


def test_rings_without_points() -> None:
    result = cadt.polygons(SQUARE, [0, 5, 5, 5], [0, 2, 2, 3], backend="host")
    assert [tuple(p) for p in result.problems] == [(p, "too few points", -1, -1) for p in (1, 2)]
    assert areas(result).tolist() == [9, 0, 0]
    assert cadt.polygons(SQUARE[:2], [0, 2]).problems[0][2:] == (0, 0)


def test_holes_of_one_and_two_points() -> None:
    result = cadt.polygons([*SQUARE, [1, 1], [2, 1], [2, 2]], [0, 5, 6, 8], [0, 3], backend="host")
    assert areas(result).tolist() == [9] and sorted(set(result.triangles.ravel())) == [0, 1, 2, 3, 5, 6, 7]


@pytest.mark.parametrize("backend", sorted({d.backend for d in cadt.devices() if d.usable}))
def test_memory_and_statistics_of_large_polygons(backend: str) -> None:
    """Rounds of small polygons, and large ones beside them: the limit is for all, and its message says what suffices."""
    angle = np.linspace(0, 2 * np.pi, 20000, endpoint=False)
    circle = np.c_[np.cos(angle), np.sin(angle)]
    xy = np.concatenate([*[[[i, 0], [i + 1, 0], [i, 1]] for i in range(2000)], circle, circle])
    rings = [*range(0, 6001, 3), 26000, 46000]
    expected = cadt.polygons(xy, rings, backend=backend)
    assert expected.statistics["certified_edges"] > 0 and expected.statistics["flips"] + expected.statistics["proven_stars"]
    limit, tries = 1000, 0
    while True:
        try:
            result = cadt.polygons(xy, rings, backend=backend, max_memory=limit)
            break
        except cadt.OutOfMemory as error:
            assert error.available == limit < error.needed
            assert f"this needs {error.needed} bytes on the device and the limit is {limit}" in str(error)
            limit, tries = error.needed, tries + 1
    assert tries <= 3
    assert limit * 0.3 < result.statistics["bytes_device_peak"] <= limit
    np.testing.assert_array_equal(result.triangles, expected.triangles)


def wkb(rings: list, order: str = "<", kind: int = 3, extra: int = 0) -> bytes:
    data = struct.pack(order + "BII", order == "<", kind, len(rings))
    for ring in rings:
        data += struct.pack(order + "I", len(ring))
        data += b"".join(struct.pack(f"{order}{2 + extra}d", *p, *[7] * extra) for p in ring)
    return data


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind,extra", [(3, 0), (1003, 1), (2003, 1), (3003, 2), (3 | 1 << 31, 1), (3 | 3 << 30, 2)])
def test_wkb(order: str, kind: int, extra: int) -> None:
    polygon = wkb([SQUARE, HOLE], order, kind, extra)
    both = struct.pack(order + "BII", order == "<", kind - 3 + 6, 2) + polygon + wkb([np.add(SQUARE, 9)], order, 3)
    result = cadt.polygons([polygon, bytearray(both), wkb([], order)])
    assert areas(result).tolist() == [8, 17, 0]
    for length in range(len(both)):
        with pytest.raises(cadt.InputError):
            cadt.polygons([both[:length]])


def test_wkb_in_arrays_and_series() -> None:
    rows = [wkb([SQUARE]), wkb([np.add(SQUARE, 9)])]
    expected = cadt.polygons(rows).triangles
    np.testing.assert_array_equal(cadt.polygons(np.array(rows, dtype=object)).triangles, expected)
    pandas = pytest.importorskip("pandas")
    series = pandas.Series(rows, index=["a", "b"])
    np.testing.assert_array_equal(cadt.polygons(series).triangles, expected)
    with pytest.raises(IndexError, match="no polygon 2"):
        cadt.polygons(rows)[2]
    pytest.importorskip("geopandas")
    assert list(cadt.polygons(series).to_geoseries().index) == ["a"] * 2 + ["b"] * 2


class Rows:
    """A Series of another library, with a dtype of its own."""

    dtype = "binary[pyarrow]"

    def __init__(self, rows: list) -> None:
        self.rows = rows

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        assert dtype == object, "numpy would drop zeros at the ends of bytes"
        return np.array(self.rows, dtype=dtype)


def test_wkb_in_arrays_of_any_dtype() -> None:
    """The last coordinate of each polygon ends with zeros, which numpy drops from S; one polygon is shorter."""
    pytest.importorskip("shapely")
    rows = [wkb([SQUARE]), wkb([np.add(SQUARE, [9, -3])[:4]])]
    assert all(row.endswith(b"\0") for row in rows) and len(rows[1]) < len(rows[0])
    expected = cadt.polygons(rows)
    assert areas(expected).tolist() == [9, 9]
    joined = np.array(rows)
    assert joined.dtype.kind == "S" and len(joined[0]) < len(rows[0])
    for given in (Rows(rows), joined, joined[::-1][::-1], np.ma.array(joined), joined.astype(f"V{joined.itemsize}")):
        result = cadt.polygons(given)
        np.testing.assert_array_equal(result.points, expected.points)
        np.testing.assert_array_equal(result.triangles, expected.triangles)
    assert areas(cadt.polygons(joined[1:])).tolist() == [9]
    with pytest.raises(cadt.InputError, match="polygons are masked"):
        cadt.polygons(np.ma.array(joined, mask=[False, True]))
    for wrong in (joined[:, None], np.zeros(3), np.array(["POLYGON EMPTY"]), Rows([rows[0], 3])):
        with pytest.raises(cadt.InputError, match="WKB bytes of all polygons in a list, an array or a Series"):
            cadt.polygons(wrong)


@pytest.mark.parametrize("kind", ["binary", "large_binary"])
def test_wkb_of_arrow(kind: str) -> None:
    pyarrow, pandas = pytest.importorskip("pyarrow"), pytest.importorskip("pandas")
    pytest.importorskip("shapely")
    rows, of = [wkb([SQUARE]), wkb([np.add(SQUARE, 9)])], getattr(pyarrow, kind)()
    expected = cadt.polygons(rows).triangles
    series = pandas.Series(rows, index=["a", "b"], dtype=pandas.ArrowDtype(of))
    array = pyarrow.array(rows, of)
    for given in (series, array, pyarrow.chunked_array([array[:1], array[1:]])):
        np.testing.assert_array_equal(cadt.polygons(given).triangles, expected)
    missing = cadt.polygons(pandas.Series([rows[0], None, rows[1]], dtype=series.dtype))
    assert areas(missing).tolist() == [9, 0, 9]
    assert missing.problems == ((1, "too few points", -1, -1),)
    pytest.importorskip("geopandas")
    assert list(cadt.polygons(series).to_geoseries().index) == ["a"] * 2 + ["b"] * 2
    assert list(cadt.polygons(array).to_geoseries().index) == [0] * 2 + [1] * 2


def test_wkb_of_others_is_refused() -> None:
    with_srid = struct.pack("<BIII", 1, 3 | 1 << 29, 4326, 1) + wkb([SQUARE])[9:]
    assert areas(cadt.polygons([with_srid])).tolist() == [9]
    for wrong in (struct.pack("<BIdd", 1, 1, 0, 0), b"\x02" + wkb([SQUARE])[1:], b""):
        with pytest.raises(cadt.InputError) as caught:
            cadt.polygons([wkb([SQUARE]), wrong])
        assert caught.value.index == 1
    for kind in (4003, 9003, 3 | 1 << 20):
        with pytest.raises(cadt.InputError, match=f"geometry 0 cannot be read as WKB: a geometry of type {kind}"):
            cadt.polygons([wkb([SQUARE], kind=kind)])
    with pytest.raises(cadt.InputError, match="geometry 1 cannot be read as WKB: there is more at byte 93"):
        cadt.polygons([wkb([SQUARE]) + b"\0\0", wkb([SQUARE]) + b"\0\1"])
    for given in ([wkb([SQUARE]), 3], (None, wkb([SQUARE]), 3.5)):
        with pytest.raises(cadt.InputError, match=f"geometry {len(given) - 1} is a .*: pass WKB bytes of all") as caught:
            cadt.polygons(given)
        assert caught.value.index == len(given) - 1
    for missing in (None, float("nan")):
        result = cadt.polygons([missing, wkb([SQUARE])])
        assert areas(result).tolist() == [0, 9] and result.problems == ((0, "too few points", -1, -1),)
    huge = struct.pack("<BIII", 1, 3, 1, 2**32 - 1)
    with pytest.raises(cadt.InputError):
        cadt.polygons([huge])


def geometries() -> Any:
    shapely = pytest.importorskip("shapely")
    square = shapely.Polygon(SQUARE, [HOLE])
    return [square, shapely.MultiPolygon([square, shapely.box(9, 9, 10, 10)]), None, shapely.Polygon(BOW_TIE)]


def test_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    rows = geometries()
    for given in (rows, np.array(rows, dtype=object), tuple(rows), [*rows[:2], float("nan"), rows[3]]):
        result = cadt.polygons(given)
        assert areas(result).tolist() == [8, 9, 0, 0]
        assert [p.reason for p in result.problems] == ["too few points", "self-crossing"]
    assert areas(cadt.polygons(shapely.box(0, 0, 1, 2))).tolist() == [2]
    assert len(cadt.polygons([shapely.Polygon()])) == 1
    with pytest.raises(cadt.InputError) as caught:
        cadt.polygons([rows[0], shapely.Point(0, 0)])
    assert caught.value.index == 1
    for wrong in ("a square", [[0, 0], [1, 1]], 3):
        with pytest.raises(cadt.InputError):
            cadt.polygons(wrong)


def test_polygons_of_collections() -> None:
    """As shapely.make_valid returns them; what is no polygon is left out."""
    shapely = pytest.importorskip("shapely")
    line, box = shapely.LineString([[0, 0], [9, 9]]), shapely.box(20, 20, 22, 22)
    nested = shapely.GeometryCollection([line, shapely.GeometryCollection([box, shapely.Point(1, 1)]), *geometries()[:2]])
    rows = [shapely.GeometryCollection([box, line]), shapely.Polygon(SQUARE), shapely.GeometryCollection(), nested]
    result = cadt.polygons(rows)
    assert areas(result).tolist() == [4, 9, 0, 4 + 1]  # an even number of rings is around the square that is there twice
    assert [p.reason for p in result.problems] == ["too few points"]
    rows[3] = shapely.GeometryCollection([line, shapely.GeometryCollection([shapely.MultiPolygon([box]), line])])
    assert areas(cadt.polygons(rows)).tolist() == [4, 9, 0, 4]
    spike = shapely.from_wkt("POLYGON((0 0,4 0,4 4,6 6,4 4,0 4,0 0))")
    assert areas(cadt.polygons([shapely.make_valid(spike)])).tolist() == [16]


def test_geoseries() -> None:
    geopandas = pytest.importorskip("geopandas")
    series = geopandas.GeoSeries(geometries(), index=["a", "b", "c", "d"], crs=25832)
    frame = geopandas.GeoDataFrame({"name": range(4)}, index=series.index, geometry=series)
    for given in (series, frame):
        triangles = cadt.polygons(given).to_geoseries()
        assert triangles.crs == series.crs
        assert triangles.area.groupby(level=0).sum().to_dict() == {"a": 8, "b": 9}
        assert set(triangles.geom_type) == {"Polygon"}
    assert len(cadt.polygons(series.iloc[2:]).to_geoseries()) == 0
    assert cadt.polygons(series.iloc[:0]).to_geoseries().crs == series.crs


def test_plot() -> None:
    pytest.importorskip("matplotlib").use("agg")
    import matplotlib.pyplot as plt

    result = cadt.polygons([wkb([SQUARE, HOLE]), wkb([np.add(SQUARE, 9)])])
    ax = result.plot(plt.figure().add_subplot(), values=[3, 4])
    assert sorted(set(ax.collections[0].get_array().tolist())) == [3, 4]
    for wrong in ([1], [1, 2, 3], [[1, 2]]):
        with pytest.raises(cadt.InputError, match=r"values must have shape \(2,\): one a polygon"):
            result.plot(plt.figure().add_subplot(), values=wrong)
    bad = cadt.polygons([wkb([SQUARE]), wkb([[[0, 0], [1e9, np.nan], [np.inf, 1]]])])
    ax = bad.plot(plt.figure().add_subplot())
    assert len(bad.problems) == 1 and ax.get_xlim()[1] < 4 and ax.get_ylim()[1] < 4


def test_simplified_boundaries_as_documented() -> None:
    """The lines of docs/constrained.md."""
    shapely = pytest.importorskip("shapely")
    text = (Path(__file__).parents[2] / "docs" / "constrained.md").read_text(encoding="utf-8")
    code = text.split("    b = cadt.label_segments(labels)\n")[1].split("\n\n")[0]
    random = np.random.default_rng(3)
    seeds, y, x = random.random((40, 2)) * [200, 150], *np.mgrid[:150, :200]
    nearest = np.argmin((x[..., None] - seeds[:, 0]) ** 2 + (y[..., None] - seeds[:, 1]) ** 2, axis=2)
    labels = random.integers(1, 9, 40)[nearest]
    names: dict[str, Any] = {"cadt": cadt, "np": np, "shapely": shapely, "labels": labels}
    exec("b = cadt.label_segments(labels)\n" + textwrap.dedent(code), names)  # noqa: S102
    mesh, label = names["mesh"], names["label"]
    assert len(mesh.segments) < len(names["b"].segments) / 5
    wrong = label[mesh.find_simplex((x + 0.5, 149.5 - y))] != labels
    assert np.count_nonzero(wrong) < 0.02 * labels.size  # those that the boundaries have moved over


def test_labels() -> None:
    image = np.zeros((30, 40), dtype=np.int64)
    image[5:20, 10:30] = 7
    image[8:12, 15:20] = -3
    boundary = cadt.label_segments(image)
    mesh = cadt.ConstrainedDelaunay(boundary.points, boundary.segments)
    assert mesh.n_regions == 3 and mesh.verify()
    label = cadt.triangle_labels(boundary.points, mesh.simplices, image)
    x, y = np.meshgrid(np.arange(40) + 0.5, 29.5 - np.arange(30))
    assert np.array_equal(label[mesh.find_simplex((x, y))], image)
    assert set(boundary.sides.ravel().tolist()) == {0, 7, -3, -(2**31)}
    wide = (np.full((2, 2), 2**31), np.full((2, 2), -(2**31)))
    for wrong in (image[0], image.astype(float), *wide, np.empty((0, 3), int), [[1], [1, 2]]):
        with pytest.raises(cadt.InputError):
            cadt.label_segments(wrong)
