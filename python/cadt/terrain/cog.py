# SPDX-License-Identifier: Apache-2.0
"""Cloud-optimised GeoTIFF, through rasterio: written row by row, so that no more than some rows are held."""

from __future__ import annotations

import concurrent.futures
import contextlib
import math
import os
import shutil
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._files import complete_file, rasterio_errors, why
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
            advice = "" if self._dtype == np.float64 else ": take --dtype float64"
            raise FileError(self._path, f"a cell has a value that is no {self._dtype}{advice}")
        nan = np.isnan(values)
        if not math.isnan(self._nodata):
            if (values == self._nodata).any():
                what = f"a cell has the value {self._nodata:g}, which means no data; name another one with --nodata"
                raise FileError(self._path, what)
            values[nan] = self._nodata
        self.blank += int(np.count_nonzero(nan))
        self._raster.write(values, 1, window=Window(0, self.next, self._grid.columns, len(values)))
        self.next += len(values)


def _tile_side(cells: int) -> int:
    """Of the file of rows: tiles are whole, so that those of a grid of few rows are low."""
    return min(BLOCK, -(-cells // 16) * 16)


def _check_disk(path: str, grid: Grid, size: int) -> None:
    wide, high = _tile_side(grid.columns), _tile_side(grid.rows)
    needed = 2 * (-(-grid.columns // wide) * wide) * (-(-grid.rows // high) * high) * size
    disk = shutil.disk_usage(os.path.dirname(os.path.realpath(path)))
    free = disk.free
    if disk.total and needed > free:
        raise FileError(
            path,
            f"{grid.columns} x {grid.rows} cells may need {needed / 2**30:.1f} GiB, the disk has {free / 2**30:.1f} GiB: "
            "take a larger --res, or tiles with --bounds",
        )


def _wait_for(work: Callable[[], None]) -> None:
    """Runs what is a single call of a library in a thread of its own, so that a signal is heard at once. The call goes on
    then: the program ends without it."""
    pool = concurrent.futures.ThreadPoolExecutor(1)
    try:
        job = pool.submit(work)
        while not concurrent.futures.wait([job], timeout=1).done:
            pass
        job.result()
    finally:
        pool.shutdown(wait=False)


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
        "blockxsize": _tile_side(grid.columns),
        "blockysize": _tile_side(grid.rows),
        "BIGTIFF": "IF_SAFER",
    }
    workers = threads or os.cpu_count() or 1
    # Overviews are averaged by all threads, and are written before the file is: without compression, unless most of their
    # tiles is empty.
    packed = "NONE" if min(grid.columns, grid.rows) >= BLOCK else "LZW"
    settings = {"GDAL_CACHEMAX": CACHE, "GDAL_NUM_THREADS": workers, "COG_TMP_COMPRESSION": packed}

    def compress(plain: str, target: str) -> None:
        with rasterio.Env(**settings):  # of this thread
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

    try:
        with complete_file(path) as target, rasterio.Env(**settings):
            plain = target + ".rows.tif"
            with rasterio.open(plain, "w", **profile) as raster:
                rows = Rows(path, grid, raster, nodata)
                yield rows
            if rows.next != grid.rows:
                raise FileError(path, f"{rows.next} of {grid.rows} rows were given")
            _wait_for(lambda: compress(plain, target))
            with rasterio.open(target) as written:  # every tile is there: GDAL tells of a full disk in its log alone
                if (written.width, written.height) != (grid.columns, grid.rows):
                    raise FileError(path, "cannot be written: the file is not complete")
    except rasterio_errors() as error:
        raise FileError(path, f"cannot be written: {why(error)}") from error
