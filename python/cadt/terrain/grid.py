# SPDX-License-Identifier: Apache-2.0
"""Grids of square or rectangular cells, the first row at the top."""

from __future__ import annotations

import dataclasses
import math
import sys
from typing import TYPE_CHECKING

from cadt._queries import cells_along

from ._files import check_input, check_utf8, rasterio_errors, why
from .cloud import Extent, name_of, same_crs
from .errors import CrsError, FileError, Unavailable, UsageError

if TYPE_CHECKING:
    import pyproj

MOST_CELLS, MOST_IN_LINE = (1 << 32) - 1, (1 << 31) - 1
Box = tuple[float, float, float, float]


@dataclasses.dataclass(frozen=True)
class Grid:
    """rows x columns cells of width dx and height dy; (x0, y1) is the upper left corner, of a part that of its whole: the
    centre of a cell is the same double in both."""

    x0: float
    y1: float
    dx: float
    dy: float
    columns: int
    rows: int
    first_column: int = 0
    first_row: int = 0

    @property
    def cells(self) -> int:
        return self.columns * self.rows

    @property
    def corner(self) -> tuple[float, float, float, float]:
        """Of the whole and of its cells, as in cadt::Grid."""
        return self.x0, self.y1, self.dx, -self.dy

    def bounds(self, first: int = 0, last: int | None = None) -> Box:
        """xmin, ymin, xmax, ymax of a whole grid's rows from `first` to before `last`."""
        last = self.rows if last is None else last
        return self.x0, self.y1 - last * self.dy, self.x0 + self.columns * self.dx, self.y1 - first * self.dy

    def part(self, row: int, column: int, rows: int, columns: int) -> Grid:
        """So many cells from a row and a column on."""
        row, column = self.first_row + row, self.first_column + column
        return Grid(self.x0, self.y1, self.dx, self.dy, columns, rows, column, row)


def check_resolution(resolution: float) -> None:
    if not (resolution > 0 and math.isfinite(resolution)):
        raise UsageError(f"--res {resolution:g}: a cell needs a finite size above 0")


def grid_of(cloud: Extent, resolution: float, bounds: Box | None) -> Grid:
    """Cells of one size, the lower left corner of one of them on that of `bounds`, or of the box of the points."""
    check_resolution(resolution)
    x0, y0, x1, y1 = bounds if bounds is not None else cloud.bounds
    columns, rows = cells_along(x1 - x0, resolution), cells_along(y1 - y0, resolution)
    if not (columns >= 1 and rows >= 1):
        raise UsageError(
            f"the points span {x1 - x0:g} x {y1 - y0:g}, which gives no cells of {resolution:g}: say where with "
            "--bounds x0,y0,x1,y1"
        )
    check_size(columns, rows, f"--res {resolution:g}")
    return Grid(x0, y0 + rows * resolution, resolution, resolution, int(columns), int(rows))


def count(cells: float) -> str:
    return f"{cells:.0f}" if abs(cells) < 1e15 else f"{cells:g}"


def check_size(columns: float, rows: float, about: str) -> None:
    if not (columns * rows <= MOST_CELLS and max(columns, rows) <= MOST_IN_LINE):
        most = f"{MOST_IN_LINE} in a row or column" if columns * rows <= MOST_CELLS else f"{MOST_CELLS} in all"
        raise UsageError(
            f"{about}: {count(columns)} x {count(rows)} cells, at most {most}: take a larger --res, or tiles with --bounds"
        )


def grid_of_file(path: str, crs: pyproj.CRS | None, bounds: Box | None) -> Grid:
    """The grid of a raster file; with `bounds` the cells of that grid that cover them.

    Raises
    ------
    FileError
        The file is no raster, or turned. CrsError: its reference system is another one.
    UsageError
        `bounds` are too many cells, or none.
    """
    try:
        import rasterio
    except ImportError as error:
        raise Unavailable("--align", "rasterio") from error
    check_input(path)
    check_utf8(path)
    try:
        with rasterio.open(path) as raster:
            transform, columns, rows, wkt = raster.transform, raster.width, raster.height, raster.crs
    except rasterio_errors() as error:
        raise FileError(path, f"is no raster: {why(error)}") from error
    if transform.b or transform.d or transform.a <= 0 or transform.e >= 0:
        raise FileError(
            path, "its rows do not run from west to east, the first one in the north: --align cannot follow them"
        )
    if wkt is not None and crs is not None:
        import pyproj

        other = pyproj.CRS.from_wkt(wkt.to_wkt())
        if not same_crs(other, crs) and not same_crs(other, _horizontal(crs)):
            raise CrsError(path, f"its reference system is {name_of(other)}, that of the points is {name_of(crs)}")
    whole = Grid(transform.c, transform.f, transform.a, -transform.e, columns, rows)
    if bounds is None:
        return whole
    x0, y0, x1, y1 = bounds
    left, right = _floor(x0, whole.x0, whole.dx), -_floor(-x1, -whole.x0, whole.dx)
    top, bottom = _floor(-y1, -whole.y1, whole.dy), -_floor(y0, whole.y1, whole.dy)
    columns, rows = right - left, bottom - top
    check_size(columns, rows, f"--align {path}")
    if not (columns >= 1 and rows >= 1):
        raise UsageError(f"--bounds: they are {count(columns)} x {count(rows)} cells of {path}: take larger ones")
    x0, y1 = whole.x0 + left * whole.dx, whole.y1 - top * whole.dy
    return Grid(x0, y1, whole.dx, whole.dy, int(columns), int(rows))


def _floor(place: float, origin: float, cell: float) -> float:
    """Whole cells from the origin up to a place. What is whole but for the rounding of decimals is whole."""
    exact = (place - origin) / cell
    if not math.isfinite(exact):
        return exact
    near = float(round(exact))
    # That of the number of cells, as in `cells_along`, and that of places far from 0.
    rounding = 1e-9 * max(1.0, abs(near)) + 4 * sys.float_info.epsilon * max(abs(place), abs(origin)) / cell
    return near if abs(exact - near) <= min(rounding, 1e-3) else float(math.floor(exact))


def _horizontal(crs: pyproj.CRS) -> pyproj.CRS:
    """The part for x and y of a system with heights."""
    return crs.sub_crs_list[0] if crs.sub_crs_list else crs


def parse_bounds(text: str) -> Box | None:
    """The rectangle of --bounds."""
    if not text:
        return None
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 4 or not all(map(math.isfinite, numbers)):
        raise UsageError(f"--bounds {text}: four numbers with commas are needed: x0,y0,x1,y1")
    x0, y0, x1, y1 = numbers
    if not (x0 < x1 and y0 < y1):
        raise UsageError(f"--bounds {text}: it is empty; the lower left corner comes first: x0 < x1 and y0 < y1")
    return x0, y0, x1, y1
