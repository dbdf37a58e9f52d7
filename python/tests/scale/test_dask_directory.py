# SPDX-License-Identifier: Apache-2.0
"""cadt.dask: the directory of a mesh, and who may write it."""

from __future__ import annotations

import fcntl
import os
import pathlib

import cadt
import cadt.dask
import numpy as np
import pytest
from cadt.dask import _run
from tile_meshes import families


def points(folder: pathlib.Path) -> str:
    np.save(folder / "xy.npy", families()["uniform"])
    return str(folder / "xy.npy")


def test_an_error_leaves_the_directory_to_the_next_run(tmp_path: pathlib.Path, no_client: None) -> None:
    def refuse(part: cadt.tiles.Part) -> None:
        raise ConnectionError

    file = points(tmp_path)
    with pytest.raises(ConnectionError) as kept:
        cadt.dask.triangulate(file, consumer=refuse, tile_points=120, out=tmp_path / "mesh.cadt")
    folder = os.open(tmp_path / "mesh.cadt", os.O_RDONLY)
    fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
    os.close(folder)
    assert kept.tb is not None


def test_a_process_looks_at_the_directory_once(
    tmp_path: pathlib.Path, no_client: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[bool] = []
    open_store = _run._Target.open_store

    def counted(target: _run._Target, tree: cadt.tiles.Tree, create: bool) -> object:
        opened.append(create)
        return open_store(target, tree, create)

    monkeypatch.setattr(_run._Target, "open_store", counted)
    file = points(tmp_path)
    for name in ("a.cadt", "b.cadt"):
        mesh = cadt.dask.triangulate(file, tile_points=120, out=tmp_path / name)
        assert len(mesh.tree) > 10
    assert opened == [True, False] * 2


def test_without_a_working_directory(tmp_path: pathlib.Path, no_client: None, monkeypatch: pytest.MonkeyPatch) -> None:
    file = points(tmp_path)
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    try:
        cadt.dask.triangulate(file, tile_points=120, out=tmp_path / "mesh.cadt")
        with pytest.raises(cadt.FileError, match="mesh.cadt: the working directory is not there"):
            cadt.dask.triangulate(file, tile_points=120, out="mesh.cadt")
    finally:
        os.chdir(tmp_path)
