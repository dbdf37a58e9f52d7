# SPDX-License-Identifier: Apache-2.0
"""cadt tin: the triangulated terrain as a mesh (.ply, .glb) or as polygons (.gpkg, .fgb)."""

from __future__ import annotations

import argparse
import dataclasses
import json
import struct
import time
from typing import IO

import numpy as np
from numpy.typing import NDArray

from ._breaklines import check_file, inputs_of, terrain_of
from ._features import triangles_wkb
from ._files import check_output, complete_file
from ._mesh import check_max_edge, kept_triangles, read
from ._progress import ProgressLine
from ._vector import check_features, write_features
from .cloud import Cloud, require_crs
from .errors import FileError, UsageError

FEATURES = ("gpkg", "fgb")
WRITE_FORMATS = ("ply", "glb", *FEATURES)
MOST_POLYGONS = 20_000_000  # each is a Python object of some hundred bytes
GLB_LIMIT = (1 << 32) - 1
PIECE = 1 << 18


def write_ply(file: IO[bytes], cloud: Cloud, corners: NDArray[np.int32]) -> None:
    """All points as doubles, in their order."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(cloud)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    file.write(header.encode("ascii"))
    for i in range(0, len(cloud), PIECE):
        file.write(np.column_stack((cloud.xy[i : i + PIECE], cloud.z[i : i + PIECE])).astype("<f8").tobytes())
    for i in range(0, len(corners), PIECE):
        piece = corners[i : i + PIECE]
        face = np.empty(len(piece), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
        face["count"], face["corners"] = 3, piece
        file.write(face.tobytes())


def write_glb(file: IO[bytes], path: str, cloud: Cloud, corners: NDArray[np.int32]) -> None:
    """glTF 2.0: y is up and numbers are floats, so that positions are relative to the middle of the points, and the place
    of the middle is the node's translation."""
    if len(corners) == 0:
        raise UsageError(f"{path}: there are no triangles, without which there is no .glb; write a .ply")
    x0, y0, x1, y1 = cloud.bounds
    low, high = (x0, y0, float(cloud.z.min())), (x1, y1, float(cloud.z.max()))
    middle = tuple(a / 2 + b / 2 for a, b in zip(low, high))
    if not max(b - m for b, m in zip(high, middle)) <= float(np.finfo(np.float32).max):
        raise FileError(path, "the coordinates are too large for the floats of a .glb; write a .ply")
    if max(b - a for a, b in zip(low, high)) < float(np.finfo(np.float32).tiny):
        raise FileError(path, "the coordinates are too close together for the floats of a .glb; write a .ply")
    n, bytes_points, bytes_faces = len(cloud), 12 * len(cloud), 12 * len(corners)
    if 1024 + bytes_points + bytes_faces > GLB_LIMIT:
        raise UsageError(
            f"{path}: {n} points and {len(corners)} triangles are more than the 4 GiB of a .glb; write a .ply"
        )
    position = np.empty((n, 3), "<f4")
    position[:, 0] = cloud.xy[:, 0] - middle[0]
    position[:, 1] = cloud.z - middle[2]
    position[:, 2] = middle[1] - cloud.xy[:, 1]
    text = json.dumps(
        {
            "asset": {"version": "2.0", "generator": "cadt"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "name": "terrain", "translation": [middle[0], middle[2], -middle[1]]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4, "material": 0}]}],
            "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}],
            "buffers": [{"byteLength": bytes_points + bytes_faces}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": bytes_points, "target": 34962},
                {"buffer": 0, "byteOffset": bytes_points, "byteLength": bytes_faces, "target": 34963},
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": n,
                    "type": "VEC3",
                    "min": position.min(axis=0).tolist(),
                    "max": position.max(axis=0).tolist(),
                },
                {"bufferView": 1, "componentType": 5125, "count": 3 * len(corners), "type": "SCALAR"},
            ],
        },
        separators=(",", ":"),
    ).encode("ascii")
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + bytes_points + bytes_faces
    file.write(struct.pack("<4sII", b"glTF", 2, length) + struct.pack("<I4s", len(text), b"JSON") + text)
    file.write(struct.pack("<I4s", bytes_points + bytes_faces, b"BIN\0"))
    file.write(position.tobytes())
    for i in range(0, len(corners), PIECE):
        file.write(corners[i : i + PIECE].astype("<u4").tobytes())


def write_tin(path: str, cloud: Cloud, corners: NDArray[np.int32]) -> None:
    """Writes triangles (t, 3) over the points of a cloud; the format is that of the suffix. The file appears when it is
    complete.

    Raises
    ------
    UsageError
        There is no such format, or the file would be too large, or a .glb without triangles, which glTF does not have.
    FileError
        It cannot be written.
    """
    suffix = check_output(path, WRITE_FORMATS, ())
    if suffix in FEATURES:
        if len(corners) > MOST_POLYGONS:
            raise UsageError(f"{path}: {len(corners)} polygons, at most {MOST_POLYGONS}; write a .ply")
        heights = cloud.z[corners].mean(axis=1)
        polygons = triangles_wkb(cloud.xy, cloud.z, corners)
        write_features(path, polygons, "Polygon Z", {"elevation": heights}, cloud.crs, "tin")
        return
    with complete_file(path) as name, open(name, "wb") as file:
        if suffix == "ply":
            write_ply(file, cloud, corners)
        else:
            write_glb(file, path, cloud, corners)


def tin_command(options: argparse.Namespace, line: ProgressLine) -> dict[str, object]:
    start = time.monotonic()
    check_max_edge(options.max_edge)
    check_file(options)
    suffix = check_output(options.output, WRITE_FORMATS, inputs_of(options))
    if suffix in FEATURES:
        check_features(options.output)
    cloud = read(options, line)
    if suffix in FEATURES:
        require_crs(cloud, options.crs, options.output)
    name = ", ".join(cloud.sources)
    terrain = terrain_of(cloud, options, line)
    mesh, given = terrain.mesh, len(cloud)
    if options.breaklines is not None:
        cloud = dataclasses.replace(cloud, xy=np.asarray(mesh.points), z=terrain.z)
    corners = np.asarray(mesh.simplices)
    kept = kept_triangles(mesh, options.max_edge, name)
    if kept is not None:
        corners = corners[kept]
    line.step(f"writing {options.output}")
    write_tin(options.output, cloud, corners)
    return {
        "points": given,
        **terrain.said,
        "triangles": len(corners),
        "time": f"{time.monotonic() - start:.3f} s",
        "back end": mesh.device,
        "written": options.output,
    }
