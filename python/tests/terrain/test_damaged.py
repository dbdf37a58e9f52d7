# SPDX-License-Identifier: Apache-2.0
"""Files that are damaged or truncated, and counts that are wrong: an error that names the file, instead of the points
that are left or the memory that a header asks for."""

from __future__ import annotations

import pathlib
import sqlite3
import struct
from typing import Any

import cadt.terrain._vector
import cadt.terrain.cloud
import laspy
import numpy as np
import pytest
from cadt import terrain
from cadt.terrain._breaklines import read_breaklines
from clouds import hills


def refused(path: Any, says: str, **more: Any) -> None:
    with pytest.raises(terrain.FileError, match=says):
        terrain.read_cloud([str(path)], **more)


@pytest.fixture
def changed(las, tmp_path):
    """A LAZ file of 40 points with one field changed: `at` bytes behind the begin of the file, of the points, of the
    record of LASzip or of the table of chunks."""

    def make(behind: str, at: int, kind: str, value: int) -> pathlib.Path:
        path = pathlib.Path(las("changed.laz", hills(40), crs=None))
        data = bytearray(path.read_bytes())
        (points,) = struct.unpack_from("<I", data, 96)
        (table,) = struct.unpack_from("<q", data, points)
        begins = {"file": 0, "points": points, "record": data.index(b"laszip encoded") - 2 + 54, "table": table}
        struct.pack_into(kind, data, begins[behind] + at, value)
        path.write_bytes(data)
        return path

    return make


@pytest.mark.parametrize(
    ("behind", "at", "kind", "value", "says"),
    [
        ("file", 100, "<I", 1000, "1000 records before the points, room for 1$"),
        ("file", 243, "<I", 1000, "truncated: 1000 records behind the points, room for"),
        ("file", 247, "<Q", 10**12, "truncated: at most 50000 points of the 1000000000000 that"),
        ("record", 12, "<I", 0, "(damaged|truncated): "),
        ("record", 12, "<I", 1 << 26, "a chunk of 67108864 points needs 1.9 GiB: write it again with smaller"),
        ("record", 36, "<H", 40, "damaged: a point has 30 bytes or 40"),
        ("table", 4, "<I", 1000, "damaged: it has no room for its 1000 chunks"),
        ("points", 0, "<q", -1, "damaged: "),
    ],
)
def test_fields_of_laz(changed, behind, at, kind, value, says):
    refused(changed(behind, at, kind, value), rf"changed\.laz: .*{says}")


def test_chunks_of_laz_that_are_said_at_the_end(changed):
    """A writer that could not go back leaves -1, and says at the end where the table is."""
    path = changed("points", 0, "<q", -1)
    data = path.read_bytes()
    (points,) = struct.unpack_from("<I", data, 96)
    whole = pathlib.Path(changed("points", 0, "<q", -1)).with_name("end.laz")
    table = data.rindex(struct.pack("<II", 0, 1))
    assert table > points
    whole.write_bytes(data + struct.pack("<q", table))
    assert len(terrain.read_cloud([str(whole)])) == 40


def test_panics_of_lazrs(las, monkeypatch):
    class PanicException(BaseException):
        pass

    def panic(*_: Any, **__: Any) -> None:
        raise PanicException("index out of bounds")

    name = las("p.laz", hills(40))
    monkeypatch.setattr(laspy.LasReader, "read_points", panic)
    refused(name, r"p\.laz: damaged after 0 of 40 points: index out of bounds")
    monkeypatch.setattr(laspy, "open", panic)
    refused(name, r"p\.laz: is no LAS or LAZ file: index out of bounds")


def test_dimensions_of_several_numbers(las):
    name = las("n.laz", hills(40))
    stored = laspy.read(name)
    stored.add_extra_dim(laspy.ExtraBytesParams("nrm", "3f4"))
    stored.write(name)
    with pytest.raises(terrain.UsageError, match=r"--values nrm: .*n\.laz has 3 numbers a point"):
        terrain.read_cloud([name], values="nrm")
    assert len(terrain.read_cloud([name])) == 40


def test_memory_is_that_of_the_most_points(las, monkeypatch):
    monkeypatch.setattr(cadt.terrain.cloud, "MOST_POINTS", 50)
    name = las("m.laz", hills(100), classes=[2, 5, 5, 5] * 25)
    ground = terrain.read_cloud([name], classes=[2])
    assert len(ground) == 25 and len(ground.xy.base) == 50
    refused(name, "too many points: at most 50 fit")


def points(path: pathlib.Path, n: int, **more: Any) -> pathlib.Path:
    """A GIS file with n points."""
    import pyogrio
    import shapely

    geometry = np.array([shapely.to_wkb(shapely.Point(k, k * k % 7, k / 2)) for k in range(n)], object)
    driver = cadt.terrain._vector.DRIVERS[path.suffix[1:]]
    options = {"geometry_type": "Point Z", "driver": driver, "layer": "a", "crs": "EPSG:25832", **more}
    pyogrio.raw.write(str(path), geometry, [np.arange(n)], ["depth"], **options)
    return path


@pytest.fixture(autouse=True)
def _pieces(monkeypatch):
    monkeypatch.setattr(cadt.terrain._vector, "CHUNK", 8)


def test_truncated_flatgeobuf(tmp_path):
    whole = points(tmp_path / "w.fgb", 30, SPATIAL_INDEX="NO").read_bytes()
    size = len(whole) - points(tmp_path / "less.fgb", 29, SPATIAL_INDEX="NO").stat().st_size  # of a feature
    cut = tmp_path / "cut.fgb"
    for features in (29, 24, 20, 1, 0):  # as a whole
        cut.write_bytes(whole[: len(whole) - (30 - features) * size])
        refused(cut, rf"cut\.fgb: truncated: {features} features of the 30 that")
    for length in (0, 10, 100, len(whole) - 1):
        cut.write_bytes(whole[:length])
        refused(cut, r"cut\.fgb: (cannot be read|truncated)")


@pytest.mark.parametrize(
    ("count", "says"),
    [(1 << 20, "truncated: it has no room for the 1048576 features"), (0xFF000000, "damaged: it promises -16777216")],
)
def test_counts_that_no_file_holds(tmp_path, count, says):
    pytest.importorskip("geopandas", reason="geopandas is not installed: scripts/python_env terrain")
    cloud = terrain.read_cloud([str(points(tmp_path / "whole.fgb", 9))])
    path = points(tmp_path / "p.fgb", 301, SPATIAL_INDEX="NO")
    banks = pathlib.Path(lines(tmp_path / "l.fgb", 301, SPATIAL_INDEX="NO"))
    for file in (path, banks):
        data = file.read_bytes()
        assert data.count(struct.pack("<Q", 301)) == 1
        file.write_bytes(data.replace(struct.pack("<Q", 301), struct.pack("<Q", count)))
    refused(path, rf"p\.fgb: {says}")
    with pytest.raises(terrain.FileError, match=rf"l\.fgb: {says}"):
        read_breaklines(str(banks), cloud, None)


@pytest.mark.parametrize("suffix", ["fgb", "geojson"])
def test_names_that_are_no_text(tmp_path, suffix):
    path = points(tmp_path / f"p.{suffix}", 9)
    path.write_bytes(path.read_bytes().replace(b"depth", b"dep\xff\xfe"))
    refused(path, rf"p\.{suffix}: cannot be read")


@pytest.mark.parametrize("count", [5, 0, 40, 10**7, None])
def test_stored_counts_of_geopackages(tmp_path, count):
    """GDAL says how many features there are by a table that other programs may not have kept up to date."""
    path = points(tmp_path / "p.gpkg", 30)
    with sqlite3.connect(path) as database:
        database.execute("update gpkg_ogr_contents set feature_count = ?", (count,))
    database.close()
    assert np.array_equal(terrain.read_cloud([str(path)]).z, np.arange(30) / 2)
    assert np.array_equal(terrain.read_cloud([str(path)], values="depth").z, np.arange(30))


def lines(path: pathlib.Path, n: int, **more: Any) -> str:
    import geopandas
    import shapely

    rows = [shapely.LineString([(x, 0, 1), (x, 9, 2)]) for x in range(n)]
    geopandas.GeoDataFrame({"a": range(n)}, geometry=rows, crs="EPSG:25832").to_file(path, **more)
    return str(path)


def test_breaklines(tmp_path):
    pytest.importorskip("geopandas", reason="geopandas is not installed: scripts/python_env terrain")
    cloud = terrain.read_cloud([str(points(tmp_path / "p.fgb", 9))])
    path = pathlib.Path(lines(tmp_path / "l.fgb", 20, SPATIAL_INDEX="NO"))
    whole = path.read_bytes()
    assert len(read_breaklines(str(path), cloud, None).offsets) == 21
    size = len(whole) - pathlib.Path(lines(tmp_path / "m.fgb", 19, SPATIAL_INDEX="NO")).stat().st_size
    for length, says in ((len(whole) - 3 * size, "truncated: 17 features of the 20"), (100, "no layer is found")):
        path.write_bytes(whole[:length])
        with pytest.raises(terrain.FileError, match=rf"l\.fgb: .*{says}"):
            read_breaklines(str(path), cloud, None)
    path = pathlib.Path(lines(tmp_path / "l.gpkg", 20))
    with sqlite3.connect(path) as database:
        database.execute("update gpkg_ogr_contents set feature_count = 5")
    database.close()
    assert len(read_breaklines(str(path), cloud, None).offsets) == 21
    path = pathlib.Path(lines(tmp_path / "l.shp", 20))
    table = bytearray(path.with_suffix(".dbf").read_bytes())
    header, record = struct.unpack_from("<HH", table, 8)
    table[header + 3 * record] = ord("*")  # deleted
    path.with_suffix(".dbf").write_bytes(table)
    assert len(read_breaklines(str(path), cloud, None).offsets) == 20


def test_a_shapefile_without_its_index(tmp_path):
    path = pathlib.Path(lines(tmp_path / "l.shp", 20))
    path.with_suffix(".shx").unlink()
    with pytest.raises(terrain.FileError, match=r"l\.shp: the \.shx file beside it is missing"):
        read_breaklines(str(path), terrain.read_cloud([str(points(tmp_path / "p.fgb", 9))]), None)


def test_styles_of_qgis_are_no_layer(tmp_path):
    pandas = pytest.importorskip("pandas", reason="pandas is not installed: scripts/python_env terrain")
    import pyogrio

    path = points(tmp_path / "p.gpkg", 9)
    pyogrio.write_dataframe(pandas.DataFrame({"styleName": ["a"]}), path, layer="layer_styles")
    cloud = terrain.read_cloud([str(path)])
    assert len(cloud) == 9
    banks = lines(tmp_path / "l.gpkg", 20)
    pyogrio.write_dataframe(pandas.DataFrame({"styleName": ["a"]}), banks, layer="layer_styles")
    assert len(read_breaklines(banks, cloud, None).offsets) == 21
    lines(tmp_path / "p.gpkg", 20, layer="b")
    refused(path, r"p\.gpkg: has several layers \(a, b\)")


def test_arrays(tmp_path):
    path = tmp_path / "a.npy"
    np.save(path, np.arange(30.0).reshape(10, 3))
    whole = path.read_bytes()
    for data in (b"", whole[:50], whole[:-1], whole.replace(b"(10, 3), }", b"(10, 3 , {"), b"junk" * 50):
        path.write_bytes(data)
        refused(path, r"a\.npy: cannot be read")
    np.savez(tmp_path / "a.npz", np.zeros((10, 3)))
    (tmp_path / "a.npz").replace(path)
    refused(path, r"a\.npy: is no \.npy file but an \.npz")
    for kind in ("c16", "m8[s]", "?"):
        np.save(path, np.ones((10, 3)).astype(kind))
        refused(path, r"a\.npy: is no table of numbers: shape \(10, 3\), ")
    for kind in ("f4", ">i2", "u1"):
        np.save(path, np.ones((10, 3)).astype(kind))
        assert len(terrain.read_cloud([str(path)])) == 10


def test_no_point_of_the_classes_that_were_asked_for():
    assert "no point is of class 2, 9; without --class" in str(cadt.terrain.cloud.no_points(["a.las"], [2, 9]))
    assert str(cadt.terrain.cloud.no_points(["a.las"], None)) == "a.las: has no points"
