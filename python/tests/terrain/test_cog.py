# SPDX-License-Identifier: Apache-2.0
"""GeoTIFF files: their room on the disk, and what ends before they are whole."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import rasterio
import rasterio.shutil
from cadt import terrain
from cadt.terrain import cog
from cadt.terrain.grid import Grid
from clouds import PACKAGES, hills


def test_more_cells_than_the_disk_holds(monkeypatch, tmp_path):
    monkeypatch.setattr(cog.shutil, "disk_usage", lambda path: type("Usage", (), {"free": 1000, "total": 2000}))
    says = r"20 x 10 cells may need 0.0 GiB, the disk has 0.0 GiB: take a larger"
    with pytest.raises(terrain.FileError, match=says), cog_of(tmp_path, 20, 10):
        pass
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("columns", "rows"), [(300_000, 1), (1, 300_000), (40_000, 20)])
def test_few_rows_take_little_of_the_disk(monkeypatch, tmp_path, columns, rows):
    """Tiles of the temporary files are whole: 512 rows high they were 1.2 GB here."""
    sizes, copy = [], rasterio.shutil.copy

    def look(plain, target, **options):
        copy(plain, target, **options)
        sizes.extend(path.stat().st_blocks * 512 for path in tmp_path.iterdir())

    monkeypatch.setattr(rasterio.shutil, "copy", look)
    free = 2 * (columns + 511) * (rows + 15) * 8 if columns > rows else 2 * (columns + 15) * (rows + 511) * 8
    monkeypatch.setattr(cog.shutil, "disk_usage", lambda path: type("Usage", (), {"free": free, "total": free}))
    cells = np.random.default_rng(1).uniform(size=(rows, columns))
    with cog_of(tmp_path, columns, rows) as out:
        for first in range(0, rows, 512):
            out.write(cells[first : first + 512])
    assert len(sizes) >= 2 and sum(sizes) < free
    with rasterio.open(tmp_path / "o.tif") as raster:
        assert np.array_equal(raster.read(1), cells)


def cog_of(folder, columns, rows):
    return terrain.open_cog(str(folder / "o.tif"), Grid(0, 0, 2, 1, columns, rows), None)


def test_rows_that_are_missing_leave_no_file(tmp_path):
    with pytest.raises(terrain.FileError, match="1 of 2 rows were given"), cog_of(tmp_path, 3, 2) as rows:
        rows.write(np.ones((1, 3)))
    with pytest.raises(KeyboardInterrupt), cog_of(tmp_path, 3, 2):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


COMPRESSING = """
import hashlib, sys
import rasterio.shutil
from cadt.terrain.__main__ import main
def copy(plain, target, **options):
    open(target, "w").close()
    print("compressing", flush=True)
    hashlib.pbkdf2_hmac("sha256", b"", b"", 200_000_000)  # a minute in a library
rasterio.shutil.copy = copy
sys.argv[1:] = ["raster", "a.las", "o.tif", "--res", "5", "-q"]
sys.exit(main())
"""


def test_interruption_of_a_library(las, tmp_path):
    """While the file is compressed, which is one call."""
    las("a.las", hills(500))
    (tmp_path / "o.tif").write_text("old")
    process = subprocess.Popen(
        [sys.executable, "-c", COMPRESSING],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": PACKAGES},
    )
    assert process.stdout.readline() == "compressing\n"
    time.sleep(0.5)  # until it is in there
    start = time.monotonic()
    process.send_signal(signal.SIGTERM)
    said = process.communicate(timeout=300)[1]
    assert (process.returncode, said) == (130, "cadt: interrupted\n") and time.monotonic() - start < 20
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.las", "o.tif"]
    assert (tmp_path / "o.tif").read_text() == "old"


def test_errors_of_gdal_are_those_of_the_file(monkeypatch, tmp_path):
    """Also those for which rasterio has no name."""
    from rasterio._err import CPLE_AppDefinedError

    def fail(plain, target, **options):
        raise CPLE_AppDefinedError(3, 1, "no room")

    monkeypatch.setattr(rasterio.shutil, "copy", fail)
    with pytest.raises(terrain.FileError, match=r"o\.tif: cannot be written: no room"), cog_of(tmp_path, 3, 2) as rows:
        rows.write(np.ones((2, 3)))
    assert list(tmp_path.iterdir()) == []
