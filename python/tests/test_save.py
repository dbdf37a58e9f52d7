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


def test_what_is_inside_is_written_with_its_region(tmp_path: Path) -> None:
    ring = [[0, 0], [6, 0], [6, 4], [0, 4], [1, 1], [2, 1], [2, 2], [1, 2], [3, 1], [4, 1], [4, 2], [3, 2]]
    mesh = cadt.ConstrainedDelaunay(ring, rings=[0, 4, 8, 12], domain="seeds", holes=[[1.5, 1.5]])
    assert len(set(mesh.region[mesh.inside].tolist())) == 2
    for inside in (True, False):
        mesh.save(tmp_path / "mesh.npz", inside=inside)
        kept = mesh.inside | (not inside)
        with np.load(tmp_path / "mesh.npz") as f:
            assert np.array_equal(f["simplices"], mesh.simplices[kept]) and np.array_equal(f["region"], mesh.region[kept])
            assert ("neighbors" in f) == ("convex_hull" in f) == (not inside)
    none = cadt.ConstrainedDelaunay(ring, domain="outer")
    none.save(tmp_path / "none.npz")
    assert np.load(tmp_path / "none.npz")["simplices"].shape == (0, 3)
    meshio = pytest.importorskip("meshio")
    for empty in (none, cadt.Delaunay(ring[:2])):
        with pytest.raises(cadt.InputError, match="there are no triangles, or none is inside"):
            empty.save(tmp_path / "none.vtk")
    none.save(tmp_path / "none.vtk", inside=False)
    mesh.save(tmp_path / "mesh.vtu")
    read = meshio.read(tmp_path / "mesh.vtu")
    assert np.array_equal(read.cells[0].data, mesh.triangles_inside)
    assert np.array_equal(read.cell_data["region"][0], mesh.region[mesh.inside])
    assert len(mesh.to_meshio(inside=False).cells[0].data) == mesh.n_triangles


def test_pyvista_has_the_regions() -> None:
    pytest.importorskip("pyvista")
    mesh = cadt.ConstrainedDelaunay([[0, 0], [4, 0], [4, 4], [0, 4]], rings=[0, 4])
    made = mesh.to_pyvista()
    assert made.n_cells == 2 and np.array_equal(made.cell_data["region"], mesh.region)


def test_heights_of_crossings_are_written(tmp_path: Path) -> None:
    cross = [[0, 0], [2, 2], [0, 2], [2, 0]]
    mesh = cadt.ConstrainedDelaunay(cross, [[0, 1], [2, 3]], crossing="exact")
    mesh.save(tmp_path / "mesh.npz", z=[0, 10, 7, 7])
    assert np.load(tmp_path / "mesh.npz")["height"].tolist() == [0, 10, 7, 7, 5]
