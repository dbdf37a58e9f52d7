#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what runs only when cadt is published, so that a mistake is found before: .github/workflows against GitHub's schema,
the scripts and jobs that they name, the wheels that cibuildwheel would build (pyproject.toml), and CITATION.cff.

usage: check_distribution.py ROOT          checks the tree; exit code 77 if python/requirements/distribution.txt is not installed
                                           in the environment of the Python that runs this
       check_distribution.py --self-test   shows that it finds what it looks for
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TOOLS = ("check-jsonschema", "cibuildwheel")
# Platform, architecture -> the last part of the names of its wheels.
WHEELS = {("linux", "x86_64"): "manylinux_x86_64", ("linux", "aarch64"): "manylinux_aarch64", ("macos", "x86_64"): "macosx_x86_64",
          ("macos", "arm64"): "macosx_arm64", ("windows", "AMD64"): "win_amd64"}
PYTHONS = ("cp310", "cp311", "cp312", "cp313", "cp314")
NOT_PINNED = "pypa/gh-action-pypi-publish@release/v1"  # docs/release.md says when it is


def tool(name):
    return pathlib.Path(sys.executable).parent / name


def output_of(*command, cwd=None):
    done = subprocess.run([str(part) for part in command], cwd=cwd, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout


def check_schemas(root):
    workflows = sorted((root / ".github" / "workflows").glob("*.yml"))
    if len(workflows) < 2:
        yield f"{root}/.github/workflows has {len(workflows)} workflows: ci.yml and wheels.yml are missing"
    for schema, files in (("github-workflows", workflows), ("citation-file-format", [root / "CITATION.cff"])):
        code, said = output_of(tool("check-jsonschema"), "--builtin-schema", f"vendor.{schema}", *files)
        if code != 0:
            yield said


def check_workflows(root):
    from ruamel.yaml import YAML  # comes with check-jsonschema
    parts = re.search(r"^first=\((.*)\)\nfurther=\((.*)\)", (root / "scripts" / "test").read_text(), re.M)
    parts = {*parts[1].split(), *parts[2].split(), "all"}
    architectures = set()
    for file in sorted((root / ".github" / "workflows").glob("*.yml")):
        for action in re.findall(r"\buses: *(.*)", file.read_text()):
            if not re.search(r"@[0-9a-f]{40} +# v[\d.]+$", action) and action.split()[0] != NOT_PINNED:
                yield f"{file.name}: {action} is not a commit, with its tag in a comment"
        jobs = YAML(typ="safe").load(file)["jobs"]
        for name, job in jobs.items():
            where = f"{file.name}: job {name}"
            needs = job.get("needs", [])
            for needed in [needs] if isinstance(needs, str) else needs:
                if needed not in jobs:
                    yield f"{where} needs {needed}, which is no job"
            if "timeout-minutes" not in job and any(re.search(r"scripts/|\.ci/run|cibuildwheel", str(step)) for step in job["steps"]):
                yield f"{where} builds and has no timeout"
            for step in job["steps"]:
                commands = str(step.get("run", ""))
                for script, argument in re.findall(r"(?<![\w/])(scripts/\w+)(?: +(?!-)([a-z-]+))?", commands):
                    yield from check_script(root, where, script)
                    if script == "scripts/test" and argument and argument not in parts:
                        yield f"{where}: scripts/test has no part {argument}"
            for row in job.get("strategy", {}).get("matrix", {}).get("include", []):
                architectures.add(row.get("archs"))
    for platform, architecture in WHEELS:
        if architecture not in architectures:
            yield f"no job builds wheels for {platform} on {architecture}"


def check_script(root, where, script):
    if not os.access(root / script, os.X_OK):
        yield f"{where}: {script} is not there, or is no program"


def check_wheels(root):
    for (platform, architecture), tag in WHEELS.items():
        code, said = output_of(tool("cibuildwheel"), "--print-build-identifiers", "--platform", platform, "--archs", architecture, root)
        expected = [f"{python}-{tag}" for python in PYTHONS]
        if code != 0 or said.split() != expected:
            yield f"cibuildwheel would build for {platform} on {architecture}: {said.split()}, not {expected}"
    for script in re.findall(r"\{project\}/(scripts/\w+)", (root / "pyproject.toml").read_text()):
        yield from check_script(root, "pyproject.toml", script)
    if "compress-mode" in re.sub(r"#.*", "", (root / "pyproject.toml").read_text()):
        yield "pyproject.toml: machine code of nvcc --compress-mode=size is not for all drivers that cadt promises"


def check_version(root):
    header = (root / "include" / "cadt" / "version.hpp").read_text()
    version = re.search(r'define CADT_VERSION "(.*)"', header)[1]
    numbers = re.findall(r"CADT_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
    if ".".join(numbers) != version:
        yield f"version.hpp says {version} and {'.'.join(numbers)}"
    cited = re.search(r"^version: (.*)$", (root / "CITATION.cff").read_text(), re.M)
    if cited is None or cited[1] != version:
        yield f"CITATION.cff is of version {cited and cited[1]}, include/cadt/version.hpp of {version}"


CHECKS = (check_schemas, check_workflows, check_wheels, check_version)


def problems_of(root):
    return [problem for check in CHECKS for problem in check(root)]


FAULTS = [  # file, what is replaced by what, what is said then
    (".github/workflows/ci.yml", "runs-on: windows-2022", "run-on: windows-2022", "runs-on|run-on"),
    (".github/workflows/ci.yml", "run: scripts/test portability", "run: scripts/test portable", "no part portable"),
    (".github/workflows/ci.yml", "run: scripts/quickstart", "run: scripts/quick_start", "scripts/quick_start is not there"),
    (".github/workflows/ci.yml", "actions/checkout@fbc6f3992d24b796d5a048ff273f7fcc4a7b6c09", "actions/checkout@v5", "v5  # v5.1.0 is not a commit"),
    (".github/workflows/wheels.yml", "  # v3.4.1", "", "is not a commit, with its tag"),
    (".github/workflows/ci.yml", "    timeout-minutes: 90\n", "", "has no timeout"),
    (".github/workflows/wheels.yml", "needs: [wheels, sdist]", "needs: [wheel, sdist]", "needs wheel, which is no job"),
    (".github/workflows/wheels.yml", "archs: aarch64", "archs: ppc64le", "no job builds wheels for linux on aarch64"),
    ("pyproject.toml", '"cp311-*", ', "", "cibuildwheel would build for linux"),
    ("pyproject.toml", "scripts/wheel_dependencies", "scripts/wheels_dependencies", "scripts/wheels_dependencies is not there"),
    ("CITATION.cff", "version: 0.", "version: 9.", "CITATION.cff is of version 9."),
    ("CITATION.cff", "title:", "titel:", "titel"),
]


def self_test(root):
    problems = problems_of(root)
    if problems:
        print("there are problems already:", *problems, sep="\n")
        return 1
    wrong = 0
    for file, old, new, expected in FAULTS:
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            for name in (".github", "scripts", "include/cadt/version.hpp", "pyproject.toml", "CITATION.cff"):
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                (shutil.copytree if (root / name).is_dir() else shutil.copy)(root / name, copy / name)
            text = (copy / file).read_text()
            if old not in text:
                print(f"{file} has no '{old}': the self-test is out of date")
                wrong += 1
                continue
            (copy / file).write_text(text.replace(old, new))
            check = {"pyproject.toml": check_wheels}.get(file)
            said = list(check(copy)) if check else [p for c in CHECKS if c is not check_wheels for p in c(copy)]
            if not re.search(expected, "\n".join(said)):
                print(f"{file} with '{new}' instead of '{old}': said {said}")
                wrong += 1
    print(f"{len(FAULTS)} planted mistakes, {wrong} not found")
    return 1 if wrong else 0


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    missing = [name for name in TOOLS if not tool(name).exists()]
    if missing:
        print(f"not checked: {sys.executable} has no {', '.join(missing)}; scripts/python_env distribution installs them")
        return 77
    if sys.argv[1] == "--self-test":
        return self_test(pathlib.Path(__file__).resolve().parents[2])
    problems = problems_of(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(problems) or "workflows, wheels, version and citation: right")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
