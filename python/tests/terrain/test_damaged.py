# SPDX-License-Identifier: Apache-2.0
"""Files that are damaged or truncated, and counts that are wrong: an error that names the file, instead of the points
that are left or the memory that a header asks for."""

from __future__ import annotations

from typing import Any

import cadt.terrain.cloud
import numpy as np
import pytest
from cadt import terrain
from clouds import hills


def refused(path: Any, says: str, **more: Any) -> None:
    with pytest.raises(terrain.FileError, match=says):
        terrain.read_cloud([str(path)], **more)


def test_memory_is_that_of_the_most_points(las, monkeypatch):
    monkeypatch.setattr(cadt.terrain.cloud, "MOST_POINTS", 50)
    name = las("m.laz", hills(100), classes=[2, 5, 5, 5] * 25)
    ground = terrain.read_cloud([name], classes=[2])
    assert len(ground) == 25 and len(ground.xy.base) == 50
    refused(name, "too many points: at most 50 fit")


def test_arrays(tmp_path):
    path = tmp_path / "a.npy"
    np.save(path, np.arange(30.0).reshape(10, 3))
    whole = path.read_bytes()
    for data in (b"", whole[:50], whole[:-1], whole.replace(b"(10, 3), }", b"(10, 3 , {"), b"junk" * 50):
        path.write_bytes(data)
        refused(path, r"a\.npy: cannot be read")
    np.savez(tmp_path / "a.npz", np.zeros((10, 3)))
    (tmp_path / "a.npz").replace(path)
    refused(path, r"a\.npy: is no \.npy file but an \.npz")
    for kind in ("c16", "m8[s]", "?"):
        np.save(path, np.ones((10, 3)).astype(kind))
        refused(path, r"a\.npy: is no table of numbers: shape \(10, 3\), ")
    for kind in ("f4", ">i2", "u1"):
        np.save(path, np.ones((10, 3)).astype(kind))
        assert len(terrain.read_cloud([str(path)])) == 10


def test_no_point_of_the_classes_that_were_asked_for():
    assert "no point is of class 2, 9; without --class" in str(cadt.terrain.cloud.no_points(["a.las"], [2, 9]))
    assert str(cadt.terrain.cloud.no_points(["a.las"], None)) == "a.las: has no points"
