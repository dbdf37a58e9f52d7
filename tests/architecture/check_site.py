#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether the site shows every public header and every page of docs/, which scripts/site refuses to build without, and
whether a merge has left its marks in a page.

usage: check_site.py ROOT
"""
import ast
import pathlib
import sys


def problems_of(root):
    names = {}
    for node in ast.parse((root / "docs/site/tools/prepare.py").read_text()).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in ("HEADERS", "SUFFIX", "NOT_SHOWN"):
            names[node.targets[0].id] = ast.literal_eval(node.value)
    include = root / "include/cadt"
    for language, suffix in names["SUFFIX"].items():
        shown = {name + suffix for group in names["HEADERS"][language].values() for name in group}
        there = {path.relative_to(include).as_posix() for path in include.rglob("*" + suffix)} - names["NOT_SHOWN"]
        for header in sorted(shown ^ there):
            yield f"include/cadt/{header}: HEADERS of docs/site/tools/prepare.py and the folder differ"
    pages = (root / "docs/site/how_it_works.md").read_text()
    for page in sorted((root / "docs").glob("*.md")):
        if f"../{page.stem}\n" not in pages:
            yield f"docs/{page.name} is in no list of docs/site/how_it_works.md"
    for page in sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")]):
        for number, line in enumerate(page.read_text().splitlines(), 1):
            if line.startswith(("<<<<<<< ", ">>>>>>> ")):
                yield f"{page.relative_to(root)}:{number}: a mark of a merge: {line}"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    problems = list(problems_of(pathlib.Path(sys.argv[1])))
    print("\n".join(problems) or "every header and page is on the site")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
