# SPDX-License-Identifier: Apache-2.0
"""Exact, parallel Delaunay triangulation in the plane, on CPUs and GPUs.

>>> import cadt
>>> mesh = cadt.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]])
>>> mesh.simplices
array([[0, 1, 2],
       [1, 3, 2]], dtype=int32)
>>> mesh.find_simplex([[0.2, 0.2], [5, 5]])
array([ 0, -1], dtype=int32)

``cadt.Delaunay`` is the mesh and what it can be asked, ``cadt.ConstrainedDelaunay`` one with segments that must be edges,
and ``cadt.polygons`` triangulates many polygons; ``cadt.scipy`` has SciPy's classes and ``cadt.cupy`` CuPy's, with their
names and shapes. NumPy is imported by the first call, not by ``import cadt``.
"""

from __future__ import annotations

import importlib

TYPE_CHECKING = False  # typing's own would take most of the time of the import
if TYPE_CHECKING:
    from typing import Any

    from cadt._batch import Batch, triangulate_batch
    from cadt._constrained import ConstrainedDelaunay
    from cadt._delaunay import Delaunay
    from cadt._devices import DeviceInfo, devices, release_memory
    from cadt._errors import (
        BackendUnavailable,
        Cancelled,
        CrossingError,
        DeviceError,
        DomainError,
        Error,
        FileError,
        InputError,
        InternalError,
        InvalidMesh,
        KernelBuildError,
        LimitError,
        NotDelaunay,
        OptionError,
        OutOfMemory,
        ResumeError,
    )
    from cadt._labels import LabelSegments, label_segments, triangle_labels
    from cadt._polygons import PolygonProblem, Polygons, polygons
    from cadt._results import Check, VerifyReport, Voronoi
    from cadt._segments import find_crossings
    from cadt._verify import verify

# Where a name stands; all others of __all__ are exceptions, in _errors.
_MODULE_OF = {
    "Batch": "_batch",
    "Check": "_results",
    "ConstrainedDelaunay": "_constrained",
    "Delaunay": "_delaunay",
    "DeviceInfo": "_devices",
    "LabelSegments": "_labels",
    "PolygonProblem": "_polygons",
    "Polygons": "_polygons",
    "VerifyReport": "_results",
    "Voronoi": "_results",
    "devices": "_devices",
    "find_crossings": "_segments",
    "label_segments": "_labels",
    "polygons": "_polygons",
    "release_memory": "_devices",
    "triangle_labels": "_labels",
    "triangulate_batch": "_batch",
    "verify": "_verify",
}

__all__ = [
    "BackendUnavailable",
    "Batch",
    "Cancelled",
    "Check",
    "ConstrainedDelaunay",
    "CrossingError",
    "Delaunay",
    "DeviceError",
    "DeviceInfo",
    "DomainError",
    "Error",
    "FileError",
    "InputError",
    "InternalError",
    "InvalidMesh",
    "KernelBuildError",
    "LabelSegments",
    "LimitError",
    "NotDelaunay",
    "OptionError",
    "OutOfMemory",
    "PolygonProblem",
    "Polygons",
    "ResumeError",
    "VerifyReport",
    "Voronoi",
    "__version__",
    "devices",
    "find_crossings",
    "label_segments",
    "polygons",
    "release_memory",
    "triangle_labels",
    "triangulate_batch",
    "verify",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        value = importlib.import_module("cadt._cadt").version
    elif name in __all__:
        value = getattr(importlib.import_module(f"cadt.{_MODULE_OF.get(name, '_errors')}"), name)
    elif name in ("scipy", "cupy", "terrain", "tiles", "mpi", "dask"):
        return importlib.import_module(f"cadt.{name}")
    else:
        raise AttributeError(f"module 'cadt' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
