# SPDX-License-Identifier: Apache-2.0
"""--breaklines: lines with and without heights, what is refused, and a lake of a LiDAR scan."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import cadt
import geopandas
import numpy as np
import pytest
import rasterio
import shapely
from cadt.terrain import read_cloud
from test_tin import read_ply

AT = np.array([500_000.0, 5_400_000.0])
BOUNDS = "500000,5400000,500160,5400100"


def ditch(y: np.ndarray) -> np.ndarray:
    """Heights across a ditch whose banks are at 40 and 60."""
    return 300 - np.clip(10 - np.abs(y - 50), 0, None)


def scattered(seed: int = 4) -> np.ndarray:
    """Points beside the ditch, and few in it."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 100, (400, 2))
    xy = xy[(np.abs(xy[:, 1] - 50) > 11) | (rng.random(len(xy)) < 0.03)]
    xy = np.round(np.concatenate([xy, [[0, 0], [100, 0], [0, 100], [100, 100]]]), 3)
    return np.column_stack([xy + AT, ditch(xy[:, 1])])


def write(path: Path, geometry: Any, crs: str | None = "EPSG:25832") -> str:
    geopandas.GeoDataFrame(geometry=list(geometry), crs=crs).to_file(path)
    return path.name


def bank(y: float, z: bool = True) -> shapely.LineString:
    x = np.linspace(0, 100, 3)
    row = np.column_stack([x + AT[0], np.full(3, y + AT[1]), np.full(3, ditch(np.array(y)))])
    return shapely.LineString(row if z else row[:, :2])


def error(path: Path) -> float:
    """The largest difference from the ditch in its inner 80 %."""
    with rasterio.open(path) as raster:
        cells = raster.read(1)
        y = raster.transform.f + (np.arange(raster.height) + 0.5) * raster.transform.e - AT[1]
        return float(np.abs(cells - ditch(y)[:, None])[:, 10:90].max())


@pytest.mark.parametrize("suffix", ["gpkg", "geojson", "fgb", "shp"])
def test_lines_with_heights_shape_the_terrain(las, tmp_path, cadt_terrain, suffix):
    las("scan.laz", scattered())
    crs = "EPSG:25832"
    name = write(tmp_path / f"banks.{suffix}", [bank(40), shapely.MultiLineString([bank(50), bank(60)])], crs)
    cadt_terrain("raster", "scan.laz", "plain.tif", "--res", "1")
    result = cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines", name)
    assert "breaklines  3, with 9 points; heights of the file" in result.err
    assert error(tmp_path / "plain.tif") > 3
    assert error(tmp_path / "dem.tif") < 1e-3  # the file's digits
    # by the library
    cloud = read_cloud([str(tmp_path / "scan.laz")])
    xyz = np.concatenate([shapely.get_coordinates(bank(y), include_z=True) for y in (40, 50, 60)])
    mesh = cadt.ConstrainedDelaunay(np.concatenate([xyz[:, :2], cloud.xy]), polylines=[0, 3, 6, 9])
    with rasterio.open(tmp_path / "dem.tif") as raster:
        cells, t = raster.read(1), raster.transform
        x, y = np.meshgrid(t.c + (np.arange(raster.width) + 0.5) * t.a, t.f + (np.arange(raster.height) + 0.5) * t.e)
    expected = mesh.interpolate(np.concatenate([xyz[:, 2], cloud.z]), (x, y))
    assert np.nanmax(np.abs(expected - cells)[np.isfinite(expected)]) < 1e-9


def test_lines_without_heights_get_them_from_the_points(las, tmp_path, cadt_terrain):
    points = scattered()
    las("scan.laz", points)
    outline = shapely.Polygon([(AT + p).tolist() for p in ([20, 5], [80, 5], [80, 30], [20, 30])])
    name = write(tmp_path / "plain.gpkg", [outline, bank(40)])
    result = cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines", name)
    assert "breaklines  2, with 8 points; heights of the file, but 5 from the points" in result.err
    name = write(tmp_path / "flat.gpkg", [bank(40, z=False)])
    result = cadt_terrain("raster", "scan.laz", "flat.tif", "--res", "1", "--breaklines", name, "--fill", "nearest")
    assert "heights of the points" in result.err and "no data     0" in result.err


def test_geojson_of_which_some_positions_have_no_height(las, tmp_path, cadt_terrain):
    """GDAL takes it for 0."""
    las("scan.laz", scattered())
    x, y = AT
    part = [[x + 20, y + 40, 299], [x + 80, y + 40]]
    parts = [[[x + 20, y + 50, 298], [x + 50, y + 50, 297]], [[x + 20, y + 60], [x + 50, y + 60]]]
    ring = [[[x + 60, y + 60, 0], [x + 70, y + 60, 0], [x + 70, y + 70], [x + 60, y + 60, 0]]]
    geometries = [
        {"type": "LineString", "coordinates": part},
        None,
        {"type": "MultiLineString", "coordinates": parts},
        {"type": "Polygon", "coordinates": ring},
    ]
    (tmp_path / "part.geojson").write_text(
        json.dumps(
            {
                "type": "FeatureCollection",
                "crs": {"type": "name", "properties": {"name": "EPSG:25832"}},
                "features": [{"type": "Feature", "properties": {}, "geometry": g} for g in geometries],
            }
        )
    )
    result = cadt_terrain("tin", "scan.laz", "t.ply", "--breaklines", "part.geojson")
    assert "breaklines  4, with 10 points; heights of the file, but 4 from the points" in result.err
    assert "feature 3 (counted from 0) has the height 0 at" in result.err  # a height that the file does give
    assert "and 2 more such points; those of the points are" in result.err
    (tmp_path / "one.geojson").write_text(json.dumps({"type": "LineString", "coordinates": part}))
    result = cadt_terrain("tin", "scan.laz", "t.ply", "--breaklines", "one.geojson", "--crs", "EPSG:25832")
    assert "with 2 points; heights of the file, but 1 from the points" in result.err
    assert "its reference system" not in result.err  # GDAL's guess
    features = [{"type": "Feature", "properties": {"a": "\xe9"}, "geometry": g} for g in geometries[:1] * 2]
    (tmp_path / "text.geojson").write_bytes("\n".join(json.dumps(f, ensure_ascii=False) for f in features).encode("latin-1"))
    result = cadt_terrain("tin", "scan.laz", "t.ply", "--breaklines", "text.geojson", "--crs", "EPSG:25832")
    assert "breaklines  2, with 4 points; heights of the file, but 2 from the points" in result.err


def test_the_reference_system_of_lines_that_crs_overrides(las, tmp_path, cadt_terrain):
    las("scan.laz", scattered())
    other = write(tmp_path / "other.gpkg", [bank(40)], "EPSG:25833")
    words = ("tin", "scan.laz", "t.ply", "--breaklines", other, "--crs")
    err = cadt_terrain(*words, "EPSG:25832").err
    assert "warning: other.gpkg: its reference system is ETRS89 / UTM zone 33N (EPSG:25833); it is taken for ETRS89" in err
    assert "its reference system" not in cadt_terrain(*words, "none").err
    assert "its reference system" not in cadt_terrain(*words, "EPSG:25833").err


def test_heights_far_from_those_of_the_points(las, tmp_path, cadt_terrain):
    las("scan.laz", scattered())
    lines = [bank(40), shapely.LineString([(*(AT + [20, 50]), -9999), (*(AT + [80, 50]), 293)])]
    name = write(tmp_path / "nodata.gpkg", lines)
    result = cadt_terrain("tin", "scan.laz", "t.ply", "--breaklines", name)
    assert "warning: nodata.gpkg: feature 1 (counted from 0) has the height -9999 at 500020 5400050; " in result.err
    dike = shapely.LineString([(*(AT + [20, 50]), 330), (*(AT + [80, 50]), 330)])
    assert "warning" not in cadt_terrain("tin", "scan.laz", "t.ply", "--breaklines", write(tmp_path / "dike.gpkg", [dike])).err


@pytest.mark.parametrize("command, out", [("raster", "t.tif"), ("contour", "t.gpkg"), ("tin", "t.ply")])
def test_an_option_that_is_given_twice_is_refused(las, tmp_path, cadt_terrain, command, out):
    las("scan.laz", scattered())
    for words in (["--breaklines", "a.gpkg", "--breaklines=b.gpkg"], ["--class", "2", "--class", "9"], ["-o", out, "--output", out]):
        result = cadt_terrain(command, "scan.laz", *words, code=2)
        assert f"error: {words[2].split('=')[0]} is given twice; see: cadt {command} --help" in result.err


def test_what_takes_segments_instead_is_told(las, tmp_path, cadt_terrain):
    las("scan.laz", scattered())
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 1 0\nl 1 2\n")
    name = write(tmp_path / "banks.gpkg", [bank(40)])
    cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--segments", "a.obj", code=2, says="lines are read by --breaklines")
    cadt_terrain("raster", "scan.laz", "dem.asc", "--res", "1", "--breaklines", name, code=2, says=".png take --segments")


def test_several_heights_at_a_place(las, tmp_path, cadt_terrain):
    """Two lakes that share the corners (60, 20) and (60, 40), and the cells between these, in either order."""
    las("scan.laz", np.array([[*AT, 0], *([x, y, 0] for x, y in AT + [[100, 0], [0, 100], [100, 100]])]))

    def lake(x: float, height: float | None) -> shapely.Polygon:
        corners = AT + [[x, 20], [x + 20, 20], [x + 20, 40], [x, 40]]
        return shapely.Polygon(corners if height is None else [(*corner, height) for corner in corners])

    def run(*lakes: shapely.Geometry) -> tuple[str, float]:
        name = write(tmp_path / "lakes.geojson", lakes)
        err = cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines", name).err
        with rasterio.open(tmp_path / "dem.tif") as raster:
            return err, float(raster.read(1)[raster.index(*(AT + [59.5, 30.5]))])

    west, east = lake(40, 5), lake(60, 7)
    at = "500060 5400020"
    err, height = run(west, east)
    assert f"warning: lakes.geojson: the features 0 and 1 (counted from 0) have the heights 5 and 7 at {at}" in err
    assert "and so it is at 1 more place; the first in the file counts" in err  # a ring ends where it began
    assert height == 5
    err, height = run(east, west)
    assert "have the heights 7 and 5 at" in err and height > 6.9
    for same in ((west, lake(60, 5)), (lake(40, None), lake(60, None)), (west,), (lake(40, None),)):
        assert "warning" not in run(*same)[0]
    err, height = run(lake(40, None), east)
    assert "have the heights 0 and 7 at" in err and height == 0
    corners = AT + [[9, 9], [9, 5], [5, 5], [9, 9]]
    err, _ = run(shapely.LineString(np.column_stack([corners, [1, 1, 1, 2]])))
    assert "feature 0 (counted from 0) has the heights 1 and 2 at 500009 5400009; the first in the file counts" in err


def test_heights_of_points_on_segments(las, tmp_path, cadt_terrain):
    """A point of another line keeps its height, with a warning; one of the cloud gets the line's, if that has heights."""
    corners = [[0, 0, 0], [100, 0, 0], [0, 100, 0], [100, 100, 0]]
    las("scan.laz", np.array([*corners, [40, 50, 77]]) + [*AT, 0])

    def line(*places: tuple[float, ...]) -> shapely.LineString:
        return shapely.LineString([(AT[0] + x, AT[1] + y, *z) for x, y, *z in places])

    def run(*lines: shapely.Geometry) -> tuple[str, np.ndarray]:
        name = write(tmp_path / "lines.gpkg", lines)
        err = cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines", name).err
        with rasterio.open(tmp_path / "dem.tif") as raster:
            return err, raster.read(1)

    slope = line((0, 50, 0), (100, 50, 10))
    err, cells = run(slope)
    assert "warning" not in err
    assert np.abs(cells[50] - (np.arange(100) + 0.5) / 10).max() < 0.2  # half a cell away
    assert run(line((0, 50), (100, 50)))[1].max() > 70  # without heights
    on = line((70, 50, 7), (70, 90, 0))
    assert "warning" not in run(slope, on)[0]
    above, beside = line((20, 50, 9), (20, 90, 0)), line((60, 50, 6.5), (60, 10, 0))
    err, _ = run(slope, above, beside)
    assert (
        "warning: lines.gpkg: feature 1 (counted from 0) has the height 9 at 500020 5400050, on a segment of feature 0 with "
        "the height 2 there; 1 more place differs by no more; the point keeps its height" in err
    )
    err, _ = run(line((0, 50, 0), (0, 80, 0)), slope, line((50, 50, 9), (50, 90, 0)))  # two that begin at one place
    assert "feature 2 (counted from 0) has the height 9 at 500050 5400050, on a segment of feature 1 with the height 5" in err
    low = line((0, 50, 0), (100, 50, 1))
    assert run(slope, low)[1][50].max() > 9 > run(low, slope)[1][50, 60]
    err, _ = run(slope, line((30, 50, 3), (60, 50, 0), (80, 50, 8)))  # along it
    assert "feature 1 (counted from 0) has the height 0 at 500060 5400050, on a segment of feature 0 with" in err


def test_lines_outside_of_the_points(las, tmp_path, cadt_terrain):
    las("scan.laz", scattered())

    def run(*lines: shapely.Geometry) -> tuple[str, np.ndarray]:
        name = write(tmp_path / "lines.gpkg", lines)
        err = cadt_terrain("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines", name, "--bounds", BOUNDS).err
        with rasterio.open(tmp_path / "dem.tif") as raster:
            return err, raster.read(1)

    away = shapely.LineString(AT + [[150, 0], [150, 90]])
    err, alone = run(away, bank(40))
    assert "warning: lines.gpkg: 1 of its 2 lines lie outside of the points' extent and are left out" in err
    assert "breaklines  1, with 3 points" in err
    assert np.array_equal(alone, run(bank(40))[1])
    err, _ = run(away)
    assert "none of its lines reaches into the points' extent, all are left out: is its reference system" in err
    assert "breaklines  0, with 0 points" in err
    err, cells = run(shapely.LineString(AT + [[50, 50], [150, 50]]))
    assert "warning" not in err and (cells != -9999).sum() > (alone != -9999).sum()


def test_contour_lines_follow_them(las, tmp_path, cadt_terrain):
    """Straight along the ditch, half way down its slopes."""
    las("scan.laz", scattered())
    name = write(tmp_path / "banks.gpkg", [bank(40), bank(50), bank(60)])

    def off(*words: str) -> float:
        err = cadt_terrain("contour", "scan.laz", "lines.gpkg", "--interval", "10", "--base", "295", *words).err
        assert ("breaklines  3, with 9 points; heights of the file" in err) == bool(words)
        x, y = (shapely.get_coordinates(geopandas.read_file(tmp_path / "lines.gpkg").geometry) - AT).T
        inner = (x > 10) & (x < 90)
        assert not words or set(np.round(y[inner])) == {45, 55}
        return float(np.abs(np.abs(y[inner] - 50) - 5).max())

    assert off() > 2
    assert off("--breaklines", name) < 0.01  # heights of the scan are whole millimetres
    cadt_terrain("contour", "scan.laz", "banks.gpkg", "--interval", "1", "--breaklines", name, code=2, says="this is an input")
    cadt_terrain("contour", "scan.laz", "l.gpkg", "--interval", "1", "--breaklines", "a.dxf", code=2, says="gpkg")


def test_tin_has_them_as_edges(las, tmp_path, cadt_terrain):
    points = scattered()
    las("scan.laz", points)
    flat = shapely.LineString(AT + [[5, 5], [95, 12]])  # without heights
    name = write(tmp_path / "banks.gpkg", [bank(40), bank(50), bank(60), flat])
    err = cadt_terrain("tin", "scan.laz", "o.ply", "--breaklines", name).err
    assert f"points      {len(points)}\nbreaklines  4, with 11 points; heights of the file, but 2 from the points" in err
    vertices, corners = read_ply((tmp_path / "o.ply").read_bytes())
    assert len(vertices) == 11 + len(points)
    assert np.array_equal(vertices[:9], [xyz for y in (40, 50, 60) for xyz in bank(y).coords])
    assert np.abs(vertices[11:] - points).max() < 1e-3
    mesh = cadt.ConstrainedDelaunay(vertices[:, :2], polylines=[0, 3, 6, 9, 11])
    assert np.array_equal(corners, mesh.simplices)
    edges = {frozenset(pair) for k in range(3) for pair in np.roll(corners, k, axis=1)[:, :2].tolist()}
    assert {frozenset((i, i + 1)) for i in (0, 1, 3, 4, 6, 7)} <= edges
    cadt_terrain("tin", "scan.laz", "short.ply", "--breaklines", name, "--max-edge", "20")
    assert 0 < len(read_ply((tmp_path / "short.ply").read_bytes())[1]) < len(corners)
    cadt_terrain("tin", "scan.laz", "o.gpkg", "--breaklines", name)
    polygons = geopandas.read_file(tmp_path / "o.gpkg").geometry
    assert len(polygons) == len(corners) and polygons.area.sum() == pytest.approx(10_000)
    cadt_terrain("tin", "scan.laz", "banks.gpkg", "--breaklines", name, code=2, says="this is an input")
    cadt_terrain("tin", "scan.laz", "o.ply", "--breaklines", "missing.shp", code=3, says="cannot be opened")
    np.savetxt(tmp_path / "row.xyz", np.column_stack([np.arange(4), np.zeros((4, 2))]) + [*AT, 0])
    row = write(tmp_path / "row.gpkg", [shapely.LineString([(*AT, 0), (*(AT + [3, 0]), 1)])])
    words = ("--crs", "EPSG:25832", "--breaklines", row)
    cadt_terrain("tin", "row.xyz", "o.ply", *words, code=3, says="no triangles: the 4 points are fewer than three")


def test_what_is_refused(las, tmp_path, cadt_terrain):
    las("scan.laz", scattered())
    across = shapely.LineString([AT + [37, 20], AT + [37, 80]])
    name = write(tmp_path / "cross.gpkg", [bank(40), bank(60), across])
    base = ("raster", "scan.laz", "dem.tif", "--res", "1", "--breaklines")
    cadt_terrain(*base, name, code=3, says="features 0 and 2 cross at 500037 5400040, features 1 and 2 cross at 500037 5400060 (")
    name = write(tmp_path / "self.gpkg", [bank(40), shapely.LineString(AT + [[1, 1], [9, 9], [9, 1], [1, 9]])])
    cadt_terrain(*base, name, code=3, says="feature 1 crosses itself at 500005 5400005 (features counted from 0); breaklines")
    # Along each other but for rounding, as a line that was drawn twice.
    twice = [
        shapely.LineString([[49.8950087290269, 84.71137417358769], [59.69363076835749, 94.60659324428221]]),
        shapely.LineString([[49.89500872902691, 84.7113741735877], [59.69363076835746, 94.60659324428218]]),
    ]
    name = write(tmp_path / "twice.gpkg", twice)
    np.savetxt(tmp_path / "small.xyz", scattered() - [*AT, 0])
    small = ("raster", "small.xyz", "dem.tif", "--res", "1", "--crs", "EPSG:25832", "--breaklines")
    err = cadt_terrain(*small, name, code=3, says="features 0 and 1 cross at ").err
    x, y = (float(word) for word in err.split("cross at ")[1].split(" (")[0].split())
    assert 49 < x < 60 and 84 < y < 95
    high = shapely.LineString([[*AT, 1], [*(AT + [9, 9]), np.inf]])
    name = write(tmp_path / "high.gpkg", [bank(40), high])
    cadt_terrain(*base, name, code=3, says="feature 1 (counted from 0) has no finite coordinates")
    name = write(tmp_path / "point.gpkg", [bank(40), shapely.Point(AT)])
    cadt_terrain(*base, name, code=3, says="feature 1 (counted from 0) is neither lines nor polygons")
    name = write(tmp_path / "hole.gpkg", [None, bank(40), None, shapely.Point(AT)])
    cadt_terrain(*base, name, code=3, says="feature 3 (counted from 0) is neither lines nor polygons")
    name = write(tmp_path / "hole.gpkg", [None, bank(40), None, bank(60), across])
    cadt_terrain(*base, name, code=3, says="features 1 and 4 cross at ")
    name = write(tmp_path / "hole.gpkg", [None, bank(40), None])
    assert "breaklines  1, with 3 points" in cadt_terrain(*base, name).err
    name = write(tmp_path / "utm33.gpkg", [bank(40)], "EPSG:25833")
    cadt_terrain(*base, name, code=3, says="its reference system is ETRS89 / UTM zone 33N")
    cadt_terrain(*base, name, "--crs", "EPSG:25832")
    name = write(tmp_path / "none.shp", [bank(40)], None)
    cadt_terrain(*base, name, code=3, says="its reference system is none")
    cadt_terrain(*base, name, "--method", "natural", code=2, says="--method natural")
    cadt_terrain(*base, name, "--scratch", ".", code=2, says="--scratch")
    cadt_terrain(*base, "banks.dxf", code=2, says="gpkg")
    cadt_terrain(*base, "missing.shp", code=3, says="cannot be opened")
    (tmp_path / "bad.gpkg").write_bytes(b"no database")
    cadt_terrain(*base, "bad.gpkg", code=3, says="cannot be read")


def test_a_lake_of_a_scan(data, tmp_path, cadt_terrain):
    """The largest lake, by its water points: ground and its shore make it flat, ground alone does not."""
    scan = data("pslg/lidr_Topography.laz")
    water = read_cloud([scan], classes=[9])
    _, edges = cadt.Delaunay(water.xy).alpha_shape(12)
    parts = shapely.get_parts(shapely.polygonize([shapely.LineString(water.xy[e]) for e in edges]))
    shore = max(parts, key=lambda part: part.area).exterior
    level = float(np.median(water.z))
    lake = shapely.Polygon([(x, y, level) for x, y in shore.coords])
    name = write(tmp_path / "lake.gpkg", [lake], water.crs)
    base = ("raster", scan, "--res", "1", "--class", "2")
    cadt_terrain(*base, "-o", "plain.tif")
    cadt_terrain(*base, "-o", "dem.tif", "--breaklines", name)
    inside = {}
    for file in ("plain.tif", "dem.tif"):
        with rasterio.open(tmp_path / file) as raster:
            z, t = raster.read(1), raster.transform
        x, y = np.meshgrid(t.c + (np.arange(z.shape[1]) + 0.5) * t.a, t.f + (np.arange(z.shape[0]) + 0.5) * t.e)
        inside[file] = z[shapely.contains_xy(shapely.Polygon(lake), x, y)]
    assert len(inside["dem.tif"]) > 3000
    assert np.mean(np.abs(inside["dem.tif"] - level) < 1e-9) > 0.99
    assert np.mean(np.abs(inside["plain.tif"] - level) < 1e-9) < 0.01
