#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that no kernel can stop a device: nothing that traps, asserts, prints or loops without an end. What goes wrong
is a word in memory that the driver reads. (Compilers also get such code wrong: PoCL issue 2113.)

usage: check_kernels.py ROOT      checks the device text of common, kernels_cl and kernels_cuda
       check_kernels.py --self-test   shows that it finds what it looks for
"""
import pathlib
import re
import sys

FORBIDDEN = re.compile(r"\b(__trap|__builtin_trap|__builtin_unreachable|abort|assert|printf|exit|__assertfail|"
                       r"__brkpt|asm\s+volatile\s*\(\s*\"(trap|exit|brkpt))\b|\bwhile\s*\(\s*(1u?|true)\s*\)")
SUFFIXES = {".h", ".cl", ".cu", ".inc", ".hpp"}


def without_comments(text):
    """Comments become blanks; lines stay where they are."""
    return re.sub(r"/\*.*?\*/|//[^\n]*", lambda match: re.sub(r"[^\n]", " ", match.group()), text, flags=re.S)


def findings(text):
    """(line, word) of what is forbidden. cadt_assert_owned is of the checked build, on the host only (locked_mesh.dev.h)."""
    for number, line in enumerate(without_comments(text).split("\n"), 1):
        for match in FORBIDDEN.finditer(line):
            yield number, match.group()


def self_test():
    bad = ["  abort();", "assert(x);", "while (1) {}", "while (true)", "__trap();", 'printf("x");', "  exit(1);", "while ( 1u ) {"]
    for line in bad:
        assert list(findings(line)), line
    good = ["/* assert that while (1) */", "// abort()", "cadt_assert_owned(1)", "for (;;) {", "while (x) {", "exited = 1;"]
    for line in good:
        assert not list(findings(line)), line
    assert list(findings("/* a\n b */ abort();"))[0][0] == 2
    print("found what it looks for")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    files = sorted((root / "common").rglob("*.dev.h")) + [
        path for folder in ("kernels_cl", "kernels_cuda") for path in sorted((root / folder).iterdir()) if path.suffix in SUFFIXES]
    found = [f"{path.relative_to(root)}:{line}: {word}" for path in files for line, word in findings(path.read_text())]
    print("\n".join(found) or f"{len(files)} files, nothing that stops a device")
    return 1 if found or len(files) < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
