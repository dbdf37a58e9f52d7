# SPDX-License-Identifier: Apache-2.0
"""cadt-terrain as a program: help, progress, interruption, missing packages, and behind the program cadt."""

from __future__ import annotations

import importlib.util
import locale
import os
import pathlib
import pty
import shutil
import signal
import subprocess
import sys
import time
import types

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
        [sys.executable, "-c", CLEANING, "1" if clean else "60"],
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


class Anything(type):
    """A class that has every name."""

    def __getattr__(cls, name):
        return Anything(name, (), {"__init__": lambda self, *words, **more: None})


@pytest.fixture
def provider(monkeypatch):
    """The plugin, without QGIS."""
    for name in ("processing", "processing.core", "processing.core.ProcessingConfig", "qgis", "qgis.core"):
        module = types.ModuleType(name)
        module.__getattr__ = lambda name: Anything(name, (Exception,) if name.endswith("Exception") else (), {})
        monkeypatch.setitem(sys.modules, name, module)
    spec = importlib.util.spec_from_file_location("cadt_provider", ROOT / "python" / "cadt_qgis" / "provider.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run_algorithm(provider, monkeypatch, tmp_path, text, canceled=lambda: False):
    """An algorithm that runs a program of Python's; what QGIS is told."""
    script = tmp_path / "program"
    script.write_text(f"#!{sys.executable}\n{text}")
    script.chmod(0o755)
    monkeypatch.setattr(provider, "program", lambda: str(script))
    told = []
    algorithm = provider.Tin()
    algorithm.parameterAsFile = algorithm.parameterAsFileOutput = lambda *_: "a"
    algorithm.parameterAsString = lambda *_: ""
    feedback = types.SimpleNamespace(isCanceled=canceled, pushCommandInfo=lambda _: None, pushConsoleInfo=told.append)
    algorithm.processAlgorithm({}, None, feedback)
    return "".join(told)


def test_qgis_stops_the_program_once(provider, monkeypatch, tmp_path):
    """One signal, and time to clean up."""
    text = """
import pathlib, signal, sys, time
signals = []
signal.signal(signal.SIGTERM, lambda number, frame: signals.append(number))
pathlib.Path(__file__).with_name("ready").touch()
while not signals:
    time.sleep(0.01)
time.sleep(1)
print(len(signals), file=sys.stderr)
sys.exit(130)
"""
    said = run_algorithm(provider, monkeypatch, tmp_path, text, canceled=(tmp_path / "ready").exists)
    assert said == "1\n"


def test_qgis_reads_what_is_no_text_of_the_locale(provider, monkeypatch, tmp_path):
    monkeypatch.setattr(locale, "getpreferredencoding", lambda *_: "ascii")
    monkeypatch.setattr(locale, "getencoding", lambda: "ascii", raising=False)
    text = "import sys\nsys.stderr.buffer.write('Höhe '.encode() + bytes([255]))\n"
    assert run_algorithm(provider, monkeypatch, tmp_path, text) == "Höhe \ufffd"


def test_qgis(las, tmp_path, installed, monkeypatch):
    qgis = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
    if qgis is None:
        pytest.skip("qgis_process is not installed: Debian's package qgis")
    las("a.laz", hills(2000))
    (tmp_path / "run").mkdir(mode=0o700)
    for name, value in (
        ("HOME", tmp_path),
        ("XDG_RUNTIME_DIR", tmp_path / "run"),
        ("QT_QPA_PLATFORM", "offscreen"),
        ("QGIS_PLUGINPATH", ROOT / "python"),
    ):
        monkeypatch.setenv(name, str(value))
    monkeypatch.delenv("PYTHONPATH")  # QGIS has a Python of its own
    script = installed / "cadt-terrain"
    script.write_text(script.read_text().replace("import sys\n", f"import sys\nsys.path.insert(0, {PACKAGES!r})\n", 1))

    def run(*words, code=0):
        done = subprocess.run([qgis, *words], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
        assert (done.returncode == 0) == (code == 0), done.stdout + done.stderr
        return done.stdout + done.stderr

    run("plugins", "enable", "cadt_qgis")
    assert all(f"cadt:{name}" in run("list") for name in ("raster", "contour", "tin"))
    run("run", "cadt:raster", "--", "INPUT=a.laz", "RES=2", "MAX_EDGE=30", "CLASS=2", f"OUTPUT={tmp_path}/o.tif")
    run("run", "cadt:contour", "--", "INPUT=a.laz", "INTERVAL=5", f"OUTPUT={tmp_path}/o.gpkg")
    run("run", "cadt:tin", "--", "INPUT=a.laz", f"OUTPUT={tmp_path}/o.ply")
    for name in ("o.tif", "o.gpkg", "o.ply"):
        assert (tmp_path / name).stat().st_size > 1000
    said = run("run", "cadt:raster", "--", "INPUT=a.laz", "RES=2", "CLASS=9", f"OUTPUT={tmp_path}/no.tif", code=1)
    assert "no point is of class 9" in said and not (tmp_path / "no.tif").exists()
