# SPDX-License-Identifier: Apache-2.0
"""cadt contour: lines against matplotlib's, and what they must be."""

from __future__ import annotations

import itertools
import json

import cadt
import numpy as np
import pyogrio
import pytest
from cadt import terrain
from cadt.terrain.contour import chains
from clouds import hills


def lines_of(xy, begin):
    return [xy[a:b] for a, b in itertools.pairwise(begin)]


def length(line):
    return np.hypot(*np.diff(line, axis=0).T).sum()


def test_lengths_are_those_of_matplotlib():
    tri = pytest.importorskip("matplotlib.tri", reason="matplotlib is not installed")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    points = hills(3000, at=(0, 0))
    mesh = cadt.Delaunay(points[:, :2])
    xy, begin, level = terrain.contour_lines(mesh, points[:, 2], 2.5, base=0.3)
    levels = np.unique(level)
    assert len(levels) > 10
    triangles = tri.Triangulation(points[:, 0], points[:, 1], mesh.simplices)
    drawn = pyplot.figure().add_subplot().tricontour(triangles, points[:, 2], levels)
    for height, theirs in zip(levels, drawn.allsegs, strict=True):
        ours = [line for line, h in zip(lines_of(xy, begin), level, strict=True) if h == height]
        assert sum(map(length, ours)) == pytest.approx(sum(map(length, theirs)), rel=1e-9)
        assert len(ours) == len(theirs)
        assert sum((a[0] == a[-1]).all() for a in ours) == sum((a[0] == a[-1]).all() for a in theirs)
    pyplot.close("all")


def test_lines_are_whole_and_have_higher_ground_on_the_left():
    points = hills(2000, at=(0, 0))
    mesh = cadt.Delaunay(points[:, :2])
    xy, begin, level = terrain.contour_lines(mesh, points[:, 2], 1.0)
    assert (np.diff(level) >= 0).all() and (np.diff(begin) >= 2).all()
    hull = mesh.points[mesh.hull]
    for line, height in zip(lines_of(xy, begin), level, strict=True):
        middle = (line[1:] + line[:-1]) / 2
        assert np.allclose(mesh.interpolate(points[:, 2], middle), height, atol=1e-6)
        along = np.diff(line, axis=0)
        left = np.column_stack((-along[:, 1], along[:, 0]))
        step = middle + 1e-4 * left / np.hypot(*left.T)[:, None]
        higher = mesh.interpolate(points[:, 2], step)
        assert (np.isnan(higher) | (higher > height)).mean() > 0.99
        if not (line[0] == line[-1]).all():  # an open line ends on the hull
            for end in (line[0], line[-1]):
                a, b = hull, np.roll(hull, -1, axis=0)
                away = (b[:, 0] - a[:, 0]) * (end[1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (end[0] - a[:, 0])
                assert (np.abs(away) / np.hypot(*(b - a).T)).min() < 1e-6


def test_heights_that_are_those_of_lines():
    """Terraces, peaks and saddles at the very heights: no line is lost, none branches, none is a point."""
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0)), axis=-1).reshape(-1, 2)
    for seed in range(20):
        z = np.random.default_rng(seed).integers(0, 4, 400).astype(float)
        mesh = cadt.Delaunay(grid)
        xy, begin, level = terrain.contour_lines(mesh, z, 1.0)
        assert set(level) <= {1.0, 2.0, 3.0}
        for line in lines_of(xy, begin):
            assert len(line) >= 2 and (np.diff(line, axis=0) != 0).any(axis=1).all()
        # At a height between, no vertex is met: the same lines but for their places.
        between = terrain.contour_lines(mesh, z, 1.0, base=-0.25)
        assert len(between[2]) >= len(level)
    peak = terrain.contour_lines(mesh, np.where(np.arange(400) == 210, 1.0, 0.0), 1.0)
    assert len(peak[2]) == 0, "a line round a vertex of its height is a point"


@pytest.mark.parametrize("interval", [0.1, 0.3, 0.7, 1.1])
@pytest.mark.parametrize("base", [0.0, 0.05, 100.0])
def test_heights_whose_quotient_is_rounded(interval, base):
    """A terrace at the very height of a line, with a slope below it: the line is its rim."""
    xy = np.array([[0.0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]])
    mesh = cadt.Delaunay(xy)
    for k in range(1, 200):
        height = base + k * interval
        for z, lines in ((height, 1), (np.nextafter(height, -np.inf), 0)):
            found = terrain.contour_lines(mesh, np.tile([z - interval / 2, z, z], 2), interval, base)
            assert len(found[2]) == lines, (k, z)
            if lines:
                assert found[2][0] == height and (found[0][:, 0] == 1).all()


def test_interval_base_and_long_edges():
    xy = np.array([[0.0, 0], [10, 0], [0, 10], [10, 10]])
    mesh = cadt.Delaunay(xy)
    z = xy[:, 0]
    found = terrain.contour_lines(mesh, z, 4.0)
    assert found[2].tolist() == [4.0, 8.0]
    assert [min(map(tuple, line.tolist())) for line in lines_of(*found[:2])] == [(4.0, 0.0), (8.0, 0.0)]
    assert terrain.contour_lines(mesh, z, 4.0, base=1.0)[2].tolist() == [1.0, 5.0, 9.0]
    assert len(terrain.contour_lines(mesh, z, 4.0, max_edge=9.0)[2]) == 0
    assert len(terrain.contour_lines(mesh, np.full(4, 5.0), 4.0)[2]) == 0
    with pytest.raises(terrain.UsageError, match="--base 1e.16 is too many steps of"):  # heights are 2 apart there
        terrain.contour_lines(mesh, z + 1e16, 1.0, base=1e16)
    with pytest.raises(terrain.UsageError, match="--base 1e.17 is too many steps of"):
        terrain.contour_lines(mesh, z, 1.0, 1e17)
    with pytest.raises(terrain.UsageError, match="take a larger one"):
        terrain.contour_lines(mesh, z, 1e-12)


def test_a_height_for_each_point():
    points = hills(100, at=(0, 0))
    mesh = cadt.Delaunay(points[:, :2])
    for z in (points[:-1, 2], points, np.where(np.arange(len(points)) == 7, np.nan, points[:, 2])):
        with pytest.raises(cadt.InputError, match=rf"z must have shape \({len(points)},\): a finite height for each"):
            terrain.contour_lines(mesh, z, 2.5)


def test_chains():
    """Open ones and circles, of all lengths, against a walk."""
    random = np.random.default_rng(4)
    for _ in range(60):
        n = int(random.integers(1, 40))
        order, following = random.permutation(n), np.full(n, -1)
        cuts = np.sort(random.integers(0, n + 1, random.integers(0, 6)))
        parts = [part for part in np.split(order, cuts) if len(part)]
        circle = [bool(random.integers(2)) for _ in parts]
        for part, closed in zip(parts, circle, strict=True):
            following[part[:-1]] = part[1:]
            if closed:
                following[part[-1]] = part[0]
        key = np.zeros(n)
        for k, part in enumerate(parts):
            key[part] = k % 3
        found, begin = chains(following, key)
        got = [found[a:b].tolist() for a, b in itertools.pairwise(begin)]
        expected = []
        for part, closed in zip(parts, circle, strict=True):
            part = part.tolist()
            at = part.index(min(part)) if closed else 0
            expected.append(part[at:] + part[:at])
        expected.sort(key=lambda line: (key[line[0]], line[0]))
        assert got == expected


def test_equal_runs_write_equal_files(las, tmp_path, cadt_terrain):
    """The name of the temporary file is not in them: as in a GeoPackage, the layer is named contour."""
    las("c.laz", hills(500))
    for name in ("a.geojson", "b.geojson"):
        cadt_terrain("contour", "c.laz", name, "--interval", "5")
    text = (tmp_path / "a.geojson").read_text()
    assert text == (tmp_path / "b.geojson").read_text() and json.loads(text)["name"] == "contour"


@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "geojson"])
def test_the_file(las, tmp_path, cadt_terrain, suffix):
    geopandas = pytest.importorskip("geopandas", reason="geopandas is not installed: scripts/python_env terrain")
    points = hills(2000)
    las("a.laz", points)
    result = cadt_terrain("contour", "a.laz", f"lines.{suffix}", "--interval", "5")
    table = geopandas.read_file(tmp_path / f"lines.{suffix}")
    cloud = terrain.read_cloud([str(tmp_path / "a.laz")])
    xy, begin, level = terrain.contour_lines(cadt.Delaunay(cloud.xy), cloud.z, 5.0)
    assert pyogrio.read_info(tmp_path / f"lines.{suffix}")["geometry_type"] == "LineString"
    assert table.crs.to_epsg() == 25832 and sorted(table["elevation"]) == level.tolist()
    assert table.length.sum() == pytest.approx(sum(map(length, lines_of(xy, begin))), rel=1e-6)
    assert f"lines       {len(level)}\n" in result.err and f"heights     {level[0]:g} to {level[-1]:g}" in result.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.laz", f"lines.{suffix}"]


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["o.gpkg"], 2, "--interval"),
        (["o.gpkg", "--interval", "0"], 2, "--interval 0: a finite height above 0"),
        (["o.gpkg", "--interval", "nan"], 2, "--interval nan"),
        (["o.gpkg", "--interval", "5", "--base", "inf"], 2, "--base inf"),
        (["o.gpkg", "--interval", "5000"], 3, "a.laz: no line at 0 + k 5000: the heights are 2"),
        (["o.gpkg", "--interval", "1e-9"], 2, "--interval 1e-09: "),
        (["o.shp", "--interval", "5"], 2, "unknown suffix '.shp'; end the output's name in one of: gpkg, fgb, geojson"),
        (["no/o.gpkg", "--interval", "5"], 3, "there is no folder 'no'"),
        (["/proc/o.gpkg", "--interval", "5"], 3, "/proc/o.gpkg: cannot be written"),
        (["o.gpkg", "--interval", "5", "--max-edge", "-1"], 2, "--max-edge -1"),
        (["o.gpkg", "--interval", "5", "--max-edge", "0.001"], 3, "every triangle has an edge longer than --max-edge 0.001"),
    ],
)
def test_what_is_refused(las, cadt_terrain, words, code, says):
    las("a.laz", hills(300))
    cadt_terrain("contour", "a.laz", *words, code=code, says=says)
