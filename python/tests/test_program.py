# SPDX-License-Identifier: Apache-2.0
"""What starts the program ``cadt`` of the package, with a program that tells how it was called in its place."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import cadt
import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the program in its place is a script")
STARTED_AS_A_SCRIPT = "import sys; from cadt._program import main; sys.exit(main())"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A folder with the package's own files, without what is compiled: nothing of it may be loaded."""
    folder = tmp_path / "packages" / "cadt"
    folder.mkdir(parents=True)
    for name in ("__init__.py", "__main__.py", "_program.py"):
        shutil.copy(Path(cadt.__path__[0]) / name, folder / name)
    return folder


def run(package: Path, *command: str | Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(package.parent)}
    return subprocess.run(
        [sys.executable, *command], check=False, capture_output=True, text=True, env=environment, cwd=package.parent.parent
    )


def add_program(package: Path) -> None:
    program = package / "bin" / "cadt"
    program.parent.mkdir()
    # What the kernel hands a script is not the name that it was called by: what is compiled would see it.
    program.write_text('#!/bin/sh\nprintf "<%s>" "$@"\nexit 7\n')
    program.chmod(0o755)


@pytest.mark.parametrize("how", [["-m", "cadt"], ["-c", STARTED_AS_A_SCRIPT]])
def test_words_and_exit_code(package: Path, how: list[str]) -> None:
    add_program(package)
    done = run(package, *how, "raster", "a b.laz", "", "--fill=2")
    assert (done.returncode, done.stdout, done.stderr) == (7, "<raster><a b.laz><><--fill=2>", "")


def test_the_name_that_it_was_called_by(package: Path, tmp_path: Path) -> None:
    (package / "bin").mkdir()
    shutil.copy(shutil.which("bash") or "/bin/bash", package / "bin" / "cadt")
    script = tmp_path / "scripts" / "cadt"
    script.parent.mkdir()
    script.write_text(f"#!{sys.executable}\n{STARTED_AS_A_SCRIPT}\n")
    # bash reads what it is called by as $0.
    assert run(package, script, "-c", "echo $0").stdout == f"{script}\n"
    assert run(package, "-m", "cadt", "-c", "echo $0").stdout == f"{Path(sys.executable).with_name('cadt')}\n"


def test_no_program_in_this_build(package: Path) -> None:
    done = run(package, "-m", "cadt", "--version")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "cadt: the program is not in this build of the package (CADT_BUILD_APPS is OFF)\n"


def test_a_program_that_may_not_be_executed(package: Path) -> None:
    add_program(package)
    (package / "bin" / "cadt").chmod(0o644)
    done = run(package, "-m", "cadt", "--version")
    assert (done.returncode, done.stdout) == (2, "")
    program = package / "bin" / "cadt"
    assert done.stderr == f"cadt: {program} cannot be started: Permission denied; install the wheel with pip\n"


def test_nothing_else_is_imported(package: Path) -> None:
    script = "import sys, cadt._program; print([m for m in sys.modules if m.startswith(('numpy', 'cadt'))])"
    assert run(package, "-c", script).stdout == "['cadt', 'cadt._program']\n"
