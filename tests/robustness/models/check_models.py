#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Searches all states of requeue.pml with Spin: none may be wrong as it stands, and each planted fault must be found.

usage: check_models.py [--large]      (--large: three workers too; minutes and some GB)

Ends with 77 and the reason when Spin or a C compiler is not there.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIP = 77
MODEL = pathlib.Path(__file__).resolve().parent / "requeue.pml"
LIVENESS = "acceptance cycle"
# Defines, what must be found ("": nothing), and why.
CASES = [
    ([], "", "no state is wrong"),
    (["POINTS=2", "UNSORTED"], "", "locks in no order: a worker that is alone makes progress"),
    (["NO_REREAD"], "assertion violated (version", "a lock that compares no version"),
    (["POINTS=2", "UNSORTED", "HOLD_AND_WAIT"], "invalid end state", "hold and wait"),
    (["DROP_POINT"], "assertion violated (inserted", "a point that is on no list"),
    (["ONE_PASS"], "assertion violated (inserted", "one legality sweep, whatever it finds"),
    (["POINTS=2", "KEEP_LOCK"], LIVENESS, "a failed try-lock that keeps a triangle"),
    (["POINTS=2", "UNSORTED", "NO_FALLBACK"], LIVENESS, "locks in no order, and no worker is ever alone"),
]


# Deadlocks and assertions; fair runs that never end.
SEARCHES = [("safety", ["-DNOCLAIM", "-DSAFETY"], []), ("liveness", [], ["-a", "-f"])]


def search(folder, defines, expected):
    """What Spin finds."""
    flags = [f"-D{name}" for name in defines]
    subprocess.run(["spin", *flags, "-a", str(MODEL)], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    found = []
    for meaning, compile_options, run_options in SEARCHES:
        if expected and (meaning == "liveness") != (expected == LIVENESS):
            continue  # a fault is looked for once
        subprocess.run(["cc", "-O1", "-w", "-DCOLLAPSE", *compile_options, "-o", "pan", "pan.c"], cwd=folder, check=True)
        done = subprocess.run(["./pan", "-m200000", *run_options], cwd=folder, stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.STDOUT)
        errors = [line for line in done.stdout.splitlines() if line.startswith("pan:1:")]
        if "max search depth too small" in done.stdout or "errors:" not in done.stdout or "Search not completed" in \
                done.stdout and not errors:
            sys.exit(f"check_models: no complete search\n{done.stdout}")
        states = re.search(r"(\d+) states, stored", done.stdout).group(1)
        print(f"    {meaning}: {errors[0][7:] if errors else f'nothing in {states} states'}", flush=True)
        found += errors
    return found


def main():
    for program in ("spin", "cc"):
        if shutil.which(program) is None:
            print(f"skipped: {program} is not there")
            return SKIP
    cases = CASES + ([(["WORKERS=3"], "", "three workers")] if "--large" in sys.argv else [])
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for defines, expected, meaning in cases:
            print(f"{' '.join(defines) or 'as it stands'}: {meaning}", flush=True)
            found = search(folder, defines, expected)
            right = any(expected in line for line in found) if expected else not found
            if not right:
                print(f"    NOT AS EXPECTED: {expected or 'nothing'}")
            wrong += not right
    print("all as expected" if not wrong else f"{wrong} not as expected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
