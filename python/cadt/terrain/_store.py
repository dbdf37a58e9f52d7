# SPDX-License-Identifier: Apache-2.0
"""Points in files of a scratch folder, so that memory holds a piece of them at a time."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from cadt.tiles._tree import first_not_finite, not_finite

from ._buckets import PIECE, Floats
from ._files import why
from .cloud import no_points, open_sources, read_all
from .errors import FileError

if TYPE_CHECKING:
    import pyproj

POINT = np.dtype((np.float64, 3))  # x, y and the value
LEAF_POINT = np.dtype([("xy", np.float64, 2), ("z", np.float64), ("id", np.uint64)])


class ArrayFile:
    """A new file of items of one type. Errors name it."""

    def __init__(self, path: str, dtype: DTypeLike) -> None:
        self.path, self.dtype = path, np.dtype(dtype)
        try:
            self._file = open(path, "x+b", buffering=0)  # noqa: SIM115  remove() closes it
        except OSError as error:
            raise FileError(path, f"cannot be written: {why(error)}") from error

    def write(self, first: int, items: NDArray[Any]) -> None:
        """Items `first` and following ones, in C's order."""
        rest = _bytes_of(np.ascontiguousarray(items))
        try:
            self._file.seek(first * self.dtype.itemsize)
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            raise FileError(self.path, f"cannot be written: {why(error)}") from error

    def read(self, first: int, count: int) -> NDArray[Any]:
        items = np.empty(count, self.dtype)
        rest = _bytes_of(items)
        try:
            self._file.seek(first * self.dtype.itemsize)
            while rest:
                got = self._file.readinto(rest)
                if not got:
                    raise FileError(self.path, "is shorter than what was written: another program has changed it")
                rest = rest[got:]
        except FileError:
            raise
        except OSError as error:
            raise FileError(self.path, f"cannot be read: {why(error)}") from error
        return items

    def remove(self) -> None:
        self._file.close()
        os.unlink(self.path)


def _bytes_of(items: NDArray[Any]) -> memoryview:
    return items.view(np.uint8).reshape(-1).data


@contextlib.contextmanager
def folder_in(path: str) -> Iterator[str]:
    """A new folder in `path`, which is removed with all that is in it at the end of the block, also by an error."""
    if not os.path.isdir(path):
        raise FileError(path, "is no folder: --scratch names one on a disk with room for the points")
    try:
        folder = tempfile.mkdtemp(prefix="cadt-raster-", dir=path)
    except OSError as error:
        raise FileError(path, f"cannot be written: {why(error)}") from error
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def check_room(folder: str, needed: int, what: str) -> None:
    """Raises FileError if the disk has less room."""
    free = shutil.disk_usage(folder).free
    if needed > free:
        raise FileError(
            os.path.dirname(folder),
            f"{what} may need {needed / 2**30:.1f} GiB in the scratch folder, its disk has {free / 2**30:.1f} GiB: name a "
            "folder of another one with --scratch",
        )


@dataclasses.dataclass(frozen=True)
class StoredCloud:
    """Points in a file: as `Cloud`, for those who ask for some at a time."""

    file: ArrayFile
    count: int
    bounds: tuple[float, float, float, float]
    crs: pyproj.CRS | None
    sources: tuple[str, ...]

    def __len__(self) -> int:
        return self.count

    def pieces(self, size: int = PIECE) -> Iterator[tuple[int, Floats, Floats]]:
        """The index of the first point, coordinates and values of so many points at a time."""
        for first in range(0, self.count, size):
            yield first, *self._piece(first, min(size, self.count - first))

    def _piece(self, first: int, count: int) -> tuple[Floats, Floats]:
        points = self.file.read(first, count)
        return np.ascontiguousarray(points[:, :2]), np.ascontiguousarray(points[:, 2])


def bytes_for(points: int) -> int:
    """In the scratch folder: as they were read, and by leaves."""
    return points * (POINT.itemsize + LEAF_POINT.itemsize)


def store_cloud(
    paths: Sequence[str],
    folder: str,
    *,
    classes: Sequence[int] | None = None,
    values: str = "z",
    columns: str = "",
    crs: str | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> StoredCloud:
    """`read_cloud` to a file of the folder. Memory: one piece of a file; text and GeoParquet are read as a whole.

    Raises
    ------
    FileError, CrsError
        As `read_cloud`; the disk has no room. InputError: a coordinate is NaN or infinite.
    """
    sources, system = open_sources(paths, classes, values, columns, crs)
    names = tuple(source.path for source in sources)
    if classes is None:  # else nobody knows how many are kept
        most = sum(source.count for source in sources)
        check_room(folder, bytes_for(most), f"{most} points")
    file = ArrayFile(os.path.join(folder, "points"), POINT)
    kept = 0
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    xy, z = np.empty((0, 2)), np.empty(0)

    def room(n: int) -> tuple[Floats, Floats]:
        flush()
        nonlocal xy, z
        xy, z = np.empty((n, 2)), np.empty(n)
        return xy, z

    def flush() -> None:
        nonlocal kept
        if len(z) == 0:
            return
        np.add(xy, 0.0, out=xy)  # -0 as 0: as points are for tiles
        bad = first_not_finite(xy)
        if bad is not None:
            raise not_finite(xy[bad], kept + bad)
        np.minimum(low, xy.min(axis=0), out=low)
        np.maximum(high, xy.max(axis=0), out=high)
        file.write(kept, np.column_stack((xy, z)))
        kept += len(z)

    read_all(sources, room, progress)
    flush()
    if kept == 0:
        raise no_points(names, classes)
    return StoredCloud(file, kept, (*low.tolist(), *high.tolist()), system, names)
