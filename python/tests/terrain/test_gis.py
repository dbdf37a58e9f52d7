# SPDX-License-Identifier: Apache-2.0
"""GIS files: names that GDAL would read otherwise, what has no points or no numbers, and files that are not complete."""

from __future__ import annotations

import decimal
import os
import resource
import subprocess
import sys

import cadt
import geopandas
import numpy as np
import pandas
import pyogrio
import pytest
import shapely
from cadt import terrain
from clouds import PACKAGES, hills

OTHERS = ("survey!new", "survey;new", "survey\tnew", "survey\nnew")


def square(path, depth: float, **more: object) -> None:
    points = shapely.points([[0, 0], [10, 0], [10, 10], [0, 10]])
    frame = geopandas.GeoDataFrame({"depth": [depth] * 4, **more}, geometry=points, crs="EPSG:25832")
    if path.suffix == ".parquet":
        frame.to_parquet(path)
    else:
        frame.to_file(path)


@pytest.mark.parametrize("name", OTHERS)
def test_a_name_that_is_taken_for_another_is_refused(las, tmp_path, cadt_terrain, name):
    for other in ("new", "survey", "surveynew"):
        square(tmp_path / f"{other}.gpkg", 99.0)
    os.rename(tmp_path / "new.gpkg", tmp_path / f"{name}.gpkg")
    square(tmp_path / "new.gpkg", 1.0)
    las("a.laz", hills(100))
    says = f"{name}.gpkg: GDAL takes this name for another one; use none with !, ;, tabs or line breaks"
    cadt_terrain("raster", f"{name}.gpkg", "o.tif", "--values", "depth", "--res", "5", code=3, says=says)
    cadt_terrain("raster", "a.laz", "o.tif", "--res", "5", "--breaklines", f"{name}.gpkg", code=3, says=says)
    for folder in (name, name[-3:]):
        (tmp_path / folder).mkdir(exist_ok=True)
    (tmp_path / "link.gpkg").symlink_to(f"{name}.gpkg")
    for output in (*([] if ";" in name else [f"{name}/o.gpkg"]), f"{name}.fgb", "link.gpkg"):
        for command in (("contour", "--interval", "5"), ("tin",)):
            cadt_terrain(command[0], "a.laz", output, *command[1:], code=3, says="GDAL takes this name for another one")
            assert not list((tmp_path / name).iterdir()) and not list((tmp_path / name[-3:]).iterdir())
    cadt_terrain("tin", "a.laz", f"{name}.ply")  # is not GDAL's
    assert (tmp_path / f"{name}.ply").exists()


@pytest.mark.parametrize("name", [" a", "a?b", "a#b", "a%20b", "http:a", "file:a", "GPKG:a", "a.zip", "bäume"])
def test_other_names_are_read_and_written(las, tmp_path, cadt_terrain, name):
    square(tmp_path / "x.gpkg", 7.0)
    os.rename(tmp_path / "x.gpkg", tmp_path / f"{name}.gpkg")
    for path in (f"{name}.gpkg", f"/{tmp_path}/{name}.gpkg"):
        assert terrain.read_cloud([path], values="depth").z.tolist() == [7.0] * 4
    las("a.laz", hills(100))
    cadt_terrain("tin", "a.laz", f"{name}.fgb")
    assert pyogrio.read_info((tmp_path / f"{name}.fgb").read_bytes())["features"] > 100


def test_a_name_that_is_no_utf8(las, tmp_path, cadt_terrain):
    las("a.laz", hills(100))
    name = os.fsdecode(b"d\xe4mme")
    for suffix in (".gpkg", ".tif"):
        (tmp_path / (name + suffix)).write_bytes(b"")
    says = "GDAL takes no name that is not UTF-8; rename it"
    cadt_terrain("raster", name + ".gpkg", "o.tif", "--res", "5", code=3, says=says)
    for more in (["--res", "5", "--breaklines", name + ".gpkg"], ["--align", name + ".tif"]):
        cadt_terrain("raster", "a.laz", "o.tif", *more, code=3, says=says)
    cadt_terrain("raster", "a.laz", name + ".tif", "--res", "5", code=3, says=says)
    cadt_terrain("contour", "a.laz", name + ".fgb", "--interval", "5", code=3, says=says)


def test_without_a_working_directory(las, tmp_path, monkeypatch, capfd):
    from cadt.terrain.__main__ import command

    scan = las("a.laz", hills(100))
    square(tmp_path / "p.gpkg", 7.0)
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    try:
        assert command(["raster", str(tmp_path / "p.gpkg"), str(tmp_path / "o.tif"), "--values", "depth", "--res", "5"]) == 0
        assert command(["contour", scan, str(tmp_path / "o.fgb"), "--interval", "5"]) == 0
        assert capfd.readouterr().err.count("error") == 0
        for words in (["contour", scan, "o.fgb", "--interval", "5"], ["tin", scan, "o.ply"]):
            assert command(words) == 3
            assert f"{words[2]}: the working directory is not there any more" in capfd.readouterr().err
    finally:
        os.chdir(tmp_path)


def test_a_table_without_geometry(las, tmp_path, cadt_terrain):
    pyogrio.write_dataframe(pandas.DataFrame({"depth": [1.0, 2.0]}), tmp_path / "table.gpkg")
    las("a.laz", hills(100))
    cadt_terrain("raster", "table.gpkg", "o.tif", "--res", "5", code=3, says="has attributes alone, and no points")
    words = ("a.laz", "o.tif", "--res", "5", "--breaklines", "table.gpkg")
    cadt_terrain("raster", *words, code=3, says="has attributes alone, and no lines")


def test_points_with_measures(tmp_path):
    pytest.importorskip("pyarrow", reason="pyarrow is not installed: scripts/python_env terrain")
    places = [(0, 0, 1), (1, 0, 2), (0, 1, 3)]
    for kind, words in (("ZM", "{} {} {} 7"), ("Z", "{} {} {}"), ("M", "{} {} 7")):
        points = shapely.from_wkt([f"POINT {kind} ({words.format(*place)})" for place in places])
        path = tmp_path / f"{kind}.parquet"
        geopandas.GeoDataFrame({"h": [1.0, 2.0, 3.0]}, geometry=points, crs=25832).to_parquet(path)
        for values in ("z", "h") if "Z" in kind else ("h",):
            cloud = terrain.read_cloud([str(path)], values=values)
            assert np.column_stack((cloud.xy, cloud.z)).tolist() == [list(map(float, place)) for place in places]
    with pytest.raises(terrain.FileError, match="M.parquet"):  # a measure is no height
        terrain.read_cloud([str(tmp_path / "M.parquet")])


def test_columns_of_geoparquet(tmp_path):
    pytest.importorskip("pyarrow", reason="pyarrow is not installed: scripts/python_env terrain")
    path = tmp_path / "p.parquet"
    columns = {
        "text": list("1234"),
        "list": [[1.0]] * 4,
        "yes": [True] * 4,
        "maybe": pandas.array([True, False, None, True], "boolean"),
        "day": pandas.to_datetime(["2020-01-01"] * 4),
        "whole": [1, 2, 3, 4],
        "single": np.arange(1, 5, dtype=np.float32),
        "nullable": pandas.array([1, 2, 3, 4], "Int16"),
        "gap": pandas.array([1, 2, None, 4], "Int64"),
        "decimal": [decimal.Decimal(k) for k in range(1, 5)],
    }
    square(path, 1.0, **columns)
    for name in ("text", "list", "yes", "maybe", "day", "geometry"):
        with pytest.raises(terrain.FileError, match=f"the attribute {name} is no number: --values names one that is"):
            terrain.read_cloud([str(path)], values=name)
    for name in ("whole", "single", "nullable", "decimal"):
        assert terrain.read_cloud([str(path)], values=name).z.tolist() == [1, 2, 3, 4]
    with pytest.raises(terrain.FileError, match="point 2 .* has no number as 'gap'"):
        terrain.read_cloud([str(path)], values="gap")


@pytest.mark.parametrize(("output", "cut"), [("o.geojson", 2), ("o.fgb", 1), ("o.gpkg", 1), ("o.tif", 1)])
def test_a_file_that_is_cut_off_is_not_kept(las, tmp_path, output, cut):
    """A limit for files, which GDAL meets as it does a full disk. In a GeoPackage the index is last."""
    las("a.laz", hills(3000))
    more = ["--res", "0.25"] if output == "o.tif" else ["--interval", "0.1"]
    command = "raster" if output == "o.tif" else "contour"
    code = (
        "import resource, sys, laspy, rasterio, pyogrio, pyproj\nfrom cadt.terrain.__main__ import command\n"
        "size = int(sys.argv[1])\nresource.setrlimit(resource.RLIMIT_FSIZE, (size, size))\n"
        "sys.exit(command(sys.argv[2:]))"
    )
    run = lambda size: subprocess.run(
        [sys.executable, "-c", code, str(size), command, "a.laz", output, *more],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": PACKAGES},
        check=False,
    )
    assert run(resource.RLIM_INFINITY).returncode == 0
    whole = (tmp_path / output).stat().st_size
    (tmp_path / output).write_text("old")
    for size in (whole // 3, whole - cut - 1000, whole - cut):
        done = run(size)
        assert done.returncode == 3 and f"cadt: error: {output}: cannot be written: " in done.stderr
        assert (tmp_path / output).read_text() == "old"
        assert sorted(p.name for p in tmp_path.iterdir()) == ["a.laz", output]


def test_layers_that_cannot_be_made_are_errors_of_the_file(tmp_path, monkeypatch):
    def refuse(*words: object, **more: object) -> None:
        raise pyogrio.errors.DataLayerError("no layer")

    monkeypatch.setattr(pyogrio.raw, "write", refuse)
    xyz = hills(50)
    cloud = terrain.Cloud(xyz[:, :2], xyz[:, 2], None)
    with pytest.raises(terrain.FileError, match=r"o\.gpkg: cannot be written: no layer"):
        terrain.write_tin(str(tmp_path / "o.gpkg"), cloud, cadt.Delaunay(cloud.xy).simplices)
    assert not list(tmp_path.iterdir())
