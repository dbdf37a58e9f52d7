# SPDX-License-Identifier: Apache-2.0
"""Exceptions. Each carries what a program needs to react; the message says what to do.

A dtype that cannot be taken is a TypeError.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


class Error(RuntimeError):
    """Base of all exceptions that cadt raises on purpose."""


class InputError(Error, ValueError):
    """A coordinate that is NaN or infinite, or arrays whose sizes do not fit together.

    Attributes
    ----------
    index : int
        The first offending point, or what the message names: a segment, query, offset or pixel.
    """

    def __init__(self, message: str, index: int = 0) -> None:
        super().__init__(message)
        self.index = index

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.index)


class InvalidMesh(Error, ValueError):
    """A mesh of another program that is no Delaunay triangulation of its points.

    Attributes
    ----------
    check : str
        The first check that failed, as in `VerifyReport`.
    first : int
        The first triangle, point or edge that failed it; -1: none in particular.
    """

    def __init__(self, message: str, check: str = "", first: int = -1) -> None:
        super().__init__(message)
        self.check = check
        self.first = first

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.check, self.first)


class LimitError(Error, ValueError):
    """More points than 32-bit indices allow: `count` instead of at most `limit`."""

    def __init__(self, message: str, count: int = 0, limit: int = 0) -> None:
        super().__init__(message)
        self.count = count
        self.limit = limit

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.count, self.limit)


class OptionError(Error, ValueError):
    """An argument that is out of range, or excluded by another; `option` is its name."""

    def __init__(self, message: str, option: str = "") -> None:
        super().__init__(message)
        self.option = option

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.option)


class BackendUnavailable(Error):
    """The requested back end or device is not available; `reason` says why. There is no silent fallback."""

    def __init__(self, message: str, backend: str = "", reason: str = "") -> None:
        super().__init__(message)
        self.backend = backend
        self.reason = reason

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.backend, self.reason)


class OutOfMemory(Error, MemoryError):
    """Not enough memory on the device or below ``max_memory``: `needed` and `available` bytes (0: unknown)."""

    def __init__(self, message: str, needed: int = 0, available: int = 0) -> None:
        super().__init__(message)
        self.needed = needed
        self.available = available

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.needed, self.available)


class DeviceError(Error):
    """A call of the device's runtime failed: `call` with `code` on `device`."""

    def __init__(self, message: str, call: str = "", device: str = "", code: int = 0) -> None:
        super().__init__(message)
        self.call = call
        self.device = device
        self.code = code

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.call, self.device, self.code)


class KernelBuildError(Error):
    """The device's compiler rejected the kernels; `log` is its output."""

    def __init__(self, message: str, device: str = "", options: str = "", log: str = "") -> None:
        super().__init__(message)
        self.device = device
        self.options = options
        self.log = log

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.device, self.options, self.log)


class FileError(Error, OSError):
    """A file that cannot be read, is malformed, or cannot be written; `path` is its name."""

    def __init__(self, message: str, path: str = "") -> None:
        super().__init__(message)
        self.path = path

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.path)


class ResumeError(Error):
    """There is a mesh directory already, or one of other points, another tile size or format."""


class CrossingError(Error, ValueError):
    """Segments cross; `pairs`: all pairs of them, (p, 2) int32, each once with the lower index first, ascending."""

    def __init__(self, message: str, pairs: Any = ()) -> None:
        super().__init__(message)
        self.pairs = pairs

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.pairs)


class DomainError(Error, ValueError):
    """Segments bound no domain: they do not close at the point `vertex`."""

    def __init__(self, message: str, vertex: int = -1) -> None:
        super().__init__(message)
        self.vertex = vertex

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.vertex)


class NotDelaunay(Error):
    """A question that only a Delaunay mesh answers right (nearest vertices, natural neighbours, Voronoi diagrams, empty
    circles), and a mesh with an edge that is not: `edge` is 3 * triangle + k, opposite vertex k. Ask `Delaunay` of the
    same points."""

    def __init__(self, message: str, edge: int = -1) -> None:
        super().__init__(message)
        self.edge = edge

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.edge)


class Cancelled(Error):
    """The call was cancelled and has no result."""


class InternalError(Error):
    """cadt has found an error of its own: please report it."""
