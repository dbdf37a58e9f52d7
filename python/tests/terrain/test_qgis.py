# SPDX-License-Identifier: Apache-2.0
"""The algorithms of QGIS: the plugin without QGIS, and with it where it is installed."""

from __future__ import annotations

import importlib.util
import locale
import shutil
import subprocess
import sys
import types

import geopandas
import pytest
import shapely
from clouds import PACKAGES, ROOT, hills


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


def run_algorithm(provider, monkeypatch, tmp_path, text, canceled=lambda: False, **files):
    """An algorithm that runs a program of Python's; what QGIS is told. `files`: parameters that are."""
    script = tmp_path / "program"
    script.write_text(f"#!{sys.executable}\n{text}")
    script.chmod(0o755)
    monkeypatch.setattr(provider, "program", lambda: str(script))
    told = []
    algorithm = provider.Tin()
    algorithm.parameterAsFile = lambda parameters, name, context: parameters.get(name, "")
    algorithm.parameterAsFileOutput = lambda *_: "out.ply"
    algorithm.parameterAsString = lambda *_: ""
    feedback = types.SimpleNamespace(isCanceled=canceled, pushCommandInfo=lambda _: None, pushConsoleInfo=told.append)
    algorithm.processAlgorithm(files, None, feedback)
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


def test_qgis_passes_files(provider, monkeypatch, tmp_path):
    text = "import sys\nprint(*sys.argv[1:], file=sys.stderr)\n"
    said = run_algorithm(provider, monkeypatch, tmp_path, text, INPUT="a.laz")
    assert said == "tin a.laz -o out.ply\n"
    said = run_algorithm(provider, monkeypatch, tmp_path, text, INPUT="a.laz", BREAKLINES="banks.gpkg")
    assert said == "tin a.laz -o out.ply --breaklines banks.gpkg\n"


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
    bank = geopandas.GeoSeries([shapely.LineString(hills(2000)[:2, :2])], crs="EPSG:25832")
    bank.to_file(tmp_path / "banks.gpkg")
    lines = f"BREAKLINES={tmp_path}/banks.gpkg"
    assert "breaklines  1" in run("run", "cadt:tin", "--", "INPUT=a.laz", lines, f"OUTPUT={tmp_path}/o.ply")
    for name in ("o.tif", "o.gpkg", "o.ply"):
        assert (tmp_path / name).stat().st_size > 1000
    said = run("run", "cadt:raster", "--", "INPUT=a.laz", "RES=2", "CLASS=9", f"OUTPUT={tmp_path}/no.tif", code=1)
    assert "no point is of class 9" in said and not (tmp_path / "no.tif").exists()
