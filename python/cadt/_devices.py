# SPDX-License-Identifier: Apache-2.0
"""Where meshes are computed: options, devices, and those that stay open."""

from __future__ import annotations

import atexit
import ctypes
import operator
import os
import threading
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

from cadt import _cadt
from cadt._errors import BackendUnavailable, OptionError

# Below this, opening a GPU takes longer than the host's whole work (docs/performance.md).
SMALL = 200_000
_KEPT = 4  # open devices at most, of which memory is kept

_lock = threading.Lock()
_open: OrderedDict[tuple, Any] = OrderedDict()
_automatic_is_host: bool | None = None


@dataclass(frozen=True)
class DeviceInfo:
    """A device of this machine. `usable` or not, and then why (`reason`).

    ``Delaunay(points, backend=info.backend, device=info.index)`` computes there. With a `watchdog` the driver ends
    kernels that run for seconds. Without `fp64` a device takes floats only; `atomics` says how they are ordered.
    """

    backend: str
    index: int
    platform: str
    name: str
    driver: str
    usable: bool
    reason: str
    memory_bytes: int
    compute_units: int
    fp64: bool
    gpu: bool
    watchdog: bool
    largest_buffer_bytes: int
    atomics: str


def devices() -> list[DeviceInfo]:
    """All devices of all back ends, usable or not. A missing driver is no error: `reason` names it. Raises
    BackendUnavailable in a process that was forked after drivers had been asked.

    >>> [d.name for d in cadt.devices() if d.backend == "host"] != []
    True
    """
    use_drivers()
    return [DeviceInfo(**d) for d in _cadt.devices()]


def whole(value: Any, option: str, bits: int) -> int:
    """A whole number below 2**bits, 0 for None. Raises OptionError for all else."""
    if value is None:
        return 0
    try:
        number = operator.index(value)
    except TypeError:
        raise OptionError(f"{option} must be a whole number, not {value!r}", option) from None
    if not 0 <= number < 1 << bits:
        said = number if abs(number) < 1 << 100 else "one of so many digits"
        raise OptionError(f"{option} must be a whole number from 0 to 2**{bits} - 1, not {said}", option)
    return number


def make_options(
    backend: str | None,
    device: int | str | None,
    order: str,
    threads: int | None,
    max_memory: int | None,
    statistics: str,
    queue: int | None = None,
) -> _cadt.Options:
    if order not in ("canonical", "fast"):
        raise OptionError(f"order must be 'canonical' or 'fast', not {order!r}", "order")
    if statistics not in ("none", "counters", "timing"):
        raise OptionError(f"statistics must be 'none', 'counters' or 'timing', not {statistics!r}", "statistics")
    threads, max_memory = whole(threads, "threads", 31), whole(max_memory, "max_memory", 63)
    if device is not None and backend is None:
        raise OptionError("device needs backend=: 'host', 'opencl' or 'cuda'", "device")
    if backend is not None and not isinstance(backend, str):
        raise TypeError(f"backend must be a string, not {type(backend).__name__}")
    if backend not in (None, "auto", "host"):
        use_drivers()
    return _cadt.Options(
        backend or "auto",
        "" if device is None else str(device),
        threads,
        order == "canonical",
        max_memory,
        statistics,
        queue,
    )


def open_device(options: _cadt.Options, key: tuple, stream: Any = None) -> Any:
    """The triangulator for `key`, which stays open for the next call. The four used last are kept."""
    if options.backend != "host":
        use_drivers()
    with _lock:
        triangulator = _open.get(key)
        if triangulator is not None:
            _open.move_to_end(key)
            return triangulator
    triangulator = _cadt.Triangulator(options, stream)  # which keeps the stream
    with _lock:
        triangulator = _open.setdefault(key, triangulator)
        while len(_open) > _KEPT:
            _open.popitem(last=False)
    return triangulator


def prefers_host(n: int) -> bool:
    """Whether n points of the host, without a back end that is named, are the host's."""
    return bool(n < SMALL or _automatic_is_host or _in_child)


def placed(options: _cadt.Options, n: int) -> _cadt.Options:
    """The options for n points of the host."""
    if options.backend == "auto" and prefers_host(n):
        return options.on_host()
    if options.backend != "host":
        use_drivers()
    return options


def device_for(options: _cadt.Options, device: int | str | None, threads: int | None, n: int) -> Any:
    """The open device for points of the host, or None: the host's own call is the faster one, or asked for."""
    global _automatic_is_host
    backend = options.backend
    if backend == "host" or (backend == "auto" and prefers_host(n)):
        return None
    triangulator = open_device(options, (backend, device, threads, None))
    if triangulator.backend == "host":
        _automatic_is_host = True
        with _lock:
            _open.pop((backend, device, threads, None), None)
        return None
    return triangulator


def release_memory() -> None:
    """Closes the devices that `Delaunay` keeps open for its next call, and releases their memory.

    What meshes and their arrays on a GPU use is released with the last of them.
    """
    with _lock:
        kept = list(_open.values())
        _open.clear()
    for triangulator in kept:
        triangulator.release_memory()


# Before drivers end with the process.
atexit.register(_open.clear)


def _after_fork() -> None:
    # A child has no context of the parent's devices: nothing of theirs may be called, not even a destructor.
    global _lock, _in_child
    _cadt.forked()
    # Threads of the host's triangulators are the parent's too, but new ones can be opened.
    _in_child = _touched
    for triangulator in _open.values():
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(triangulator))
    _open.clear()
    _lock = threading.Lock()


_touched = False  # whether drivers may have been asked for anything
_in_child = False  # of a process where they had been
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def refuse_after_fork() -> None:
    """Drivers do not survive a fork: they wait for ever for threads of the parent's."""
    if _in_child:
        raise BackendUnavailable(
            "this process was forked after a device had been opened, which drivers do not survive: "
            "use multiprocessing.set_start_method('spawn'), or backend='host'",
            "",
            "forked",
        )


def use_drivers() -> None:
    """Before drivers are asked for anything."""
    global _touched
    refuse_after_fork()
    _touched = True


def for_queries(options: _cadt.Options) -> _cadt.Options:
    """Of a mesh whose arrays are on the host: after a fork the host answers."""
    return options.on_host() if _in_child else options
