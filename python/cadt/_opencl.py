# SPDX-License-Identifier: Apache-2.0
"""Arrays of PyOpenCL."""

from __future__ import annotations

import sys
import threading
from typing import Any

import numpy as np

from cadt._arrays import Array

_reading = threading.Lock()  # PoCL ends the process where threads read from one queue


class OpenCl(Array):
    backend = "opencl"
    device = None

    def __init__(self, a: Any) -> None:
        self.cl = sys.modules["pyopencl"]
        self.cl_queue = self.stream = a.queue
        self.queue = int(a.queue.int_ptr)
        super().__init__(a)

    def convert(self, a: Any, dtype: str) -> Any:
        if a.dtype == np.float16:  # which PyOpenCL does not know
            return self.from_host(self.host_of(a).astype(dtype))
        return a.astype(dtype)

    def contiguous(self, a: Any) -> Any:
        self.finish(a)
        if a.flags.c_contiguous and not a.offset:  # parts of buffers begin anywhere
            return a
        if a.flags.c_contiguous:
            return a.copy()
        along = np.ogrid[tuple(slice(n) for n in a.shape)]
        places = sum((i * stride for i, stride in zip(along, a.strides)), np.int64(a.offset)) // a.dtype.itemsize
        flat = self.cl.array.Array(self.cl_queue, (a.base_data.size // a.dtype.itemsize,), a.dtype, data=a.base_data)
        return self.gather(flat, places)

    def address(self, a: Any) -> int:
        self.finish(a)
        return int(a.base_data.int_ptr) if a.size else 0  # nothing has no buffer

    def finish(self, a: Any) -> None:
        """Waits for what others do to the array in queues of their own."""
        if a.queue is not None and a.queue != self.cl_queue:
            a.queue.finish()

    # PyOpenCL neither copies columns, nor in another order, nor reduces rows (without Mako, one of its extras).
    def gather(self, a: Any, places: np.ndarray) -> Any:
        at = self.cl.array.to_device(self.cl_queue, np.ascontiguousarray(places.reshape(-1)))
        return self.cl.array.take(a.reshape(-1), at, queue=self.cl_queue).reshape(places.shape)

    def column(self, a: Any, j: int) -> Any:
        return self.gather(a, np.arange(j, a.size, a.shape[1]))

    def stack(self, rasters: list[Any]) -> Any:
        all_of = self.cl.array.stack(rasters)
        return self.gather(all_of, np.moveaxis(np.arange(all_of.size).reshape(all_of.shape), 0, -1))

    def fold(self, a: Any, pick: Any) -> list[Any]:
        while len(a) > 1:  # the first half with the last one, which share a row if there is an odd number
            half = (len(a) + 1) // 2
            a = pick(a[:half], a[len(a) - half :])
        return self.host_of(a)[0].tolist()

    def bounds(self) -> tuple[float, float, float, float]:
        (x0, y0), (x1, y1) = self.fold(self.a, self.cl.array.minimum), self.fold(self.a, self.cl.array.maximum)
        return (x0, y0, x1, y1)

    def fits_int32(self, a: Any) -> bool:
        low, high = self.fold(a, self.cl.array.minimum), self.fold(a, self.cl.array.maximum)
        return min(low) >= 0 and max(high) < 2**31

    def host_of(self, a: Any) -> np.ndarray:
        with _reading:
            return self.contiguous(a).get()

    def from_host(self, host: np.ndarray) -> Any:
        return self.cl.array.to_device(self.cl_queue, host.view(np.int8) if host.dtype == bool else host)

    def empty(self, shape: tuple[int, ...], dtype: str) -> Any:
        return self.cl.array.empty(self.cl_queue, shape, dtype)

    def of_handle(self, mesh: Any, handle: int, shape: tuple[int, ...], dtype: str = "int32") -> Any:
        buffer = self.cl.Buffer.from_int_ptr(handle)
        buffer._cadt_mesh = mesh  # the memory is the mesh's; parts of the array share the buffer
        return self.cl.array.Array(self.cl_queue, shape, np.dtype(dtype), data=buffer)
