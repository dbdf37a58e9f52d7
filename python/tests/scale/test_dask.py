# SPDX-License-Identifier: Apache-2.0
"""cadt.dask on a cluster of two processes, and by threads of this one."""

from __future__ import annotations

import os
import pathlib
import signal

import cadt
import cadt.dask
import cadt.mpi
import dask.distributed
import laspy
import numpy as np
import pytest
from cadt import _cadt
from cadt.dask import _run, _sources
from mpi_program import digest, directory_points
from tile_meshes import families


@pytest.fixture(scope="module")
def client():
    with (
        dask.distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
        ) as cluster,
        dask.distributed.Client(cluster) as client,
    ):
        yield client


def save(path: pathlib.Path, xy: np.ndarray) -> str:
    np.save(path, xy)
    return str(path)


def write_las(path: pathlib.Path, xy: np.ndarray, step: float = 0.01) -> np.ndarray:
    """Writes points, and returns them as they are in the file."""
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = [step] * 3, [1000.0, -50.0, 0.0]
    las = laspy.LasData(header)
    las.x, las.y = xy.T
    las.z = np.zeros(len(xy))
    las.write(str(path))
    steps = np.stack([las.X, las.Y], axis=1).astype(float)
    return steps * step + [1000.0, -50.0]


def require_mesh(mesh: cadt.dask.Mesh, xy: np.ndarray) -> None:
    one = cadt.Delaunay(xy)
    assert mesh.hash == one.hash
    assert (mesh.sums.points, mesh.sums.triangles) == (len(xy), one.n_triangles)
    assert int(mesh.triangles.sum()) == one.n_triangles
    cadt.tiles.check_complete(mesh.sums)


def area(part: cadt.tiles.Part) -> float:
    """Of the triangles of a node: what a raster of the tile would do."""
    a, b, c = (part.points[part.triangles[:, k]] for k in range(3))
    return float(np.abs(np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2]).sum() / 2)


@pytest.mark.parametrize("name", families())
def test_families(client: dask.distributed.Client, tmp_path: pathlib.Path, name: str) -> None:
    xy = families()[name]
    file = save(tmp_path / "xy.npy", xy)
    if len(xy) == 0:
        with pytest.raises(cadt.FileError, match="has no points"):
            cadt.dask.triangulate([file], client)
        return
    mesh = cadt.dask.triangulate([file], client, tile_points=120)
    require_mesh(mesh, xy)
    assert mesh.tree == cadt.tiles.Tree.of(xy, 120)


def test_the_consumer_gets_each_triangle_once(client: dask.distributed.Client, tmp_path: pathlib.Path) -> None:
    xy = np.concatenate([np.random.default_rng(0).random((3000, 2)), [[0, 0], [1, 0], [0, 1], [1, 1]]])
    mesh = cadt.dask.triangulate([save(tmp_path / "xy.npy", xy)], client, area, tile_points=400)
    assert len(mesh.values) == len(mesh.tree) > 10
    assert sum(mesh.values) == pytest.approx(1, abs=1e-12)
    assert min(mesh.values) < 0.2


def test_files_of_all_formats(client: dask.distributed.Client, tmp_path: pathlib.Path) -> None:
    """One after another, in the order given; equal points across files are one vertex."""
    rng = np.random.default_rng(1)
    las = write_las(tmp_path / "a.las", rng.random((400, 2)) * 50)
    laz = write_las(tmp_path / "b.laz", rng.random((300, 2)) * 50 + [50, 0])
    npy = np.concatenate([laz[:40], rng.random((100, 2)).astype(np.float32)])
    save(tmp_path / "c.npy", np.column_stack([npy, np.ones(len(npy))]))
    csv = rng.random((50, 2)) * 100
    rows = "\n".join(f"{float(x)!r},{float(y)!r},7" for x, y in csv)
    (tmp_path / "d.csv").write_text(f"# stations\nx,y,z\n{rows}\n")
    xyz = rng.random((20, 2))
    (tmp_path / "e.xyz").write_text("".join(f"{float(x)!r} {float(y)!r} 1\n" for x, y in xyz))
    write_las(tmp_path / "f.las", np.empty((0, 2)))
    files = [tmp_path / name for name in ("a.las", "b.laz", "c.npy", "d.csv", "e.xyz", "f.las")]
    mesh = cadt.dask.triangulate(files, client, tile_points=100)
    xy = np.concatenate([las, laz, npy, csv, xyz])
    require_mesh(mesh, xy)
    assert mesh.sums.distinct == len(xy) - 40
    assert mesh.wrong_boxes == ()


def test_boxes_of_headers_are_not_trusted(client: dask.distributed.Client, tmp_path: pathlib.Path) -> None:
    rng = np.random.default_rng(2)
    first = write_las(tmp_path / "a.laz", rng.random((500, 2)) * 10)
    second = write_las(tmp_path / "b.laz", rng.random((500, 2)) * 10)
    data = bytearray((tmp_path / "b.laz").read_bytes())
    data[179:187] = np.float64(1e6).tobytes()  # max x
    data[187:195] = np.float64(1e6 - 1).tobytes()  # min x
    (tmp_path / "b.laz").write_bytes(data)
    files = [str(tmp_path / "a.laz"), str(tmp_path / "b.laz")]
    mesh = cadt.dask.triangulate(files, client, tile_points=100)
    require_mesh(mesh, np.concatenate([first, second]))
    assert mesh.wrong_boxes == (files[1],)


def test_pieces_of_files(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file larger than what a task reads, and pieces of several files."""
    monkeypatch.setattr(_run, "PIECE_POINTS", 1 << 16)
    xy = np.round(np.random.default_rng(3).random((200_000, 2)) * 1000, 2)
    laz = write_las(tmp_path / "a.laz", xy[:90_000])
    files = [tmp_path / "a.laz", save(tmp_path / "b.npy", xy[90_000:100_000]), save(tmp_path / "c.npy", xy[100_000:])]
    mesh = cadt.dask.triangulate(files, client, tile_points=30_000)
    require_mesh(mesh, np.concatenate([laz, xy[90_000:]]))


def test_a_piece_that_ends_where_a_tile_begins(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The median, 1, is the largest x of the first piece."""
    monkeypatch.setattr(_run, "PIECE_POINTS", 1 << 16)
    rng = np.random.default_rng(5)
    x = np.concatenate([rng.random(65_526), np.ones(20), 1 + rng.random(65_526)])
    xy = np.column_stack([x, rng.random(len(x)) / 4])
    mesh = cadt.dask.triangulate([save(tmp_path / "xy.npy", xy)], client, tile_points=70_000)
    assert mesh.tree.boxes[1, 0] == 1 == xy[: 1 << 16, 0].max()
    require_mesh(mesh, xy)


def test_a_sample_of_pieces(tmp_path: pathlib.Path) -> None:
    """Of so many points that not all are in it: their indices decide."""
    xy = np.random.default_rng(8).random((1_200_000, 2))
    builder = _cadt.TreeBuilder(len(xy), 200_000)
    pieces = _sources.cut([_sources.open_file(save(tmp_path / "xy.npy", xy))], 1 << 18)
    total = _run._add_passes([_run._look_at(piece, builder)[1] for piece in pieces])
    builder.finish_pass(total)
    builder.finish_pass(_run._add_passes([_run._pass_of(piece, builder) for piece in pieces]))
    assert cadt.tiles.Tree(builder.take()) == cadt.tiles.Tree.of(xy, 200_000)


def test_cut() -> None:
    files = [_sources.File("a", 5), _sources.File("b", 0), _sources.File("c", 8)]
    pieces = _sources.cut(files, 4)
    assert [piece.first for piece in pieces] == [0, 4, 8, 12]
    assert [[(f.path, i, n) for f, i, n in piece.ranges] for piece in pieces] == [
        [("a", 0, 4)],
        [("a", 4, 1), ("c", 0, 3)],
        [("c", 3, 4)],
        [("c", 7, 1)],
    ]
    assert pieces[1].place_of(2) == ("c", 1)
    assert len(_sources.cut([], 4)) == 1


def test_directory_is_that_of_mpi(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mpi = pytest.importorskip("mpi4py.MPI")
    monkeypatch.setattr(_run, "PIECE_POINTS", 1 << 16)
    xy = directory_points()
    files = [save(tmp_path / "a.npy", xy[:70_000]), save(tmp_path / "b.npy", xy[70_000:])]
    mesh = cadt.dask.triangulate(files, client, tile_points=25_000, out=tmp_path / "mesh.cadt")
    require_mesh(mesh, xy)
    cadt.mpi.triangulate(mpi.COMM_SELF, xy, tile_points=25_000, out=tmp_path / "mpi.cadt")
    assert digest(tmp_path / "mesh.cadt") == digest(tmp_path / "mpi.cadt")
    with pytest.raises(cadt.ResumeError):
        cadt.dask.triangulate(files, client, tile_points=25_000, out=tmp_path / "mesh.cadt")


class Once:
    """Does something in the first call for a node, wherever it is made."""

    def __init__(self, folder: pathlib.Path, node: int, times: int = 1) -> None:
        self.folder, self.node, self.times = folder, node, times

    def __call__(self, part: cadt.tiles.Part) -> int:
        if part.node == self.node:
            calls = len(list(self.folder.glob("call*")))
            if calls < self.times:
                (self.folder / f"call{calls}").touch()
                self.happen()
        return len(part.triangles)

    def happen(self) -> None:
        raise NotImplementedError


class Kill(Once):
    def happen(self) -> None:
        os.kill(os.getpid(), signal.SIGKILL)


class Fail(Once):
    def happen(self) -> None:
        raise ConnectionError("for a moment")


def test_a_worker_that_is_killed_once(tmp_path: pathlib.Path) -> None:
    """Its nodes are made again, and there is nothing that tells."""
    xy = families()["uniform"]
    file = save(tmp_path / "xy.npy", xy)
    with (
        dask.distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
        ) as cluster,
        dask.distributed.Client(cluster) as client,
    ):
        before = set(client.run(os.getpid).values())
        mesh = cadt.dask.triangulate([file], client, Kill(tmp_path, 6), tile_points=120, out=tmp_path / "mesh.cadt")
        client.wait_for_workers(2, timeout=120)
        assert set(client.run(os.getpid).values()) != before
    assert (tmp_path / "call0").exists()
    require_mesh(mesh, xy)
    assert sum(mesh.values) == mesh.sums.triangles


@pytest.mark.parametrize("times", [2, 3])
def test_a_task_is_tried_three_times(client: dask.distributed.Client, tmp_path: pathlib.Path, times: int) -> None:
    xy = families()["uniform"]
    file = save(tmp_path / "xy.npy", xy)
    if times == 3:
        with pytest.raises(ConnectionError):
            cadt.dask.triangulate([file], client, Fail(tmp_path, 2, times), tile_points=120)
    else:
        require_mesh(cadt.dask.triangulate([file], client, Fail(tmp_path, 2, times), tile_points=120), xy)
    assert len(list(tmp_path.glob("call*"))) == times


def test_not_finite(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The smallest index, although the piece that has it ends last or not at all."""
    monkeypatch.setattr(_run, "PIECE_POINTS", 1 << 16)
    xy = np.random.default_rng(3).random((140_000, 2))
    xy[139_000:, 0] = np.inf
    xy[[65_530, 65_535], 1] = np.nan
    files = [save(tmp_path / "a.npy", xy[:100]), save(tmp_path / "b.npy", xy[100:])]
    with pytest.raises(cadt.InputError, match=r"b\.npy, row 65430") as e:
        cadt.dask.triangulate(files, client)
    assert e.value.index == 65_530


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("a.tif", b"", "end in one of"),
        ("a.laz", b"no laz file at all", "no LAS or LAZ"),
        ("a.npy", b"no npy file at all", "cannot be read"),
        ("a.csv", b"x,y\n1,2\n3,four\n", "cannot be read"),
        ("a.csv", b"x\n1\n", "column 2 is expected"),
        ("a.txt", b"", "is empty"),
        ("missing.csv", None, "cannot be read"),
    ],
)
def test_files_that_are_none(tmp_path: pathlib.Path, name: str, data: bytes | None, says: str) -> None:
    if data is not None:
        (tmp_path / name).write_bytes(data)
    with pytest.raises(cadt.FileError, match=says) as e:
        cadt.dask.triangulate([tmp_path / name])
    assert e.value.path == str(tmp_path / name)


def test_a_file_that_changes_between_readings(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A point that moves within its tile, and points that move to a tile that does not expect them."""
    monkeypatch.setattr(_run, "PIECE_POINTS", 1 << 16)
    xy = np.random.default_rng(0).random((70_000, 2))
    files = [save(tmp_path / "a.npy", xy), save(tmp_path / "b.npy", xy + [2, 0])]
    nodes = _run._Tasks.nodes
    for first, move in ((69_999, 1e-12), (40_000, 2)):

        def change(*arguments: object, first: int = first, move: float = move) -> object:
            moved = xy.copy()
            moved[first:, 0] += move
            save(tmp_path / "a.npy", moved)
            return nodes(*arguments)

        monkeypatch.setattr(_run._Tasks, "nodes", change)
        with pytest.raises(cadt.FileError, match=r"a\.npy.*changed while being read"):
            cadt.dask.triangulate(files, client, tile_points=5000)
        save(tmp_path / "a.npy", xy)


def test_names_are_those_of_the_client(
    client: dask.distributed.Client, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whose working directory is not that of its workers."""
    xy = families()["uniform"]
    save(tmp_path / "xy.npy", xy)
    monkeypatch.chdir(tmp_path)
    assert set(client.run(os.getcwd).values()) != {str(tmp_path)}
    require_mesh(cadt.dask.triangulate("xy.npy", client, tile_points=120, out="mesh.cadt"), xy)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mesh.cadt", "xy.npy"]
    assert len(list((tmp_path / "mesh.cadt").glob("node-*"))) > 10


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_a_number_of_points_that_no_file_has(tmp_path: pathlib.Path, name: str) -> None:
    write_las(tmp_path / name, np.random.default_rng(0).random((500, 2)))
    data = bytearray((tmp_path / name).read_bytes())
    data[247:255] = (1 << 50).to_bytes(8, "little")
    (tmp_path / name).write_bytes(data)
    with pytest.raises(cadt.FileError, match="its header promises 1125899906842624 points"):
        cadt.dask.triangulate(tmp_path / name)


def test_boxes_that_are_no_numbers() -> None:
    bounds = np.array([0.0, 0.0, 1.0, 1.0])
    assert not _sources.File("a", 2, (0.0, 0.0, 1.0, 1.005), 0.01).differs_from(bounds)
    assert _sources.File("a", 2, (0.0, 0.0, 1.0, 1.02), 0.01).differs_from(bounds)
    assert _sources.File("a", 2, (0.0, 0.0, 1.0, float("nan")), 0.01).differs_from(bounds)


def test_truncated_laz(client: dask.distributed.Client, tmp_path: pathlib.Path) -> None:
    write_las(tmp_path / "a.las", np.random.default_rng(0).random((5000, 2)))
    data = (tmp_path / "a.las").read_bytes()
    (tmp_path / "a.las").write_bytes(data[: len(data) * 2 // 3])
    with pytest.raises(cadt.FileError, match=r"a\.las: ") as e:
        cadt.dask.triangulate([tmp_path / "a.las"], client)
    assert e.value.path == str(tmp_path / "a.las")


def test_bad_arguments(client: dask.distributed.Client, tmp_path: pathlib.Path) -> None:
    file = save(tmp_path / "xy.npy", families()["uniform"])
    with pytest.raises(cadt.OptionError, match="at least 3"):
        cadt.dask.triangulate([file], client, tile_points=1)
    with pytest.raises(cadt.OptionError, match="files: there are none"):
        cadt.dask.triangulate([], client)
    for tile_points in (1000.5, None, "9"):
        with pytest.raises(TypeError, match="tile_points must be a whole number, not "):
            cadt.dask.triangulate([file], client, tile_points=tile_points)
    with pytest.raises(cadt.OptionError, match="backend"):
        cadt.dask.triangulate([file], client, device=1)
    with pytest.raises(cadt.BackendUnavailable):
        cadt.dask.triangulate([file], client, backend="cuda", device=99)
    with pytest.raises(cadt.FileError, match="mesh.cadt"):
        cadt.dask.triangulate([file], client, out=tmp_path / "no" / "mesh.cadt")


def test_without_a_cluster(tmp_path: pathlib.Path, no_client: None) -> None:
    xy = families()["lattice"]
    require_mesh(cadt.dask.triangulate([save(tmp_path / "xy.npy", xy)], tile_points=50), xy)


@pytest.mark.parametrize(
    ("visible", "name", "card"), [("3", 1, 0), (None, 1, 1), (None, "2", 0), (None, "tcp://one", 0), ("", 1, 1)]
)
def test_the_card_of_a_worker(monkeypatch: pytest.MonkeyPatch, visible: str | None, name: object, card: int) -> None:
    """On a machine with two cards."""
    import types

    from cadt.tiles import _nodes

    worker = types.SimpleNamespace(name=name, state=types.SimpleNamespace(nthreads=3))
    cards = [types.SimpleNamespace(backend="cuda", usable=True, index=i) for i in range(2)]
    monkeypatch.setattr("distributed.get_worker", lambda: worker)
    monkeypatch.setattr(_nodes, "_known_devices", lambda: cards)
    if visible is None:
        monkeypatch.delenv("CUDA_VISIBLE_DEVICES", raising=False)
    else:
        monkeypatch.setenv("CUDA_VISIBLE_DEVICES", visible)
    target = _run._Target(_run.Where(), 1_000_000, None, None)
    where = _run._here(target)
    assert (where.backend, where.device, where.threads) == ("cuda", card, 3)
    small = _run._Target(_run.Where(), 1_000, None, None)
    assert _run._here(small).backend == "host"
    named = _run._Target(_run.Where("cuda", 5, 2), 1_000, None, None)
    assert _run._here(named) == _run.Where("cuda", 5, 2)
