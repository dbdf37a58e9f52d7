#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that nothing asks the dynamic linker for a driver, so that the program starts on a machine without any.

usage: check_linking.py program READELF PROGRAM   the libraries that the program cannot start without
       check_linking.py library NM LIBRARY        functions of OpenCL and of the CUDA driver that the library leaves open
"""
import re
import subprocess
import sys

DRIVERS = re.compile(r"lib(OpenCL|cuda|cudart|nv)")
FUNCTIONS = re.compile(r"(cl|cu)[A-Z]\w*")  # clFinish, cuInit; not cudaMalloc, which the static runtime brings


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def check_program(readelf, program):
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", output_of(readelf, "--dynamic", "--wide", program))
    if not any(name.startswith("libc.") for name in needed):
        return [f"{readelf} says nothing about libc, so its output was not understood"]
    return [f"{program} does not start without {name}" for name in needed if DRIVERS.match(name)]


def check_library(nm, library):
    symbols = [line.split()[-1] for line in output_of(nm, "--undefined-only", library).splitlines() if " U " in line]
    if "__cxa_throw" not in symbols:
        return [f"{nm} does not list __cxa_throw, so its output was not understood"]
    return [f"{name} would be looked for by the linker: add its line to backends/opencl/loader.hpp"
            for name in sorted(set(symbols)) if FUNCTIONS.fullmatch(name)]


def main():
    checks = {"program": check_program, "library": check_library}
    if len(sys.argv) != 4 or sys.argv[1] not in checks:
        print(__doc__)
        return 2
    problems = checks[sys.argv[1]](*sys.argv[2:])
    print("\n".join(problems) or f"{sys.argv[3]}: no driver is linked")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
