#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prepares what Sphinx reads: the documents as they are, and pages made from the headers and the program's help.

usage: prepare.py ROOT BUILD PROGRAM      BUILD/doxygen/xml is there

BUILD/source has the layout of the repository, so that links between documents, and from them to sources, lead to the
same files as in the repository. Files that did not change keep their times: Sphinx reads again only what did.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml_tree

from doxygen_xml import complete

HEADERS = {
    "cpp": {
        "The mesh": ["triangulator", "points", "options", "triangulation", "errors", "version"],
        "Segments and polygons": ["constrained", "polygons", "label_image"],
        "Asking it": ["queries", "topology", "verify"],
        "Further": ["batch", "finalization", "uniform_cells", "devices", "statistics", "stop_token", "triangle", "cadt"],
        "Files and pictures (component io)": [
            "io/points_file",
            "io/mesh_file",
            "io/query_files",
            "io/triangle_files",
            "io/segments_file",
            "io/region_file",
            "io/label_image_file",
            "io/picture",
            "io/generate",
            "io/text_file",
            "io/errors",
        ],
    },
    "c": {"": ["cadt", "constrained", "queries", "triangulateio"]},
}
SUFFIX = {"cpp": ".hpp", "c": ".h"}
COMPLETED = {f"docs/site/reference/{name}.md" for name in ("cpp", "c", "cli")}  # here, with what is made
NOT_SHOWN = {"export.hpp"}  # macros alone
TERRAIN = {("contour",), ("tin",)}


def write(path: pathlib.Path, text: str) -> pathlib.Path:
    """Writes the file unless it has that text already."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def copy_documents(root: pathlib.Path, source: pathlib.Path, made: set[pathlib.Path]) -> None:
    for path in (root / "docs").rglob("*"):
        target = source / path.relative_to(root)
        if path.is_file() and "__pycache__" not in path.parts and path.relative_to(root).as_posix() not in COMPLETED:
            target.parent.mkdir(parents=True, exist_ok=True)
            if not target.exists() or target.read_bytes() != path.read_bytes():
                shutil.copyfile(path, target)
            made.add(target)
    for path in root.iterdir():  # what documents have links to
        link = source / path.name
        if path.name not in ("docs", "build", ".git") and not link.is_symlink():
            link.symlink_to(path, target_is_directory=path.is_dir())


def header_page(xml: pathlib.Path, header: str, refid: str) -> str:
    """What the header describes, its functions and enumerations, and each of its classes under a title of its own."""
    compound = xml_tree.parse(xml / f"{refid}.xml").getroot().find("compounddef")
    assert compound is not None
    page = f"({refid})=\n\n# `<{header}>`\n\n"
    if compound.find("detaileddescription/para") is not None:
        page += f"```{{doxygenfile}} {header}\n:sections: briefdescription detaileddescription\n```\n\n"
    kinds = [section.get("kind") for section in compound.findall("sectiondef")]
    if kinds:
        title = "Functions and types" if "func" in kinds else "Types and macros"
        spaces = [space.text or "" for space in compound.findall("innernamespace")]
        inside = next((space for space in sorted(spaces, key=len, reverse=True) if space.startswith("cadt")), "0")
        members = f"```{{doxygenfile}} {header}\n:sections: define enum typedef var func\n```\n\n"
        if header.endswith(".hpp"):
            members = f"```{{cpp:namespace}} {inside}\n```\n\n{members}```{{cpp:namespace}} 0\n```\n\n"
        page += f"## {title}\n\n{members}"
    for inner in compound.findall("innerclass"):
        name, kind = inner.text or "", "class" if inner.get("refid", "").startswith("class") else "struct"
        described = xml_tree.parse(xml / f"{inner.get('refid')}.xml").getroot().find("compounddef")
        assert described is not None
        if described.find("location") is not None and "bodyfile" in described.find("location").attrib:  # type: ignore[union-attr]
            page += f"## `{name}`\n\n```{{doxygen{kind}}} {name}\n:members:\n```\n\n"
    return page


def header_pages(root: pathlib.Path, build: pathlib.Path, language: str, made: set[pathlib.Path]) -> None:
    """A page for each public header, and the list of them. A header that is in no group is an error."""
    include, xml = root / "include/cadt", build / "doxygen/xml"
    folder = build / "source/docs/site/reference"
    suffix = SUFFIX[language]
    groups = HEADERS[language]
    grouped = {name + suffix for names in groups.values() for name in names}
    there = {path.relative_to(include).as_posix() for path in include.rglob("*" + suffix)} - NOT_SHOWN
    if grouped != there:
        raise SystemExit(f"prepare.py: HEADERS and include/cadt differ: {sorted(grouped ^ there)}")
    index = xml_tree.parse(xml / "index.xml").getroot()
    refids = {entry.findtext("name"): entry.get("refid", "") for entry in index.findall("compound[@kind='file']")}
    entries = []
    for title, names in groups.items():
        tree = "\n".join(f"<cadt/{name}{suffix}> <{language}/{name.replace('/', '_')}>" for name in names)
        entries.append((f"## {title}\n\n" if title else "") + f"```{{toctree}}\n:maxdepth: 1\n\n{tree}\n```\n")
        for name in names:
            header = f"cadt/{name}{suffix}"
            made.add(
                write(folder / language / f"{name.replace('/', '_')}.md", header_page(xml, header, refids[header]))
            )
    introduction = (root / f"docs/site/reference/{language}.md").read_text(encoding="utf-8")
    made.add(write(folder / f"{language}.md", introduction.rstrip("\n") + "\n\n" + "\n".join(entries)))


def help_of(program: str, *arguments: str) -> str:
    terrain = arguments[:1] in TERRAIN  # commands of Python's part, which is not installed here
    command = [sys.executable, "-m", "cadt.terrain"] if terrain else [program]
    done = subprocess.run([*command, *arguments, "--help"], capture_output=True, text=True, check=True)
    return done.stdout.rstrip("\n")


def command_page(program: str, folder: pathlib.Path, introduction: str, made: set[pathlib.Path]) -> None:
    """The program's own help, of it and of each command that it lists."""
    text = help_of(program)
    listed = re.search(r"(?ms)^Subcommands:\n(.*?)\n\n", text)
    names = re.findall(r"(?m)^  ([a-z]+) ", listed.group(1)) if listed else []
    if not {"triangulate", "raster", "verify"} <= set(names):
        raise SystemExit(f"prepare.py: no commands in the help of {program}:\n{text}")
    blocks = [f"## cadt\n\n```text\n{text}\n```\n"]
    blocks += [f"## cadt {name}\n\n```text\n{help_of(program, name)}\n```\n" for name in names]
    made.add(write(folder / "cli.md", introduction.rstrip("\n") + "\n\n" + "\n".join(blocks)))


def main() -> None:
    root, build, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
    source = build / "source"
    made: set[pathlib.Path] = set()
    complete(build / "doxygen/xml")
    copy_documents(root, source, made)
    reference = source / "docs/site/reference"
    for language in HEADERS:
        header_pages(root, build, language, made)
    introduction = (root / "docs/site/reference/cli.md").read_text(encoding="utf-8")
    command_page(program, reference, introduction, made)
    for path in (source / "docs").rglob("*"):  # of files that are no more
        if path.is_file() and path not in made and "site/examples" not in path.as_posix():
            path.unlink()


if __name__ == "__main__":
    main()
