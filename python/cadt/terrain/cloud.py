# SPDX-License-Identifier: Apache-2.0
"""Points with heights, from one file or several, and their reference system."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from ._files import Room, check_input, suffix_of
from ._las import LasSource
from ._tables import TableSource
from ._vector import OgrSource, ParquetSource, named_crs
from .errors import CrsError, FileError, UsageError

if TYPE_CHECKING:
    import pyproj

LAS = ("las", "laz")
OGR = ("gpkg", "geojson", "fgb")
TABLES = ("xyz", "txt", "csv", "npy")
READ_FORMATS = (*LAS, *OGR, "parquet", *TABLES)
MOST_POINTS = (1 << 29) - 2


@dataclasses.dataclass(frozen=True)
class Cloud:
    """n points: `xy` (n, 2), their values `z` (n,), both float64, and the reference system, if there is one."""

    xy: NDArray[np.float64]
    z: NDArray[np.float64]
    crs: pyproj.CRS | None
    sources: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.z)

    @functools.cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """xmin, ymin, xmax, ymax."""
        # Minima down long columns are slow, along long rows they are not.
        wide = self.xy[: len(self) // 256 * 256].reshape(-1, 512)
        rest = self.xy[len(wide) * 256 :]
        parts = [wide.min(axis=0).reshape(256, 2), wide.max(axis=0).reshape(256, 2)] if len(wide) else []
        ends = np.concatenate([*parts, rest])
        (x0, y0), (x1, y1) = ends.min(axis=0), ends.max(axis=0)
        return float(x0), float(y0), float(x1), float(y1)


class Extent(Protocol):
    """Of points in memory or in a file: their box and reference system, and where they come from."""

    @property
    def crs(self) -> pyproj.CRS | None: ...
    @property
    def sources(self) -> tuple[str, ...]: ...
    @property
    def bounds(self) -> tuple[float, float, float, float]: ...
    def __len__(self) -> int: ...


class Source(Protocol):
    path: str
    count: int  # of points, at most

    @property
    def crs(self) -> pyproj.CRS | None: ...

    def read(self, room: Room, step: Callable[[int], None]) -> None: ...


def read_cloud(
    paths: Sequence[str],
    *,
    classes: Sequence[int] | None = None,
    values: str = "z",
    columns: str = "",
    crs: str | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Cloud:
    """Reads points of LAS, LAZ, GeoPackage, GeoJSON, FlatGeobuf, GeoParquet, text and .npy files as one cloud.

    Parameters
    ----------
    paths
        The files, in this order. Those that say which reference system they have must all have the same one.
    classes
        Of LAS and LAZ points only those of these classes are kept. The others are dropped while reading: memory is
        that of the points that are kept, 24 bytes each, and of one piece of the file.
    values
        What `z` is: "z", the third coordinate, or the name of a dimension (LAS) or of an attribute.
    columns
        Of tables: the columns of x, y and the value, by number (from 1) or by their names in the header.
    crs
        The reference system, if the files do not say it or say it wrongly ("EPSG:25832"). "none": there is none.
    progress
        Called with a file's name and the fraction of it that is read.

    Raises
    ------
    FileError
        A file cannot be read, is damaged or truncated, or no point is left. CrsError: the systems differ.
    """
    sources, system = open_sources(paths, classes, values, columns, crs)
    most = min(sum(source.count for source in sources), MOST_POINTS)
    xy = np.empty((most, 2))  # pages that no point reaches cost nothing
    z = np.empty(most)
    kept = 0

    def room(n: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        nonlocal kept
        kept += n
        if kept > MOST_POINTS:
            what = (
                f"at most {MOST_POINTS} fit in one mesh; split them into tiles, or make a linear raster with --scratch"
            )
            raise FileError(", ".join(names), f"too many points: {what}")
        return xy[kept - n : kept], z[kept - n : kept]

    names = tuple(source.path for source in sources)
    read_all(sources, room, progress)
    if kept == 0:
        raise no_points(names, classes)
    return Cloud(xy[:kept], z[:kept], system, names)


def open_sources(
    paths: Sequence[str], classes: Sequence[int] | None, values: str, columns: str, crs: str | None
) -> tuple[list[Source], pyproj.CRS | None]:
    """The files of `read_cloud`, and their reference system."""
    names = [str(path) for path in paths]
    sources: list[Source] = []
    for name in names:
        check_input(name)
        sources.append(_open(name, classes, values, columns, crs is None))
    system = _common_crs(sources, crs)
    if sum(source.count for source in sources) == 0:
        raise FileError(names[0] if len(names) == 1 else ", ".join(names), "has no points")
    return sources, system


def read_all(sources: Sequence[Source], room: Room, progress: Callable[[str, float], None] | None) -> None:
    """Points of all files, one after another."""
    for source in sources:
        whole = max(source.count, 1)

        def step(done: int, path: str = source.path, whole: int = whole) -> None:
            if progress is not None:
                progress(f"reading {path}", done / whole)

        source.read(room, step)


def no_points(paths: Sequence[str], classes: Sequence[int] | None) -> FileError:
    if classes is None:
        return FileError(", ".join(paths), "has no points")
    names = ", ".join(map(str, classes))
    return FileError(", ".join(paths), f"no point is of class {names}; without --class all points are taken")


def _open(path: str, classes: Sequence[int] | None, values: str, columns: str, with_crs: bool) -> Source:
    suffix = suffix_of(path)
    if suffix not in READ_FORMATS:
        raise UsageError(f"{path}: points are read from files that end in one of: {', '.join(READ_FORMATS)}")
    if suffix in LAS:
        return LasSource(path, classes, values, with_crs)
    if classes is not None:
        raise UsageError(f"--class: {path} has no classes; only LAS and LAZ files have")
    if suffix in TABLES:
        if values != "z":
            raise UsageError(f"--values {values}: the value of {path} is the third of its --columns")
        return TableSource(path, columns)
    return ParquetSource(path, values, with_crs) if suffix == "parquet" else OgrSource(path, values, with_crs)


def _common_crs(sources: Sequence[Source], asked: str | None) -> pyproj.CRS | None:
    if asked is not None:
        return named_crs(asked)
    known = [source for source in sources if source.crs is not None]
    for other in known[1:]:
        if not same_crs(known[0].crs, other.crs):
            raise CrsError(
                other.path,
                f"its reference system is {name_of(other.crs)}, that of {known[0].path} is {name_of(known[0].crs)}; "
                "transform one of them, or name the one that is right with --crs",
            )
    if not known:
        return None
    for source in sources:
        if source.crs is None:
            raise CrsError(
                source.path,
                f"does not say its reference system, {known[0].path} does ({name_of(known[0].crs)}); "
                "if it is the same, name it with --crs",
            )
    return known[0].crs


def same_crs(a: pyproj.CRS | None, b: pyproj.CRS | None) -> bool:
    if a is None or b is None:
        return a is b
    return bool(a.equals(b, ignore_axis_order=True))


def name_of(crs: pyproj.CRS | None) -> str:
    if crs is None:
        return "none"
    code = crs.to_epsg()
    return f"{crs.name} (EPSG:{code})" if code else str(crs.name)


def require_crs(cloud: Extent, asked: str | None, output: str) -> None:
    """A map without a reference system is not found in the right place again, so that it has to be asked for."""
    if cloud.crs is None and asked is None:
        raise CrsError(
            ", ".join(cloud.sources),
            f"no reference system is said, and {output} should have one; name it with --crs EPSG:..., or write without: --crs none",
        )
