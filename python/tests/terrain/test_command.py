# SPDX-License-Identifier: Apache-2.0
"""cadt-terrain as a program: help, progress, interruption, missing packages, and behind the program cadt."""

from __future__ import annotations

import os
import pathlib
import pty
import signal
import subprocess
import sys
import time

import cadt
import numpy as np
import pytest
from cadt.terrain import __main__, _options
from clouds import PACKAGES, ROOT, hills


def test_help_teaches_by_examples():
    for command in ("raster", "contour", "tin"):
        done = subprocess.run(
            [sys.executable, "-m", "cadt.terrain", command, "--help"],
            capture_output=True,
            text=True,
            check=True,
            env={**os.environ, "PYTHONPATH": PACKAGES},
        )
        assert done.stderr == "" and f"usage: cadt {command} IN [IN...] OUT" in done.stdout
        assert done.stdout.count(f"\n  cadt {command} ") >= 2 and "Exit codes:" in done.stdout


def test_version():
    done = subprocess.run(
        [sys.executable, "-m", "cadt.terrain", "--version"],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": PACKAGES},
    )
    assert (done.stdout, done.stderr) == (f"cadt {cadt.__version__}\n", "")


def test_every_option_is_in_the_documentation():
    text = (ROOT / "docs" / "cli.md").read_text()
    for command in _options.SUMMARIES:
        section = text.split(f"## cadt {command}\n")[1].split("\n## ")[0]
        for action in _options.parser_of(command)._actions:
            for word in action.option_strings:
                if word not in ("-h", "--help"):
                    assert f"`{word}" in section, f"{word} is not under cadt {command}"


def test_the_examples_of_the_help_are_command_lines():
    for command, text in _options.EXAMPLES.items():
        lines = [line.split() for line in text.splitlines() if line.startswith("  cadt ")]
        for line in lines:
            options = _options.parse(command, line[2:])
            assert options.inputs and options.output


def test_without_words():
    done = subprocess.run(
        [sys.executable, "-m", "cadt.terrain"],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": PACKAGES},
    )
    assert done.returncode == 2 and "usage: cadt raster|contour|tin" in done.stdout


def test_a_wrong_command(cadt_terrain):
    cadt_terrain("rastr", code=2, says="there is no command 'rastr'; did you mean raster?")
    cadt_terrain("raster", "a.laz", "o.tif", "--rse", "1", code=2, says="has no option --rse; did you mean --res?; see:")
    cadt_terrain("contour", "a.laz", "--bogus=1", code=2, says="cadt contour has no option --bogus; see: cadt contour")
    cadt_terrain("contour", "a.laz", "o.fgb", code=2, says="--interval")
    cadt_terrain("mesh", code=2, says="there is no command 'mesh'; there are: raster, contour, tin")


def test_progress_on_a_terminal_alone(las, tmp_path, cadt_terrain):
    las("a.laz", hills(20_000))
    words = ["raster", "a.laz", "o.tif", "--res", "1"]
    assert "\r" not in cadt_terrain(*words).err
    assert cadt_terrain(*words, "-q").err == ""
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "cadt.terrain", *words],
        stderr=slave,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": PACKAGES},
    )
    os.close(slave)
    text = b""
    try:
        while piece := os.read(master, 65536):
            text += piece
    except OSError:  # the other end is closed
        pass
    os.close(master)
    assert process.wait(60) == 0
    assert b"\rsorting" in text and b"\rcompressing o.tif" in text
    assert text.rstrip().endswith(b"written     o.tif")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interruption_leaves_nothing(las, tmp_path, number):
    las("a.las", hills(1_500_000, size=1000.0))
    process = subprocess.Popen(
        [sys.executable, "-m", "cadt.terrain", "raster", "a.las", "o.tif", "--res", "0.5"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": PACKAGES},
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),  # noqa: PLW1509
    )
    end = time.monotonic() + 60
    while len(list(tmp_path.iterdir())) == 1:  # until the temporary file is there
        assert time.monotonic() < end and process.poll() is None
        time.sleep(0.01)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert (process.returncode, said) == (130, "cadt: interrupted\n")
    assert [p.name for p in tmp_path.iterdir()] == ["a.las"]


@pytest.mark.parametrize("closed", ["2>&-", "2>/dev/full", ">&- 2>&-", "<&- >&- 2>&-"])
def test_without_a_standard_error(las, tmp_path, closed):
    las("a.las", hills(500))
    expected = None
    for where in ("", closed):
        command = f'"{sys.executable}" -m cadt.terrain raster a.las {{}} --res 5 {where}'
        for words, code in (("o.tif", 0), ("o.xyz", 2)):
            done = subprocess.run(
                ["sh", "-c", command.format(words)],
                cwd=tmp_path,
                capture_output=True,
                check=False,
                env={**os.environ, "PYTHONPATH": PACKAGES},
            )
            assert (done.returncode, done.stdout) == (code, b"")
        found = (tmp_path / "o.tif").read_bytes()
        expected = expected or found
        assert found == expected
    assert done.stderr == b""


@pytest.mark.parametrize(("words", "code"), [("--help", 3), ("raster --help", 3), ("", 3), ("rasters", 2)])
def test_a_standard_output_that_cannot_be_written(words, code):
    done = subprocess.run(
        ["sh", "-c", f'"{sys.executable}" -m cadt.terrain {words} > /dev/full'],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": PACKAGES},
    )
    assert done.returncode == code
    if code == 3:
        assert done.stderr == "cadt: error: standard output: cannot be written: No space left on device\n"


CLEANING = """
import signal, sys, time
from cadt.terrain import __main__ as program
program.TOGETHER = float(sys.argv[2])
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, program._stop)
try:
    print("ready", flush=True)
    time.sleep(60)
except KeyboardInterrupt:
    print("cleaning", flush=True)
    time.sleep(float(sys.argv[1]))
    print("clean", flush=True)
"""


IMPORTING = """
import sys, time
class Slow:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            print("importing", flush=True)
            try:
                time.sleep(60)
            except KeyboardInterrupt:
                if "%s" == "lost":
                    raise ImportError("numpy is broken")
                raise
sys.meta_path.insert(0, Slow())
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("what", ["raised", "lost"])
def test_interruption_of_imports(tmp_path, number, what):
    """The first half second, in which a library may say what it likes."""
    (tmp_path / "sitecustomize.py").write_text(IMPORTING % what)
    process = subprocess.Popen(
        [sys.executable, "-m", "cadt.terrain", "raster", "a.las", "o.tif", "--res", "1"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{PACKAGES}"},
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),  # noqa: PLW1509
    )
    assert process.stdout.readline() == "importing\n"
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert (process.returncode, said) == (130, "cadt: interrupted\n")


@pytest.mark.parametrize(("wait", "clean"), [(0.0, True), (0.7, False)])
@pytest.mark.parametrize("second", [signal.SIGINT, signal.SIGTERM])
def test_a_second_signal(wait, clean, second):
    """With the first it changes nothing; later it ends the process at once."""
    process = subprocess.Popen(
        [sys.executable, "-c", CLEANING, *(("1", "60") if clean else ("60", "0.5"))],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": PACKAGES},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGTERM)
    assert process.stdout.readline() == "cleaning\n"
    time.sleep(wait)
    process.send_signal(second)
    said = process.communicate(timeout=30)[0]
    assert (process.returncode, said) == ((0, "clean\n") if clean else (-second, ""))


@pytest.mark.parametrize(
    ("package", "words", "install"),
    [
        ("laspy", ["a.las", "o.tif"], "cadt[terrain]"),
        ("lazrs", ["a.laz", "o.tif"], "cadt[terrain]"),
        ("rasterio", ["a.las", "o.tif"], "cadt[terrain]"),
        ("pyproj", ["a.las", "o.tif"], "cadt[terrain]"),
        ("pyogrio", ["p.gpkg", "o.tif"], "cadt[terrain]"),
        ("pyarrow", ["p.parquet", "o.tif"], "geopandas pyarrow"),
    ],
)
def test_missing_packages_are_named(las, tmp_path, cadt_terrain, package, words, install):
    las("a.las", hills(100))
    las("a.laz", hills(100))
    for name in ("p.gpkg", "p.parquet"):
        (tmp_path / name).write_text("")
    hidden = tmp_path.parent / (tmp_path.name + "-hidden")
    hidden.mkdir()
    (hidden / "sitecustomize.py").write_text(f"import sys\nsys.modules[{package!r}] = None\n")
    environment = {"PYTHONPATH": f"{hidden}{os.pathsep}{PACKAGES}"}
    cadt_terrain("raster", *words, "--res", "1", code=5, says=f'pip install "{install}"', environment=environment)


def test_errors_of_the_library_have_the_exit_codes_of_the_program(capsys):
    import cadt

    for error, code in (
        (cadt.OptionError("o", "threads"), 2),
        (cadt.InputError("i", 3), 3),
        (cadt.LimitError("l", 5, 4), 3),
        (cadt.BackendUnavailable("b"), 5),
        (cadt.DeviceError("d"), 5),
        (cadt.KernelBuildError("k"), 5),
        (cadt.OutOfMemory("m"), 6),
        (MemoryError(), 6),
        (KeyboardInterrupt(), 130),
        (cadt.Cancelled("c"), 130),
        (cadt.InternalError("x"), 1),
        (ZeroDivisionError("z"), 1),
    ):
        assert __main__._explain(error) == code
        assert capsys.readouterr().err.startswith("cadt: ")


def test_one_program(las, tmp_path, installed):
    las("a.laz", hills(500))
    run = lambda *words: subprocess.run(["cadt", *words], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run("raster", "a.laz", "o.tif", "--res", "2").returncode == 0
    assert run("contour", "a.laz", "o.gpkg", "--interval", "5").returncode == 0
    assert run("tin", "a.laz", "o.ply").returncode == 0
    wrong = run("raster", "a.laz", "o.tif", "--res", "0")
    assert wrong.returncode == 2 and wrong.stderr.startswith("cadt: error: --res 0")
    # The same cells as from the program itself, which reads text.
    np.savetxt(tmp_path / "a.xyz", hills(500), fmt="%.3f")
    assert run("raster", "a.xyz", "--res", "2", "-o", "o.npy").returncode == 0
    assert run("raster", "a.xyz", "x.tif", "--res", "2", "--crs", "none", "--nodata", "nan").returncode == 0
    import rasterio

    with rasterio.open(tmp_path / "x.tif") as raster:
        assert np.allclose(raster.read(1), np.load(tmp_path / "o.npy"), atol=1e-9, rtol=0, equal_nan=True)
