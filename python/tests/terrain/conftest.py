# SPDX-License-Identifier: Apache-2.0
"""Files for the tests of cadt.terrain, and the command as its users meet it."""

from __future__ import annotations

import dataclasses
import lzma
import os
import pathlib
import shutil
import subprocess
import sys
from collections.abc import Callable

import pytest
from cadt.terrain import __main__
from needed import MISSING

if not MISSING:
    from clouds import PACKAGES, ROOT, make_las


def pytest_ignore_collect(collection_path: pathlib.Path) -> bool | None:
    """Without the packages, test_packages.py alone is left, and says so."""
    return (MISSING and collection_path.match("test_*.py") and collection_path.name != "test_packages.py") or None


@pytest.fixture
def las(tmp_path: pathlib.Path) -> Callable[..., str]:
    """Writes a LAS or LAZ file into the test's folder and returns its path."""
    return lambda name, xyz, *args, **more: make_las(tmp_path / name, xyz, *args, **more)


@pytest.fixture
def data(tmp_path: pathlib.Path) -> Callable[[str], str]:
    """A file of the data folder, unpacked into the test's folder; the test is skipped without the folder."""
    folder = pathlib.Path(os.environ.get("CADT_DATA_DIR", ROOT.parent / "shared" / "data"))

    def find(name: str) -> str:
        packed = folder / (name + ".xz")
        if (folder / name).exists():
            return str(folder / name)
        if not packed.exists():
            pytest.skip(f"{name} is not there: CADT_DATA_DIR names the folder with the point sets")
        target = tmp_path / pathlib.PurePath(name).name
        target.write_bytes(lzma.decompress(packed.read_bytes()))
        return str(target)

    return find


@dataclasses.dataclass
class Result:
    code: int
    out: str
    err: str


@pytest.fixture
def cadt_terrain(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Callable[..., Result]:
    """Runs cadt-terrain in the test's folder; `code` is the exit code it must have. One that fails leaves no file. In a
    process of its own only where the environment is another one: imports take a second."""
    monkeypatch.chdir(tmp_path)

    def run(*words: object, code: int = 0, says: str = "", environment: dict[str, str] | None = None) -> Result:
        before = sorted(tmp_path.iterdir())
        if environment is None:
            capfd.readouterr()
            found = __main__.command([str(word) for word in words])
            result = Result(found, *capfd.readouterr())
        else:
            done = subprocess.run(
                [sys.executable, "-m", "cadt.terrain", *map(str, words)],
                check=False,
                capture_output=True,
                text=True,
                timeout=300,
                env={**os.environ, **environment},
            )
            result = Result(done.returncode, done.stdout, done.stderr)
        assert result.code == code, result.err
        assert says in result.err
        if code:
            assert result.err.startswith("cadt: error: ")
            assert result.out == ""
            assert "Traceback" not in result.err
            assert sorted(tmp_path.iterdir()) == before, "a run that fails leaves nothing behind"
        return result

    return run


def program() -> str:
    """The program cadt of this build."""
    beside = pathlib.Path(PACKAGES).parent / "bin" / "cadt"
    found = os.environ.get("CADT_PROGRAM") or (str(beside) if beside.exists() else shutil.which("cadt"))
    if found is None:
        pytest.skip("the program cadt is not there: CADT_PROGRAM names it")
    return found


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """cadt and cadt-terrain in one folder that is first on PATH, as pip installs them."""
    folder = tmp_path.parent / (tmp_path.name + "-bin")
    folder.mkdir()
    (folder / "cadt").symlink_to(program())
    script = folder / "cadt-terrain"
    script.write_text(f"#!{sys.executable}\nimport sys\nfrom cadt.terrain.__main__ import main\nsys.exit(main())\n")
    script.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", PACKAGES)
    return folder
