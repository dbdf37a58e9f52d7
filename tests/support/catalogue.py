#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A set of the catalogue of hard inputs with about FACTOR times its points, as lines `x y`.

usage: catalogue.py SCRIPT ID FACTOR

SCRIPT is the catalogue's own generator. Its parameter is a number of points for some sets, for others the side of a
lattice, a depth or a radius. So it is raised in small steps until there are as many points; no further than to FACTOR
times its default, nor than to where coordinates leave the range of a double.
"""
import importlib.util
import math
import sys


def load(path):
    spec = importlib.util.spec_from_file_location("generator", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.C


def finite(points):
    return all(math.isfinite(x) and math.isfinite(y) for x, y in points)


def enlarged(make, factor):
    points = make()
    default = (make.__defaults__ or (0,))[0]
    if default == 0 or factor == 1:
        return points
    wanted, parameter = factor * len(points), default
    while len(points) < wanted and parameter < factor * default:
        parameter = min(parameter + max(1, default // 16), factor * default)
        try:
            larger = make(parameter)
        except OverflowError:
            break
        if not finite(larger):
            break
        points = larger
    return points


def main():
    script, name, factor = sys.argv[1:4]
    print("".join(f"{x:.17g} {y:.17g}\n" for x, y in enlarged(load(script)[name], int(factor))), end="")


if __name__ == "__main__":
    main()
