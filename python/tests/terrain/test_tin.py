# SPDX-License-Identifier: Apache-2.0
"""cadt tin: meshes and polygons, read back."""

from __future__ import annotations

import json
import struct

import cadt
import numpy as np
import pytest
from cadt import terrain
from clouds import hills


def expected(tmp_path, max_edge=None):
    cloud = terrain.read_cloud([str(tmp_path / "a.laz")])
    mesh = cadt.Delaunay(cloud.xy)
    kept = slice(None) if max_edge is None else mesh.alpha_shape(np.inf, max_edge=max_edge)[0]
    return np.column_stack((cloud.xy, cloud.z)), mesh.simplices[kept]


def read_ply(data):
    head, body = data.split(b"end_header\n", 1)
    n, t = (int(line.split()[-1]) for line in head.decode().splitlines() if line.startswith("element"))
    points = np.frombuffer(body[: 24 * n], "<f8").reshape(n, 3)
    faces = np.frombuffer(body[24 * n :], np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    assert len(faces) == t and (faces["count"] == 3).all()
    return points, faces["corners"]


def test_ply(las, tmp_path, cadt_terrain):
    las("a.laz", hills(1500))
    for options, edge in (([], None), (["--max-edge", "4"], 4.0)):
        result = cadt_terrain("tin", "a.laz", "o.ply", *options)
        points, corners = read_ply((tmp_path / "o.ply").read_bytes())
        xyz, triangles = expected(tmp_path, edge)
        assert np.array_equal(points, xyz) and np.array_equal(corners, triangles)
        assert f"triangles   {len(triangles)}\n" in result.err
    if (meshio := pytest.importorskip("meshio", reason="meshio is not installed")) is not None:
        assert np.array_equal(meshio.read(tmp_path / "o.ply").cells_dict["triangle"], triangles)


def test_glb_has_floats(tmp_path, cadt_terrain):
    places = np.random.default_rng(1).random((20, 3))
    for scale, says in ((1e39, "too large"), (1e308, "too large"), (1e-50, "too close together")):
        np.savetxt(tmp_path / "p.xyz", places * scale)
        cadt_terrain("tin", "p.xyz", "o.glb", code=3, says=f"the coordinates are {says} for the floats of a .glb")
    assert not (tmp_path / "o.glb").exists()


def test_glb(las, tmp_path, cadt_terrain):
    las("a.laz", hills(1500), crs=None)  # no reference system is needed: a .glb has none
    cadt_terrain("tin", "a.laz", "o.glb", "-q")
    data = (tmp_path / "o.glb").read_bytes()
    magic, version, size = struct.unpack("<4sII", data[:12])
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON" and length % 4 == 0
    about = json.loads(data[20 : 20 + length])
    size, kind = struct.unpack("<I4s", data[20 + length : 28 + length])
    body = data[28 + length :]
    assert kind == b"BIN\0" and size == len(body) == about["buffers"][0]["byteLength"]
    views, accessors = about["bufferViews"], about["accessors"]
    position = np.frombuffer(body[: views[0]["byteLength"]], "<f4").reshape(-1, 3)
    index = np.frombuffer(body[views[1]["byteOffset"] :], "<u4").reshape(-1, 3)
    xyz, triangles = expected(tmp_path)
    assert (
        np.array_equal(index, triangles) and accessors[1]["count"] == index.size and accessors[0]["count"] == len(xyz)
    )
    x, up, back = (position + np.array(about["nodes"][0]["translation"])).T
    assert np.allclose(np.column_stack((x, -back, up)), xyz, atol=1e-4, rtol=0)
    assert position.min(axis=0).tolist() == accessors[0]["min"] and position.max(axis=0).tolist() == accessors[0]["max"]


@pytest.mark.parametrize("suffix", ["gpkg", "fgb"])
def test_polygons(las, tmp_path, cadt_terrain, suffix):
    geopandas = pytest.importorskip("geopandas", reason="geopandas is not installed: scripts/python_env terrain")
    import shapely

    las("a.laz", hills(400))
    cadt_terrain("tin", "a.laz", f"o.{suffix}", "--max-edge", "20")
    table = geopandas.read_file(tmp_path / f"o.{suffix}")
    xyz, triangles = expected(tmp_path, 20.0)
    assert table.crs.to_epsg() == 25832 and len(table) == len(triangles)
    rings = shapely.get_coordinates(table.geometry, include_z=True).reshape(-1, 4, 3)
    assert (rings[:, 0] == rings[:, 3]).all()
    order = {tuple(sorted(map(tuple, xyz[t].tolist()))) for t in triangles}
    assert {tuple(sorted(map(tuple, ring[:3].tolist()))) for ring in rings} == order
    assert np.allclose(table["elevation"], rings[:, :3, 2].mean(axis=1))
    assert table.area.min() > 0


def test_what_is_refused(las, tmp_path, cadt_terrain):
    las("a.laz", hills(100))
    for suffix in ("glb", "ply", "gpkg"):
        short = "a.laz: every triangle has an edge longer than --max-edge 0.001; take a larger one"
        cadt_terrain("tin", "a.laz", f"o.{suffix}", "--max-edge", "0.001", code=3, says=short)
    with pytest.raises(terrain.UsageError, match="there are no triangles"):
        terrain.write_tin("o.glb", terrain.read_cloud(["a.laz"]), np.empty((0, 3), np.int32))
    las("none.laz", hills(100), crs=None)
    cadt_terrain(
        "tin", "a.laz", "o.stl", code=2, says="unknown suffix '.stl'; end the output's name in one of: ply, glb"
    )
    cadt_terrain("tin", "none.laz", "o.gpkg", code=3, says="no reference system")
    cadt_terrain("tin", "none.laz", "o.ply")
    cadt_terrain("tin", "a.laz", "/proc/o.ply", code=3, says="/proc/o.ply: cannot be written")
