# SPDX-License-Identifier: Apache-2.0
"""Points and shapes of GIS files: pyogrio for GeoPackage, GeoJSON and FlatGeobuf, geopandas for GeoParquet."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._files import Room, check_utf8, complete_file, from_root, suffix_of, why
from .errors import CrsError, FileError, Unavailable, UsageError

if TYPE_CHECKING:
    import pyproj

CHUNK = 1 << 18  # features read at a time: each is a Python object
NUMBERS = ("integer", "floating", "mixed-integer-float", "decimal")  # as pandas calls them
DRIVERS = {"gpkg": "GPKG", "geojson": "GeoJSON", "fgb": "FlatGeobuf"}


def _pyogrio(what: str) -> Any:
    try:
        import pyogrio
    except ImportError as error:
        raise Unavailable(what, "pyogrio") from error
    return pyogrio


def errors_of(ogr: Any) -> tuple[type[Exception], ...]:
    """What reading and writing lead to, damaged files among them."""
    errors = ogr.errors
    return errors.DataSourceError, errors.DataLayerError, errors.FeatureError, UnicodeDecodeError


def name_for_ogr(path: str, file: str | None = None) -> str:
    """The name by which pyogrio finds a file, `path` unless it is another one that stands for it.

    Raises
    ------
    FileError
        There is none: pyogrio takes what is after `!` or `;`, and names with tabs and line breaks, for another file.
    """
    check_utf8(path)
    name = from_root(path, path if file is None else file)  # none of a URL's parts is at its beginning
    if name.startswith("//"):
        name = "/" + name.lstrip("/")
    try:
        from pyogrio.util import vsi_path
    except ImportError:
        return name
    if vsi_path(name) != name:
        raise FileError(path, "GDAL takes this name for another one; use none with !, ;, tabs or line breaks")
    return name


def parse_crs(path: str, text: object) -> pyproj.CRS | None:
    if text is None:
        return None
    try:
        import pyproj
    except ImportError as error:
        raise Unavailable("reference systems", "pyproj") from error
    try:
        return pyproj.CRS.from_user_input(text)
    except pyproj.exceptions.CRSError as error:
        raise CrsError(path, f"its reference system is not understood: {why(error)}; name it with --crs") from error


def named_crs(name: str) -> pyproj.CRS | None:
    """What ``--crs NAME`` means; None for 'none'."""
    try:
        return None if name.lower() == "none" else parse_crs("--crs", name)
    except CrsError as error:
        raise UsageError(f"--crs {name}: no such reference system; say it such as EPSG:25832, or none") from error


def _coordinates(path: str, geometry: NDArray[np.object_], first: int) -> NDArray[np.float64]:
    """x, y, z of points in well-known binary; z is NaN where there is none."""
    result = np.full((len(geometry), 3), np.nan)
    sizes = np.fromiter((-1 if g is None else len(g) for g in geometry), np.int64, len(geometry))
    # Byte order, type, coordinates. Type 1 is a point; 1001, or the highest bit, says that there is a z; 2001, or the
    # next bit, that there is a measure, which is left out; 3001, or both, that there are both.
    for size, words, types in (
        (21, 2, (1,)),
        (29, 3, (1001, 0x80000001)),
        (29, 2, (2001, 0x40000001)),
        (37, 3, (3001, 0xC0000001)),
    ):
        rows = np.flatnonzero(sizes == size)
        if len(rows) == 0:
            continue
        raw = np.frombuffer(b"".join(geometry[rows]), np.uint8).reshape(len(rows), size)
        kind = raw[:, 1:5].copy().view("<u4")[:, 0]
        good = (raw[:, 0] == 1) & np.isin(kind, types)
        result[rows[good], :words] = raw[good, 5 : 5 + 8 * words].copy().view("<f8")
        sizes[rows[good]] = 0
    bad = np.flatnonzero(sizes != 0)
    if len(bad):
        what = "has no geometry" if sizes[bad[0]] == -1 else "is no point"
        raise FileError(path, f"feature {first + int(bad[0])} (counted from 0) {what}; only points can be read")
    lost = np.flatnonzero(~np.isfinite(result[:, :2]).all(axis=1))
    if len(lost):
        raise FileError(path, f"feature {first + int(lost[0])} (counted from 0) has no finite coordinates")
    return result


@dataclasses.dataclass(frozen=True)
class Layer:
    """The layer of a file, of which there must be one alone."""

    file: str  # as pyogrio finds it
    name: str
    count: int  # of features; in Shapefiles those that are deleted are counted, too
    where: str | None  # what to read it with, so that GDAL finds as many
    crs: str | None
    fields: list[str]


def only_layer(ogr: Any, path: str, what: str) -> Layer:
    """The layer with `what`. Raises FileError if there are several, or features that cannot be there. Tables without
    geometry do not count where there is a layer with it: QGIS stores styles in one."""
    file = name_for_ogr(path)
    try:
        layers = ogr.list_layers(file)
        names = [str(name) for name, kind in layers if kind is not None] or [str(name) for name in layers[:, 0]]
        if not names:
            raise FileError(path, "cannot be read: no layer is found in it")
        if len(names) > 1:
            raise FileError(path, f"has several layers ({', '.join(names)}); export one of them to a file of its own")
        info = ogr.read_info(file, layer=names[0], force_feature_count=True)
        if info["geometry_type"] is None:
            raise FileError(path, f"has attributes alone, and no {what}")
        count = int(info["features"])
        where = None
        if suffix_of(path) == "gpkg":
            # GDAL says what a table of the file says, which other programs may not have kept up to date.
            quoted = names[0].replace('"', '""')
            true_count = int(ogr.raw.read(file, sql=f'SELECT COUNT(*) FROM "{quoted}"')[3][0][0])
            if true_count != count:
                count, where = true_count, "1 = 1"
    except errors_of(ogr) as error:
        if "SHAPE_RESTORE_SHX" in str(error):
            said = "the .shx file beside it is missing, a part of the Shapefile; get it, or make it again with the environment SHAPE_RESTORE_SHX=YES"
            raise FileError(path, said) from error
        raise FileError(path, f"cannot be read: {why(error)}") from error
    if count < 0:
        raise FileError(path, f"damaged: it promises {count} features")
    if count > os.path.getsize(path):  # a feature takes more than a byte
        raise FileError(path, f"truncated: it has no room for the {count} features that it promises")
    return Layer(file, names[0], count, where, info["crs"], [str(name) for name in info["fields"]])


class OgrSource:
    """Points of a GeoPackage, a GeoJSON or a FlatGeobuf file."""

    def __init__(self, path: str, values: str, with_crs: bool) -> None:
        self.path = path
        self._values = values
        self._ogr = _pyogrio(f"reading {path}")
        self._layer = only_layer(self._ogr, path, "points")
        self.count = self._layer.count
        self.crs = parse_crs(path, self._layer.crs) if with_crs else None
        fields = self._layer.fields
        if values != "z" and values not in fields:
            raise UsageError(f"--values {values}: {path} has no such attribute; it has: {', '.join(fields) or 'none'}")

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        columns = [] if self._values == "z" else [self._values]
        done = 0
        while done < self.count:
            try:
                _, _, geometry, fields = self._ogr.raw.read(
                    self._layer.file,
                    layer=self._layer.name,
                    where=self._layer.where,
                    columns=columns,
                    skip_features=done,
                    max_features=CHUNK,
                )
            except errors_of(self._ogr) as error:
                raise FileError(self.path, f"cannot be read: {why(error)}") from error
            if len(geometry) == 0:
                raise truncated(self.path, done, self.count)
            points = _coordinates(self.path, geometry, done)
            xy, z = room(len(points))
            xy[:] = points[:, :2]
            if columns and fields[0].dtype.kind not in "iuf":
                raise _no_number(self.path, columns[0])
            z[:] = fields[0] if columns else points[:, 2]
            check_values(self.path, z, self._values, done)
            done += len(points)
            step(done)


def truncated(path: str, features: int, count: int) -> FileError:
    return FileError(path, f"truncated: {features} features of the {count} that it promises")


def _no_number(path: str, attribute: str) -> FileError:
    return FileError(path, f"the attribute {attribute} is no number: --values names one that is")


class ParquetSource:
    """Points of a GeoParquet file."""

    def __init__(self, path: str, values: str, with_crs: bool) -> None:
        try:
            import geopandas
            import pandas
            import pyarrow  # noqa: F401  geopandas finds it out late
            import shapely
        except ImportError as error:
            raise Unavailable(f"reading {path}", "geopandas and pyarrow", "geopandas pyarrow") from error
        self.path = path
        self._values = values
        try:
            frame = geopandas.read_parquet(path)
        except Exception as error:  # pyarrow's, geopandas' and pandas' errors have no common base
            raise FileError(path, f"cannot be read: {why(error)}") from error
        self.count = len(frame)
        self.crs = parse_crs(path, frame.crs) if with_crs else None
        if values != "z" and values not in frame.columns:
            raise UsageError(
                f"--values {values}: {path} has no such column; it has: {', '.join(map(str, frame.columns))}"
            )
        self._geometry = np.asarray(shapely.to_wkb(frame.geometry.values, byte_order=1), dtype=object)
        self._column = None
        if values != "z":
            if pandas.api.types.infer_dtype(frame[values]) not in NUMBERS:
                raise _no_number(path, values)
            self._column = frame[values].to_numpy(dtype=float, na_value=np.nan)

    def read(self, room: Room, step: Callable[[int], None]) -> None:
        points = _coordinates(self.path, self._geometry, 0)
        xy, z = room(self.count)
        xy[:] = points[:, :2]
        z[:] = points[:, 2] if self._column is None else self._column
        check_values(self.path, z, self._values, 0)
        step(self.count)


def check_values(path: str, z: NDArray[np.float64], name: str, first: int, rows: Any = None) -> None:
    """Raises FileError if a point has no value: 2D points, an empty attribute, or what is not finite. `first` is the number
    of the first point, or where only some are kept of point 0 of `rows`, their numbers."""
    bad = np.flatnonzero(~np.isfinite(z))
    if len(bad):
        number = first + int(bad[0] if rows is None else rows[bad[0]])
        what = "no height" if name == "z" else f"no number as '{name}'"
        raise FileError(path, f"point {number} (counted from 0) has {what}; name an attribute with --values")


def check_features(path: str) -> None:
    """What can be known to be wrong about an output of `write_features`, before any work."""
    _pyogrio(f"writing {path}")
    name_for_ogr(path, os.path.realpath(path))


def write_features(
    path: str,
    geometry: NDArray[np.object_],
    kind: str,
    fields: dict[str, NDArray[Any]],
    crs: pyproj.CRS | None,
    layer: str,
) -> None:
    """Writes well-known binary of one kind (LineString, Polygon Z) with its attributes. The driver is that of the suffix, and the
    file appears when it is complete."""
    ogr = _pyogrio(f"writing {path}")
    suffix = path.rsplit(".", 1)[-1].lower()
    try:
        with complete_file(path) as name:
            name = name_for_ogr(path, name)
            ogr.raw.write(
                name,
                geometry,
                list(fields.values()),
                list(fields),
                geometry_type=kind,
                driver=DRIVERS[suffix],
                crs=None if crs is None else crs.to_wkt(),
                layer=layer,  # in GeoJSON, too, whose default is the name of the temporary file
            )
            if not _is_complete(ogr, name, suffix, len(geometry)):
                raise FileError(path, "cannot be written: the file is not complete")
    except errors_of(ogr) as error:
        raise FileError(path, f"cannot be written: {why(error)}") from error


def _is_complete(ogr: Any, name: str, suffix: str, count: int) -> bool:
    """Whether the last feature is in a file, and what follows it: GDAL does not say of all formats that a disk was full."""
    try:
        _, _, last, _ = ogr.raw.read(name, columns=[], skip_features=max(count - 1, 0), max_features=1)
        if suffix == "gpkg":  # the spatial index is made when all features are there
            sql = "SELECT 1 FROM gpkg_extensions WHERE extension_name = 'gpkg_rtree_index'"
            if len(ogr.raw.read(name, sql=sql)[3][0]) == 0:
                return False
    except (ValueError, ogr.errors.DataLayerError):  # there are fewer, or there is no such table
        return False
    with open(name, "rb") as file:
        file.seek(max(os.path.getsize(name) - 64, 0))
        ended = suffix != "geojson" or file.read().rstrip().endswith(b"}")
    return ended and len(last) == min(count, 1)
