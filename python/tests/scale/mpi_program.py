# SPDX-License-Identifier: Apache-2.0
"""Runs on all ranks: each case, and then rank 0 writes what it gave, or how it failed, as JSON.

usage: mpirun -n N python mpi_program.py FOLDER
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import pathlib
import sys
import time
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))

import cadt
import cadt.mpi
import numpy as np
from cadt.mpi import _exchange, _run
from tile_meshes import families, require_same


def share(comm, xy: np.ndarray, seed: int = 2) -> np.ndarray:
    """The rank's points: shares of any size, some of them empty."""
    cuts = np.sort(np.random.default_rng(seed).integers(0, len(xy) + 1, comm.size - 1))
    return np.split(xy, cuts)[comm.rank]


def directory_points() -> np.ndarray:
    rng = np.random.default_rng(9)
    xy = np.round(rng.random((150_000, 2)), 3)  # one of fourteen equals another
    xy[rng.integers(0, len(xy), 50)] = -0.0
    return xy


def digest(folder: pathlib.Path) -> str:
    """Of the names and bytes of all files but those that may differ between runs."""
    sha = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.name != "run.json":
            sha.update(str(file.relative_to(folder)).encode() + b"\0" + file.read_bytes())
    return sha.hexdigest()


def all_of(comm, mesh: cadt.mpi.Mesh) -> list[cadt.tiles.Part]:
    return sum(comm.allgather(list(mesh.parts.values())), [])


def meshes(comm, folder: pathlib.Path) -> list[str]:
    for name, xy in families().items():
        for tile_points in (10, 60):
            mesh = cadt.mpi.triangulate(comm, share(comm, xy), tile_points=tile_points)
            assert mesh.first_id == sum(comm.allgather(len(share(comm, xy)))[: comm.rank])
            assert set(mesh.parts) == set(np.flatnonzero(mesh.owners == comm.rank).tolist()), name
            assert mesh.tree == cadt.tiles.Tree.of(xy, tile_points), name
            require_same(xy, all_of(comm, mesh), mesh.bases, mesh.sums)
    return list(families())


def tree_of_a_sample(comm, folder: pathlib.Path) -> int:
    """Of so many points that not all are in the sample: their indices decide."""
    xy = np.random.default_rng(8).random((1_200_000, 2))
    tree = _run._Run(_exchange.Group(comm), share(comm, xy), 200_000).tree
    if comm.rank == 0:
        assert tree == cadt.tiles.Tree.of(xy, 200_000)
    return len(tree)


def work_is_shared(comm, folder: pathlib.Path) -> list[int]:
    """Ranks have about equally many points, whoever brought them."""
    xy = np.random.default_rng(4).random((4000, 2))
    mesh = cadt.mpi.triangulate(comm, xy if comm.rank == comm.size - 1 else xy[:0], tile_points=100)
    points = sum(len(p.ids) for n, p in mesh.parts.items() if mesh.tree.children[n, 0] < 0)
    assert 4000 / comm.size - 100 <= points <= 4000 / comm.size + 100
    children = mesh.tree.children
    for node in np.flatnonzero(children[:, 0] >= 0):
        assert mesh.owners[node] == min(mesh.owners[children[node]])
    return comm.allgather(points)


def duplicates_across_ranks(comm, folder: pathlib.Path) -> int:
    """All ranks bring the same points: those of rank 0 are the vertices."""
    xy = np.random.default_rng(6).random((200, 2))
    mesh = cadt.mpi.triangulate(comm, xy, tile_points=60)
    parts = all_of(comm, mesh)
    require_same(np.concatenate([xy] * comm.size), parts, mesh.bases, mesh.sums)
    assert max(part.vertices.max(initial=0) for part in parts) < 200
    return mesh.sums.distinct


def small_messages(comm, folder: pathlib.Path) -> int:
    """Messages above the limit of MPI's counts, with a lower limit."""
    _exchange.MOST_ELEMENTS = 7
    try:
        xy = families()["uniform"]
        mesh = cadt.mpi.triangulate(comm, share(comm, xy), tile_points=200)
        require_same(xy, all_of(comm, mesh), mesh.bases, mesh.sums)
    finally:
        _exchange.MOST_ELEMENTS = 2**30
    return len(mesh.tree)


def directory(comm, folder: pathlib.Path) -> str:
    xy = directory_points()
    out = folder / "mesh.cadt"
    mesh = cadt.mpi.triangulate(comm, share(comm, xy), tile_points=25_000, out=out)
    assert mesh.hash == cadt.Delaunay(xy).hash and not mesh.parts
    assert not any(np.signbit(np.load(file)).any() for file in out.glob("*/points.npy")), "-0 is read as 0"
    assert not (out / "unfinished").exists() and len(list(out.glob("node-*"))) == len(mesh.tree)
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["complete"] and manifest["hash"] == mesh.hash
    assert [node["base"] for node in manifest["nodes"]] == mesh.bases[:-1].tolist()
    _fails(comm, cadt.ResumeError, lambda: cadt.mpi.triangulate(comm, share(comm, xy), tile_points=25_000, out=out))
    _fails(comm, cadt.FileError, lambda: cadt.mpi.triangulate(comm, share(comm, xy), out=folder / "no" / "mesh.cadt"))
    _failed_runs(comm, folder, xy)
    if comm.size > 1:
        _other_directories(comm, folder, xy)
    comm.Barrier()
    return digest(out)


def _failed_runs(comm, folder: pathlib.Path, xy: np.ndarray) -> None:
    """They leave the directory to others, though their error is kept."""

    def refuse(part: cadt.tiles.Part) -> None:
        raise KeyError

    out = folder / "failed.cadt"
    kept = _fails(comm, KeyError, lambda: cadt.mpi.triangulate(comm, share(comm, xy), consumer=refuse, out=out))
    comm.Barrier()
    if comm.rank == 0:
        locked = os.open(out, os.O_RDONLY)
        fcntl.flock(locked, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.close(locked)
    assert kept.__traceback__ is not None


def _other_directories(comm, folder: pathlib.Path, xy: np.ndarray) -> None:
    """Ranks that see another mesh under the name of `out` leave it alone."""
    before = digest(folder / "mesh.cadt")
    place = folder / f"rank{comm.rank}"
    place.mkdir()
    if comm.rank == 1:
        (place / "mesh.cadt").symlink_to(folder / "mesh.cadt")
    own = pathlib.Path.cwd()
    os.chdir(place)
    try:
        _fails(comm, (cadt.ResumeError, cadt.FileError), lambda: cadt.mpi.triangulate(comm, share(comm, xy), out="mesh.cadt"))
    finally:
        os.chdir(own)
    comm.Barrier()
    assert digest(folder / "mesh.cadt") == before


def consumed(comm, folder: pathlib.Path) -> list[int]:
    xy = families()["uniform"]
    mesh = cadt.mpi.triangulate(comm, share(comm, xy), tile_points=80, consumer=lambda part: len(part.triangles))
    assert not mesh.parts
    def forget(part: cadt.tiles.Part) -> None:
        part.links[:] = 0

    assert cadt.mpi.triangulate(comm, share(comm, xy), tile_points=80, consumer=forget).hash == mesh.hash
    values = {}
    for of_rank in comm.allgather(mesh.values):
        values.update(of_rank)
    assert [values[node] for node in range(len(mesh.tree))] == np.diff(mesh.bases.astype(np.int64)).tolist()
    return sorted(values)


def _fails(comm, kind: type[BaseException], call) -> BaseException:
    try:
        call()
    except kind as e:
        return e
    raise AssertionError(f"{kind.__name__} was expected")


def not_finite(comm, folder: pathlib.Path) -> list[int]:
    """The smallest index of all ranks."""
    xy = np.random.default_rng(1).random((50, 2))
    if comm.rank >= comm.size - 2:
        xy[40:, 1] = np.nan
    error = _fails(comm, cadt.InputError, lambda: cadt.mpi.triangulate(comm, xy))
    assert error.index == max(comm.size - 2, 0) * 50 + 40, str(error)
    return comm.allgather(error.index)


def errors_reach_all(comm, folder: pathlib.Path) -> list[str]:
    """Whatever is wrong on one rank, in whatever phase, is raised on all."""
    last = comm.size - 1
    xy = share(comm, families()["uniform"])

    class Custom(Exception):  # cannot be pickled: it is local
        pass

    def late(part: cadt.tiles.Part) -> None:
        if comm.rank == 0 and part.node > 20:
            raise Custom("in a join")

    def early(part: cadt.tiles.Part) -> None:
        if comm.rank == last:
            raise KeyError("in a leaf")

    class Closed(Exception):
        rank = property(lambda self: 5)

    def closed(part: cadt.tiles.Part) -> None:
        raise Closed("its rank cannot be set")

    _fails(comm, (Closed, cadt.Error), lambda: cadt.mpi.triangulate(comm, xy, tile_points=50, consumer=closed))
    _fails(comm, TypeError, lambda: cadt.mpi.triangulate(comm, xy, tile_points=None))
    errors = [
        _fails(comm, cadt.InputError, lambda: cadt.mpi.triangulate(comm, xy if comm.rank < last else xy[:, :1])),
        _fails(comm, TypeError, lambda: cadt.mpi.triangulate(comm, xy if comm.rank < last else xy.astype(complex))),
        _fails(comm, KeyError, lambda: cadt.mpi.triangulate(comm, xy, tile_points=50, consumer=early)),
        _fails(
            comm, (Custom, cadt.Error), lambda: cadt.mpi.triangulate(comm, xy, tile_points=50, consumer=late)
        ),
        _fails(comm, cadt.OptionError, lambda: cadt.mpi.triangulate(comm, xy, tile_points=2)),
        _fails(comm, cadt.BackendUnavailable, lambda: cadt.mpi.triangulate(comm, xy, backend="cuda", device=99)),
    ]
    if comm.size > 1:
        errors.append(_fails(comm, cadt.OptionError, lambda: cadt.mpi.triangulate(comm, xy, tile_points=50 + comm.rank)))
        assert errors[0].rank == last and errors[2].rank == last and errors[3].rank == 0
    return [str(e) for e in errors]


def main(folder: pathlib.Path) -> None:
    from mpi4py import MPI

    comm = MPI.COMM_WORLD
    results = {}
    cases = (
        meshes,
        tree_of_a_sample,
        work_is_shared,
        duplicates_across_ranks,
        small_messages,
        directory,
        consumed,
        not_finite,
        errors_reach_all,
    )
    for case in cases:
        begin = time.monotonic()
        try:
            result, wrong = case(comm, folder), ""
        except BaseException:
            result, wrong = None, f"rank {comm.rank}: {traceback.format_exc()}"
        wrong = "".join(comm.allgather(wrong))
        results[case.__name__] = {"result": result, "wrong": wrong, "seconds": time.monotonic() - begin}
    if comm.rank == 0:
        (folder / "results.json").write_text(json.dumps(results))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
