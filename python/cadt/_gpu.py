# SPDX-License-Identifier: Apache-2.0
"""Points that are on a GPU: arrays of CuPy, PyTorch, JAX and PyOpenCL stay there, and results are of the same kind."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np

from cadt import _cadt, _devices
from cadt._errors import BackendUnavailable, InputError, OptionError

_HOST = 1  # DLPack's kDLCPU


def array_on_device(points: Any) -> Array | None:
    """The adapter for an array on a GPU; None for everything on the host."""
    if type(points) in (np.ndarray, list, tuple):
        return None
    package = type(points).__module__.partition(".")[0]
    if package == "pyopencl" and hasattr(points, "queue"):
        return OpenCl(points)
    if package == "torch":
        return Torch(points) if points.is_cuda else None
    if package == "cupy":
        return CuPy(points)
    if package in ("jax", "jaxlib"):
        return Jax(points) if next(iter(points.devices())).platform in ("gpu", "cuda") else None
    if hasattr(points, "__cuda_array_interface__"):
        return CudaInterface(points)
    if hasattr(points, "__dlpack_device__") and int(points.__dlpack_device__()[0]) not in (_HOST, 3):
        raise TypeError(
            f"arrays of {package} on a device are not known to cadt: pass one with __cuda_array_interface__, "
            "or of CuPy, PyTorch, JAX or PyOpenCL"
        )
    return None


class Array:
    """An array on a device and its library. `a` has shape (n, 2), float64 or float32, and is contiguous."""

    backend = "cuda"
    device: int | None = 0
    queue: int | None = None
    stream: Any = None  # the object that owns the queue

    def __init__(self, a: Any) -> None:
        self.a = self.rows(a, "points")

    def rows(self, a: Any, what: str) -> Any:
        if len(a.shape) != 2 or a.shape[1] != 2:
            raise InputError(f"{what} must have shape (n, 2), not {tuple(a.shape)}", 0)
        name = str(a.dtype).rpartition(".")[2]
        if name not in ("float32", "float64"):
            if not (name.startswith(("int", "uint")) and name not in ("int64", "uint64")) and name != "float16":
                raise TypeError(f"{what} must be float64 or float32, not {name}: convert them first")
            a = self.convert(a, "float64")
        return self.contiguous(a)

    def coordinates(self, a: Any) -> _cadt.DevicePoints:
        return _cadt.DevicePoints(self.address(a), a.shape[0], "float32" in str(a.dtype))

    def memory(self, a: Any) -> tuple[int, int]:
        return (self.address(a), math.prod(a.shape))

    # What each library does in its own words.
    def convert(self, a: Any, dtype: str) -> Any:
        raise NotImplementedError

    def contiguous(self, a: Any) -> Any:
        raise NotImplementedError

    def address(self, a: Any) -> int:
        return a.__cuda_array_interface__["data"][0]

    def to_host(self) -> np.ndarray:
        raise NotImplementedError

    def like(self, host: Any) -> Any:
        """An array of the host (or several) on the device."""
        if isinstance(host, tuple):
            return tuple(self.like(h) for h in host)
        return self.from_host(np.ascontiguousarray(host))

    def from_host(self, host: np.ndarray) -> Any:
        raise NotImplementedError

    def is_here(self, a: Any) -> bool:
        """Whether an argument is an array of this library already."""
        return isinstance(a, type(self.a))

    def take(self, a: Any, dtype: str) -> Any:
        """An argument as a contiguous array of this library on the device."""
        a = a if self.is_here(a) else self.from_host(np.ascontiguousarray(a))
        return self.contiguous(a if str(a.dtype).rpartition(".")[2] == dtype else self.convert(a, dtype))

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        raise NotImplementedError

    def triangles(self, mesh: Any, which: str) -> Any:
        """The arrays of a mesh, without a copy; they keep it."""
        raise NotImplementedError


class CuPy(Array):
    def __init__(self, a: Any) -> None:
        import cupy

        self.xp = cupy
        self.device = int(a.device.id)
        with cupy.cuda.Device(self.device):
            self.stream = cupy.cuda.get_current_stream()
            self.queue = int(self.stream.ptr)
            super().__init__(a)

    def convert(self, a: Any, dtype: str) -> Any:
        return a.astype(dtype)

    def contiguous(self, a: Any) -> Any:
        return self.xp.ascontiguousarray(a)

    def address(self, a: Any) -> int:
        return int(a.data.ptr)

    def to_host(self) -> np.ndarray:
        return self.xp.asnumpy(self.a)

    def from_host(self, host: np.ndarray) -> Any:
        with self.xp.cuda.Device(self.device):
            return self.xp.asarray(host)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        with self.xp.cuda.Device(self.device):
            return self.xp.empty(shape, dtype)

    def triangles(self, mesh: Any, which: str) -> Any:
        if mesh.number_of_triangles == 0:
            return self.empty((0, 3), "int32")
        return self.xp.from_dlpack(getattr(_cadt, f"cuda_{which}")(mesh))


class CudaInterface(CuPy):
    """Any other object with ``__cuda_array_interface__``, such as Numba's: results are CuPy's."""

    def __init__(self, a: Any) -> None:
        try:
            import cupy
        except ImportError:
            raise TypeError(
                f"results for {type(a).__module__}.{type(a).__name__} on a GPU are CuPy's arrays: pip install cupy-cuda13x"
            ) from None
        super().__init__(cupy.asarray(a))


class Torch(Array):
    def __init__(self, a: Any) -> None:
        self.xp = sys.modules["torch"]
        self.where = a.device
        self.device = a.device.index
        self.stream = self.xp.cuda.current_stream(a.device)
        self.queue = int(self.stream.cuda_stream)
        super().__init__(a.detach())

    def convert(self, a: Any, dtype: str) -> Any:
        return a.to(getattr(self.xp, dtype))

    def contiguous(self, a: Any) -> Any:
        return a.contiguous()

    def address(self, a: Any) -> int:
        return int(a.data_ptr())

    def to_host(self) -> np.ndarray:
        return self.a.cpu().numpy()

    def from_host(self, host: np.ndarray) -> Any:
        return self.xp.from_numpy(np.array(host)).to(self.where)

    def is_here(self, a: Any) -> bool:
        return isinstance(a, self.xp.Tensor) and a.device == self.where

    def take(self, a: Any, dtype: str) -> Any:
        if isinstance(a, self.xp.Tensor):
            a = a.detach().to(self.where)
        return super().take(a, dtype)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        return self.xp.empty(shape, dtype=getattr(self.xp, dtype), device=self.where)

    def triangles(self, mesh: Any, which: str) -> Any:
        if mesh.number_of_triangles == 0:
            return self.empty((0, 3), "int32")
        return self.xp.from_dlpack(getattr(_cadt, f"cuda_{which}")(mesh))


class Jax(Array):
    """JAX has no arrays that others write to: the mesh stays on the GPU, the answers to queries go through the host."""

    def __init__(self, a: Any) -> None:
        self.jax = sys.modules["jax"]
        a.block_until_ready()  # JAX names no stream
        self.where = next(iter(a.devices()))
        self.device = int(self.where.local_hardware_id)
        self.queue = 1  # cudaStreamLegacy
        super().__init__(a)

    def convert(self, a: Any, dtype: str) -> Any:
        return self.jax.numpy.asarray(a, "float32").block_until_ready()

    def contiguous(self, a: Any) -> Any:
        return a

    def address(self, a: Any) -> int:
        return int(a.unsafe_buffer_pointer())

    def to_host(self) -> np.ndarray:
        return np.asarray(self.a)

    def from_host(self, host: np.ndarray) -> Any:
        return self.jax.device_put(host, self.where)

    def triangles(self, mesh: Any, which: str) -> Any:
        if mesh.number_of_triangles == 0:
            return self.from_host(np.empty((0, 3), np.int32))
        return self.jax.numpy.from_dlpack(getattr(_cadt, f"cuda_{which}")(mesh))


class OpenCl(Array):
    backend = "opencl"
    device = None

    def __init__(self, a: Any) -> None:

        self.cl = sys.modules["pyopencl"]
        self.cl_queue = self.stream = a.queue
        self.queue = int(a.queue.int_ptr)
        super().__init__(a)

    def convert(self, a: Any, dtype: str) -> Any:
        return a.astype(dtype)

    def contiguous(self, a: Any) -> Any:
        return a if a.flags.c_contiguous and not a.offset else a.copy()  # parts of buffers begin anywhere

    def address(self, a: Any) -> int:
        return int(a.base_data.int_ptr)

    def to_host(self) -> np.ndarray:
        return self.a.get()

    def from_host(self, host: np.ndarray) -> Any:
        return self.cl.array.to_device(self.cl_queue, host)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        return self.cl.array.empty(self.cl_queue, shape, dtype)

    def triangles(self, mesh: Any, which: str) -> Any:
        handle = getattr(mesh, f"{which}_handle")
        if not handle:
            return self.cl.array.empty(self.cl_queue, (0, 3), np.int32)
        buffer = self.cl.Buffer.from_int_ptr(handle)
        result = self.cl.array.Array(self.cl_queue, (mesh.number_of_triangles, 3), np.int32, data=buffer)
        result._cadt_mesh = mesh  # the memory is the mesh's
        return result


class Mesh:
    """A mesh in device memory and what it can be asked."""

    def __init__(self, array: Array, arguments: tuple, report: Any) -> None:
        backend, device, order, threads, max_memory, statistics = arguments
        if backend not in (None, array.backend):
            raise OptionError(
                f"the points are in the memory of a {array.backend} device: leave backend out, or pass points of the host",
                "backend",
            )
        if device is not None:
            raise OptionError("points on a device are triangulated there: leave device out", "device")
        if statistics == "none":
            raise OptionError("statistics='none' would not wait for the device; use 'counters'", "statistics")
        self.array = array
        self.options = _devices.make_options(
            array.backend, array.device, order, threads, max_memory, statistics, array.queue
        )
        key = (array.backend, array.device, threads, array.queue)
        self.triangulator = _devices.open_device(self.options, key, array.stream)
        if self.triangulator.backend != array.backend:
            raise BackendUnavailable("the device of the points cannot be used", array.backend, "")
        self.points = array.coordinates(array.a)
        self.mesh = _cadt.triangulate_on_device(self.triangulator, self.points, self.options, report)
        self._queries: Any = None

    @property
    def simplices(self) -> Any:
        return self.array.triangles(self.mesh, "triangles")

    @property
    def neighbors(self) -> Any:
        return self.array.triangles(self.mesh, "neighbors")

    def bounds(self) -> tuple[float, float, float, float]:
        p = self.array.to_host()
        return (float(p[:, 0].min()), float(p[:, 1].min()), float(p[:, 0].max()), float(p[:, 1].max()))

    def _ask(self) -> Any:
        if isinstance(self.array, Jax):
            raise NotImplementedError("queries of JAX arrays: ask cadt.Delaunay(np.asarray(points)), on the host")
        if self.mesh.number_of_triangles == 0:
            raise InputError("a mesh without triangles on a device cannot be asked: pass points of the host", 0)
        if self._queries is None:
            self._queries = _cadt.DeviceQueries(self.mesh, self.points)
        return self._queries

    def _rows(self, xi: Any) -> tuple[Any, tuple[int, ...]]:
        xi = xi if self.array.is_here(xi) else self.array.like(np.asarray(xi, dtype=np.float64))
        if len(xi.shape) == 0 or xi.shape[-1] != 2:
            raise InputError(f"queries must have shape (..., 2), not {tuple(xi.shape)}", 0)
        shape = tuple(xi.shape[:-1])
        return self.array.rows(xi.reshape(math.prod(shape), 2), "queries"), shape

    def find_simplex(self, xi: Any) -> Any:
        q, shape = self._rows(xi)
        result = self.array.empty(shape, "int32")
        self._ask().locate(self.array.coordinates(q), self.array.memory(result))
        return result

    def barycentric(self, xi: Any) -> tuple[Any, Any]:
        q, shape = self._rows(xi)
        triangles, weights = self.array.empty(shape, "int32"), self.array.empty((*shape, 3), "float64")
        self._ask().barycentric(self.array.coordinates(q), self.array.memory(triangles), self.array.memory(weights))
        return triangles, weights

    def nearest_vertex(self, xi: Any, k: int) -> Any:
        q, shape = self._rows(xi)
        result = self.array.empty(shape if k == 1 else (*shape, k), "int32")
        self._ask().nearest(self.array.coordinates(q), k, self.array.memory(result))
        return result

    def _values(self, values: Any) -> tuple[Any, tuple[int, ...]]:
        v = self.array.take(values, "float64")
        if len(v.shape) == 0 or v.shape[0] != self.mesh.number_of_points:
            raise InputError(f"values must have shape ({self.mesh.number_of_points},) or one row a point", 0)
        return v, tuple(v.shape[1:])

    def interpolate(self, values: Any, xi: Any, method: str, outside: str) -> Any:
        v, one = self._values(values)
        q, shape = self._rows(xi)
        result = self.array.empty((*shape, *one), "float64")
        memory = self.array.memory
        self._ask().interpolate(memory(v), self.array.coordinates(q), memory(result), method, outside)
        return result

    def rasterize(self, values: Any, grid: tuple, rows: int, columns: int, method: str, max_edge: float) -> Any:
        v, one = self._values(values)
        memory = self.array.memory
        if not one:
            result = self.array.empty((rows, columns), "float64")
            self._ask().rasterize(grid, columns, rows, memory(v), memory(result), method, max_edge)
            return result
        # The library makes a raster of one value a point.
        result = self.array.empty((rows, columns, *one), "float64")
        of, to = v.reshape(v.shape[0], math.prod(one)), result.reshape(rows, columns, math.prod(one))
        raster = self.array.empty((rows, columns), "float64")
        for j in range(math.prod(one)):
            column = self.array.contiguous(of[:, j])
            self._ask().rasterize(grid, columns, rows, memory(column), memory(raster), method, max_edge)
            to[..., j] = raster
        return result

    def circumcenters(self) -> Any:
        result = self.array.empty((self.mesh.number_of_triangles, 2), "float64")
        self._ask().circumcenters(self.array.memory(result))
        return result
