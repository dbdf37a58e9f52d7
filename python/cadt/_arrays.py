# SPDX-License-Identifier: Apache-2.0
"""Arrays that are on a GPU, of CuPy, PyTorch, JAX and PyOpenCL: each library in its own words."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np

from cadt import _cadt
from cadt._errors import InputError
from cadt._points import as_pairs, as_points, to_float

_HOST = 1  # DLPack's kDLCPU


def array_on_device(points: Any) -> Array | None:
    """The adapter for an array on a GPU; None for everything on the host."""
    adapter = adapter_of(points)
    return None if adapter is None else adapter(points)


def as_host_points(points: Any, what: str = "points") -> np.ndarray:
    """As as_points, where an array on a GPU is not taken."""
    if adapter_of(points) is not None:
        raise InputError(f"{what} are read on the host: pass a copy there", 0)
    return as_points(points, what)


def adapter_of(points: Any) -> type[Array] | None:
    if type(points) in (np.ndarray, list, tuple):
        return None
    package = type(points).__module__.partition(".")[0]
    if package == "pyopencl" and hasattr(points, "queue"):
        from cadt._opencl import OpenCl

        return OpenCl
    if package == "torch":
        return Torch if points.is_cuda else None
    if package == "cupy":
        return CuPy
    if package in ("jax", "jaxlib"):
        return Jax if next(iter(points.devices())).platform in ("gpu", "cuda") else None
    if hasattr(points, "__cuda_array_interface__"):
        return CudaInterface
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
    queue: int | None = None  # goes to Options::queue (_devices.make_options)
    stream: Any = None  # the object that owns the queue
    triangulator: Any = None  # the open device
    xp: Any = None  # the library

    def __init__(self, a: Any) -> None:
        self.a = self.rows(a, "points")

    def rows(self, a: Any, what: str) -> Any:
        if len(a.shape) != 2 or a.shape[1] != 2:
            raise InputError(f"{what} must have shape (n, 2), not {tuple(a.shape)}", 0)
        name = str(a.dtype).rpartition(".")[2]
        if name not in ("float32", "float64"):
            if not name.startswith(("int", "uint")) and name != "float16":
                raise TypeError(f"{what} must be float64 or float32 (or integers), not {name}: convert them first")
            checked = name in ("int64", "uint64")  # as not all have a float64
            a = self.from_host(to_float(self.host_of(a), what)) if checked else self.convert(self.contiguous(a), "float64")
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
        return self.host_of(self.a)

    def host_of(self, a: Any) -> np.ndarray:
        raise NotImplementedError

    def like(self, host: Any) -> Any:
        """An array of the host (or several) on the device."""
        if isinstance(host, tuple):
            return tuple(self.like(h) for h in host)
        return self.from_host(np.asarray(host, order="C"))

    def from_host(self, host: np.ndarray) -> Any:
        raise NotImplementedError

    def is_here(self, a: Any) -> bool:
        """Whether an argument is an array of this library already."""
        return isinstance(a, type(self.a))

    def takes(self, a: Any) -> bool:
        """Whether `take` is for it: arrays of the host are read as for meshes there."""
        return self.is_here(a) or adapter_of(a) is not None

    def take(self, a: Any, dtype: str) -> Any:
        """Numbers as a contiguous array of this library on the device."""
        if (name := str(getattr(a, "dtype", "")).rpartition(".")[2]).startswith(("bool", "complex")):
            raise TypeError(f"values must be real numbers, not {name}")
        a = a if self.is_here(a) else self.from_host(np.ascontiguousarray(a))
        a = self.contiguous(a)
        return a if str(a.dtype).rpartition(".")[2] == dtype else self.convert(a, dtype)

    def begin(self) -> None:
        """Before a call of the library, which works in `queue`: that waits for the caller's current stream."""

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        """Memory for a result, of which `finished` makes an array."""
        raise NotImplementedError

    def finished(self, result: Any) -> Any:
        """An array for the caller's current stream, which waits for the call."""
        return result

    def column(self, a: Any, j: int) -> Any:
        """Column j, contiguous."""
        return self.contiguous(a[:, j])

    def stack(self, rasters: list[Any]) -> Any:
        return self.xp.stack(rasters, -1)

    def bounds(self) -> tuple[float, float, float, float]:
        (x0, y0), (x1, y1) = self.xp.amin(self.a, 0).tolist(), self.xp.amax(self.a, 0).tolist()
        return (x0, y0, x1, y1)

    def pairs(self, a: Any, what: str) -> Any:
        """Indices of shape (m, 2) on the device, as contiguous int32."""
        if not self.is_here(a):
            raise InputError(f"{what} must be arrays of the host, or of the points' library and device", 0)
        name = str(a.dtype).rpartition(".")[2]
        if len(a.shape) != 2 or a.shape[1] != 2 or name not in ("int32", "int64"):
            raise InputError(f"{what} must be int32 or int64 of shape (m, 2), not {name} of {tuple(a.shape)}", 0)
        a = self.contiguous(a)
        if name == "int64":
            if a.shape[0] and not self.fits_int32(a):
                as_pairs(self.host_of(a), what)  # says which
            a = self.convert(a, "int32")
        return a

    def fits_int32(self, a: Any) -> bool:
        return bool(a.min() >= 0) and bool(a.max() < 2**31)

    def words(self, mesh: Any, which: str, shape: tuple[int, ...]) -> Any:
        """An array of a mesh, without a copy; it keeps the mesh. Zeros where the mesh has none."""
        handle = getattr(mesh, f"{which}_handle")
        return self.of_handle(mesh, handle, shape) if handle else self.from_host(np.zeros(shape, np.int32))

    def flags(self, words: Any) -> Any:
        """Words, each 0 or not, as bool; with PyOpenCL, which computes nothing with bool, as int8."""
        return words != 0

    def doubles(self, mesh: Any, which: str, shape: tuple[int, ...]) -> Any:
        """The same of doubles, which the mesh must have."""
        return self.of_handle(mesh, getattr(mesh, f"{which}_handle"), shape, "float64")

    def doubles_on_host(self, mesh: Any, which: str, shape: tuple[int, ...]) -> np.ndarray:
        return self.host_of(self.doubles(mesh, which, shape))

    def of_handle(self, mesh: Any, handle: int, shape: tuple[int, ...], dtype: str = "int32") -> Any:
        return self.xp.from_dlpack(_cadt.cuda_array(mesh, handle, shape, dtype == "float64"))


class CuPy(Array):
    def __init__(self, a: Any) -> None:
        import cupy

        self.xp = cupy
        self.device = int(a.device.id)
        with cupy.cuda.Device(self.device):
            self.stream = cupy.cuda.get_current_stream()
            self.queue = int(self.stream.ptr)
            super().__init__(a)

    # Events belong to the device that is current when they are made, and the default stream is that of this device.
    def begin(self) -> None:
        with self.xp.cuda.Device(self.device):
            if (current := self.xp.cuda.get_current_stream()) != self.stream:
                self.stream.wait_event(current.record())

    def finished(self, result: Any) -> Any:
        with self.xp.cuda.Device(self.device):
            if (current := self.xp.cuda.get_current_stream()) != self.stream:
                current.wait_event(self.stream.record())
        return result

    def convert(self, a: Any, dtype: str) -> Any:
        return a.astype(dtype)

    def contiguous(self, a: Any) -> Any:
        return self.xp.ascontiguousarray(a)

    def address(self, a: Any) -> int:
        return int(a.data.ptr)

    def bounds(self) -> tuple[float, float, float, float]:
        x, y = self.column(self.a, 0), self.column(self.a, 1)  # what is not contiguous takes 8 ms for ten million
        return (float(x.min()), float(y.min()), float(x.max()), float(y.max()))

    def host_of(self, a: Any) -> np.ndarray:
        return self.xp.asnumpy(a)

    def from_host(self, host: np.ndarray) -> Any:
        with self.xp.cuda.Device(self.device):
            return self.xp.asarray(host)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        with self.xp.cuda.Device(self.device):
            return self.xp.empty(shape, dtype)


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

    def pairs(self, a: Any, what: str) -> Any:
        return super().pairs(self.xp.asarray(a), what)


class Torch(Array):
    def __init__(self, a: Any) -> None:
        self.xp = sys.modules["torch"]
        self.where = a.device
        self.device = a.device.index
        self.stream = self.xp.cuda.current_stream(a.device)
        self.queue = int(self.stream.cuda_stream)
        super().__init__(a.detach())

    def begin(self) -> None:
        self.stream.wait_stream(self.xp.cuda.current_stream(self.where))

    def finished(self, result: Any) -> Any:
        self.xp.cuda.current_stream(self.where).wait_stream(self.stream)
        return result

    def convert(self, a: Any, dtype: str) -> Any:
        return a.to(getattr(self.xp, dtype))

    def contiguous(self, a: Any) -> Any:
        return a.contiguous()

    def address(self, a: Any) -> int:
        return int(a.data_ptr())

    def host_of(self, a: Any) -> np.ndarray:
        return a.cpu().numpy()

    def from_host(self, host: np.ndarray) -> Any:
        return self.xp.from_numpy(np.array(host)).to(self.where)

    def is_here(self, a: Any) -> bool:
        return isinstance(a, self.xp.Tensor) and a.device == self.where

    def takes(self, a: Any) -> bool:
        return isinstance(a, self.xp.Tensor) or super().takes(a)

    def take(self, a: Any, dtype: str) -> Any:
        if isinstance(a, self.xp.Tensor):
            a = a.detach().to(self.where)
        return super().take(a, dtype)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        return self.xp.empty(shape, dtype=getattr(self.xp, dtype), device=self.where)


class Jax(Array):
    """JAX has no arrays that others write to, and names no stream: results are in memory of the library's, and calls in a
    stream of its own, in which all has ended when they return."""

    def __init__(self, a: Any) -> None:
        self.jax, self.xp = sys.modules["jax"], sys.modules["jax"].numpy
        self.x64 = self.jax.enable_x64 if hasattr(self.jax, "enable_x64") else self.jax.experimental.enable_x64
        self.where = next(iter(a.devices()))
        self.device = int(self.where.local_hardware_id)
        self.zero = self.jax.device_put(np.float32(0), self.where)
        super().__init__(a)

    def begin(self) -> None:
        # JAX computes in one stream of a device, and does not wait for it when it returns memory that others own: after
        # this, nobody still reads what the library will use again.
        (self.zero + 1).block_until_ready()

    def convert(self, a: Any, dtype: str) -> Any:
        with self.x64(True):
            return self.xp.asarray(a, dtype)

    def contiguous(self, a: Any) -> Any:
        return a

    def address(self, a: Any) -> int:
        return a.address if isinstance(a, _cadt.DeviceMemory) else int(a.block_until_ready().unsafe_buffer_pointer())

    def host_of(self, a: Any) -> np.ndarray:
        return np.asarray(a)

    def from_host(self, host: np.ndarray) -> Any:
        with self.x64(True):
            return self.jax.device_put(host, self.where)

    def is_here(self, a: Any) -> bool:
        return isinstance(a, self.jax.Array) and a.devices() == {self.where}

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        return _cadt.DeviceMemory(self.triangulator, shape, dtype == "float64")

    def finished(self, result: Any) -> Any:
        """Without ``jax_enable_x64`` the numbers are float32, as all of JAX's."""
        if result.address == 0:
            return self.xp.zeros(result.shape, "float64" if self.jax.config.jax_enable_x64 else "float32")
        return self.xp.from_dlpack(_cadt.cuda_memory(result))

    def bounds(self) -> tuple[float, float, float, float]:
        with self.x64(True):
            return super().bounds()

    def doubles_on_host(self, mesh: Any, which: str, shape: tuple[int, ...]) -> np.ndarray:
        with self.x64(True):
            return super().doubles_on_host(mesh, which, shape)
