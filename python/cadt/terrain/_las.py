# SPDX-License-Identifier: Apache-2.0
"""LAS and LAZ, through laspy and lazrs: in pieces, so that only what is kept is held."""

from __future__ import annotations

import concurrent.futures
import os
import struct
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._files import Room, why
from ._vector import check_values
from .errors import CrsError, FileError, TerrainError, Unavailable, UsageError

if TYPE_CHECKING:
    import pyproj

CHUNK = 1 << 19  # points decoded at a time: 10 to 20 MB, and there are two of them
MOST_OF_CHUNK = 1 << 30  # bytes of the points of one chunk of LAZ, which lazrs decodes at once; as a rule it is 2 MB


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


def _of_file(error: BaseException) -> bool:
    """Whether it may come of a damaged file. Panics of lazrs are no Exception."""
    return isinstance(error, Exception) or type(error).__name__ == "PanicException"


def _check_records(path: str) -> None:
    """Raises FileError if the header promises more records than there is room for: laspy would make all. The fields
    are those of the public header block of the LAS specification 1.4 (ASPRS). A record begins with 54 bytes of its own,
    one behind the points with 60."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        head = file.read(247)
    if len(head) < 104 or head[:4] != b"LASF":
        return  # laspy says what it is
    header_size, points, records = struct.unpack_from("<HII", head, 94)
    room = (min(points, size) - header_size) // 54
    if records > room:
        raise FileError(path, f"is no LAS or LAZ file: {records} records before the points, room for {max(room, 0)}")
    if head[24] == 1 and head[25] >= 4 and len(head) == 247:
        first, records = struct.unpack_from("<QI", head, 235)
        room = max(size - first, 0) // 60
        if records > room:
            raise FileError(path, f"truncated: {records} records behind the points, room for {room}")


def _check_chunks(path: str, header: Any) -> None:
    """Raises FileError if a LAZ file cannot hold the points that its header promises, or if lazrs would ask for memory
    that no file needs: it ends the process if it does not get it."""
    try:
        import lazrs
    except ImportError:
        return  # laspy has another package that reads LAZ

    record = lazrs.LazVlr(header.vlrs[header.vlrs.index("LasZipVlr")].record_data)
    size, begin, length = header.point_format.size, header.offset_to_point_data, os.path.getsize(path)
    if record.item_size() != size:
        raise FileError(path, f"damaged: a point has {size} bytes or {record.item_size()}")
    with open(path, "rb") as file:
        # Eight bytes say where the table of chunks is; a writer that could not go back there puts them at the end.
        file.seek(begin)
        (table,) = struct.unpack("<q", file.read(8))
        if table <= begin:
            file.seek(-8, os.SEEK_END)
            (table,) = struct.unpack("<q", file.read(8))
        file.seek(table + 4)
        (count,) = struct.unpack("<I", file.read(4))
        if count * size > length:  # a chunk begins with a point as it is
            raise FileError(path, f"damaged: it has no room for its {count} chunks")
        file.seek(begin)
        chunks = lazrs.read_chunk_table(file, record)
    points, sizes = sum(n for n, _ in chunks), sum(n for _, n in chunks)
    most = max((n for n, _ in chunks), default=0)
    if most * size > MOST_OF_CHUNK:
        raise FileError(
            path, f"a chunk of {most} points needs {most * size / 2**30:.1f} GiB: write it again with smaller chunks"
        )
    if sizes > length:
        raise FileError(path, f"truncated: its chunks have {sizes} bytes")
    if points < header.point_count:
        raise FileError(
            path, f"truncated: at most {points} points of the {header.point_count} that its header promises"
        )


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
            elif self.count:
                try:
                    _check_chunks(path, header)
                except BaseException as error:
                    if isinstance(error, TerrainError) or not _of_file(error):
                        raise
                    raise FileError(path, f"damaged: {why(error)}") from error
            names = {dimension.name: int(dimension.num_elements) for dimension in header.point_format.dimensions}
            self.crs = self._crs(header) if with_crs else None
        if classes is not None and "classification" not in names:
            raise FileError(path, "has no classes; leave out --class")
        if values != "z" and values not in names:
            raise UsageError(f"--values {values}: {path} has no such dimension; it has: {', '.join(sorted(names))}")
        if names.get(values, 1) != 1:
            raise UsageError(f"--values {values}: {path} has {names[values]} numbers a point, one is needed")

    def _open(self) -> Any:
        laspy = _laspy()
        _check_records(self.path)
        selection = laspy.DecompressionSelection
        wanted = selection.base() | selection.Z | selection.CLASSIFICATION
        if self._values not in ("z", "classification"):
            wanted = selection.all()
        try:
            return laspy.open(self.path, decompression_selection=wanted)
        except BaseException as error:  # whatever a damaged header leads to: numpy, struct, lazrs
            if not _of_file(error):
                raise
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
        except BaseException as error:
            if isinstance(error, (TerrainError, MemoryError)) or not _of_file(error):
                raise
            raise FileError(self.path, f"damaged after {seen} of {self.count} points: {why(error)}") from error
        if seen != self.count:
            raise self._truncated(seen)

    def _truncated(self, points: int) -> FileError:
        return FileError(self.path, f"truncated: {points} points of the {self.count} that its header promises")
