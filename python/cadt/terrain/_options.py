# SPDX-License-Identifier: Apache-2.0
"""The command line: the words of the program cadt, and help that teaches by examples."""

from __future__ import annotations

import argparse
import difflib
import itertools
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

from ._say import write_out
from .cloud import READ_FORMATS
from .errors import UsageError

SUMMARIES = {
    "raster": "heights between points as a GeoTIFF: LAS, LAZ, GeoPackage ... to a terrain model",
    "contour": "contour lines of the triangulated terrain",
    "tin": "the triangulated terrain itself: a mesh or polygons",
}

EXIT_CODES = """\
Exit codes: 0 done, 1 internal error, 2 the command line is wrong, 3 a file cannot be read, is damaged, holds nothing of
use, or cannot be written, or breaklines cross, 5 a back end, a device or a Python package is not available, 6 out of
memory, 130 interrupted.
Nothing is left behind by a run that fails.
"""

EXAMPLES = {
    "raster": """\
Examples:
  cadt raster scan.laz dem.tif --res 1 --class 2
      a terrain model of the ground points, one metre a cell, with the reference system of the scan
  cadt raster west.laz east.laz dem.tif --res 0.5 --max-edge 30
      two files as one cloud; no data where triangles have edges over 30, such as bays and lakes
  cadt raster scan.laz new.tif --align old.tif --fill nearest
      the very cells of another raster, to subtract them, without gaps
  cadt raster depths.gpkg sea.tif --res 10 --values depth --method natural
      points with an attribute; smooth, by natural neighbours
  cadt raster scan.laz dem.tif --res 1 --class 2,9 --breaklines lakes.gpkg
      triangles end at the shores, and at banks and ridges
  cadt raster tiles/*.laz country.tif --res 0.5 --class 2 --max-edge 100 --scratch /mnt/fast
      more points than memory takes: they go through a fast disk

A cell has the value at its centre, exactly that of the Delaunay triangulation of all points. The file is a
cloud-optimised GeoTIFF: tiles, overviews, compressed.
""",
    "contour": """\
Examples:
  cadt contour scan.laz lines.gpkg --interval 5 --class 2
      a line each 5 metres of height, with the attribute elevation
  cadt contour scan.laz lines.fgb --interval 1 --base 0.5 --max-edge 50
      at 0.5, 1.5, 2.5 ...; none through triangles with edges over 50
  cadt contour scan.laz lines.gpkg --interval 1 --class 2,9 --breaklines lakes.gpkg
      they bend at banks and shores, as the triangles do

The lines are those of the triangles themselves, so that they pass exactly through the surface that `cadt raster` samples.
Higher ground is on the left. For lines of a raster use gdal_contour.
""",
    "tin": """\
Examples:
  cadt tin scan.laz terrain.ply --class 2
      all points and triangles, in double precision, for CloudCompare, MeshLab, ParaView
  cadt tin scan.laz terrain.glb --max-edge 50
      for browsers and Blender
  cadt tin survey.gpkg triangles.gpkg
      a polygon with heights for each triangle, for QGIS
  cadt tin scan.laz terrain.ply --class 2,9 --breaklines lakes.gpkg
      the points of the lines are vertices, before the others
""",
}


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see: {self.prog} --help")

    def print_help(self, file: Any = None) -> None:
        write_out(self.format_help())


class _Once(argparse.Action):
    """An option with a value, which the last of several would take from the others."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option_string: str | None = None) -> None:
        given = namespace.__dict__.setdefault("_given", set())
        if option_string is not None and self.dest in given:
            parser.error(f"{option_string} is given twice")
        given.add(self.dest)
        setattr(namespace, self.dest, values)


def _classes(text: str) -> list[int]:
    try:
        numbers = [int(word) for word in text.replace(",", " ").split()]
    except ValueError:
        numbers = []
    if not numbers or not all(0 <= number <= 255 for number in numbers):
        raise argparse.ArgumentTypeError(f"{text}: classes are whole numbers from 0 to 255, such as 2 or 2,9")
    return numbers


def _threads(text: str) -> int:
    if not text.isdecimal() or int(text) > 4096:
        raise argparse.ArgumentTypeError(f"{text}: a number from 0 to 4096 is needed")
    return int(text)


def _input(parser: argparse.ArgumentParser, outputs: str) -> None:
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help=f"one file of points or several ({' '.join(READ_FORMATS)}), and at the end the output, if it is not named with -o: {outputs}",
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="the output; then all others are inputs")
    parser.add_argument(
        "--class",
        dest="classes",
        type=_classes,
        metavar="C[,C]",
        help="take the points of these classes of LAS and LAZ files alone: 2 is ground, 9 water",
    )
    parser.add_argument(
        "--values", default="z", metavar="NAME", help="what a point's height is: z (default), or an attribute's name"
    )
    parser.add_argument(
        "--columns", default="", metavar="X,Y,Z", help="columns of a table, counted from 1 or by their header names"
    )
    parser.add_argument(
        "--crs",
        metavar="CRS",
        help="reference system, if the files do not say it or say it wrongly: EPSG:25832; none: write without one",
    )
    parser.add_argument(
        "--max-edge",
        type=float,
        metavar="L",
        help="leave out triangles with a longer edge: bays and holes in the points stay open",
    )


def _work(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--backend",
        choices=("auto", "host", "opencl", "cuda"),
        default="auto",
        help="where to compute: auto, host, opencl or cuda (default: auto, the fastest usable)",
    )
    parser.add_argument(
        "--device",
        metavar="DEVICE",
        help="device of the back end, its number or a part of its name (see: cadt devices)",
    )
    parser.add_argument(
        "--threads", type=_threads, default=0, metavar="N", help="host threads; 0 takes all cores (default: 0)"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="nothing on standard error but errors")


def _breaklines(parser: argparse.ArgumentParser, limit: str = "") -> None:
    parser.add_argument(
        "--breaklines",
        metavar="FILE",
        help="lines and outlines of polygons that triangles do not cross (.gpkg .geojson .fgb .shp): banks, ridges, lakes; "
        f"heights are the file's, or where it has none those between the points{limit}",
    )


def _raster(parser: argparse.ArgumentParser) -> None:
    _input(parser, "a GeoTIFF, .tif")
    parser.add_argument("--res", type=float, metavar="R", help="width and height of a cell, in the units of the points")
    parser.add_argument(
        "--bounds",
        default="",
        metavar="X0,Y0,X1,Y1",
        help="rectangle to cover (default: the box of the points); --bounds=-1,... if negative",
    )
    parser.add_argument(
        "--align",
        metavar="GRID.tif",
        help="take the cells of this raster instead of --res; with --bounds those that cover it",
    )
    parser.add_argument(
        "--method",
        choices=("linear", "nearest", "natural"),
        default="linear",
        help="between the points: linear (in the triangle; default), nearest (the nearest point's) or natural (natural neighbours: smooth)",
    )
    _breaklines(parser, "; --method linear alone")
    parser.add_argument(
        "--fill",
        choices=("none", "nearest"),
        default="none",
        help="cells without data: none (default), or the nearest point's value",
    )
    parser.add_argument(
        "--nodata",
        type=float,
        default=-9999.0,
        metavar="V",
        help="value of cells without data (default: -9999); nan is one",
    )
    parser.add_argument(
        "--dtype",
        choices=("float64", "float32"),
        default="float64",
        help="numbers of the file: float64 (default), or float32 for half the size",
    )
    parser.add_argument(
        "--scratch",
        metavar="DIR",
        help="for more points than memory takes: keep them in a temporary folder of DIR, 56 bytes each; --method linear alone",
    )
    parser.add_argument(
        "--tile-points",
        type=int,
        metavar="N",
        help="with --scratch: triangulate at most N points at a time (default: what a quarter of the free memory takes)",
    )
    _work(parser)


def _contour(parser: argparse.ArgumentParser) -> None:
    _input(parser, ".gpkg .fgb .geojson")
    parser.add_argument("--interval", type=float, required=True, metavar="D", help="height between two lines")
    parser.add_argument("--base", type=float, default=0.0, metavar="H", help="height of one of the lines (default: 0)")
    _breaklines(parser)
    _work(parser)


def _tin(parser: argparse.ArgumentParser) -> None:
    _input(parser, ".ply .glb .gpkg .fgb")
    _breaklines(parser)
    _work(parser)


_ADD = {"raster": _raster, "contour": _contour, "tin": _tin}


def parser_of(command: str) -> argparse.ArgumentParser:
    parser = _Parser(
        prog=f"cadt {command}",
        usage=f"cadt {command} IN [IN...] OUT [options]",
        description=SUMMARIES[command][0].upper() + SUMMARIES[command][1:] + ".",
        epilog=EXAMPLES[command] + "\n" + EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.register("action", None, _Once)
    _ADD[command](parser)
    return parser


def suggestion(word: str, names: Iterable[str]) -> str:
    """Which of the names may be meant; nothing if none is near."""
    near = difflib.get_close_matches(word, names, 1, 0.7)
    return f"; did you mean {near[0]}?" if near else ""


def parse(command: str, words: Sequence[str]) -> argparse.Namespace:
    """The options; `inputs` and `output` are told apart."""
    parser = parser_of(command)
    known = [name for action in parser._actions for name in action.option_strings]
    for word in itertools.takewhile(lambda word: word != "--", words):  # before what is missing
        name = word.split("=")[0]
        if name.startswith("--") and name not in known:
            if command == "raster" and name in ("--segments", "--crossing"):
                raise UsageError(f"{name} is for .asc, .npy and .png; with a GeoTIFF lines are read by --breaklines")
            parser.error(f"cadt {command} has no option {name}{suggestion(name, known)}")
    options = parser.parse_intermixed_args(words)
    files = list(options.files)
    if options.output is None:
        if len(files) < 2:
            raise UsageError(f"an output is missing: cadt {command} {files[0]} OUT ...; see: cadt {command} --help")
        options.output = files.pop()
    options.inputs = files
    return options


def main_help() -> str:
    commands = "\n".join(f"  cadt {name:<8} {text}" for name, text in SUMMARIES.items())
    return f"""\
usage: cadt raster|contour|tin IN [IN...] OUT [options]

The part of the program cadt that reads LAS, LAZ and GIS files.

{commands}

Each command has its own help: cadt raster --help
"""
