# SPDX-License-Identifier: Apache-2.0
"""What `Delaunay` and `Voronoi` share: whose they are, cadt's or SciPy's, and points that are added."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

import cadt
from cadt.scipy._qhull import FlatPointsError, as_doubles, options_of, say

if TYPE_CHECKING:
    from collections.abc import Callable


class Plane:
    """A base before SciPy's class. `mesh` is None where that class does the work."""

    mesh: cadt.Delaunay | None = None
    _default_options: str
    _points: np.ndarray
    _incremental = False

    def __init__(
        self,
        points: Any,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        backend: str | None = None,
        device: int | str | None = None,
        threads: int | None = None,
        progress: bool | Callable[[str, float], object] | None = None,
    ) -> None:
        mesh = points if isinstance(points, cadt.Delaunay) else None
        points = as_doubles(points if mesh is None else mesh.points)
        options, reason = options_of(qhull_options, incremental, self._default_options)
        if points.shape[1] != 2:
            reason = f"{type(self).__name__} in {points.shape[1]} dimensions"
        elif furthest_site:
            reason = "furthest_site=True"
        if reason:
            self._leave_to_scipy(reason, points, furthest_site, incremental, qhull_options)
            return
        self._how: dict[str, Any] = {"backend": backend, "device": device, "threads": threads, "progress": progress}
        self._options, self._qhull_options = options, qhull_options
        self._incremental = incremental
        self.furthest_site = False
        self._take(points.copy() if incremental else points, mesh)

    def _leave_to_scipy(self, reason: str, *arguments: Any) -> None:
        say(reason, 5)
        super().__init__(*arguments)

    def _take(self, points: np.ndarray, mesh: cadt.Delaunay | None = None) -> None:
        if mesh is None:
            mesh = cadt.Delaunay(points, **self._how)
        if mesh.n_triangles == 0:
            if len(points) == 0:
                raise ValueError("No points given")
            where = "there are fewer than three points" if len(points) < 3 else "all points are on one line or equal"
            raise FlatPointsError(f"no triangle: {where}")
        if "QJ" in self._options and len(mesh.simplices) and (mesh.duplicate_of >= 0).any():
            # QJ promises that every point is a vertex, which is so anyway but for duplicates.
            self.__dict__.pop("mesh", None)
            self._leave_to_scipy(
                "Qhull option QJ with duplicates", points, False, self._incremental, self._qhull_options
            )
            return
        self.mesh = mesh
        self._points = points
        self.npoints, self.ndim = points.shape
        self._reset()

    def _reset(self) -> None:
        """Forgets what was computed from the points before."""
        for name in [n for c in type(self).__mro__ for n, v in vars(c).items() if isinstance(v, cached_property)]:
            self.__dict__.pop(name, None)

    @property
    def _mesh(self) -> cadt.Delaunay:
        # Asked for by attributes that SciPy's own instances have from the beginning.
        if self.mesh is None:
            raise AttributeError(f"this {type(self).__name__} is incomplete: its constructor has failed")
        return self.mesh

    @cached_property
    def min_bound(self) -> np.ndarray:
        return self._points.min(axis=0)

    @cached_property
    def max_bound(self) -> np.ndarray:
        return self._points.max(axis=0)

    def add_points(self, points: Any, restart: bool = False) -> None:
        """Adds points to what was made with ``incremental=True``. All points are triangulated anew.

        If that raises, everything is as before.
        """
        if self.mesh is None:
            super().add_points(points, restart)  # type: ignore[misc]
            return
        if not self._incremental:
            raise RuntimeError("incremental mode not enabled or already closed")
        points = as_doubles(points)
        if points.shape[1] != 2:
            raise ValueError(f"points must have shape (n, 2), not {points.shape}")
        self._take(np.concatenate([self._points, points], axis=0))

    def __getstate__(self) -> dict[str, Any]:
        state = {name: value for name, value in self.__dict__.items() if name != "_hull_finder"}
        if "_how" in state:  # its function need not be one that can be pickled
            state["_how"] = {**self._how, "progress": None}
        return state

    def close(self) -> None:
        """Ends incremental processing: points can no longer be added."""
        self._incremental = False
        super().close()  # type: ignore[misc]

    def __repr__(self) -> str:
        if self.mesh is None:
            return super().__repr__()
        return f"<cadt.scipy.{type(self).__name__}: {self.npoints:,} points, {self.mesh.n_triangles:,} triangles>"
