# SPDX-License-Identifier: Apache-2.0
"""The Delaunay triangulation. Its arrays are in _mesh.py, what it can be asked in _queries.py."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices, _gpu
from cadt._arrays import array_on_device
from cadt._mesh import Mesh
from cadt._points import as_indices, as_input, as_points
from cadt._progress import reporter
from cadt._results import VerifyReport, report_of

if TYPE_CHECKING:
    from collections.abc import Callable


class Delaunay(Mesh):
    """The Delaunay triangulation of points in the plane.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        float64 or float32, with any strides, and read where it lies; integers are converted. Lists, and objects with
        ``__array__``, ``__dlpack__`` or ``__cuda_array_interface__``: arrays of CuPy, PyTorch or JAX on a GPU stay there,
        in the current stream (queries may come in another one, and wait for the mesh's), and all results are arrays of
        the same kind on that GPU; so are arrays of PyOpenCL. (JAX has float32 in place of float64 unless
        ``jax_enable_x64`` is set.) Points that equal an earlier one are no vertices (`duplicate_of`). The points must not
        change while the mesh is used.
    backend : {"host", "opencl", "cuda"}, optional
        Where to compute. Default: where the points are; for points of the host a GPU if there is one and there are
        200,000 points or more, else the host.
    device : int or str, optional
        Device of the back end: its index in `cadt.devices`, or a part of its name.
    order : {"canonical", "fast"}
        Order of the triangles. Canonical: each starts with its lowest index and they ascend, so that the arrays are the
        same from every device and call. Fast: as the device left them.
    threads : int, optional
        Threads of the host at most. Default: one for each core.
    max_memory : int, optional
        Limit of the device's memory in bytes. What needs more is refused: a triangulation before any work, segments and
        queries at the first step that does not fit.
    statistics : {"none", "counters", "timing"}
        What `statistics` counts.
    progress : bool or callable, optional
        True: a progress bar of tqdm where it is installed, else a line on a terminal. A callable gets
        ``(phase, fraction)``; what it raises ends the call. With segments that cross a second mesh begins at 0 again.

    Raises
    ------
    InputError
        A coordinate is NaN or infinite, or the shape is wrong.
    TypeError
        The dtype cannot be taken (complex, object, strings, ...).
    LimitError
        More than 536,870,910 points.
    BackendUnavailable, OptionError, OutOfMemory, DeviceError, KernelBuildError

    Notes
    -----
    The result is exact: predicates are, and ties between cocircular points are broken by symbolic perturbation, as in
    CGAL, so the set of triangles is a function of the points alone. Expected O(n log n) work for a sort and O(n) for
    the rest. The GIL is released; Ctrl-C ends a call. Meshes never change, and threads may share them.

    Examples
    --------
    >>> mesh = Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]])
    >>> mesh
    <cadt.Delaunay: 4 points, 2 triangles, host>
    >>> mesh.neighbors
    array([[ 1, -1, -1],
           [-1,  0, -1]], dtype=int32)
    """

    def __init__(
        self,
        points: Any,
        *,
        backend: str | None = None,
        device: int | str | None = None,
        order: str = "canonical",
        threads: int | None = None,
        max_memory: int | None = None,
        statistics: str = "counters",
        progress: bool | Callable[[str, float], object] | None = None,
    ) -> None:
        self._mesh: _cadt.Triangulation | None = None
        self._gpu: _gpu.Mesh | None = None
        self._adopted = False
        self._cache: dict[str, Any] = {}
        arguments = (backend, device, order, threads, max_memory, statistics)
        if (on_gpu := array_on_device(points)) is not None:
            self._points: Any = points
            with reporter(progress) as report:
                self._gpu = _gpu.Mesh(on_gpu, arguments, report)
            self._options = self._gpu.options
            return
        self._points = as_input(points)
        n = len(self._points)
        self._options = _devices.make_options(*arguments)
        open_device = _devices.device_for(self._options, device, threads, n)
        with reporter(progress) as report:
            if open_device is not None:
                self._mesh = open_device.triangulate(self._points, self._options, report)
            else:
                if self._options.backend == "auto":
                    self._options = self._options.on_host()
                self._mesh = _cadt.triangulate(self._points, self._options, report)

    @classmethod
    def from_simplices(cls, points: Any, simplices: Any, neighbors: Any = None, *, verify: bool = True) -> Delaunay:
        """The mesh of another program, e.g. of ``scipy.spatial.Delaunay``.

        Parameters
        ----------
        points : array_like, shape (n, 2)
        simplices : array_like of int, shape (t, 3)
            Vertices of each triangle; clockwise ones are turned.
        neighbors : array_like of int, shape (t, 3), optional
            Of each triangle, the one opposite each vertex, -1 outside. Derived if missing.
        verify : bool
            Whether the whole mesh is verified exactly. False: its structure alone, so that no query can run away.

        Raises
        ------
        InvalidMesh
            It is no Delaunay triangulation of the points; `check` names the first check that failed.

        Examples
        --------
        >>> Delaunay.from_simplices([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]).n_triangles
        1
        """
        p = as_points(points)
        triangles = as_indices(simplices, "simplices")
        of = None if neighbors is None else as_indices(neighbors, "neighbors")
        if len(triangles) and triangles.min() >= 0 and triangles.max() < len(p):
            turn = _cadt.clockwise(p, triangles).view(bool)
            triangles[turn] = triangles[turn][:, [0, 2, 1]]
            if of is not None and of.shape == triangles.shape:
                of[turn] = of[turn][:, [0, 2, 1]]
        return cls._of_mesh(p, _cadt.adopt(p, triangles, of, verify), adopted=True)

    @classmethod
    def _of_mesh(
        cls,
        points: np.ndarray,
        mesh: _cadt.Triangulation,
        options: _cadt.Options | None = None,
        *,
        adopted: bool = False,
    ) -> Delaunay:
        self = cls.__new__(cls)
        self._points, self._mesh, self._gpu, self._cache, self._adopted = points, mesh, None, {}, adopted
        self._options = options or _devices.make_options("host", None, "canonical", None, None, "counters")
        return self

    @property
    def hash(self) -> str:
        """32 hexadecimal digits: a hash of the set of triangles, of duplicates, and of the numbers of points and of hull
        vertices. The same from every device and order."""
        return self._host("hash", lambda m: m.hash())

    def verify(self) -> VerifyReport:
        """Checks the whole mesh exactly, with predicates that share no code with those that made it. O(n).

        Another program's (`from_simplices`) may break ties and choose among equal points as it likes, as for `cadt.verify`.
        """
        if self._adopted:
            mesh = self._host_mesh
            return report_of(_cadt.verify(self._host_points, mesh.triangles, mesh.neighbors))
        return report_of(self._host_mesh.verify(self._host_points))

    def __repr__(self) -> str:
        return f"<cadt.Delaunay: {self.n_points:,} points, {self.n_triangles:,} triangles, {self.device}>"

    def __reduce__(self) -> tuple:
        mesh = self._host_mesh
        return _restore, (type(self), self._host_points, mesh.triangles, mesh.neighbors, self._adopted)


def _restore(
    cls: type[Delaunay], points: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, adopted: bool = False
) -> Delaunay:
    return cls._of_mesh(points, _cadt.adopt(points, simplices, neighbors, False), adopted=adopted)
