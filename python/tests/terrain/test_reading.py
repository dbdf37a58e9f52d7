# SPDX-License-Identifier: Apache-2.0
"""Points from files: exact coordinates, filters, reference systems, and what is refused."""

from __future__ import annotations

import csv
import json
import pathlib
import subprocess
import sys

import cadt.terrain._las
import laspy
import numpy as np
import pytest
from cadt import terrain
from clouds import hills


@pytest.mark.parametrize("suffix", ["las", "laz"])
@pytest.mark.parametrize("chunk", [700, 1000, 1 << 19])
def test_coordinates_are_steps_times_scale_plus_offset(las, suffix, chunk, monkeypatch):
    monkeypatch.setattr(cadt.terrain._las, "CHUNK", chunk)
    steps = np.random.default_rng(1).integers(-(2**31), 2**31, (3000, 3))
    offset = np.array([4321.5, -87654.25, 12.125])
    name = las(f"a.{suffix}", steps * 0.01 + offset, scale=0.01, offset=tuple(offset))
    stored = laspy.read(name)
    cloud = terrain.read_cloud([name])
    for found, raw, shift in zip(
        (cloud.xy[:, 0], cloud.xy[:, 1], cloud.z), (stored.X, stored.Y, stored.Z), offset, strict=True
    ):
        assert np.array_equal(found, np.asarray(raw).astype(float) * 0.01 + shift)
    assert cloud.xy.dtype == cloud.z.dtype == np.float64
    assert cloud.bounds == (*cloud.xy.min(axis=0), *cloud.xy.max(axis=0))
    assert cloud.crs.to_epsg() == 25832


@pytest.mark.parametrize(
    ("name", "points", "epsg", "ground"),
    [
        ("real/orig/ahn_small.laz", 39233, 7415, 18392),
        ("real/orig/lidr_mixedconifer.laz", 37657, 26912, 5820),
        ("real/orig/las_epsg4326.las", 5380, 4326, 0),
        ("pslg/lidr_Topography.laz", 73403, 2949, 8159),
        ("pslg/pdal_autzen_trim.laz", 110000, None, 26107),
        ("pslg/pdal_mvk-thin.las", 6280, 26995, 1693),
        ("pslg/pdal_sample_c.las", 14408, 0, 1368),
        ("pslg/pdal_warsaw_small.las", 3000, 0, 1381),
    ],
)
def test_real_files(data, name, points, epsg, ground):
    path = data(name)
    cloud = terrain.read_cloud([path])
    assert len(cloud) == points
    if epsg == 0:
        assert cloud.crs is None
    else:
        assert cloud.crs.to_epsg() == epsg  # None: a system without a number
    if ground:
        assert len(terrain.read_cloud([path], classes=[2])) == ground


def test_real_coordinates_are_those_of_the_text(data):
    """The same file as text, made by another program."""
    expected = np.loadtxt(data("real/las_sample_c.xy"))
    assert np.array_equal(terrain.read_cloud([data("real/orig/las_sample_c.las")]).xy, expected)


def test_several_files_are_one_cloud_in_their_order(las):
    parts = [hills(1000, seed=seed) for seed in (1, 2, 3)]
    names = [las(f"{k}.la{'zs'[k % 2]}", part, classes=[2, 5] * 500) for k, part in enumerate(parts)]
    cloud = terrain.read_cloud(names)
    assert np.allclose(np.column_stack((cloud.xy, cloud.z)), np.concatenate(parts), atol=1e-9, rtol=0)
    ground = terrain.read_cloud(names, classes=[2])
    assert np.array_equal(ground.xy, cloud.xy[::2]) and np.array_equal(ground.z, cloud.z[::2])
    assert len(terrain.read_cloud(names, classes=[2, 5])) == 3000
    assert np.array_equal(terrain.read_cloud(names[:1], values="classification").z, [2, 5] * 500)


def test_reference_systems_must_agree(las):
    a, b, none = las("a.laz", hills(10)), las("b.laz", hills(10), crs="EPSG:25833"), las("c.laz", hills(10), crs=None)
    with pytest.raises(terrain.CrsError, match=r"b\.laz: its reference system is .*33N.* that of .*a\.laz is .*32N"):
        terrain.read_cloud([a, b])
    with pytest.raises(terrain.CrsError, match=r"c\.laz: does not say its reference system"):
        terrain.read_cloud([a, none])
    assert terrain.read_cloud([none]).crs is None
    assert terrain.read_cloud([a, b, none], crs="EPSG:25832").crs.to_epsg() == 25832
    assert terrain.read_cloud([a], crs="none").crs is None
    data = pathlib.Path(a).read_bytes()
    pathlib.Path(a).write_bytes(data.replace(b"PROJCRS", b"PROJXXX").replace(b"PROJCS", b"PROJXX"))
    with pytest.raises(terrain.CrsError, match=r"a\.laz: its reference system is not understood"):
        terrain.read_cloud([a])
    assert len(terrain.read_cloud([a], crs="EPSG:25832")) == 10  # then nobody asks the file
    with pytest.raises(terrain.UsageError, match="--crs nonsense: no such"):
        terrain.read_cloud([a], crs="nonsense")


def test_files_without_points(las):
    empty, some = las("e.laz", np.empty((0, 3))), las("s.las", hills(10), classes=5)
    with pytest.raises(terrain.FileError, match=r"e\.laz: has no points"):
        terrain.read_cloud([empty])
    with pytest.raises(terrain.FileError, match=r"s\.las: no point is of class 2, 9"):
        terrain.read_cloud([some], classes=[2, 9])
    assert len(terrain.read_cloud([empty, some])) == 10
    with pytest.raises(terrain.UsageError, match="no such dimension; it has: .*intensity"):
        terrain.read_cloud([some], values="depth")


def test_headers_that_promise_more(las, tmp_path):
    """Memory is asked for only when the file can hold the points."""
    damaged = bytearray(pathlib.Path(las("a.las", hills(100))).read_bytes())
    for at, size in ((107, 4), (247, 8)):  # the numbers of points of LAS 1.2 and of 1.4
        damaged[at : at + size] = (10**12 if size == 8 else 2**32 - 1).to_bytes(size, "little")
    (tmp_path / "more.las").write_bytes(damaged)
    with pytest.raises(terrain.FileError, match=r"more\.las: truncated: 100 points of the \d{10,} that"):
        terrain.read_cloud([str(tmp_path / "more.las")])


@pytest.mark.parametrize("suffix", ["las", "laz"])
def test_damaged_files(las, tmp_path, suffix):
    whole = pathlib.Path(las(f"w.{suffix}", hills(200_000)))
    data = whole.read_bytes()
    cut = tmp_path / f"cut.{suffix}"
    for size in (0, 3, 100, 374, 500, len(data) // 2, len(data) - 1):
        cut.write_bytes(data[:size])
        with pytest.raises(
            terrain.FileError, match=rf"cut\.{suffix}: (is no LAS or LAZ|truncated|damaged|its reference system is not)"
        ):
            terrain.read_cloud([str(cut)])
    cut.write_bytes(b"not a cloud at all" * 100)
    with pytest.raises(terrain.FileError, match="is no LAS or LAZ file"):
        terrain.read_cloud([str(cut)])
    flipped = bytearray(data)
    for at in range(2000, len(data), 997):
        flipped[at] ^= 0xFF
    cut.write_bytes(flipped)
    try:  # any coordinates, or an error of ours
        terrain.read_cloud([str(cut)])
    except terrain.TerrainError:
        pass


def test_names_that_cannot_be_read(tmp_path):
    with pytest.raises(terrain.FileError, match=r"no\.laz: cannot be opened: No such file"):
        terrain.read_cloud([str(tmp_path / "no.laz")])
    with pytest.raises(terrain.FileError, match="is a folder"):
        terrain.read_cloud([str(tmp_path)])
    (tmp_path / "a.shp").write_text("")
    with pytest.raises(terrain.UsageError, match=r"a\.shp: points are read from files that end in one of: las, laz"):
        terrain.read_cloud([str(tmp_path / "a.shp")])


def frame(n=500):
    geopandas = pytest.importorskip("geopandas", reason="geopandas is not installed: scripts/python_env terrain")
    import shapely

    xyz = hills(n)
    table = geopandas.GeoDataFrame({"depth": -xyz[:, 2], "name": "x"}, geometry=shapely.points(xyz), crs="EPSG:25832")
    return table, xyz


@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "geojson", "parquet"])
def test_vector_files(tmp_path, suffix):
    table, xyz = frame()
    path = tmp_path / f"p.{suffix}"
    options = (
        {"SPATIAL_INDEX": "NO"} if suffix == "fgb" else {"COORDINATE_PRECISION": 15} if suffix == "geojson" else {}
    )
    if suffix == "parquet":
        pytest.importorskip("pyarrow", reason="pyarrow is not installed: scripts/python_env terrain")
        table.to_parquet(path)
    else:
        table.to_file(path, **options)
    cloud = terrain.read_cloud([str(path)])
    assert np.array_equal(np.column_stack((cloud.xy, cloud.z)), xyz)
    assert cloud.crs.to_epsg() == 25832
    assert np.array_equal(terrain.read_cloud([str(path)], values="depth").z, -xyz[:, 2])
    with pytest.raises(terrain.UsageError, match="--values width: .* it has: depth"):
        terrain.read_cloud([str(path)], values="width")
    with pytest.raises(terrain.UsageError, match="has no classes"):
        terrain.read_cloud([str(path)], classes=[2])


def test_vector_files_that_are_refused(tmp_path):
    table, _ = frame(3)
    flat = table.copy()
    flat.geometry = flat.geometry.force_2d()
    flat.to_file(tmp_path / "flat.gpkg")
    with pytest.raises(terrain.FileError, match="point 0 .* has no height; name an attribute with --values"):
        terrain.read_cloud([str(tmp_path / "flat.gpkg")])
    assert np.array_equal(terrain.read_cloud([str(tmp_path / "flat.gpkg")], values="depth").z, table["depth"])
    flat.loc[1, "depth"] = None
    flat.to_file(tmp_path / "gap.gpkg")
    with pytest.raises(terrain.FileError, match="point 1 .* has no number as 'depth'"):
        terrain.read_cloud([str(tmp_path / "gap.gpkg")], values="depth")
    table.geometry = table.geometry.buffer(1)
    table.to_file(tmp_path / "area.gpkg")
    with pytest.raises(terrain.FileError, match=r"feature 0 .* is no point"):
        terrain.read_cloud([str(tmp_path / "area.gpkg")])
    (tmp_path / "bad.geojson").write_text("{")
    with pytest.raises(terrain.FileError, match=r"bad\.geojson: cannot be read"):
        terrain.read_cloud([str(tmp_path / "bad.geojson")])
    (tmp_path / "none.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": []}))
    with pytest.raises(terrain.FileError, match="has no points"):
        terrain.read_cloud([str(tmp_path / "none.geojson")])


def test_tables(tmp_path):
    rows = hills(50)
    np.savetxt(tmp_path / "a.xyz", rows, fmt="%.17g")
    np.save(tmp_path / "a.npy", rows.astype("<f8"))
    header = "# made by hand\nid,east,north,depth\n"
    lines = "".join(f"{k},{x!r},{y!r},{z!r}\n" for k, (x, y, z) in enumerate(rows.tolist()))
    (tmp_path / "a.csv").write_text(header + lines)
    for name, columns in (
        ("a.xyz", ""),
        ("a.npy", ""),
        ("a.npy", "1,2,3"),
        ("a.csv", "east,north,depth"),
        ("a.csv", "2,3,4"),
    ):
        cloud = terrain.read_cloud([str(tmp_path / name)], columns=columns)
        assert np.array_equal(np.column_stack((cloud.xy, cloud.z)), rows), name
        assert cloud.crs is None
    with pytest.raises(terrain.UsageError, match="has no column width; it has: id, east"):
        terrain.read_cloud([str(tmp_path / "a.csv")], columns="east,north,width")
    with pytest.raises(terrain.UsageError, match="has no column ²; it has: id, east"):
        terrain.read_cloud([str(tmp_path / "a.csv")], columns="1,2,²")
    (tmp_path / "b.xyz").write_text("1 2 3\n1 nan 3\n")
    with pytest.raises(terrain.FileError, match=r"line 2: column 2: 'nan' is not a finite number"):
        terrain.read_cloud([str(tmp_path / "b.xyz")])
    with pytest.raises(terrain.FileError, match=r"line 4: column 4: 'inf' is not a finite number"):
        (tmp_path / "c.csv").write_text("# made by hand\nid,x,y,z\n\n1,2,3,inf\n")
        terrain.read_cloud([str(tmp_path / "c.csv")])
    (tmp_path / "b.xyz").write_text("1 2 3\n1 2\n")
    with pytest.raises(terrain.FileError, match=r"b\.xyz: cannot be read"):
        terrain.read_cloud([str(tmp_path / "b.xyz")])
    for text, says in (("", "is empty"), ("\n", "has no points"), ("# none\n", "has no points")):
        (tmp_path / "b.xyz").write_text(text)
        with pytest.raises(terrain.FileError, match=says):
            terrain.read_cloud([str(tmp_path / "b.xyz")])
    np.save(tmp_path / "n.npy", [[0, 0, 1], [1, np.nan, 1]])
    with pytest.raises(terrain.FileError, match=r"row 1 .* no finite number in column 2"):
        terrain.read_cloud([str(tmp_path / "n.npy")])


THREE = [[0, 0, 1], [1, 0, 2], [0, 1, 3]]


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ("\ufeff0 0 1\r\n1 0 2\r\n0 1 3\r\n", ""),
        ("\ufeffx,y,z\r\n0,0,1\r\n1,0,2\r\n0,1,3\r\n", "x,y,z"),
        ("id,x,y,z\n7,0,0,1\n8,1,0,2\n9,0,1,3\n", ""),
        ("z,y,x\n1,0,0\n2,0,1\n3,1,0\n", ""),
        ("Z,Lat,LON,name\n1,0,0,a\n2,0,1,b\n3,1,0,c\n", ""),
        ("X,Y,Z,name\n0,0,1,a\n1,0,2,b\n0,1,3,c\n", "x,y,z"),
        ('  # made\n"east";"north";"elev"\n"0";"0";"1"\n"1";"0";"2"\n"0";"1";"3"\n', ""),
        ("a,b,c\n0,0,1\n1,0,2\n0,1,3\n", ""),
        ("x,street,y,z\n0,#1 DRIVE,0,1\n1,2 //A,0,2\n0,>3,1,3\n", ""),
        ("0 0 1 # first\n> segment\n// note\n1 0 2\n0 1 3\n", ""),
        ("name\tx\ty\tz\na b\t0\t0\t1\n\t1\t0\t2\nc\t0\t1\t3\n", ""),
        ('x;y;z;d\n0;0;1;"x;\n7;7"\n1;0;2;""\n0;1;3;\n', ""),
        ("0,0,1,\n1,0,2,\n0,1,3,\n", ""),
    ],
)
def test_headers_are_read_as_the_program_reads_them(tmp_path, text, columns):
    (tmp_path / "t.csv").write_bytes(text.encode())
    cloud = terrain.read_cloud([str(tmp_path / "t.csv")], columns=columns)
    assert np.array_equal(np.column_stack((cloud.xy, cloud.z)), THREE)


def test_names_that_do_not_tell_the_coordinates(tmp_path):
    (tmp_path / "t.csv").write_text("point_id,easting_m,northing_m,elev_m\n1,0,0,1\n2,1,0,2\n3,0,1,3\n")
    with pytest.raises(terrain.FileError, match="of 4 columns with names none are x and y"):
        terrain.read_cloud([str(tmp_path / "t.csv")])
    cloud = terrain.read_cloud([str(tmp_path / "t.csv")], columns="easting_m,northing_m,elev_m")
    assert np.array_equal(np.column_stack((cloud.xy, cloud.z)), THREE)


@pytest.mark.parametrize("row", ["0,0,n/a", "0,0,", "0,0,nodata"])
def test_a_first_row_that_is_bad_is_no_header(tmp_path, row):
    (tmp_path / "t.csv").write_text(f"{row}\n1,0,2\n0,1,3\n1,1,4\n")
    with pytest.raises(terrain.FileError, match="cannot be read"):
        terrain.read_cloud([str(tmp_path / "t.csv")])


def test_fields_that_begin_as_comments(data):
    """Streets such as "#1 MEMORIAL DRIVE"."""
    path = data("real/orig/walmart_stores.csv")
    cloud = terrain.read_cloud([path], columns="LON,LAT,YEAR")
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(cloud) == len(rows) and any(row["STREETADDR"].startswith("#") for row in rows)
    assert np.array_equal(cloud.xy, [[float(row["LON"]), float(row["LAT"])] for row in rows])
    assert np.array_equal(cloud.z, [float(row["YEAR"]) for row in rows])


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("1,2", "line 99999: the line has 2 fields, column 3 is expected"),
        ("1,2,three", "line 99999: column 3: 'three' is not a decimal number"),
        ("1,2,1_0", "line 99999: column 3: '1_0' is not a decimal number"),
        ("1,,3", "line 99999: column 2 is empty"),
        ("1,2,1e999", "line 99999: column 3: '1e999' is too large"),
        ('1,2,3,"', "line 99999: a quoted field is not closed"),
    ],
)
def test_errors_name_the_line_of_the_file(tmp_path, line, says):
    (tmp_path / "t.csv").write_text("# a\n\nx,y,z\n" + "1,2,3\n" * 99_995 + line + "\n1,2,3\n")
    with pytest.raises(terrain.FileError, match=says):
        terrain.read_cloud([str(tmp_path / "t.csv")])


def test_tables_without_what_is_needed(tmp_path):
    (tmp_path / "t.csv").write_text("x,y,z\n")
    with pytest.raises(terrain.FileError, match="only a header line"):
        terrain.read_cloud([str(tmp_path / "t.csv")])
    (tmp_path / "t.csv").write_text("lat,lon,name\n1,2,a\n")
    with pytest.raises(terrain.UsageError, match="no column of heights"):
        terrain.read_cloud([str(tmp_path / "t.csv")])


def test_attributes_that_are_no_numbers(tmp_path):
    pytest.importorskip("pyogrio")
    for value in ("x", "2020-01-01", True):
        features = [
            {"type": "Feature", "properties": {"h": value}, "geometry": {"type": "Point", "coordinates": [k, k * k]}}
            for k in range(4)
        ]
        (tmp_path / "p.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
        with pytest.raises(terrain.FileError, match="the attribute h is no number"):
            terrain.read_cloud([str(tmp_path / "p.geojson")], values="h")


@pytest.mark.parametrize("byte", [131, 155])
def test_a_scale_or_offset_that_is_no_number(las, byte):
    name = las("nan.las", hills(50))
    data = bytearray(open(name, "rb").read())
    data[byte : byte + 8] = np.float64(np.nan).tobytes()
    open(name, "wb").write(data)
    with pytest.raises(terrain.FileError, match="no finite number"):
        terrain.read_cloud([name])


@pytest.mark.parametrize("suffix", ["las", "laz"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_dimensions_with_values_that_are_not_finite(las, cadt_terrain, suffix, value, monkeypatch):
    monkeypatch.setattr(cadt.terrain._las, "CHUNK", 700)
    name = las(f"a.{suffix}", hills(2000), classes=np.where(np.arange(2000) % 3 == 0, 2, 5))
    stored = laspy.read(name)
    stored.add_extra_dim(laspy.ExtraBytesParams("depth", np.float32))
    depth = np.arange(2000.0)
    depth[1500] = value
    stored["depth"] = depth
    stored.write(name)
    for classes in (None, [2]):
        with pytest.raises(terrain.FileError, match=r"point 1500 \(counted from 0\) has no number as 'depth'"):
            terrain.read_cloud([name], values="depth", classes=classes)
    assert np.array_equal(terrain.read_cloud([name], values="depth", classes=[5]).z, depth[np.arange(2000) % 3 != 0])
    assert len(terrain.read_cloud([name])) == 2000  # nobody asks for them
    for words in (("raster", "o.tif", "--res", "5"), ("tin", "o.glb"), ("contour", "o.gpkg", "--interval", "5")):
        cadt_terrain(words[0], name, *words[1:], "--values", "depth", code=3, says="no number as 'depth'")


@pytest.mark.thorough
def test_reading_holds_what_is_kept_and_one_piece(las):
    """3 million points, a tenth of them ground: 24 bytes a kept point, and the piece that is decoded."""
    n = 3_000_000
    name = las("big.laz", hills(n, size=3000.0), classes=np.where(np.arange(n) % 10 == 0, 2, 5))
    program = (
        "import resource, sys\nimport laspy, lazrs, pyproj, numpy as np, cadt.terrain as t\n"
        "t.read_cloud([sys.argv[2]])\n"
        "before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "cloud = t.read_cloud([sys.argv[1]], classes=[2] if sys.argv[3] == '2' else None)\n"
        "print(len(cloud), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)\n"
    )
    small = las("small.laz", hills(100))
    for which, kept in (("2", n // 10), ("all", n)):
        out = subprocess.run(
            [sys.executable, "-c", program, name, small, which], capture_output=True, text=True, check=True
        )
        points, kilobytes = map(int, out.stdout.split())
        assert points == kept
        assert kilobytes * 1024 < 24 * kept + (100 << 20)
