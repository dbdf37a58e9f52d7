#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that nothing asks the dynamic linker for a driver, so that the program starts on a machine without any, and the
extension module of Python for nothing but what all processes have.

usage: check_linking.py program READELF PROGRAM   the libraries that the program cannot start without
       check_linking.py library NM LIBRARY        functions of OpenCL and of the CUDA driver that the library leaves open
       check_linking.py module READELF MODULE     the libraries that the module is loaded with, and the symbols that it exports
"""
import re
import subprocess
import sys

DRIVERS = re.compile(r"lib(OpenCL|cuda|cudart|nv)")
# Not cairo, PNG and zlib, which are for pictures; with cairo fontconfig and X11 would come.
OF_THE_MODULE = re.compile(r"(libstdc\+\+|libm|libgcc_s|libc|libpthread|libdl|librt|libatomic|ld-linux.*|libfmt)\.so(\.[\d.]+)?")
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


def check_module(readelf, module):
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", output_of(readelf, "--dynamic", "--wide", module))
    symbols = [line.split() for line in output_of(readelf, "--dyn-syms", "--wide", module).splitlines()]
    exported = [words[7] for words in symbols if len(words) > 7 and words[4] in ("GLOBAL", "WEAK", "UNIQUE") and words[6] != "UND"]
    if "PyInit__cadt" not in exported:
        return [f"{module} does not export PyInit__cadt, or the output of {readelf} was not understood"]
    return [f"{module} is loaded with {name}" for name in needed if not OF_THE_MODULE.fullmatch(name)] + [
        f"{module} exports {name}" for name in exported if name != "PyInit__cadt"]


def main():
    checks = {"program": check_program, "library": check_library, "module": check_module}
    if len(sys.argv) != 4 or sys.argv[1] not in checks:
        print(__doc__)
        return 2
    problems = checks[sys.argv[1]](*sys.argv[2:])
    print("\n".join(problems) or f"{sys.argv[3]}: nothing is linked that should not be")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
