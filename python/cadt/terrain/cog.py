# SPDX-License-Identifier: Apache-2.0
"""Cloud-optimised GeoTIFF, through rasterio: written row by row, so that no more than some rows are held."""

from __future__ import annotations

import contextlib
import math
import os
import shutil
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._files import complete_file, why
from .errors import FileError, Unavailable, UsageError
from .grid import Grid

if TYPE_CHECKING:
    import pyproj

BLOCK = 512  # side of a tile of the file
CACHE = 32 << 20  # bytes of decoded tiles that GDAL keeps


def check_nodata(nodata: float, dtype: str) -> None:
    with np.errstate(over="ignore"):
        if not math.isnan(nodata) and float(np.dtype(dtype).type(nodata)) != nodata:
            raise UsageError(f"--nodata {nodata!r}: is no {dtype}, so that no cell could be compared with it")


class Rows:
    """Takes the rows of a raster from the top on."""

    def __init__(self, path: str, grid: Grid, raster: Any, nodata: float) -> None:
        self._path, self._grid, self._raster, self._nodata = path, grid, raster, nodata
        self._dtype = np.dtype(raster.dtypes[0])
        self.next = 0
        self.blank = 0  # cells without data

    def write(self, rows: NDArray[np.floating[Any]]) -> None:
        """The next rows; NaN: no data."""
        from rasterio.windows import Window

        with np.errstate(over="ignore"):
            values = np.asarray(rows).astype(self._dtype, copy=True)
        if np.isinf(values).any():
            raise FileError(self._path, f"a cell has a value that is no {self._dtype}: take --dtype float64")
        nan = np.isnan(values)
        if not math.isnan(self._nodata):
            if (values == self._nodata).any():
                what = f"a cell has the value {self._nodata:g}, which means no data; name another one with --nodata"
                raise FileError(self._path, what)
            values[nan] = self._nodata
        self.blank += int(np.count_nonzero(nan))
        self._raster.write(values, 1, window=Window(0, self.next, self._grid.columns, len(values)))
        self.next += len(values)


def _check_disk(path: str, grid: Grid, size: int) -> None:
    needed = 2 * grid.cells * size
    disk = shutil.disk_usage(os.path.dirname(os.path.realpath(path)))
    free = disk.free
    if disk.total and needed > free:
        raise FileError(
            path,
            f"{grid.columns} x {grid.rows} cells may need {needed / 2**30:.1f} GiB, the disk has {free / 2**30:.1f} GiB: "
            "take a larger --res, or tiles with --bounds",
        )


@contextlib.contextmanager
def open_cog(
    path: str,
    grid: Grid,
    crs: pyproj.CRS | None,
    *,
    nodata: float = -9999.0,
    dtype: str = "float64",
    threads: int = 0,
) -> Iterator[Rows]:
    """A GeoTIFF that takes rows in the block and becomes a COG with overviews at its end, under its name.

    The rows go to a file without compression first: a COG has its overviews before its pixels, and these are known last.
    That costs the size of the raster on the disk, for that time.
    """
    try:
        import rasterio
        import rasterio.errors
        import rasterio.shutil
    except ImportError as error:
        raise Unavailable(f"writing {path}", "rasterio") from error
    check_nodata(nodata, dtype)
    _check_disk(path, grid, np.dtype(dtype).itemsize)
    profile: dict[str, Any] = {
        "driver": "GTiff",
        "width": grid.columns,
        "height": grid.rows,
        "count": 1,
        "dtype": dtype,
        "nodata": nodata,
        "transform": rasterio.Affine(grid.dx, 0, grid.x0, 0, -grid.dy, grid.y1),
        "crs": None if crs is None else rasterio.crs.CRS.from_wkt(crs.to_wkt()),
        "tiled": True,
        "blockxsize": BLOCK,
        "blockysize": BLOCK,
        "BIGTIFF": "IF_SAFER",
    }
    workers = threads or os.cpu_count() or 1
    # Overviews are averaged by all threads, and are written without compression before the file is.
    settings = {"GDAL_CACHEMAX": CACHE, "GDAL_NUM_THREADS": workers, "COG_TMP_COMPRESSION": "NONE"}
    try:
        with complete_file(path) as target, rasterio.Env(**settings):
            plain = target + ".rows.tif"
            with rasterio.open(plain, "w", **profile) as raster:
                rows = Rows(path, grid, raster, nodata)
                yield rows
            if rows.next != grid.rows:
                raise FileError(path, f"{rows.next} of {grid.rows} rows were given")
            rasterio.shutil.copy(
                plain,
                target,
                driver="COG",
                COMPRESS="DEFLATE",
                LEVEL=1,  # 6 takes twice as long for files that are 1 to 3 % smaller
                PREDICTOR="YES",  # of floating point: bytes of equal weight stand together
                BLOCKSIZE=BLOCK,
                BIGTIFF="IF_SAFER",
                OVERVIEW_RESAMPLING="AVERAGE",
                NUM_THREADS=workers,
            )
            with rasterio.open(target) as written:  # every tile is there: GDAL tells of a full disk in its log alone
                if (written.width, written.height) != (grid.columns, grid.rows):
                    raise FileError(path, "cannot be written: the file is not complete")
    except rasterio.errors.RasterioError as error:
        raise FileError(path, f"cannot be written: {why(error)}") from error
