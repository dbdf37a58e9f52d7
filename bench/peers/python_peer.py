#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Delaunay triangulation of Python's libraries; the protocol is that of bench/peers.hpp.

usage: python_peer.py scipy|cupy POINTS.f64 [--warm-up W] [--runs R] [--limit SECONDS]
       python_peer.py scipy|cupy --version
"""
import argparse
import importlib
import json
import math
import sys
import time

NOT_USABLE = 3


def scipy_peer():
    """SciPy's Delaunay is Qhull's, on one core."""
    scipy, numpy = importlib.import_module("scipy"), importlib.import_module("numpy")
    spatial = importlib.import_module("scipy.spatial")
    return scipy.__version__, "host", numpy.asarray, spatial.Delaunay, lambda: None


def cupy_peer():
    """CuPy's Delaunay is gDel2D, on the GPU. Points and triangles stay there."""
    cupy = importlib.import_module("cupy")
    cupy.cuda.runtime.getDeviceCount()  # raises where there is no driver or no card
    delaunay = importlib.import_module("cupyx.scipy.spatial").Delaunay
    return cupy.__version__, "device", cupy.asarray, delaunay, cupy.cuda.get_current_stream().synchronize


PEERS = {"scipy": scipy_peer, "cupy": cupy_peer}


def measure(arguments, to_place, triangulate, synchronise):
    """Points where the library likes them best, then the runs. The mesh of a run is gone before the next one."""
    import numpy

    points = to_place(numpy.fromfile(arguments.points, dtype="<f8").reshape(-1, 2))

    def once():
        synchronise()
        start = time.perf_counter()
        mesh = triangulate(points)
        synchronise()
        return 1e3 * (time.perf_counter() - start), len(mesh.simplices)

    begin = time.perf_counter()
    warmups, milliseconds = 0, []
    while warmups < arguments.warm_up and time.perf_counter() - begin < arguments.limit:
        once()
        warmups += 1
    while not milliseconds or (len(milliseconds) < arguments.runs and time.perf_counter() - begin < arguments.limit):
        taken, triangles = once()
        milliseconds.append(taken)
    return {"triangles": triangles, "warmups": warmups, "milliseconds": milliseconds}


def one_line(error):
    text = str(error).strip()
    return f"{type(error).__name__}: {text.splitlines()[0]}" if text else type(error).__name__


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("peer", choices=sorted(PEERS))
    parser.add_argument("points", nargs="?")
    parser.add_argument("--warm-up", type=int, default=1)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=math.inf)
    parser.add_argument("--version", action="store_true")
    arguments = parser.parse_args()
    if not arguments.version and arguments.points is None:
        parser.error("no points")

    answer, code = {"name": arguments.peer}, 0
    try:
        answer["version"], answer["timing"], to_place, triangulate, synchronise = PEERS[arguments.peer]()
    except Exception as error:  # whatever an import or a driver raises
        answer["error"], code = one_line(error), NOT_USABLE
    else:
        if not arguments.version:
            try:
                answer.update(measure(arguments, to_place, triangulate, synchronise))
            except Exception as error:  # too little memory, points on a line, ...
                answer["error"] = one_line(error)
    print(json.dumps(answer), flush=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
