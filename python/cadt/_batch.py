# SPDX-License-Identifier: Apache-2.0
"""Many small sets in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cadt import _cadt, _devices
from cadt._arrays import as_host_points
from cadt._delaunay import Delaunay
from cadt._errors import InputError
from cadt._points import index_of
from cadt._progress import reporter
from cadt._segments import as_offsets

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class Batch:
    """The triangulations of many sets: ``batch[s]`` is that of set s, a `Delaunay`.

    Attributes
    ----------
    simplices, neighbors : (t, 3) int32
        Of all sets, one after another; indices are those of the set's own points and triangles.
    triangle_offsets : (sets + 1,) int64
        Set s has the triangles ``triangle_offsets[s]`` to ``triangle_offsets[s + 1] - 1``.
    statistics : dict
        Of the whole call.
    """

    def __init__(self, points: np.ndarray, offsets: np.ndarray, batch: Any, options: _cadt.Options | None) -> None:
        self._points, self._offsets, self._options = points, offsets, options
        self._of_set: Callable[[int], _cadt.Triangulation] = batch.triangulation
        self.simplices: np.ndarray = batch.triangles
        self.neighbors: np.ndarray = batch.neighbors
        self.triangle_offsets: np.ndarray = batch.triangle_offsets
        self.statistics: dict[str, Any] = batch.statistics

    def __len__(self) -> int:
        return len(self.triangle_offsets) - 1

    def __getitem__(self, s: int) -> Delaunay:
        s = index_of(s, len(self), "set")
        points = self._points[self._offsets[s] : self._offsets[s + 1]]
        return Delaunay._of_mesh(points, self._of_set(s), self._options and self._options.on_host())

    def __iter__(self) -> Iterator[Delaunay]:
        return (self[s] for s in range(len(self)))

    def __reduce__(self) -> tuple:
        arrays = (self.simplices, self.neighbors, self.triangle_offsets, self.statistics)
        return _restore, (self._points, self._offsets, *arrays)

    def __repr__(self) -> str:
        return f"<cadt.Batch: {len(self):,} sets, {len(self._points):,} points, {len(self.simplices):,} triangles>"


class _Arrays(NamedTuple):
    """The arrays of a batch that was pickled, in place of the library's."""

    points: np.ndarray
    offsets: np.ndarray
    triangles: np.ndarray
    neighbors: np.ndarray
    triangle_offsets: np.ndarray
    statistics: dict[str, Any]

    def triangulation(self, s: int) -> _cadt.Triangulation:
        points = self.points[self.offsets[s] : self.offsets[s + 1]]
        own = slice(self.triangle_offsets[s], self.triangle_offsets[s + 1])
        return _cadt.adopt(points, self.triangles[own], self.neighbors[own], False)


def _restore(points: np.ndarray, offsets: np.ndarray, *arrays: Any) -> Batch:
    return Batch(points, offsets, _Arrays(points, offsets, *arrays), None)


def triangulate_batch(
    points: Any,
    offsets: Any,
    *,
    backend: str | None = None,
    device: int | str | None = None,
    order: str = "canonical",
    threads: int | None = None,
    max_memory: int | None = None,
    progress: bool | Callable[[str, float], object] | None = None,
) -> Batch:
    """Triangulates many sets in one call, small ones with common launches.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        The points of all sets, one set after another.
    offsets : array_like of int, shape (sets + 1,)
        Set s has the points ``offsets[s]`` to ``offsets[s + 1] - 1``; the first is 0, the last n. Sets may be empty.

    Notes
    -----
    The other parameters, and what is raised, are as for `Delaunay`.

    Examples
    --------
    >>> batch = cadt.triangulate_batch([[0, 0], [1, 0], [0, 1], [0, 0], [2, 0], [2, 2]], [0, 3, 6])
    >>> len(batch), batch[1].simplices.tolist()
    (2, [[0, 1, 2]])
    """
    p = as_host_points(points)
    begin = as_offsets(offsets, "offsets", "integers of shape (sets + 1,)")
    if begin.min() < 0:
        raise InputError("offsets must not be negative", int(np.argmin(begin)))
    begin = begin.copy()  # the caller may change what was given
    options = _devices.placed(_devices.make_options(backend, device, order, threads, max_memory, "counters"), len(p))
    with reporter(progress) as report:
        return Batch(p, begin, _cadt.triangulate_batch(p, begin, options, report), options)
