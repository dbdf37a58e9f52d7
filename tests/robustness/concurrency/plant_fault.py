#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Copies the kernels with one fault of the lock protocol planted in them, for the programs that must find it.

usage: plant_fault.py ROOT TARGET FAULT      copies the device text from ROOT to TARGET, changed
       plant_fault.py --list [TOOL]          names of the faults (that TOOL is to find)

The text that a fault replaces must be in the sources exactly once, so a fault that has become stale is an error.
"""
import pathlib
import shutil
import sys

LOCK, SPLIT, FLIP, INSERT = (f"common/insertion/{name}.dev.h" for name in ("lock", "split", "flip", "insert"))
ATOMICS = "common/portable/atomics.dev.h"

# name: (what is wrong, tools that find it, [(file, text, replacement)])
# Tools: host, opencl, gpu (cadt-tests-perturbed on the host, on OpenCL, and there as on GPUs), tsan (the same under the
# thread sanitizer), relacy (tests/robustness/models/protocol_test.cpp; relacy-gpu with the memory orders of GPUs). No tool:
# docs/reliability.md says why.
FAULTS = {
    "none": ("nothing: the control", [], []),
    "flip_one_lock_short": (
        "a flip locks three of its four triangles", ["host", "opencl", "gpu", "relacy", "relacy-gpu"],
        [(FLIP, "CADT_TRIANGLE_OF(outer_aq)}", "CADT_NONE}")]),
    "split_one_lock_short": (
        "a split locks two of its three triangles", ["host", "opencl", "gpu"],
        [(SPLIT, "CADT_TRIANGLE_OF(s.n2), CADT_NONE}", "CADT_NONE, CADT_NONE}")]),
    "no_reread": (
        "a lock is taken whatever the triangle holds: neither version nor fields are compared",
        ["host", "opencl", "gpu", "relacy", "relacy-gpu"],
        [(LOCK, "#elif CADT_CONTIGUOUS\n  if (*version == CADT_ANY_VERSION) *version", "#elif CADT_CONTIGUOUS\n  *version"),
         (LOCK, "if (*version != CADT_ANY_VERSION && *version != found) {", "if (*version == 1u) {"),
         (LOCK, "const cadt_snapshot now = cadt_snapshot_from(m, t, k);", "const cadt_snapshot now = *s;\n  (void)m, (void)t, (void)k;")]),
    "no_confirm": (
        "GPUs: the version is compared, the fields are not read again", ["relacy-gpu"],
        [(LOCK, "const cadt_snapshot now = cadt_snapshot_from(m, t, k);", "const cadt_snapshot now = *s;\n  (void)m, (void)t, (void)k;")]),
    "confirm_no_vertices": (
        "GPUs: the vertices by which a flip was tested are not compared", ["relacy-gpu"],
        [(LOCK, "cadt_u32 other = (now.v0 ^ s->v0) | (now.v1 ^ s->v1) | (now.v2 ^ s->v2);", "cadt_u32 other = 0u;")]),
    "confirm_no_links": (
        "GPUs: the half-edges by which a flip chose its locks are not compared", ["relacy-gpu"],
        [(FLIP, "cadt_validate(m, t, k, CADT_HALF_EDGES_01, &s)", "cadt_validate(m, t, k, 0u, &s)"),
         (FLIP, "cadt_validate(m, n, j, CADT_HALF_EDGES_01, &u)", "cadt_validate(m, n, j, 0u, &u)")]),
    "release_early": (
        "a flip unlocks its triangles before it has written them", ["host", "opencl", "gpu", "relacy", "relacy-gpu"],
        [(FLIP,
          "  cadt_write_flip(m, half_edge, &s, &u, counters);\n  cadt_fence_before_unlock();\n  cadt_unlock(m, &locks);\n",
          "  cadt_fence_before_unlock();\n  cadt_unlock(m, &locks);\n  cadt_write_flip(m, half_edge, &s, &u, counters);\n")]),
    "publish_early": (
        "the new triangles of a split are published before they are written", ["host", "opencl", "gpu"],
        [(SPLIT, "  cadt_write_face_split(m, i, t, &s, edges, counters);\n",
          "  cadt_publish_triangle(m, t1);\n  cadt_publish_triangle(m, t2);\n  cadt_write_face_split(m, i, t, &s, edges, counters);\n")]),
    "same_version": (
        "an unlock after a change does not raise the version", ["host", "opencl", "relacy"],
        [(LOCK, "{ return version + 2u ? version + 2u : 2u; }", "{ return version; }")]),
    "check_then_set": (
        "a try-lock is a load and a store, not one operation", ["host", "opencl", "gpu", "relacy", "relacy-gpu"],
        [(LOCK, "cadt_cas_lock(lock, *version, *version | 1u)) return 1u;",
          "cadt_load_field(lock) == *version) {\n    cadt_store_relaxed(lock, *version | 1u);\n    return 1u;\n  }"),
         (LOCK, "const cadt_u32 found = cadt_or_relaxed(lock, 1u);",
          "const cadt_u32 found = cadt_load_relaxed(lock);\n  cadt_store_relaxed(lock, found | 1u);")]),
    "lock_kept_at_failure": (
        "a failed try-lock unlocks all but the last triangle that it had", ["host", "opencl", "gpu"],
        [(LOCK, "cadt_unlock_unchanged(m, c, i);", "cadt_unlock_unchanged(m, c, i ? i - 1u : 0u);")]),
    "point_dropped": (
        "a point that got no locks is on no list", ["host", "opencl", "gpu"],
        [(INSERT, "const cadt_u32 at = cadt_add_relaxed(deferred_counts, 1u);",
          "const cadt_u32 at = cadt_load_relaxed(deferred_counts);")]),
    "plain_unlock": (
        "the unlock is a plain store", ["tsan"],
        [(ATOMICS, "{ cadt_store_release(p, value); }\n/* after locks", "{ *p = value; }\n/* after locks")]),
    "relaxed_claim": (
        "CPUs: the compare-and-swap of a lock orders nothing", [],
        [(ATOMICS, "  return cadt_cas_acq_rel(p, expected, desired);", "  return cadt_cas_relaxed(p, expected, desired);")]),
    "relaxed_unlock": (
        "CPUs: the store of an unlock orders nothing", ["relacy"],
        [(ATOMICS, "{ cadt_store_release(p, value); }\n/* after locks",
          "{ cadt_store_relaxed(p, value); }\n/* after locks")]),
    "relaxed_fields_load": (
        "CPUs: fields are read in no order, and not read again", ["relacy"],
        [(ATOMICS, "{ return cadt_load_acquire(p); }", "{ return cadt_load_relaxed(p); }")]),
    "relaxed_fields_store": (
        "CPUs: fields are written in no order", [],
        [(ATOMICS, "{ cadt_store_release(p, value); }\nCADT_FN cadt_u32 cadt_cas_lock",
          "{ cadt_store_relaxed(p, value); }\nCADT_FN cadt_u32 cadt_cas_lock")]),
    "block_fence_claims": (
        "GPUs: the fence after the locks is none for other groups (block scope)", ["relacy-gpu"],
        [(ATOMICS, "CADT_FN void cadt_fence_after_lock(void) { cadt_fence_acq_rel(); }", "CADT_FN void cadt_fence_after_lock(void) {}")]),
    "block_fence_locks": (
        "GPUs: the fence before the unlocks is none for other groups (block scope)", ["relacy-gpu"],
        [(ATOMICS, "CADT_FN void cadt_fence_before_unlock(void) { cadt_fence_acq_rel(); }", "CADT_FN void cadt_fence_before_unlock(void) {}")]),
    "abandon_by_store": (
        "GPUs: a triangle is unlocked unchanged by a store, which cuts the last owner's release sequence", [],
        [(LOCK, "      cadt_add_relaxed(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, 0xFFFFFFFFu);",
          "      cadt_store_relaxed(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, c->version[i]);")]),
}


def plant(root, target, fault):
    if target.exists():
        shutil.rmtree(target)
    for folder in ("common", "kernels_cl"):
        shutil.copytree(root / folder, target / folder,
                        ignore=shutil.ignore_patterns("*.cpp", "*.hpp", "*.cmake", "CMakeLists.txt"))
    for name, old, new in FAULTS[fault][2]:
        path = target / name
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"plant_fault: {fault}: {name} has this {text.count(old)} times, not once:\n{old}")
        path.write_text(text.replace(old, new))


def main():
    if len(sys.argv) in (2, 3) and sys.argv[1] == "--list":
        print(";".join(name for name, (_, tools, _) in FAULTS.items() if len(sys.argv) == 2 or sys.argv[2] in tools), end="")
    elif len(sys.argv) == 4 and sys.argv[3] in FAULTS:
        plant(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
