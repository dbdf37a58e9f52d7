# SPDX-License-Identifier: Apache-2.0
"""LAS and LAZ, through laspy and lazrs: in pieces, so that only what is kept is held."""

from __future__ import annotations

import concurrent.futures
import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._files import Room, why
from ._vector import check_values
from .errors import CrsError, FileError, TerrainError, Unavailable, UsageError

if TYPE_CHECKING:
    import pyproj

CHUNK = 1 << 19  # points decoded at a time: 10 to 20 MB, and there are two of them


def _laspy() -> Any:
    try:
        import laspy
    except ImportError as error:
        raise Unavailable("reading LAS and LAZ", "laspy") from error
    return laspy


def _ahead(items: Iterator[Any]) -> Iterator[Any]:
    """The items, of which the next one is made while the caller uses one."""
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        following = pool.submit(next, items, None)
        while (item := following.result()) is not None:
            following = pool.submit(next, items, None)
            yield item


class LasSource:
    """A LAS or LAZ file: how many points it promises, its reference system, and the points that a filter keeps."""

    def __init__(self, path: str, classes: Sequence[int] | None, values: str, with_crs: bool) -> None:
        self.path = path
        self._classes = classes
        self._values = values
        with self._open() as reader:
            header = reader.header
            if header.are_points_compressed and not _laspy().LazBackend.detect_available():
                raise Unavailable("reading LAZ", "lazrs")
            self.count = int(header.point_count)
            if not np.isfinite([*header.scales, *header.offsets]).all():
                raise FileError(path, "is no LAS or LAZ file: a scale or offset in its header is no finite number")
            if not header.are_points_compressed:
                held = (os.path.getsize(path) - header.offset_to_point_data) // header.point_format.size
                if held < self.count:
                    raise self._truncated(max(held, 0))
            names = set(header.point_format.dimension_names)
            self.crs = self._crs(header) if with_crs else None
        if classes is not None and "classification" not in names:
            raise FileError(path, "has no classes; leave out --class")
        if values != "z" and values not in names:
            raise UsageError(f"--values {values}: {path} has no such dimension; it has: {', '.join(sorted(names))}")

    def _open(self) -> Any:
        laspy = _laspy()
        selection = laspy.DecompressionSelection
        wanted = selection.base() | selection.Z | selection.CLASSIFICATION
        if self._values not in ("z", "classification"):
            wanted = selection.all()
        try:
            return laspy.open(self.path, decompression_selection=wanted)
        except Exception as error:  # whatever a damaged header leads to: numpy, struct, lazrs
            raise FileError(self.path, f"is no LAS or LAZ file: {why(error)}") from error

    def _crs(self, header: Any) -> pyproj.CRS | None:
        try:
            import pyproj
        except ImportError as error:
            raise Unavailable("the reference system of LAS files", "pyproj") from error
        try:
            return header.parse_crs()
        except pyproj.exceptions.CRSError as error:
            if not any(
                vlr.record_id == 2112 and vlr.string.strip("\0 '\"") for vlr in header.vlrs if hasattr(vlr, "string")
            ):
                return None  # a record that is empty
            raise CrsError(
                self.path, f"its reference system is not understood: {why(error)}; name it with --crs"
            ) from error

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        """Fills the arrays of `room` with the points that are kept.

        Raises
        ------
        FileError
            The file is damaged or truncated, or a point that is kept has no finite value.
        """
        seen = 0
        try:
            with self._open() as reader:
                header = reader.header
                for points in _ahead(reader.chunk_iterator(CHUNK)):
                    before, seen = seen, seen + len(points)
                    which: Any = slice(None)
                    if self._classes is not None:
                        which = np.flatnonzero(np.isin(np.asarray(points.classification), self._classes))
                    xy, z = room(len(points) if isinstance(which, slice) else len(which))
                    # A coordinate is a whole number of steps from an offset: one product and one sum, both rounded.
                    for k, (name, out) in enumerate((("X", xy[:, 0]), ("Y", xy[:, 1]), ("Z", z))):
                        if k == 2 and self._values != "z":
                            out[:] = np.asarray(points[self._values])[which]
                            continue
                        np.multiply(np.asarray(points[name])[which], header.scales[k], out=out)
                        out += header.offsets[k]
                    check_values(self.path, z, self._values, before, None if self._classes is None else which)
                    step(seen)
        except TerrainError:
            raise
        except MemoryError:
            raise
        except Exception as error:
            raise FileError(self.path, f"damaged after {seen} of {self.count} points: {why(error)}") from error
        if seen != self.count:
            raise self._truncated(seen)

    def _truncated(self, points: int) -> FileError:
        return FileError(self.path, f"truncated: {points} points of the {self.count} that its header promises")
