# SPDX-License-Identifier: Apache-2.0
"""cadt raster --scratch: the cells are those of one mesh in memory, and neither memory nor the folder keeps anything."""

from __future__ import annotations

import argparse
import os
import pathlib
import resource
import signal
import struct
import subprocess
import sys
import time

import cadt
import numpy as np
import pytest
import rasterio
from cadt import _cadt, _devices, terrain
from cadt.terrain._buckets import Buckets
from cadt.terrain._mesh import rasterize
from cadt.terrain._progress import ProgressLine
from cadt.terrain.grid import Grid
from clouds import PACKAGES, hills, hull_on_centres, lattice, many

pytest.importorskip("cadt.tiles", reason="this build has no tiles")
from cadt.terrain import _scratch as scratch
from cadt.terrain import _store
from cadt.terrain._blocks import Blocks


def stored(
    folder: pathlib.Path, xyz: np.ndarray, grid: Grid, tile_points: int, max_edge: float | None = None
) -> np.ndarray:
    """The raster through files of a folder."""
    np.save(folder / "points.npy", xyz)
    options = argparse.Namespace(
        inputs=[str(folder / "points.npy")], classes=None, values="z", columns="", crs="none", dtype="float64",
        max_edge=max_edge, tile_points=tile_points, backend="host", device=None, threads=1,
    )  # fmt: skip
    with scratch.folder_in(str(folder)) as own:
        way = scratch.InScratch(options, ProgressLine(quiet=True), own)
        rows, _ = way.rows(way.read(), grid)
        cells = np.concatenate(list(rows))
    assert os.listdir(folder) == ["points.npy"]
    return cells


def in_memory(xyz: np.ndarray, grid: Grid, max_edge: float | None = None) -> np.ndarray:
    points = Buckets(terrain.Cloud(xyz[:, :2].copy(), xyz[:, 2].copy(), None))
    return rasterize(cadt.Delaunay(points.xy, backend="host"), points.z, grid, max_edge=max_edge)


def check(folder: pathlib.Path, xyz: np.ndarray, grid: Grid, tile_points: int, max_edge: float | None = None) -> None:
    whole, cells = in_memory(xyz, grid, max_edge), stored(folder, xyz, grid, tile_points, max_edge)
    assert np.array_equal(np.isnan(cells), np.isnan(whole)), np.argwhere(np.isnan(cells) != np.isnan(whole))[:5]
    assert np.nanmax(np.abs(cells - whole), initial=0) < 1e-9


def with_heights(xy: np.ndarray) -> np.ndarray:
    return np.column_stack((xy, np.random.default_rng(2).uniform(0, 10, len(xy))))


def whole_cells(xy: np.ndarray) -> Grid:
    """About 150 cells along the longer side; corners and sizes are such that all centres are exact."""
    (x0, y0), (x1, y1) = np.floor(xy.min(axis=0)), np.ceil(xy.max(axis=0))
    size = 2.0 ** np.round(np.log2(max(x1 - x0, y1 - y0) / 150))
    columns, rows = int((x1 - x0) // size) + 2, int((y1 - y0) // size) + 2
    return Grid(x0 - size, y0 + rows * size, size, size, columns + 2, rows + 1)


@pytest.mark.parametrize("name", many())
@pytest.mark.parametrize("max_edge", [None, 3.0])
def test_the_raster_is_that_of_one_mesh(tmp_path, name, max_edge):
    xy = np.round(many()[name], 3) + [500_000, 5_400_000]
    for tile_points in (50, 900):
        check(tmp_path, with_heights(xy), whole_cells(xy), tile_points, max_edge)


@pytest.mark.parametrize("tile_points", [3, 50, 700])
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.thorough) for k in (1, 2, 3))])
def test_centres_on_vertices_and_edges(tmp_path, tile_points, seed):
    """Integer points with gaps, and centres at integers and halves: most lie on vertices or edges, many between tiles, and
    edges of length 2 and more are left out beside others that are kept."""
    random = np.random.default_rng(seed)
    xy = lattice(30, 25)[random.random(750) < 0.6]
    xyz = with_heights(xy[random.permutation(len(xy))])
    for size in (1.0, 0.25):  # in one block, and in four
        grid = Grid(-1 - size / 2, 26 + size / 2, size, size, int(32 / size), int(28 / size))
        for max_edge in (None, 1.5, 2.0):
            check(tmp_path, xyz, grid, tile_points, max_edge)


REAL = (
    "ahn_small.xy",
    "autzen_trim.f64",
    "baja_bathymetry.xy",
    "cdt_sweden_with_duplicate_points.xy",
    "delaunator_grid.xy",
)


@pytest.mark.parametrize("name", REAL)
def test_real_sets(tmp_path, data, name):
    path = data(f"real/{name}")
    xy = np.fromfile(path).reshape(-1, 2) if name.endswith(".f64") else np.loadtxt(path)
    folder = tmp_path / "scratch"  # the set may be unpacked beside it
    folder.mkdir()
    check(folder, with_heights(xy), whole_cells(xy), max(len(xy) // 30, 50))
    check(folder, with_heights(xy), whole_cells(xy), max(len(xy) // 30, 50), np.ptp(xy[:, 0]) / 40)


def test_on_a_device(las, cadt_terrain):
    if not any(device.backend == "opencl" and device.usable for device in cadt.devices()):
        pytest.skip("no OpenCL device")
    las("a.laz", hills(3000))
    words = ["a.laz", "--res", "1", "--max-edge", "9", "--scratch", ".", "--tile-points", "900"]
    cells, _, said = of_command(cadt_terrain, *words, "--backend", "opencl")
    assert "back end    opencl, 4 tiles" in said
    assert np.allclose(cells, of_command(cadt_terrain, *words, "--backend", "host")[0], atol=1e-9, rtol=0)


def test_an_equal_point_that_comes_first_gives_the_value(tmp_path):
    """Of equal points with different values, wherever they are in the files."""
    xy = np.random.default_rng(4).integers(0, 12, (3000, 2)).astype(float)
    xyz = np.column_stack((xy, np.arange(3000.0)))
    grid = Grid(-0.5, 11.5, 1, 1, 12, 12)
    first = np.full((12, 12), np.nan)
    first[11 - xy[::-1, 1].astype(int), xy[::-1, 0].astype(int)] = xyz[::-1, 2]
    assert np.array_equal(stored(tmp_path, xyz, grid, 40), first)


def test_a_block_is_read_as_it_was_written(tmp_path):
    """Rows of a grid that is no multiple of the blocks, of which some are never written."""
    grid = Grid(3.0, 7.0, 0.5, 0.25, 150, 1100)
    blocks = Blocks(grid, 64, str(tmp_path / "cells"), "float32")
    expected = np.full((1100, 150), np.nan, np.float32)
    for number in (0, 7, 30, blocks.nx * blocks.ny - 1):
        block = blocks.block(number)
        cells = np.random.default_rng(number).normal(size=(block.grid.rows, block.grid.columns))
        blocks.write(block, cells, cells > 0)
        part = expected[block.grid.first_row :, block.grid.first_column :][: block.grid.rows, : block.grid.columns]
        part[cells > 0] = cells[cells > 0]
        assert block.grid.corner == grid.corner
    strips = list(blocks.rows())
    assert [len(s) for s in strips] == [512, 512, 76] and strips[0].dtype == np.float32
    assert np.array_equal(np.concatenate(strips), expected, equal_nan=True)


@pytest.mark.parametrize("column", [65, 131])
@pytest.mark.parametrize("max_edge", [None, 30.0])
def test_a_hull_on_centres_of_cells(tmp_path, column, max_edge):
    """They are the same doubles in all blocks, so that a column is within the hull or not."""
    grid = Grid(500_000.3, 5_400_006.7, 0.1, 0.1, 140, 60)
    check(tmp_path, with_heights(hull_on_centres(grid, column)), grid, 40, max_edge)


@pytest.mark.parametrize("size", [1e-160, 1e-110, 1e110])
def test_the_smallest_and_largest_coordinates(tmp_path, size):
    xy = np.random.default_rng(0).uniform(0, 1, (1500, 2))
    xy = size * xy[np.hypot(*(xy - 0.5).T) > 0.25]
    check(tmp_path, with_heights(xy), Grid(0, size, size / 150, size / 150, 150, 150), 60)


def of_command(cadt_terrain, *words) -> tuple[np.ndarray, dict, str]:
    said = cadt_terrain("raster", *words, "-o", "one.tif").err
    with rasterio.open("one.tif") as raster:
        return raster.read(1), {**raster.profile, "overviews": raster.overviews(1)}, said


@pytest.mark.parametrize(
    "options",
    [
        ["--res", "0.5"],
        ["--res", "0.5", "--class", "2", "--max-edge", "6", "--nodata", "nan", "--dtype", "float32"],
        ["--res", "2", "--bounds", "500010,5400020,500160,5400080.5", "--values", "intensity"],
        ["--align", "grid.tif", "--threads", "2", "--backend", "host"],
    ],
)
def test_the_file_is_that_without_scratch(las, tmp_path, cadt_terrain, options):
    points = hills(12_000)
    las("a.laz", points[:5000], classes=np.arange(5000) % 3)
    las("b.las", points[5000:], classes=np.arange(7000) % 3)
    cadt_terrain("raster", "a.laz", "grid.tif", "--res", "3", "--bounds", "499990.25,5400005.5,500100,5400200")
    whole, about, said = of_command(cadt_terrain, "a.laz", "b.las", *options)
    cells, same, told = of_command(cadt_terrain, "a.laz", "b.las", *options, "--scratch", ".", "--tile-points", "700")
    assert repr(about) == repr(same)  # nan is not nan
    blank = np.isnan(whole) if np.isnan(about["nodata"]) else whole == about["nodata"]
    assert np.array_equal(np.isnan(cells) if np.isnan(about["nodata"]) else cells == about["nodata"], blank)
    assert 0 < blank.sum() < blank.size
    assert np.abs(cells - whole)[~blank].max() < (1e-4 if about["dtype"] == "float32" else 1e-9)
    keep = lambda text: [line for line in text.splitlines() if not line.startswith(("time", "back end"))]
    assert keep(said) == keep(told) and "back end    host, " in told
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.laz", "b.las", "grid.tif", "one.tif"]


@pytest.mark.parametrize(
    ("options", "code", "says"),
    [
        (["--scratch", "no"], 3, "no: is no folder: --scratch names one"),
        (["--scratch", "/proc"], 3, "/proc: cannot be written"),
        (["--tile-points", "100"], 2, "--tile-points is for --scratch"),
        (["--scratch", ".", "--tile-points", "2"], 2, "--tile-points 2: at least 3"),
        (["--scratch", ".", "--tile-points", "many"], 2, "--tile-points"),
        (
            ["--scratch", ".", "--method", "natural"],
            2,
            "--method natural: with --scratch a tile is drawn and forgotten",
        ),
        (["--scratch", ".", "--method", "nearest"], 2, "use --method linear, or leave out --scratch"),
        (["--scratch", ".", "--fill", "nearest"], 2, "--fill nearest: the nearest point of a cell may be in any tile"),
        (["--scratch", ".", "--class", "9"], 3, "a.laz: no point is of class 9"),
        (["--scratch", ".", "--backend", "cuda", "--device", "99"], 5, "cadt: error"),
        (["--scratch", ".", "--nodata", "5"], 3, "a cell has the value 5"),
        (["--scratch", ".", "--bounds", "0,0,1e9,1e9"], 2, "at most 4294967295"),
    ],
)
def test_what_is_refused_leaves_nothing(las, cadt_terrain, options, code, says):
    las("a.laz", [(500_000 + x, 5_400_000 + y, 5) for x in range(5) for y in range(5)])
    cadt_terrain("raster", "a.laz", "dem.tif", "--res", "1", *options, code=code, says=says)


def test_points_that_are_refused(las, tmp_path, cadt_terrain):
    words = ["dem.tif", "--res", "1", "--scratch", "."]
    las("line.laz", [(500_000 + k, 5_400_000 + k, 1) for k in range(50)])
    cadt_terrain(
        "raster", "line.laz", *words, "--tile-points", "8", code=3, says="line.laz: no triangles: the 50 points"
    )
    las("two.laz", hills(2))
    cadt_terrain("raster", "two.laz", *words, code=3, says="two.laz: no triangles: the 2 points")
    whole = bytearray(pathlib.Path(las("a.las", hills(900))).read_bytes())
    (tmp_path / "cut.las").write_bytes(whole[:-3000])
    cadt_terrain("raster", "cut.las", *words, code=3, says="cut.las: ")
    whole[131:139] = struct.pack("<d", 1e308)  # the scale of x
    (tmp_path / "far.las").write_bytes(whole)
    cadt_terrain("raster", "far.las", *words, code=3, says="coordinates must be finite")
    las("none.laz", hills(300), crs=None)
    cadt_terrain("raster", "none.laz", *words, code=3, says="none.laz: no reference system is said")


def test_a_disk_without_room_is_told_before_any_work(las, cadt_terrain, monkeypatch):
    las("a.laz", hills(900))
    free = 900 * 56
    room = lambda path: argparse.Namespace(total=1 << 40, free=free if "cadt-raster-" in path else 1 << 40)
    monkeypatch.setattr(_store.shutil, "disk_usage", room)
    words = ["raster", "a.laz", "dem.tif", "--scratch", "."]
    asks = "may need 0.0 GiB in the scratch folder, its disk has 0.0 GiB: name a folder of another one"
    cadt_terrain(*words, "--res", "0.1", code=3, says=f"900 points and 998 x 1000 cells {asks}")
    free -= 1
    cadt_terrain(*words, "--res", "50", code=3, says=f"900 points {asks}")


def test_a_full_disk_names_the_file(las, tmp_path):
    las("a.las", hills(60_000))
    before = sorted(tmp_path.iterdir())
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))  # bytes of a file
    done = run_limited(tmp_path, "", ["a.las", "o.tif", "--res", "20", "--scratch", "."], preexec_fn=limit)
    assert done.returncode == 3 and "/points: cannot be written: File too large" in done.stderr
    assert sorted(tmp_path.iterdir()) == before


def run_limited(folder: pathlib.Path, before: str, words: list[str], **how) -> subprocess.CompletedProcess[str]:
    """cadt raster in a process of its own, `before` being done when all is imported."""
    code = (
        "import sys, resource, rasterio, laspy, pyproj, cadt.terrain.raster, cadt.terrain._scratch\n"
        f"from cadt.terrain.__main__ import command\n{before}\nsys.exit(command(['raster', *sys.argv[1:]]))"
    )
    environment = {**os.environ, "PYTHONPATH": PACKAGES, "MALLOC_ARENA_MAX": "1"}
    return subprocess.run(
        [sys.executable, "-c", code, *words], cwd=folder, capture_output=True, text=True, env=environment, check=False, **how
    )  # fmt: skip


@pytest.mark.thorough
def test_memory_is_that_of_a_tile(las, tmp_path):
    """288 MB of points in 250 MB."""
    las("a.las", hills(3_000_000, size=1000.0))
    limit = (
        "used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (used + 250_000_000,) * 2)"
    )
    words = [*["a.las"] * 4, "o.tif", "--res", "4", "--threads", "1", "--backend", "host"]
    refused = run_limited(tmp_path, limit, words)
    assert refused.returncode == 6 and "cadt raster needs less with --scratch" in refused.stderr
    done = run_limited(tmp_path, limit, [*words, "--scratch", ".", "--tile-points", "100000"])
    assert done.returncode == 0, done.stderr
    assert "points      12000000\n" in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.las", "o.tif"]


@pytest.mark.parametrize("phase", ["points", pytest.param("leaves", marks=pytest.mark.thorough), "cells"])
def test_interruption_removes_the_folder(las, tmp_path, phase):
    las("a.las", hills(1_200_000, size=1000.0))
    process = subprocess.Popen(
        [sys.executable, "-m", "cadt.terrain", "raster", "a.las", "o.tif", "--res", "0.5", "--scratch", ".", "--tile-points", "5000"],
        cwd=tmp_path, stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": PACKAGES},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )  # fmt: skip
    end = time.monotonic() + 100
    # A file with something in it: the one of cells is made first.
    while not any(file.stat().st_size > 0 for file in tmp_path.glob(f"cadt-raster-*/{phase}")):
        assert time.monotonic() < end and process.poll() is None
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=400)[1]
    assert process.returncode == 130 and said == "cadt: interrupted\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a.las"]


def test_a_part_with_two_fans_at_a_vertex():
    """Two triangles with a vertex in common and nothing between them: what a tile may be left with."""
    xy = np.array([[0.0, 0], [4, 0], [0, 4], [-4, 0], [0, -4]])
    triangles = np.array([[0, 1, 2], [0, 3, 4]], np.int32)
    part = _cadt.PartRaster(xy, triangles, np.array([[-2, -3, -1], [-4, -5, -1]], np.int32), host())
    corner = (-4.5, 4.5, 1.0, -1.0)
    cells = part.rasterize(corner, 9, 9, np.array([1.0, 2, 3, 4, 5]), np.inf)
    x, y = np.meshgrid(np.arange(-4, 5), np.arange(4, -5, -1))
    inside = (x * y >= 0) & (abs(x + y) <= 4) & ((x + y == 0) <= (x == 0))
    assert np.array_equal(~np.isnan(cells), inside) and cells[4, 4] == 1
    found, lowest, edges = part.rim(corner, 9, 9)
    rim = inside & ((x == 0) | (y == 0) | (abs(x + y) == 4))
    assert set(found.tolist()) == set(np.flatnonzero(rim))
    centre = found == 4 * 9 + 4
    assert centre.sum() == 4 and (lowest[centre] == 0).all() and (edges[centre] == 0).all()
    first = (x >= 0) & (y >= 0)  # quadrant
    assert np.array_equal(lowest == 0, first.ravel()[found])
    assert part.blocks(corner, 9, 9, 3).tolist() == [[0, 1, 1], [1, 1, 1], [1, 1, 0]]
    dropped = part.rasterize(corner, 9, 9, np.ones(5), 4.0)
    assert np.isnan(dropped).all(), "the longest edges are longer"


@pytest.mark.parametrize(
    "triangle", [[(0, 0), (10, 0), (0, 10)], [(1, 1), (11, 6), (6, 11)], [(0, 3), (9, 0), (12, 12)]]
)
def test_a_rim_is_that_of_each_window(triangle):
    """Cells on edges that reach far beyond a grid, which is a small part of them."""
    xy = np.array(triangle, float)
    part = _cadt.PartRaster(xy, np.array([[0, 1, 2]], np.int32), np.full((1, 3), -1, np.int32), host())
    on = np.zeros((13, 13), bool)  # row y, column x
    for (ax, ay), (bx, by) in zip(triangle, triangle[1:] + triangle[:1], strict=True):
        for y, x in np.ndindex(on.shape):
            level = (bx - ax) * (y - ay) == (by - ay) * (x - ax)
            on[y, x] |= level and min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by)
    assert on.sum() >= 6
    for side in (1, 3, 13):
        for y, x in np.ndindex(14 - side, 14 - side):
            cells, triangles, _ = part.rim((-0.5, -0.5, 1.0, 1.0), side, side, x, y)
            assert set(cells.tolist()) == set(np.flatnonzero(on[y : y + side, x : x + side])) and not triangles.any()


def test_indices_of_a_part_are_checked():
    xy = np.zeros((3, 2))
    for triangles, neighbors in (
        ([[0, 1, 3]], [[-1, -1, -1]]),
        ([[0, 1, -1]], [[-1, -1, -1]]),
        ([[0, 1, 2]], [[1, -1, -1]]),
    ):
        with pytest.raises(cadt.InputError, match="triangle 0 has an index out of range"):
            _cadt.PartRaster(xy, np.array(triangles, np.int32), np.array(neighbors, np.int32), host())


def host() -> _cadt.Options:
    return _devices.make_options("host", None, "canonical", 1, None, "none")
