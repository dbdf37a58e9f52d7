#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles the device code with the front end of a language, without a device.

usage: check_dialect.py opencl|cuda ROOT

Ends with 77 and the reason when the compiler or the entry file is not there.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

SKIP = 77


def skip(reason):
    print(f"skipped: {reason}")
    return SKIP


def run(command):
    print(" ".join(command))
    return subprocess.run(command, stdin=subprocess.DEVNULL).returncode


def clang_of_this_machine():
    return next((c for c in ("clang", "clang-19", "clang-18", "clang-15", "clang-14") if shutil.which(c)), None)


def opencl(root):
    programs = sorted(entry for entry in (root / "kernels_cl").glob("*.cl") if entry.name != "primitives.cl")
    for_doubles = ("batch", "crossings", "stars", "verify")
    clang = clang_of_this_machine()
    if clang is None:
        return skip("no clang")
    # 64-bit SPIR is what the standard library of the front end knows; only the syntax and types are looked at.
    variants = [["-cl-std=CL3.0", "-DCADT_CL_C11=1"], ["-cl-std=CL3.0", "-DCADT_CL_C11=1", "-DCADT_TIMED=1"], ["-cl-std=CL1.2", "-DCADT_WIDE=1", "-DCADT_CONTIGUOUS=0", "-DCADT_RADIX_BITS=4"]]
    floats = ["-DCADT_FLOAT=1", "-cl-single-precision-constant"]  # any double is an error
    variants += [variant + floats for variant in variants]
    return max(run([clang, "-x", "cl", "-target", "spir64", "-fsyntax-only", "-Wall", "-Werror", "-Wno-unused-function",
                    "-Wno-gcc-compat", "-Xclang", "-finclude-default-header", "-I", str(root), *options, str(entry)])
               for options in variants for entry in programs
               if not ("-DCADT_FLOAT=1" in options and entry.stem in for_doubles))


def cuda(root):
    entries = [root / "kernels_cuda" / name for name in ("narrow.cu", "wide.cu", "timed.cu")]
    clang = clang_of_this_machine()  # nvcc takes a minute, and has seen the kernels where the library has them
    if clang is None and shutil.which("nvcc") is not None:
        with tempfile.TemporaryDirectory() as folder:
            return max(run(["nvcc", "-std=c++17", "--fmad=false", "-arch=compute_75", "-I", str(root), "-ptx", str(entry),
                            "-o", f"{folder}/cadt.ptx"]) for entry in entries)
    if clang is None:
        return skip("neither clang nor nvcc")
    return max(run([clang, "-x", "cuda", "--cuda-device-only", "--cuda-gpu-arch=sm_70", "-nocudainc", "-nocudalib",
                    "-fsyntax-only", "-std=c++17", "-Wall", "-Werror", "-Wno-unused-function", "-Wno-unknown-cuda-version",
                    "-include", str(root / "tests" / "architecture" / "cuda_declarations.h"), "-I", str(root),
                    str(entry)]) for entry in entries)


def main():
    languages = {"opencl": opencl, "cuda": cuda}
    if len(sys.argv) != 3 or sys.argv[1] not in languages:
        print(__doc__)
        return 2
    return languages[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve())


if __name__ == "__main__":
    sys.exit(main())
