#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that includes point only one way:

    apps -> tiles, viewer -> io -> include <- common <- backends -> kernels_cl, kernels_cuda -> device text of common

Device text is what ends in .dev.h: C99, OpenCL C and CUDA C++ at once. It includes device text alone. Headers of the
driver (common/driver/*.hpp) are what all stages share, so they know no stage.

usage: check_dependencies.py ROOT      checks the tree
       check_dependencies.py --self-test   shows that it finds what it looks for
"""
import pathlib
import re
import sys
import tempfile

# Folder -> folders of this project that its files may include. The longest matching prefix counts.
MAY_INCLUDE = {
    "include/cadt": ["include/cadt"],
    "include/cadt/io": ["include/cadt", "include/cadt/io"],
    "io": ["io", "include/cadt", "include/cadt/io"],
    "apps": ["apps", "tiles", "viewer", "include/cadt", "include/cadt/io"],
    "tiles": ["tiles", "io", "include/cadt", "include/cadt/io"],  # for programs: the library knows nothing of it
    "viewer": ["viewer", "io", "include/cadt", "include/cadt/io"],  # an application: nothing includes it but apps
    "viewer/growth": ["viewer", "include/cadt", "include/cadt/io"],
    "common": ["common", "include/cadt"],
    "common/platform": ["common/platform", "include/cadt"],
    "common/verify": ["common", "include/cadt"],
    "common/verify/host": ["common/verify/host", "common/platform", "include/cadt"],
    "backends": ["backends", "common", "include/cadt", "kernels_cl", "kernels_cuda"],
    "kernels_cl": ["kernels_cl", "common"],
    "kernels_cuda": ["kernels_cuda", "common"],
}
# (files, what of this project they may include): all rules that fit a file hold.
DEVICE_TEXT = r"common/.*\.dev\.h$|common/portable/kernel_list\.h$"
ONLY = [
    (r"common/.*\.dev\.h$", DEVICE_TEXT),
    (r"kernels_cl/", r"kernels_cl/|" + DEVICE_TEXT),
    (r"kernels_cuda/", r"kernels_cuda/|" + DEVICE_TEXT),
    # The verifier of the host shares nothing with the builder but how loops run on threads.
    (r"common/verify/host/", r"common/verify/host/|common/platform/parallel\.hpp$|include/"),
    # The verifier's kernels share nothing with the builder's but the view of a mesh.
    (r"common/verify/device/.*\.dev\.h$", r"common/verify/device/|common/portable/(dialect|atomics)\.dev\.h$|common/mesh/mesh_view\.dev\.h$"),
    # What all stages share knows no stage, but for the text of the kernels, of which it takes layouts and parameters.
    (r"common/driver/(?!triangulat|device_triangulation|choose_strategy|build|session).*\.hpp$", r"common/driver/|include/|common/portable/"),
]
# What the verifier of the host is to check must not be made with it: nobody else includes it but the tests, and these.
VERIFIER, ITS_USERS = "common/verify/host/", r"common/verify/|tests/"
EXCEPTIONS = {  # file -> headers of the verifier; docs/constrained.md and docs/scale.md say what for
    "common/constraints/domains/locate_seeds.cpp": ["exact_sign.hpp"],  # holes and regions
    "common/constraints/polygons/first_edges.cpp": ["exact_sign.hpp"],  # a ring that is in no order
    "common/constraints/exact/implicit_point.hpp": ["exact_sign.hpp"],  # crossings: where all points are doubles
    "common/constraints/verify/verify_segments.cpp": ["mesh.hpp"],  # the verifier of segments
    "common/driver/adopt.cpp": ["mesh.hpp"],  # the mesh of another program is verified
    "common/triangle/segments.cpp": ["exact_sign.hpp"],  # which crossings an error names
    "common/finalization/children.hpp": ["exact_sign.hpp"],  # certificates of edges between nodes
    "common/finalization/finish.cpp": ["exact_sign.hpp"],  # whether arithmetic is IEEE
    "common/finalization/join.cpp": ["exact_sign.hpp"],
    "common/queries/call.cpp": ["exact_sign.hpp"],  # whether arithmetic is IEEE
    "common/queries/queries.cpp": ["exact_sign.hpp"],  # whether arithmetic is IEEE
}
# One back end knows nothing of another.
BACKENDS = ["host", "opencl", "cuda"]
# Headers from outside -> folders that may use them.
OUTSIDE = {
    r"CGAL/": ["tests", "bench"],
    r"CL/": ["backends/opencl", "kernels_cl", "viewer/mesh", "tests"],
    r"cuda": ["backends/cuda", "kernels_cuda", "common/portable", "viewer/mesh", "tests", "examples"],
    r"cub/|thrust/": ["backends/cuda", "kernels_cuda"],
    r"cairo|png|zlib": ["io", "tests"],
    r"fast_float/": ["apps", "io"],
    r"CLI/": ["apps", "bench"],
    r"nlohmann/": ["apps", "io/segments", "tiles", "bench", "tests"],
    r"xxhash": ["tiles"],
    r"mpi": ["tiles/mpi"],
    r"GLFW/": ["viewer/window", "examples"],
    r"imgui|backends/imgui": ["viewer/window"],
    r"gtest/|gmock/": ["tests"],
}
SUFFIXES = {".hpp", ".cpp", ".h", ".c", ".cl", ".cu", ".cuh", ".inc"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def folder_rule(path):
    """Key of MAY_INCLUDE for a path relative to the root, or None."""
    best = None
    for key in MAY_INCLUDE:
        if path.startswith(key + "/") and (best is None or len(key) > len(best)):
            best = key
    return best


def resolve(root, file, name):
    """Path of an included file of this project relative to the root, or None if it is from outside."""
    for base in (file.parent, root, root / "include"):
        target = (base / name).resolve()
        if target.is_file() and target.is_relative_to(root):
            return target.relative_to(root).as_posix()
    return None


def may_include(source, target):
    rule = folder_rule(source)
    if rule is None:
        return True  # tests, bench, examples: may use everything
    for files, targets in ONLY:
        if re.match(files, source) and not re.match(targets, target):
            return False
    if target.startswith(VERIFIER) and not re.match(ITS_USERS, source) and \
            target.removeprefix(VERIFIER) not in EXCEPTIONS.get(source, []):
        return False
    allowed = MAY_INCLUDE[rule]
    target_rule = folder_rule(target)
    # "include/cadt" allows the core headers, not those of io below it.
    if target_rule not in allowed and not any(
            target_rule and target_rule.startswith(a + "/") and not a.startswith("include") for a in allowed):
        return False
    return backend_of(source) in (None, backend_of(target)) or backend_of(target) is None


def backend_of(path):
    for name in BACKENDS:
        if path.startswith(f"backends/{name}/"):
            return name
    return {"kernels_cl": "opencl", "kernels_cuda": "cuda"}.get(path.split("/")[0])


def check(root):
    problems, files = [], 0
    folders = {key.split("/")[0] for key in MAY_INCLUDE} | {"tests", "bench", "examples"}
    for folder in sorted(folders):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in SUFFIXES or not file.is_file():
                continue
            files += 1
            source = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
                found = INCLUDE.match(line)
                if not found:
                    continue
                where, name = f"{source}:{number}", found.group(2)
                target = resolve(root, file, name)
                if target is not None:
                    if not may_include(source, target):
                        problems.append(f"{where}: {source.rsplit('/', 1)[0]} must not include {target}")
                    continue
                if found.group(1) == '"' and folder not in ("tests", "bench", "examples"):
                    problems.append(f"{where}: \"{name}\" is not a file of this project")
                for pattern, users in OUTSIDE.items():
                    if re.match(pattern, name) and not any(source.startswith(user + "/") for user in users):
                        problems.append(f"{where}: <{name}> belongs in {', '.join(users)} only")
    return problems, files


def self_test():
    """Each line: file, include line, is it allowed?"""
    cases = [
        ("include/cadt/a.hpp", "#include <cadt/b.hpp>", True),
        ("include/cadt/a.hpp", "#include <cadt/io/c.hpp>", False),
        ("include/cadt/a.hpp", '#include "common/driver/d.hpp"', False),
        ("include/cadt/io/c2.hpp", "#include <cadt/b.hpp>", True),
        ("io/x.cpp", "#include <cadt/io/c.hpp>", True),
        ("io/x.cpp", '#include "common/driver/d.hpp"', False),
        ("io/x.cpp", "#include <CLI/CLI.hpp>", False),
        ("apps/y.cpp", '#include "io/support/e.hpp"', False),
        ("apps/y.cpp", "#include <CGAL/Kernel.h>", False),
        ("apps/y.cpp", '#include "tiles/t.hpp"', True),
        ("tiles/t2.cpp", '#include "io/support/e.hpp"', True),
        ("tiles/t2.cpp", "#include <xxhash.h>", True),
        ("tiles/t2.cpp", '#include "common/driver/d.hpp"', False),
        ("tiles/t2.cpp", '#include "apps/y.hpp"', False),
        ("tiles/t2.cpp", "#include <mpi.h>", False),
        ("tiles/mpi/m.cpp", "#include <mpi.h>", True),
        ("tiles/mpi/m.cpp", '#include "tiles/t.hpp"', True),
        ("io/x.cpp", '#include "tiles/t.hpp"', False),
        ("io/x.cpp", "#include <xxhash.h>", False),
        ("common/driver/d2.cpp", '#include "tiles/t.hpp"', False),
        ("common/stars/s.cpp", '#include "backends/host/f.hpp"', False),
        ("common/stars/s.cpp", '#include "common/driver/d.hpp"', True),
        ("common/stars/s.cpp", "#include <cadt/io/c.hpp>", False),
        ("common/driver/d2.hpp", '#include "common/points/p.hpp"', False),
        ("common/driver/d2.cpp", '#include "common/points/p.hpp"', True),
        ("common/verify/host/v.cpp", '#include "common/points/g.dev.h"', False),
        ("common/verify/host/v.cpp", '#include "common/platform/parallel.hpp"', True),
        ("common/verify/host/v.cpp", '#include "common/platform/other.hpp"', False),
        ("common/verify/device/v.cpp", '#include "common/driver/d.hpp"', True),
        ("common/verify/device/v.cpp", '#include "common/verify/host/exact_sign.hpp"', True),
        ("tests/t.cpp", '#include "common/verify/host/exact_sign.hpp"', True),
        ("common/stars/s.cpp", '#include "common/verify/host/exact_sign.hpp"', False),
        ("common/constraints/domains/locate_seeds.cpp", '#include "common/verify/host/exact_sign.hpp"', True),
        ("common/constraints/stop_check.hpp", '#include "common/verify/host/exact_sign.hpp"', False),
        ("backends/host/f2.cpp", '#include "common/driver/d.hpp"', True),
        ("backends/opencl/f3.cpp", '#include "backends/host/f.hpp"', False),
        ("backends/host/f2.cpp", "#include <CL/opencl.hpp>", False),
        ("kernels_cl/k.cl", '#include "common/driver/d.hpp"', False),
        ("kernels_cl/k.cl", '#include "common/points/g.dev.h"', True),
        ("common/points/g2.dev.h", '#include "g.dev.h"', True),
        ("common/points/g2.dev.h", '#include "common/points/p.hpp"', False),
        ("common/verify/device/g3.dev.h", '#include "common/points/g.dev.h"', False),
        ("common/verify/device/g3.dev.h", '#include "common/portable/dialect.dev.h"', True),
        ("common/verify/device/g3.dev.h", '#include "common/mesh/mesh_view.dev.h"', True),
        ("common/verify/device/g3.dev.h", '#include "common/mesh/locked_mesh.dev.h"', False),
        ("common/points/g2.dev.h", '#include "backends/host/f.hpp"', False),
        ("common/points/g2.dev.h", '#include "missing.h"', False),
        ("tests/t.cpp", '#include "common/driver/d.hpp"', True),
    ]
    present = ["include/cadt/b.hpp", "include/cadt/io/c.hpp", "common/driver/d.hpp", "common/points/p.hpp", "io/support/e.hpp", "tiles/t.hpp", "apps/y.hpp",
               "backends/host/f.hpp", "common/points/g.dev.h", "common/portable/dialect.dev.h",
               "common/platform/parallel.hpp", "common/platform/other.hpp",
               "common/mesh/mesh_view.dev.h", "common/mesh/locked_mesh.dev.h", "common/verify/host/exact_sign.hpp"]
    failed = 0
    for source, line, allowed in cases:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            for name in present + [source]:
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text("")
            (root / source).write_text(line + "\n")
            if (not check(root)[0]) != allowed:
                failed += 1
                print(f"wrong about {source}: {line} (allowed: {allowed})")
    print(f"self-test: {len(cases) - failed} of {len(cases)} right")
    return failed


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    if sys.argv[1] == "--self-test":
        return 1 if self_test() else 0
    problems, files = check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(problems))
    print(f"{files} files, {len(problems)} includes that point the wrong way")
    return 1 if problems or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
