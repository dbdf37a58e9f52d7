#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Searches all states of requeue.pml and claims.pml with Spin: none may be wrong as it stands, and each planted fault must
be found.

usage: check_models.py [--large] [MODEL...]      (--large: more workers too; minutes and some GB)

Ends with 77 and the reason when Spin or a C compiler is not there.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIP = 77
MODELS = pathlib.Path(__file__).resolve().parent
LIVENESS = "acceptance cycle"
# For each model: defines, what must be found ("": nothing), and why.
REQUEUE = [
    ([], "", "no state is wrong"),
    (["POINTS=2", "UNSORTED"], "", "locks in no order: a worker that is alone makes progress"),
    (["NO_REREAD"], "assertion violated (version", "a lock that compares no version"),
    (["POINTS=2", "UNSORTED", "HOLD_AND_WAIT"], "invalid end state", "hold and wait"),
    (["DROP_POINT"], "assertion violated (inserted", "a point that is on no list"),
    (["ONE_PASS"], "assertion violated (inserted", "one legality sweep, whatever it finds"),
    (["POINTS=2", "KEEP_LOCK"], LIVENESS, "a failed try-lock that keeps a triangle"),
    (["POINTS=2", "UNSORTED", "NO_FALLBACK"], LIVENESS, "locks in no order, and no worker is ever alone"),
]
BOTH_GO_ON, LOWEST_WAITS = "assertion violated ( !(wins", "assertion violated (wins"
CLAIMS = [
    ([], "", "no state is wrong"),
    (["SAME_KEYS"], BOTH_GO_ON, "two pieces with one key"),
    (["LOAD_AND_STORE"], LOWEST_WAITS, "a claim that is no atomic minimum"),
    (["ONE_SHORT"], BOTH_GO_ON, "a triangle that is neither claimed nor looked at"),
    (["NO_NEIGHBORS"], BOTH_GO_ON, "adjacent triangles are not looked at"),
    (["KEEP_CLAIMS"], LOWEST_WAITS, "pieces that wait keep their claims"),
    (["DECIDE_AT_ONCE"], BOTH_GO_ON, "a decision in the launch of the claims"),
    (["SETTLE_AT_ONCE"], BOTH_GO_ON, "claims that others still look at are settled"),
    (["FILL_AT_ONCE"], "assertion violated ((written", "triangles that others still read are written"),
]
LARGE = {"requeue": [(["WORKERS=3"], "", "three workers")], "claims": [(["PIECES=4"], "", "four pieces")]}


# Deadlocks and assertions; fair runs that never end.
SEARCHES = [("safety", ["-DNOCLAIM", "-DSAFETY"], []), ("liveness", [], ["-a", "-f"])]


def search(folder, model, defines, expected):
    """What Spin finds."""
    flags = [f"-D{name}" for name in defines]
    subprocess.run(["spin", *flags, "-a", str(MODELS / f"{model}.pml")], cwd=folder, check=True, stdout=subprocess.DEVNULL)
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
    asked = [word for word in sys.argv[1:] if word != "--large"]
    if unknown := set(asked) - set(LARGE):
        sys.exit(f"no model {' '.join(sorted(unknown))}: there are {' '.join(LARGE)}")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for model, cases in (("requeue", REQUEUE), ("claims", CLAIMS)):
            if asked and model not in asked:
                continue
            for defines, expected, meaning in cases + (LARGE[model] if "--large" in sys.argv else []):
                print(f"{model}, {' '.join(defines) or 'as it stands'}: {meaning}", flush=True)
                found = search(folder, model, defines, expected)
                right = any(expected in line for line in found) if expected else not found
                if not right:
                    print(f"    NOT AS EXPECTED: {expected or 'nothing'}")
                wrong += not right
    print("all as expected" if not wrong else f"{wrong} not as expected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
