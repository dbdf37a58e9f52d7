# SPDX-License-Identifier: Apache-2.0
"""What save() writes, and what it leaves where it cannot."""

from __future__ import annotations

from pathlib import Path

import cadt
import numpy as np
import pytest


def test_files(points: np.ndarray, tmp_path: Path) -> None:
    mesh = cadt.Delaunay(points)
    mesh.save(tmp_path / "mesh.npz", z=np.zeros(mesh.n_points))
    with np.load(tmp_path / "mesh.npz") as f:
        assert set(f) >= {"points", "simplices", "neighbors"}
        assert np.array_equal(f["simplices"], mesh.simplices)
    assert [f.name for f in tmp_path.iterdir()] == ["mesh.npz"]


def test_names_of_files(tmp_path: Path) -> None:
    """Errors name the file that was asked for, not a temporary one, and leave none."""
    mesh = cadt.Delaunay(np.random.default_rng(0).random((10, 2)))
    for wrong in ([1, 2, 3], np.zeros((10, 2)), 0):
        with pytest.raises(cadt.InputError, match="must have shape"):
            mesh.save(tmp_path / "mesh.npz", z=wrong)
    with pytest.raises(cadt.InputError, match="masked"):
        mesh.save(tmp_path / "mesh.npz", z=np.ma.masked_all(10))
    (tmp_path / "folder.npz").mkdir()
    for name in ("no/mesh.npz", "folder.npz"):
        with pytest.raises(cadt.FileError, match=f"{name}: cannot be written: [^']*$") as caught:
            mesh.save(tmp_path / name)
        assert caught.value.path == str(tmp_path / name)
    with pytest.raises(cadt.FileError, match=r"mesh: a suffix says the format: \.npz"):
        mesh.save(tmp_path / "mesh")
    mesh.save(tmp_path / "MESH.NPZ", z=range(10))
    assert sorted(f.name for f in tmp_path.iterdir()) == ["MESH.NPZ", "folder.npz"]
    with np.load(tmp_path / "MESH.NPZ") as f:
        assert np.array_equal(f["simplices"], mesh.simplices) and f["height"].tolist() == list(range(10))


def test_files_through_links(tmp_path: Path) -> None:
    """They stay, also one to a file that is not there yet."""
    mesh = cadt.Delaunay(np.random.default_rng(0).random((10, 2)))
    (tmp_path / "there").mkdir()
    (tmp_path / "link.npz").symlink_to(Path("there") / "mesh.npz")
    (tmp_path / "lost.npz").symlink_to(Path("no") / "mesh.npz")
    for _ in range(2):
        mesh.save(tmp_path / "link.npz")
        assert (tmp_path / "link.npz").is_symlink() and not (tmp_path / "there" / "mesh.npz").is_symlink()
    with np.load(tmp_path / "there" / "mesh.npz") as f:
        assert np.array_equal(f["simplices"], mesh.simplices)
    with pytest.raises(cadt.FileError, match=r"lost\.npz: cannot be written"):
        mesh.save(tmp_path / "lost.npz")
    assert sorted(f.name for f in tmp_path.rglob("*")) == ["link.npz", "lost.npz", "mesh.npz", "there"]


def test_meshio(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    mesh = cadt.Delaunay(np.random.default_rng(0).random((10, 2)))
    for name in ("a.vtk", "b.PLY"):
        mesh.save(tmp_path / name, z=np.arange(10))
        read = meshio.read(tmp_path / name)
        assert np.array_equal(read.points[:, 2], np.arange(10)) and len(read.cells[0].data) == mesh.n_triangles
    with pytest.raises(cadt.FileError, match=r"end in one of: \.npz, .*\.ply"):
        mesh.save(tmp_path / "mesh.no_such_format")
    with pytest.raises(cadt.InputError, match="must have shape"):
        mesh.to_meshio([1, 2, 3])


def test_heights_of_crossings_are_written(tmp_path: Path) -> None:
    cross = [[0, 0], [2, 2], [0, 2], [2, 0]]
    mesh = cadt.ConstrainedDelaunay(cross, [[0, 1], [2, 3]], crossing="exact")
    mesh.save(tmp_path / "mesh.npz", z=[0, 10, 7, 7])
    assert np.load(tmp_path / "mesh.npz")["height"].tolist() == [0, 10, 7, 7, 5]
