#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's INPUT_FILTER: the comments of a public header in the form that Doxygen reads.

The headers have plain comments: // at the top of a file, and in C /* before a declaration or behind a member. Here the
top becomes the description of the file, and comments of C become documentation. Lines keep their numbers.
"""

import pathlib
import re
import sys


def of_cpp(text: str) -> str:
    """The comment at the top describes the file; all others are documentation already."""
    lines = text.split("\n")
    top = 0
    while top < len(lines) and lines[top].startswith("//"):
        lines[top] = "///" + lines[top][2:] if top else "/// \\file"
        top += 1
    return "\n".join(lines)


def of_c(text: str) -> str:
    """Comments before declarations and behind members; titles such as /* ---- errors ---- */ stay what they are."""
    lines = text.split("\n")
    if lines[0].startswith("/* SPDX") and lines[1].startswith("/* "):
        lines[0] = "/** \\file"
        lines[1] = " * " + lines[1][3:]
    for number, line in enumerate(lines[2:], 2):
        if re.match(r"/\* -+ ", line):
            continue
        if re.match(r"\s*/\* ", line):
            lines[number] = line.replace("/* ", "/** ", 1)
        elif re.search(r"[;,]\s*/\* ", line) or re.match(r"\s*[A-Z_]+ = \d+\s*/\* ", line):
            lines[number] = line.replace("/* ", "/**< ", 1)
    return "\n".join(lines)


def main() -> None:
    path = pathlib.Path(sys.argv[1])
    # Doxygen takes the word behind \throws for all that is thrown; here a sentence follows.
    text = re.sub(r"\\throws\b", "<p><b>Throws</b>", path.read_text(encoding="utf-8"))
    sys.stdout.write(of_c(text) if path.suffix == ".h" else of_cpp(text))


if __name__ == "__main__":
    main()
