# SPDX-License-Identifier: Apache-2.0
"""cadt raster: cells against SciPy, tiles against the whole, the file, and what is refused."""

from __future__ import annotations

import itertools

import cadt
import numpy as np
import pytest
import rasterio
from cadt import terrain
from cadt.terrain._buckets import Buckets
from cadt.terrain._mesh import rasterize
from cadt.terrain._tiles import TiledRaster, discs
from cadt.terrain.grid import Grid, grid_of_file, parse_bounds
from cadt.terrain.raster import rows_at_a_time
from clouds import hills, hull_on_centres, many
from rasterio.crs import CRS

NODATA = -9999.0


def centers(grid_or_raster) -> np.ndarray:
    """Of all cells, row by row."""
    r = grid_or_raster
    if isinstance(r, Grid):
        rows, columns, x0, y1, dx, dy = r.rows, r.columns, r.x0, r.y1, r.dx, r.dy
    else:
        rows, columns, t = r.height, r.width, r.transform
        x0, y1, dx, dy = t.c, t.f, t.a, -t.e
    row, column = np.divmod(np.arange(rows * columns), columns)
    return np.column_stack((x0 + (column + 0.5) * dx, y1 - (row + 0.5) * dy))


def read(path) -> tuple[np.ndarray, dict]:
    with rasterio.open(path) as raster:
        return raster.read(1), {
            "centers": centers(raster),
            **raster.profile,
            "crs": raster.crs,
            "file": raster.tags(ns="IMAGE_STRUCTURE"),
            "overviews": raster.overviews(1),
        }


@pytest.mark.parametrize("options", [[], ["--class", "2"]])
def test_cells_are_those_of_griddata(las, tmp_path, cadt_terrain, options):
    """20,000 scattered points: no four of them are on a circle."""
    interpolate = pytest.importorskip("scipy.interpolate", reason="SciPy is not installed")
    points = hills(20_000)
    classes = np.where(np.arange(len(points)) % 3, 2, 5)
    las("a.laz", points[:12_000], classes=classes[:12_000])
    las("b.laz", points[12_000:], classes=classes[12_000:])
    result = cadt_terrain("raster", "a.laz", "b.laz", "dem.tif", "--res", "0.5", *options)
    cells, about = read(tmp_path / "dem.tif")
    used = terrain.read_cloud([str(tmp_path / name) for name in ("a.laz", "b.laz")], classes=[2] if options else None)
    # Qhull's own rounding is that of the coordinates: from the middle of the points.
    middle = used.xy.mean(axis=0)
    expected = interpolate.griddata(used.xy - middle, used.z, about["centers"] - middle, method="linear").reshape(
        cells.shape
    )
    assert np.array_equal(np.isnan(expected), cells == NODATA)
    assert np.nanmax(np.abs(np.where(cells == NODATA, np.nan, cells) - expected)) < 1e-9
    assert f"points      {len(used)}\n" in result.err and "written     dem.tif" in result.err
    assert f"no data     {np.isnan(expected).sum()}\n" in result.err
    elsewhere = cadt_terrain("raster", "a.laz", "nothing.tif", "--res", "1", "--bounds=-900,-900,-890,-890")
    assert "no data     every cell: see --bounds and --max-edge\n" in elsewhere.err


def test_the_file_is_a_cog(las, tmp_path, cadt_terrain):
    las("a.laz", hills(5000, size=1000.0))
    cadt_terrain("raster", "a.laz", "dem.tif", "--res", "1", "-q")
    cells, about = read(tmp_path / "dem.tif")
    assert about["driver"] == "GTiff" and about["file"]["LAYOUT"] == "COG" and about["file"]["COMPRESSION"] == "DEFLATE"
    assert about["tiled"] and (about["blockxsize"], about["blockysize"]) == (512, 512)
    assert about["overviews"] == [2] and about["dtype"] == "float64" and about["nodata"] == NODATA
    assert about["crs"] == CRS.from_epsg(25832)
    assert (tmp_path / "dem.tif").stat().st_size < cells.nbytes
    cadt_terrain("raster", "a.laz", "f.tif", "--res", "1", "--dtype", "float32", "--nodata", "nan")
    half, about = read(tmp_path / "f.tif")
    assert about["dtype"] == "float32" and np.isnan(about["nodata"])
    assert np.array_equal(half, np.where(cells == NODATA, np.nan, cells).astype(np.float32), equal_nan=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.laz", "dem.tif", "f.tif"]


def test_a_plane_and_its_grid(las, tmp_path, cadt_terrain):
    corners = [(0, 0), (2.1, 0), (0, 0.9), (2.1, 0.9)]
    las("p.las", [(500_000 + x, 5_400_000 + y, 2 * x - 3 * y + 7) for x, y in corners])
    cadt_terrain("raster", "p.las", "-o", "p.tif", "--res", "0.3")
    cells, about = read(tmp_path / "p.tif")
    assert cells.shape == (3, 7)  # 2.1 / 0.3 is more than 7 in doubles
    x, y = (about["centers"] - [500_000, 5_400_000]).T
    assert np.allclose(cells.ravel(), 2 * x - 3 * y + 7, atol=1e-9)
    # The lower left corner is that of the points, as with the other formats of cadt raster.
    assert about["transform"].c == 500_000 and abs(about["transform"].f - 5_400_000.9) < 1e-9


def test_bounds_edges_fill_and_methods(las, tmp_path, cadt_terrain):
    square = [(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1), (9, 0, 5), (9, 1, 5)]
    las("p.laz", [(500_000 + x, 5_400_000 + y, z) for x, y, z in square])

    def row(*options):
        cadt_terrain("raster", "p.laz", "o.tif", "--res", "1", *options)
        return read(tmp_path / "o.tif")[0].tolist()

    assert row() == [[1, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75, 4.25, 4.75]]
    none = NODATA
    assert row("--max-edge", "2") == [[1] + [none] * 8]
    assert row("--max-edge", "2", "--fill", "nearest") == [[1, 1, 1, 1, 1, 5, 5, 5, 5]]
    assert row("--method", "nearest") == [[1, 1, 1, 1, 1, 5, 5, 5, 5]]
    assert row("--bounds=499998,5399999,500001,5400001.5", "--nodata=-1") == [[-1, -1, -1], [-1, -1, 1], [-1, -1, -1]]
    assert row("--bounds=499998,5399999,500001,5400001.5", "--fill", "nearest") == [[1, 1, 1]] * 3
    natural = row("--method", "natural")[0]
    assert natural[0] == 1 and all(a < b for a, b in itertools.pairwise(natural))


def test_the_cells_of_another_raster(las, tmp_path, cadt_terrain):
    las("a.laz", hills(3000))
    cadt_terrain("raster", "a.laz", "one.tif", "--res", "2", "--bounds", "500010.25,5400020.5,500060.25,5400080.5")
    cadt_terrain("raster", "a.laz", "two.tif", "--align", "one.tif", "--fill", "nearest")
    (one, first), (two, second) = read(tmp_path / "one.tif"), read(tmp_path / "two.tif")
    assert first["transform"] == second["transform"] and np.array_equal(one, two) and one.shape == (30, 25)
    cadt_terrain("raster", "a.laz", "part.tif", "--align", "one.tif", "--bounds", "500015,5400030,500021,5400041")
    part, third = read(tmp_path / "part.tif")
    assert part.shape == (7, 4) and third["transform"].c == 500014.25 and third["transform"].f == 5400042.5
    assert np.array_equal(part, one[19:26, 2:6])
    las("other.laz", hills(100), crs="EPSG:25833")
    cadt_terrain("raster", "other.laz", "x.tif", "--align", "one.tif", code=3, says="one.tif: its reference system is")
    las("heights.laz", hills(100), crs="EPSG:25832+5783")  # with heights: the same in the plane
    cadt_terrain("raster", "heights.laz", "x.tif", "--align", "one.tif")
    cadt_terrain("raster", "a.laz", "y.tif", "--align", "a.laz", code=3, says="a.laz: is no raster")


@pytest.mark.parametrize("at", [(0.0, 0.0), (500_000.0, 5_400_000.0), (-500_000.0, -5_400_000.0)])
def test_bounds_on_the_cells_of_another_raster(las, tmp_path, cadt_terrain, at):
    """Decimals are no doubles: 0.3 / 0.1 is less than 3."""
    las("a.las", hills(2000, size=10.0, at=at), offset=(*at, 0.0))

    def bounds(*corners):
        return "--bounds=" + ",".join(f"{at[k % 2] + c:.10g}" for k, c in enumerate(corners))

    cadt_terrain("raster", "a.las", "one.tif", "--res", "0.1", bounds(0, 0, 10, 10))
    _, one = read(tmp_path / "one.tif")
    for k in range(1, 95):
        box = parse_bounds(bounds(k / 10, k / 10, k / 10 + 0.3, k / 10 + 0.3).partition("=")[2])
        part = grid_of_file(str(tmp_path / "one.tif"), None, box)
        assert (part.columns, part.rows) == (3, 3)
        assert np.allclose((part.x0, part.y1), (at[0] + k / 10, at[1] + k / 10 + 0.3), rtol=0, atol=1e-6)
    cadt_terrain("raster", "a.las", "two.tif", "--align", "one.tif", bounds(0.3, 0.3, 0.6, 0.6))
    two, about = read(tmp_path / "two.tif")
    assert two.shape == (3, 3) and about["transform"].a == one["transform"].a
    cadt_terrain("raster", "a.las", "three.tif", "--align", "one.tif", bounds(0.301, 0.3, 0.6, 0.599))
    assert read(tmp_path / "three.tif")[0].shape == (3, 3)
    cadt_terrain("raster", "a.las", "four.tif", "--align", "one.tif", bounds(0.299, 0.3, 0.6, 0.601))
    assert read(tmp_path / "four.tif")[0].shape == (4, 4)
    far = "--bounds=-1e308,-1e308,1e308,1e308"
    cadt_terrain("raster", "a.las", "x.tif", "--align", "one.tif", far, code=2, says="cells, at most")


SLOW = ("dense corner", "far point")  # many buckets are asked again


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.thorough) if n in SLOW else n for n in many()])
@pytest.mark.parametrize("max_edge", [None, 3.0])
@pytest.mark.parametrize("fill", [False, True])
def test_tiles_give_the_raster_of_the_whole(name, max_edge, fill):
    """Whatever the tiles are, the cells are those of the one triangulation."""
    xy = np.round(many()[name], 3) + [500_000, 5_400_000]
    cloud = terrain.Cloud(xy, np.random.default_rng(2).uniform(0, 10, len(xy)), None)
    # Sizes and corners that doubles have, so that a centre is the same from each tile's corner.
    x0, y0, x1, y1 = np.array(cloud.bounds).round().tolist()
    size = 2.0 ** np.round(np.log2(max(x1 - x0, y1 - y0) / 150))
    for grid in (
        terrain.grid_of(cloud, size, (x0, y0, x1 + 1, y1 + 1)),
        terrain.grid_of(cloud, size, (x0 - 20 * size, y0 + 5 * size, x0 + 60 * size, y1 + 9 * size)),
        Grid(x0, y1, 16.0, 8.0, 7, 5),
    ):
        points = Buckets(cloud, per_bucket=9, piece=1000)
        mesh = cadt.Delaunay(points.xy)
        whole = rasterize(mesh, points.z, grid, max_edge=max_edge)
        if fill:
            blank = np.isnan(whole).ravel()
            found = points.z[mesh.nearest_vertex(centers(grid)[blank])] if blank.any() else []
            whole.ravel()[blank] = found
        for per_tile in (200, 900):
            tiled = TiledRaster(points, grid, max_edge=max_edge, fill=fill, threads=2, per_tile=per_tile)
            cells = np.concatenate(list(tiled.rows()))
            assert np.array_equal(np.isnan(cells), np.isnan(whole))
            assert np.nanmax(np.abs(cells - whole), initial=0) < 1e-9, (name, per_tile)
    assert name not in ("strips", "ring", "lake") or tiled.again > 0, "no cell needed points of other tiles"


@pytest.mark.parametrize("column", [65, 131, 136, 138])
def test_a_hull_on_centres_of_cells(column):
    """They are the same doubles in all tiles, so that a column is within the hull or not, whatever the tiles are."""
    grid = Grid(500_000.3, 5_400_006.7, 0.1, 0.1, 140, 60)
    xy = hull_on_centres(grid, column)
    points = Buckets(terrain.Cloud(xy, xy[:, 1].copy(), None), per_bucket=9)
    mesh = cadt.Delaunay(points.xy)
    whole = rasterize(mesh, points.z, grid)
    assert not np.isnan(whole[5:55, column]).any() and np.isnan(whole[:, column + 1 :]).all()
    parts = [grid.part(row, 0, 20, 140).part(0, first, 20, 70) for row in (0, 20, 40) for first in (0, 70)]
    made = [rasterize(mesh, points.z, part) for part in parts]
    assert np.array_equal(np.block([made[:2], made[2:4], made[4:]]), whole, equal_nan=True)
    for per_tile in (200, 900):
        cells = np.concatenate(list(TiledRaster(points, grid, threads=1, per_tile=per_tile).rows()))
        assert np.array_equal(np.isnan(cells), np.isnan(whole))


@pytest.mark.parametrize("size", [1e-160, 1e-110, 1e-104, 1e-92, 1e-80, 1e80, 1e110])
def test_the_smallest_and_largest_coordinates(size):
    """With a lake, so that circles reach far. No tiles are made where products of lengths are lost."""
    xy = np.random.default_rng(0).uniform(0, 1, (1500, 2))
    xy = size * xy[np.hypot(*(xy - 0.5).T) > 0.25]
    grid = Grid(0, size, size / 64, size / 64, 64, 64)
    points = Buckets(terrain.Cloud(xy, np.random.default_rng(2).uniform(0, 10, len(xy)), None), per_bucket=4)
    assert points.useful == (1e-90 < size < 1e90)
    if points.useful:
        whole = rasterize(cadt.Delaunay(points.xy), points.z, grid)
        cells = np.concatenate(list(TiledRaster(points, grid, threads=1, per_tile=60).rows()))
        assert np.allclose(cells, whole, atol=1e-9, rtol=0, equal_nan=True)


def test_triangles_too_small_for_their_circles():
    """Some points of a cloud at a place so small that products of lengths are lost."""
    xy = np.array([[0.0, 0], [1, 0], [0, 1]])
    for scale in (1e-170, 1e-110, 1e110, 1e170):
        assert np.isinf(discs(scale * xy, np.array([[0, 1, 2]], np.int32))[1]).all()
    center, radius = discs(1e-80 * xy, np.array([[0, 1, 2]], np.int32))
    assert np.allclose(center, 5e-81, atol=0) and np.allclose(radius, 0.5**0.5 * 1e-80, atol=0)


@pytest.mark.parametrize("piece", [700, 1 << 20])
def test_buckets_keep_the_order_and_find_the_hull(piece):
    xy = np.random.default_rng(1).normal(0, 10, (5000, 2)).round(2)
    points = Buckets(terrain.Cloud(xy.copy(), np.arange(5000.0), None), per_bucket=20, piece=piece)
    assert np.array_equal(xy[points.z.astype(int)], points.xy)
    column, row = points.place(points.xy)
    for k, (begin, end) in enumerate(zip(points.begin[:, :-1].T, points.begin[:, 1:].T, strict=True)):
        for a, b in zip(begin, end, strict=True):
            assert (np.diff(points.z[a:b]) > 0).all() and (row[a:b] * points.nx + column[a:b] == k).all()
    assert len(points.begin) == -(-5000 // piece) and points.begin[0, 0] == 0 and points.begin[-1, -1] == 5000
    hull = set(map(tuple, xy[cadt.Delaunay(xy).hull]))
    assert hull == set(map(tuple, points.xy[points.hull]))
    rows = np.zeros_like(points.filled)
    rows[2:5, 1:9] = True
    rectangle, z = points.of_rectangle(1, 2, 9, 5)
    assert np.array_equal(rectangle, points.xy[points.of_buckets(rows)])
    assert np.array_equal(z, points.z[points.of_buckets(rows)])


def test_points_are_sorted_in_place_or_not_at_all():
    """Points outside of the squares, and those that are no numbers, belong to the nearest ones. Nothing is copied."""
    from cadt import _cadt

    xy = np.array([[9.5, 9.5], [np.nan, 0.5], [-5, 1.5], [2.5, -1], [0.5, 1.5], [1, 1], [1, 0]], float)
    z = np.arange(7.0)
    begin = _cadt.sort_by_square(xy, z, 0.0, 0.0, 1.0, 3, 2)
    assert z.tolist() == [1, 6, 3, 2, 4, 5, 0] and begin.tolist() == [0, 1, 2, 3, 5, 6, 7]
    assert np.array_equal(xy[1:], [[1, 0], [2.5, -1], [-5, 1.5], [0.5, 1.5], [1, 1], [9.5, 9.5]])
    for wrong_xy, wrong_z in ((np.zeros((4, 3))[:, :2], z[:4]), (xy, np.zeros(14)[::2]), (xy.astype("f4"), z)):
        with pytest.raises(TypeError):
            _cadt.sort_by_square(wrong_xy, wrong_z, 0.0, 0.0, 1.0, 3, 2)
    for arguments in ((z[:6], 0.0, 0.0, 1.0, 3, 2), (z, 0.0, 0.0, 0.0, 3, 2), (z, 0.0, 0.0, 1.0, 0, 2)):
        with pytest.raises(ValueError, match="needed"):
            _cadt.sort_by_square(xy, *arguments)


def test_discs_hold_the_circumscribed_ones():
    """Against rational arithmetic: no corner is outside, and no fourth point that is inside is missed."""
    from fractions import Fraction

    random = np.random.default_rng(3)
    xy = random.uniform(0, 1, (3000, 2)) * random.choice([1.0, 1e-3, 1e-7], (3000, 1)) + [5e5, 5.4e6]
    corners = np.arange(3000, dtype=np.int32).reshape(-1, 3)
    center, radius = discs(xy, corners)
    for triangle, c, r in zip(corners, center, radius, strict=True):
        if not np.isfinite(r):
            continue
        a, b, d = ([Fraction(v) for v in xy[k].tolist()] for k in triangle)
        bx, by, dx, dy = b[0] - a[0], b[1] - a[1], d[0] - a[0], d[1] - a[1]
        cross = 2 * (bx * dy - by * dx)
        ux = (dy * (bx * bx + by * by) - by * (dx * dx + dy * dy)) / cross
        uy = (bx * (dx * dx + dy * dy) - dx * (bx * bx + by * by)) / cross
        away = float((ux + a[0] - Fraction(c[0])) ** 2 + (uy + a[1] - Fraction(c[1])) ** 2) ** 0.5
        assert away + float(ux * ux + uy * uy) ** 0.5 <= r * (1 + 1e-15)
    assert np.isinf(discs(np.array([[0.0, 0], [1, 1], [2, 2]]), np.array([[0, 1, 2]], np.int32))[1]).all()


@pytest.mark.parametrize(
    ("options", "code", "says"),
    [
        ([], 2, "--res R or with --align"),
        (["--res", "0"], 2, "--res 0: a cell needs a finite size above 0"),
        (["--res", "nan"], 2, "--res nan"),
        (["--res", "-1"], 2, "--res -1"),
        (["--res", "inf"], 2, "--res inf"),
        (["--res", "x"], 2, "--res"),
        (["--res", "1e-6"], 2, "at most 4294967295 in all: take a larger --res, or tiles with --bounds"),
        (["--res", "1e-300"], 2, "e+301 cells, at most 4294967295"),
        (["--res", "1e-4", "--bounds", "0,0,300000,0.0001"], 2, "3000000000 x 1 cells, at most 2147483647 in a row"),
        (["--res", "1", "--threads", "²"], 2, "argument --threads: ²: a number from 0 to 4096 is needed"),
        (["--res", "1", "--align", "a.laz"], 2, "either with --res R or with --align"),
        (["--res", "1", "--max-edge", "-2"], 2, "--max-edge -2"),
        (["--res", "1", "--max-edge", "nan"], 2, "--max-edge nan"),
        (["--res", "1", "--bounds", "0,0,0,1"], 2, "--bounds 0,0,0,1: it is empty"),
        (["--res", "1", "--bounds", "1,2"], 2, "four numbers"),
        (["--res", "1", "--class", "two"], 2, "--class"),
        (["--res", "1", "--class", "256"], 2, "from 0 to 255"),
        (["--res", "1", "--class", "9"], 3, "a.laz: no point is of class 9"),
        (["--res", "1", "--nodata", "1e300", "--dtype", "float32"], 2, "is no float32"),
        (["--res", "1", "--crs", "EPSG:0"], 2, "--crs EPSG:0: "),
        (["--res", "1", "--backend", "cuda", "--device", "99"], 5, "cadt: error"),
        (["--res", "1", "--backend", "vulkan"], 2, "--backend"),
        (["--res", "1", "--threads", "-1"], 2, "--threads"),
        (["--res", "1", "--resolution", "3"], 2, "--resolution"),
        (["--res", "1", "--align", "no.tif"], 2, "either"),
        (["--align", "no.tif"], 3, "no.tif: cannot be opened"),
    ],
)
def test_options_that_are_refused(las, cadt_terrain, options, code, says):
    las("a.laz", hills(300))
    cadt_terrain("raster", "a.laz", "dem.tif", *options, code=code, says=says)


def test_files_that_are_refused(las, tmp_path, cadt_terrain):
    las("a.laz", hills(300))
    las("none.laz", hills(300), crs=None)
    las("empty.laz", np.empty((0, 3)))
    las("line.laz", [(500_000 + k, 5_400_000 + k, 1) for k in range(5)])
    las("two.laz", hills(2))
    las("flat.laz", [(500_000, 5_400_000, -9999), (500_009, 5_400_000, -9999), (500_000, 5_400_009, -9999)])
    (tmp_path / "folder.tif").mkdir()
    (tmp_path / "cut.laz").write_bytes((tmp_path / "a.laz").read_bytes()[:1500])
    res = ["--res", "1"]
    for words, code, says in (
        (
            ["none.laz", "o.tif"],
            3,
            "none.laz: no reference system is said, and o.tif should have one; name it with --crs EPSG:",
        ),
        (["empty.laz", "o.tif"], 3, "empty.laz: has no points"),
        (["cut.laz", "o.tif"], 3, "cut.laz: "),
        (["line.laz", "o.tif"], 3, "line.laz: no triangles: the 5 points are fewer than three, or all on one line"),
        (["two.laz", "o.tif"], 3, "two.laz: no triangles"),
        (
            ["flat.laz", "o.tif"],
            3,
            "o.tif: a cell has the value -9999, which means no data; name another one with --nodata",
        ),
        (["missing.laz", "o.tif"], 3, "missing.laz: cannot be opened: No such file"),
        (["a.laz", "folder.tif"], 3, "folder.tif: is a folder"),
        (["a.laz", "no/o.tif"], 3, "there is no folder 'no'; create it first"),
        (["a.laz", "/proc/o.tif"], 3, "/proc/o.tif: cannot be written"),
        (["a.laz", "o.png"], 2, "o.png: unknown suffix '.png'; end the output's name in one of: tif, tiff"),
        (["a.laz", "o"], 2, "o: no suffix"),
        (["a.laz", "a.laz"], 2, "a.laz: unknown suffix"),
        (["a.laz"], 2, "an output is missing"),
        ([], 2, "FILE"),
    ):
        cadt_terrain("raster", *words, *res, code=code, says=says)
    cadt_terrain("raster", "none.laz", "o.tif", *res, "--crs", "none")
    assert read(tmp_path / "o.tif")[1]["crs"] is None
    cadt_terrain("raster", "none.laz", "o.tif", *res, "--crs", "EPSG:2154")
    assert read(tmp_path / "o.tif")[1]["crs"] == CRS.from_epsg(2154)
    (tmp_path / "o.gpkg").symlink_to("o.tif")
    cadt_terrain("raster", "flat.laz", "o.tif", *res, code=3)  # the older file stays
    assert read(tmp_path / "o.tif")[1]["crs"] == CRS.from_epsg(2154)


def test_rows_of_a_call_have_fewer_than_2_31_cells() -> None:
    assert rows_at_a_time(Grid(0, 0, 1, 1, 5_000_000, 500), 100) == 429
    assert rows_at_a_time(Grid(0, 0, 1, 1, 2**31 - 1, 2), 100) == 1
    assert rows_at_a_time(Grid(0, 0, 1, 1, 4_000_000, 600), 100) == 512
    assert rows_at_a_time(Grid(0, 0, 1, 1, 1000, 10_000), 100) == 4096
