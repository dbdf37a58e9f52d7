# SPDX-License-Identifier: Apache-2.0
"""The C interface from Python's ctypes. usage: smoke.py LIBRARY"""
import ctypes
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p

library = ctypes.CDLL(sys.argv[1])

PROGRESS = ctypes.CFUNCTYPE(None, c_char_p, c_double, c_void_p)
CANCELLED = ctypes.CFUNCTYPE(c_int32, c_void_p)
OK, INPUT_ERROR, CANCELLED_BY_CALLER, BUFFER_TOO_SMALL = 0, 2, 9, 12
BACKEND_HOST, KEEP_COPY = 1, 1


class Points(ctypes.Structure):
    _fields_ = [("x", c_void_p), ("y", c_void_p), ("count", c_size_t), ("stride", c_size_t), ("scalar", c_int32)]


class Options(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("backend", c_int32), ("order", c_int32), ("device", c_char_p), ("max_memory", c_uint64),
                ("threads", c_uint32), ("keep_points", c_int32), ("statistics", c_int32), ("has_queue", c_int32),
                ("queue", c_void_p), ("strategy", c_int32), ("work_group_size", c_uint32), ("user", c_void_p),
                ("progress", PROGRESS), ("cancelled", CANCELLED), ("allocate", c_void_p), ("deallocate", c_void_p)]


class Error(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("status", c_int32), ("code", c_int32), ("message", c_char_p), ("name", c_char_p),
                ("detail", c_char_p), ("index", c_int64), ("needed", c_uint64), ("available", c_uint64)]


def last_error():
    error = Error(size=ctypes.sizeof(Error))
    assert library.cadt_last_error(byref(error)) == OK
    return error


def check(status):
    assert status == OK, last_error().message


def options():
    result = Options()
    check(library.cadt_options_init(byref(result), c_size_t(ctypes.sizeof(result))))
    result.backend = BACKEND_HOST
    return result


def main():
    library.cadt_version.restype = c_char_p
    assert library.cadt_version().count(b".") == 2
    assert library.cadt_abi_version() == 0

    n = 2000
    xy = (c_double * (2 * n))(*((k * step) % 1.0 for k in range(n) for step in (0.7548776662466927, 0.5698402909980532)))
    points = Points(ctypes.addressof(xy), None, n, 0, 0)
    mesh = c_void_p()
    phases = []
    chosen = options()
    chosen.progress = PROGRESS(lambda phase, fraction, user: phases.append(phase.decode()))
    check(library.cadt_triangulate(byref(points), byref(chosen), byref(mesh)))
    assert phases[0] == "sort", phases

    count, triangles_count, array = c_size_t(), c_size_t(), POINTER(c_int32)()
    check(library.cadt_triangulation_size(mesh, byref(count), byref(triangles_count)))
    check(library.cadt_triangulation_triangles(mesh, byref(array)))
    triangles = array[:3 * triangles_count.value]
    assert count.value == n and set(triangles) == set(range(n))

    edge_words = c_size_t()
    check(library.cadt_triangulation_edges(mesh, None, c_size_t(0), byref(edge_words)))
    assert edge_words.value // 2 == n + triangles_count.value - 1
    edges = (c_int32 * edge_words.value)()
    assert library.cadt_triangulation_edges(mesh, edges, c_size_t(5), byref(edge_words)) == BUFFER_TOO_SMALL
    assert last_error().needed == edge_words.value and last_error().available == 5 and not any(edges)
    check(library.cadt_triangulation_edges(mesh, edges, c_size_t(len(edges)), byref(edge_words)))
    pairs = {tuple(sorted((triangles[k], triangles[k - 2 if k % 3 == 2 else k + 1]))) for k in range(len(triangles))}
    assert list(zip(edges[::2], edges[1::2])) == sorted(pairs)

    report, ok = c_void_p(), c_int32()
    check(library.cadt_triangulation_verify(mesh, byref(points), None, byref(report)))
    check(library.cadt_report_ok(report, byref(ok)))
    assert ok.value == 1
    library.cadt_report_free(report)
    library.cadt_triangulation_free(mesh)

    constrained, flags = c_void_p(), POINTER(c_uint32)()
    segment = (c_int32 * 2)(0, n - 1)
    check(library.cadt_triangulate_constrained(byref(points), segment, c_size_t(1), None, None, byref(constrained)))
    edge_list, edge_count = POINTER(c_int32)(), c_size_t()
    check(library.cadt_constrained_edges(constrained, byref(edge_list), byref(edge_count)))
    assert edge_list[:2 * edge_count.value] == [0, n - 1]
    check(library.cadt_constrained_edge_flags(constrained, byref(flags)))
    assert sum(bin(word).count("1") for word in flags[:triangles_count.value]) == 2
    library.cadt_constrained_free(constrained)

    chosen = options()
    chosen.cancelled = CANCELLED(lambda user: 1)
    assert library.cadt_triangulate(byref(points), byref(chosen), byref(mesh)) == CANCELLED_BY_CALLER
    xy[7] = float("nan")
    assert library.cadt_triangulate(byref(points), None, byref(mesh)) == INPUT_ERROR
    assert last_error().index == 3, last_error().index
    print("ctypes: ok")


# 64-bit handles are passed as such.
for name in ("cadt_triangulation_free", "cadt_report_free", "cadt_constrained_free"):
    getattr(library, name).argtypes = [c_void_p]
    getattr(library, name).restype = None
main()
