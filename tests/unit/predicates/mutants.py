#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants faults in a copy of the predicates, one at a time, and shows which sets of cases catch each.

usage: mutants.py --root ROOT --work FOLDER --cases PROGRAM [--cxx COMPILER] [--only WORDS | --sample] [--table FILE]
                  [--jobs N]

PROGRAM is cadt-write-predicate-cases. --sample takes the first fault of each group, in the first build that catches it,
unless CADT_MUTANTS=all is set. A fault is caught if a case has a wrong sign, or if a stage decides that must not
by the bounds. Exit code 1: a fault that no set catches, or a case that fails without a fault.
"""
import argparse
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from faults import FLAGS, TEXTS  # noqa: E402

BUILDS = {"narrow": [], "GPU": ["-DCADT_AS_GPU"], "wide": ["-DCADT_WIDE=1"],
          # devices that have no doubles may flush as well
          "float": ["-DCADT_FLOAT=1", "-DCADT_PLANT_FLUSH"]}
VERIFIER = {"verifier": ["-DCADT_VERIFIER"]}
FOLDERS = ["common/predicates", "common/verify/device"]
# Columns of the table; all other sets share one.
COLUMNS = {"predicates_pscico_orient2d.txt": "classic orientation", "predicates_pscico_incircle.txt": "classic incircle",
           "gen_threshold_orient2d.txt": "threshold orientation", "gen_threshold_incircle.txt": "threshold incircle",
           "cocircular": "cocircular", "rectangles": "rectangles"}


def faults():
    for fault in TEXTS:
        group, name, file, old, new = fault[:5]
        yield {"group": group, "name": name, "file": file, "old": old, "new": new, "flags": [],
               "times": fault[5] if len(fault) > 5 else 1}
    for group, name, flags in FLAGS:
        yield {"group": group, "name": name, "file": None, "flags": flags}


def patched(root, folder, fault):
    """A folder with the headers, one of them with the fault, to be searched before the root."""
    for name in FOLDERS:
        (folder / name).mkdir(parents=True)
        for header in (root / name).glob("*.dev.h"):
            shutil.copy(header, folder / name / header.name)
    if fault["file"]:
        path = next(folder / name / fault["file"] for name in FOLDERS if (folder / name / fault["file"]).exists())
        text = path.read_text()
        if text.count(fault["old"]) != fault["times"]:
            raise SystemExit(f"mutants: {fault['file']} has changed: {fault['times']} times expected: {fault['old']!r}")
        path.write_text(text.replace(fault["old"], fault["new"]))


def caught_in(sets):
    return any(r[1] or r[2] for r in sets.values())


def run(root, work, cases, cxx, sample, number, fault):
    """Results {build: {set: (cases, wrong signs, wrong stages)}}; empty if the compiler cannot build the fault."""
    folder = work / f"fault{number}"
    shutil.rmtree(folder, ignore_errors=True)
    patched(root, folder, fault)
    results = {}
    builds = {"": BUILDS | VERIFIER, "verifier": VERIFIER, "floats": {"float": BUILDS["float"]}}.get(fault["group"], BUILDS)
    for build, flags in builds.items():
        program = folder / build
        command = [cxx, "-std=c++20", "-O2", "-ffp-contract=off", "-w", *flags, *fault["flags"], "-I", str(folder),
                   "-I", str(root), str(root / "tests/unit/predicates/evaluate.cpp"), "-o", str(program)]
        compiled = subprocess.run(command, capture_output=True, text=True)
        if compiled.returncode != 0:
            raise SystemExit(f"mutants: {fault['name']}: cannot be compiled\n{compiled.stderr}")
        done = subprocess.run([program, cases], capture_output=True, text=True, timeout=300)
        if done.returncode != 0:
            raise SystemExit(f"mutants: {fault['name']}: ends with {done.returncode}")
        results[build] = {words[0]: tuple(map(int, words[1:])) for words in map(str.split, done.stdout.splitlines())}
        if sample and (caught_in(results[build]) or not fault["group"]):
            break
    shutil.rmtree(folder)
    return results


def worst(results, choose):
    """The largest numbers of wrong signs and of wrong stages among builds and the chosen sets, and the set of it."""
    found = [(r[1], r[2], name, build) for build, sets in results.items() for name, r in sets.items() if choose(name)]
    return max(found, default=(0, 0, "", ""), key=lambda f: (f[0], f[1]))


def cell(entry, with_name=False):
    signs, stages, name, _ = entry
    text = str(signs) if signs or not stages else f"({stages})"
    return f"{text} {name}" if with_name and (signs or stages) else text


def has_fma():
    try:
        return " fma " in pathlib.Path("/proc/cpuinfo").read_text()
    except OSError:
        return False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--cases", required=True)
    parser.add_argument("--cxx", default="c++")
    parser.add_argument("--only", default="")
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=1)
    args = parser.parse_args()
    args.root = args.root.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    cases = args.work / "cases"
    subprocess.run([args.cases, cases], check=True)

    none = {"group": "", "name": "none", "file": None, "flags": []}
    chosen = [none] + [f for f in faults() if args.only in f"{f['group']}: {f['name']}"]
    if len(chosen) == 1:
        raise SystemExit(f"mutants: no fault is called '{args.only}'")
    if not has_fma():
        print("mutants: this processor has no fused multiplication: contraction is left out")
        chosen = [f for f in chosen if "-mfma" not in f["flags"]]
    sample = args.sample and os.environ.get("CADT_MUTANTS") != "all"
    if sample:
        groups = [f["group"] for f in chosen]
        chosen = [f for i, f in enumerate(chosen) if f["group"] not in groups[:i]]
    rows = ["| fault | " + " | ".join(COLUMNS.values()) + " | most by any other set | builds |",
            "| --- |" + " --- |" * (len(COLUMNS) + 2)]
    missed = []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        everything = pool.map(lambda job: run(args.root, args.work, cases, args.cxx, sample, *job), enumerate(chosen))
        for fault, results in zip(chosen, everything):
            caught = [b for b, sets in results.items() if caught_in(sets)]
            name = f"{fault['group']}: {fault['name']}" if fault["group"] else fault["name"]
            if bool(caught) != bool(fault["group"]):
                missed.append(name)
            cells = [cell(worst(results, lambda n, c=column: n == c)) for column in COLUMNS]
            cells.append(cell(worst(results, lambda n: n not in COLUMNS), True))
            rows.append(f"| {name} | " + " | ".join(cells) + " | " + (", ".join(caught) or "-") + " |")
            print(rows[-1], flush=True)
    if args.table:
        args.table.write_text("\n".join(rows) + "\n")
    cases.unlink()
    for name in missed:
        print(f"mutants: {'fails without a fault' if name == 'none' else 'not caught: ' + name}")
    print(f"mutants: {len(chosen) - 1} faults, {len(missed)} not as expected")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
