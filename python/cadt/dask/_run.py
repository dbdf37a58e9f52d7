# SPDX-License-Identifier: Apache-2.0
"""Examination, tree, shuffle, leaves and joins as tasks."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import threading
import weakref
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt
from cadt._errors import FileError, InputError, InternalError, OptionError
from cadt.dask._sources import File, Piece, cut, open_file
from cadt.tiles._nodes import Open, Part, Sums, Where, apply_links, check_complete, mesh_hash, share
from cadt.tiles._tree import TILE_POINTS, Tree, first_not_finite, new_builder, not_finite

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

# Points that a task reads at a time: 24 bytes each until their leaves are made. A multiple of _cadt.block_points.
PIECE_POINTS = 1 << 23
RETRIES = 2


@dataclass(frozen=True)
class Mesh:
    """What is known of a mesh whose nodes have been made.

    Attributes
    ----------
    tree : cadt.tiles.Tree
    values : list
        What ``consumer`` returned, by node.
    triangles : (nodes,) uint64
        Final triangles of each node.
    sums : cadt.tiles.Sums
        Of the whole mesh; they have been checked (`cadt.tiles.check_complete`).
    hash : str
        That of the mesh of all points in one call, `cadt.Delaunay.hash`.
    wrong_boxes : tuple of str
        LAS and LAZ files whose header has another box than their points, whose boxes are what was used.
    """

    tree: Tree
    values: list[Any] = field(repr=False)
    triangles: np.ndarray = field(repr=False)
    sums: Sums
    hash: str
    wrong_boxes: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Look:
    """What the first reading of a piece finds."""

    bad: InputError | None
    bounds: np.ndarray  # of each of its ranges
    content: tuple[int, int]


@dataclass(frozen=True)
class _Report:
    """What a node leaves for the end."""

    sums: Sums
    links: np.ndarray
    told: np.ndarray
    value: Any


@dataclass(frozen=True, eq=False)
class _Target:
    """Where nodes are made, and what becomes of them there."""

    where: Where
    tile_points: int
    consumer: Callable[[Part], Any] | None
    store: tuple[str, tuple[int, int]] | None

    def open_store(self, tree: Tree, create: bool) -> _cadt.TileStore | None:
        if self.store is None:
            return None
        path, content = self.store
        return _cadt.TileStore(path, tree._tree, self.tile_points, content, create)

    def joined_store(self, tree: Tree) -> _cadt.TileStore | None:
        """That of this process, which looks once whether it sees the directory of the run: it takes a long time for
        many nodes."""
        with _joining:
            if self not in _joined:
                _joined[self] = self.open_store(tree, create=False)
            return _joined[self]


_joining = threading.Lock()
_joined: weakref.WeakKeyDictionary[_Target, _cadt.TileStore | None] = weakref.WeakKeyDictionary()


def triangulate(
    files: Sequence[str | os.PathLike[str]],
    client: Any = None,
    consumer: Callable[[Part], Any] | None = None,
    *,
    tile_points: int = TILE_POINTS,
    out: str | os.PathLike[str] | None = None,
    backend: str | None = None,
    device: int | str | None = None,
    threads: int | None = None,
    max_memory: int | None = None,
) -> Mesh:
    """Triangulates the points of files as one set: each node of the tree is a task, which is tried three times.

    Parameters
    ----------
    files : sequence of paths, or one
        .las, .laz (with laspy and lazrs), .npy of shape (n, 2) or (n, 3), .csv, .xyz, .xy, .txt: x and y are the first two
        columns, or in tables of text those that the header names (x, y; lon, lat; easting, northing), as for ``cadt tiles``.
        The input indices are those of the points of all files one after another. All workers must see them under these
        names; relative ones are those of the client.
    client : dask.distributed.Client, optional
        Default: the current one; without one, threads of this process do the work, once each.
    consumer : callable, optional
        Called on the worker with the `cadt.tiles.Part` of each node as it finishes, links to later nodes pending: a
        raster of the tile, statistics. A node that is lost with its worker is made again: calls must be repeatable.
        What it returns goes through the scheduler: keep it small.
    tile_points : int
        Points of a leaf of the tree at most. The mesh does not depend on it, its division into nodes does.
    out : path, optional
        Writes the directory of the mesh, on a file system that all see, as ``cadt tiles`` does: equal bytes for equal
        points and tiles. It must not be there yet.
    backend, device, threads, max_memory
        As for `cadt.Delaunay`, on the workers. Without `device`, "cuda" takes the first card that CUDA_VISIBLE_DEVICES of
        the worker names, else the one whose number is the worker's name. Without `threads`, as many as the worker has.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        NaN or infinity: `index` is the smallest input index of one; the message names the file.
    FileError, ResumeError
        A file cannot be read, is damaged, or changes meanwhile; ``out`` cannot be written, or is there already.

    Notes
    -----
    Files are read three times, and tables of text for each 8 million of their points: convert large ones to .npy. Boxes
    in the headers of LAS and LAZ files are not trusted: those of the points are used. The points go from the tasks that
    read to those that triangulate, 24 bytes each, through the memory of the workers, which Dask spills to disk.

    Examples
    --------
    >>> np.save("points.npy", np.random.default_rng(0).random((5000, 2)))             # doctest: +SKIP
    >>> mesh = cadt.dask.triangulate(["points.npy"], consumer=lambda part: len(part.triangles), tile_points=1000)
    ...                                                                               # doctest: +SKIP
    """
    where = Where(backend, device, threads, max_memory)
    where.check()
    new_builder(0, tile_points)
    # Workers may have other working directories.
    path = None if out is None else _from_root(out)
    names = [_from_root(file) for file in ([files] if isinstance(files, (str, os.PathLike)) else files)]
    if not names:
        raise OptionError("files: there are none", "files")
    tasks = _Tasks(client)
    opened = [open_file(name) for name in names]
    pieces = cut(opened, PIECE_POINTS)

    builder = new_builder(sum(file.count for file in opened), tile_points)
    looks, first_pass = tasks.look(pieces, builder)
    bad = [look.bad for look in looks if look.bad is not None]
    if bad:
        raise min(bad, key=lambda error: error.index)
    if not builder.done:
        builder.finish_pass(first_pass)
    while not builder.done:
        builder.finish_pass(tasks.pass_of(pieces, builder))
    tree = Tree(builder.take())

    store = None if path is None else (path, _sum([look.content for look in looks]))
    target = _Target(where, tile_points, consumer, store)
    directory = target.open_store(tree, create=True)
    try:
        reports = tasks.nodes(pieces, looks, tree, target)
        sums = sum((report.sums for report in reports), Sums())
        check_complete(sums)
        if sums.points != int(tree.counts[-1]):
            raise InternalError(f"the leaves have {sums.points} points, and the tree {int(tree.counts[-1])}")
        if directory is not None:
            directory.finish()  # which checks the links too
        else:
            told = np.concatenate([report.told for report in reports])
            apply_links({node: report.links for node, report in enumerate(reports)}, told)
    finally:
        del directory  # which no other run may write as long as it is here, or in the traceback of an error
    return Mesh(
        tree,
        [report.value for report in reports],
        np.array([report.sums.triangles for report in reports], np.uint64),
        sums,
        mesh_hash(sums),
        _wrong_boxes(opened, pieces, looks),
    )


class _Tasks:
    """Graphs of tasks, and how they are computed."""

    def __init__(self, client: Any) -> None:
        import dask

        self._delayed = dask.delayed
        if client is None:
            import distributed

            with contextlib.suppress(ValueError):  # there is none
                client = distributed.default_client()
        self._client = client

    def _compute(self, tasks: list[Any]) -> list[Any]:
        if self._client is None:
            import dask

            return list(dask.compute(*tasks, scheduler="threads"))
        return self._client.gather(self._client.compute(tasks, retries=RETRIES))

    def _once(self, constant: Any) -> Any:
        """A constant of many tasks, which each worker gets once."""
        return self._delayed(constant, pure=False, traverse=False)

    def _sum(self, passes: list[Any]) -> Any:
        while len(passes) > 1:
            groups = [passes[i : i + 16] for i in range(0, len(passes), 16)]
            passes = [self._delayed(_add_passes)(group) for group in groups]
        return passes[0]

    def look(self, pieces: list[Piece], builder: _cadt.TreeBuilder) -> tuple[list[_Look], _cadt.TreePass]:
        """The first reading of all pieces, and the first pass for the tree."""
        shared = self._once(builder)
        both = [self._delayed(_look_at, nout=2)(piece, shared) for piece in pieces]
        *looks, found = self._compute([*(look for look, _ in both), self._sum([found for _, found in both])])
        return looks, found

    def pass_of(self, pieces: list[Piece], builder: _cadt.TreeBuilder) -> _cadt.TreePass:
        shared = self._once(builder)
        return self._compute([self._sum([self._delayed(_pass_of)(piece, shared) for piece in pieces])])[0]

    def nodes(self, pieces: list[Piece], looks: list[_Look], tree: Tree, target: _Target) -> list[_Report]:
        shared, goal = self._once(tree), self._once(target)
        splits = [self._delayed(_split)(piece, shared, look.content) for piece, look in zip(pieces, looks)]
        whole = np.array([_union(look.bounds) for look in looks])
        opens: dict[int, Any] = {}
        reports = []
        for node, (left, right) in enumerate(tree.children.tolist()):
            if left < 0:
                box = tree.boxes[node]
                meet = (whole[:, :2] < box[2:]).all(axis=1) & (whole[:, 2:] >= box[:2]).all(axis=1)
                parts = [self._delayed(_pick)(splits[i], node) for i in np.flatnonzero(meet)]
                made = self._delayed(_leaf, nout=2)(goal, shared, node, parts)
            else:
                made = self._delayed(_join, nout=2)(goal, shared, node, [opens.pop(left), opens.pop(right)])
            opens[node] = made[0]
            reports.append(made[1])
        return self._compute(reports)


def _add_passes(passes: list[_cadt.TreePass]) -> _cadt.TreePass:
    total = _cadt.TreePass.of_arrays(*passes[0].arrays())  # what tasks get is not theirs to change
    for found in passes[1:]:
        total += found
    return total


def _pass_of(piece: Piece, builder: _cadt.TreeBuilder, points: np.ndarray | None = None) -> _cadt.TreePass:
    found = builder.new_pass()
    builder.look_at(found, piece.first, piece.read() if points is None else points)
    return found


def _look_at(piece: Piece, builder: _cadt.TreeBuilder) -> tuple[_Look, _cadt.TreePass]:
    points = piece.read()
    row = first_not_finite(points)
    if row is not None:  # not raised here: another piece may have an earlier one
        path, number = piece.place_of(row)
        bad = not_finite(points[row], piece.first + row, f" ({path}, row {number})")
        return _Look(bad, np.empty((0, 4)), (0, 0)), builder.new_pass()
    bounds, begin = [], 0
    for _, _, count in piece.ranges:
        rows = points[begin : begin + count]
        bounds.append(np.concatenate([rows.min(axis=0), rows.max(axis=0)]))
        begin += count
    content = _cadt.blocks_hash(piece.first, points)
    return _Look(None, np.array(bounds).reshape(-1, 4), content), _pass_of(piece, builder, points)


def _split(piece: Piece, tree: Tree, content: tuple[int, int]) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """The points of a piece by leaf, with their input indices. Raises FileError if they are not those of the first
    reading."""
    points = piece.read()
    if _cadt.blocks_hash(piece.first, points) != content:
        paths = list(dict.fromkeys(file.path for file, _, _ in piece.ranges))
        raise FileError(f"{', '.join(paths)}: changed while being read", paths[0])
    counts, xy, ids = _cadt.distribute(tree._tree, piece.first, points)
    ends = np.cumsum(counts.astype(np.int64))
    nodes = np.flatnonzero(counts)
    return {int(n): (xy[ends[n] - int(counts[n]) : ends[n]], ids[ends[n] - int(counts[n]) : ends[n]]) for n in nodes}


def _pick(split: dict[int, tuple[np.ndarray, np.ndarray]], leaf: int) -> tuple[np.ndarray, np.ndarray]:
    return split.get(leaf, (np.empty((0, 2)), np.empty(0, np.uint64)))


def _leaf(target: _Target, tree: Tree, node: int, parts: list[tuple]) -> tuple[Open, _Report]:
    xy = np.concatenate([np.empty((0, 2)), *(p[0] for p in parts)])
    ids = np.concatenate([np.empty(0, np.uint64), *(p[1] for p in parts)])
    return _finish(target, tree, _here(target).leaf(xy, ids, tree.boxes[node], node))


def _join(target: _Target, tree: Tree, node: int, opens: list[Open]) -> tuple[Open, _Report]:
    return _finish(target, tree, _here(target).join(opens, tree.boxes[node], node))


def _finish(target: _Target, tree: Tree, made: _cadt.TileNode) -> tuple[Open, _Report]:
    directory = target.joined_store(tree)
    if directory is not None:
        directory.write(made)
    value = None if target.consumer is None else target.consumer(Part(made))
    return made.open, _Report(made.sums, made.links, made.messages, value)


def _here(target: _Target) -> Where:
    """On this worker: its threads, its card."""
    import distributed

    where = target.where
    try:
        worker = distributed.get_worker()
    except ValueError:  # a thread of the caller's
        return share(where, target.tile_points, 0)
    own = os.environ.get("CUDA_VISIBLE_DEVICES")  # as dask-cuda sets it: the worker's card is the first
    number = int(worker.name) if not own and str(worker.name).isdigit() else 0
    threads = where.threads or worker.state.nthreads
    return share(dataclasses.replace(where, threads=threads), target.tile_points, number)


def _from_root(path: str | os.PathLike[str]) -> str:
    name = os.fspath(path)
    try:
        return name if os.path.isabs(name) else os.path.join(os.getcwd(), name)
    except OSError as error:
        raise FileError(f"{name}: the working directory is not there any more: {error.strerror}", name) from error


def _union(bounds: np.ndarray) -> np.ndarray:
    """Of boxes. Of none: one that meets nothing."""
    if len(bounds) == 0:
        return np.array([np.inf, np.inf, -np.inf, -np.inf])
    return np.concatenate([bounds[:, :2].min(axis=0), bounds[:, 2:].max(axis=0)])


def _sum(hashes: list[tuple[int, int]]) -> tuple[int, int]:
    return sum(h[0] for h in hashes) % 2**64, sum(h[1] for h in hashes) % 2**64


def _wrong_boxes(files: list[File], pieces: list[Piece], looks: list[_Look]) -> tuple[str, ...]:
    bounds: dict[str, list[np.ndarray]] = {}
    for piece, look in zip(pieces, looks):
        for (file, _, _), box in zip(piece.ranges, look.bounds):
            bounds.setdefault(file.path, []).append(box)
    wrong = [f.path for f in files if f.path in bounds and f.differs_from(_union(np.array(bounds[f.path])))]
    return tuple(dict.fromkeys(wrong))
