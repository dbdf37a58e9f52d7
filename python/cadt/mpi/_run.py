# SPDX-License-Identifier: Apache-2.0
"""Sample, tree, shuffle, leaves, joins, links: the same nodes for any number of ranks."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt
from cadt._errors import InternalError, OptionError
from cadt.mpi._exchange import Group
from cadt.tiles._nodes import (
    LOCAL_BITS,
    Open,
    Part,
    Sums,
    Where,
    apply_links,
    check_complete,
    mesh_hash,
    share,
)
from cadt.tiles._tree import TILE_POINTS, Tree, build_tree, first_not_finite, new_builder, normalized, not_finite

if TYPE_CHECKING:
    from collections.abc import Callable

    from mpi4py import MPI


@dataclass(frozen=True)
class Mesh:
    """What a rank has of a mesh.

    Attributes
    ----------
    tree : cadt.tiles.Tree
    owners : (nodes,) int64
        The rank that made each node.
    parts : dict of int to cadt.tiles.Part
        The nodes of this rank with complete links; empty if ``out`` or ``consumer`` took them.
    values : dict of int to object
        What ``consumer`` returned for the nodes of this rank.
    first_id : int
        Input index of the first point of this rank.
    bases : (nodes + 1,) uint64
        Triangle ``node << 40 | row`` of the whole mesh is number ``bases[node] + row`` of it.
    sums : cadt.tiles.Sums
        Of the whole mesh; they have been checked (`cadt.tiles.check_complete`).
    hash : str
        That of the mesh of all points in one call, `cadt.Delaunay.hash`.
    """

    tree: Tree
    owners: np.ndarray
    parts: dict[int, Part] = field(repr=False)
    values: dict[int, Any] = field(repr=False)
    first_id: int
    bases: np.ndarray = field(repr=False)
    sums: Sums
    hash: str


def triangulate(
    comm: MPI.Intracomm,
    xy: Any,
    *,
    tile_points: int = TILE_POINTS,
    out: str | os.PathLike[str] | None = None,
    consumer: Callable[[Part], Any] | None = None,
    backend: str | None = None,
    device: int | str | None = None,
    threads: int | None = None,
    max_memory: int | None = None,
) -> Mesh:
    """Triangulates the points of all ranks as one set. Collective.

    Parameters
    ----------
    comm : mpi4py.MPI.Intracomm
    xy : array_like, shape (n, 2)
        The points of this rank, any number. The input indices are those of the points of all ranks one after another.
    tile_points : int
        Points of a leaf of the tree at most. The mesh does not depend on it, its division into nodes does.
    out : path, optional
        Writes the directory of the mesh, which all ranks must see, as ``cadt tiles`` does: equal bytes for equal points
        and tiles, whatever the number of ranks. It must not be there yet.
    consumer : callable, optional
        Called with the `cadt.tiles.Part` of each node as the rank finishes it, links to later nodes pending.
    backend, device, threads, max_memory
        As for `cadt.Delaunay`. Without `device`, the ranks of a machine take the cards of `backend` in turn; without
        `backend`, CUDA's where there are any and tiles of 200,000 points or more, else the host; without `threads`, the
        ranks of a machine share its cores.

    Returns
    -------
    Mesh
        Also equal on all ranks but for `parts`, `values` and `first_id`.

    Raises
    ------
    InputError
        NaN or infinity: `index` is the smallest input index of one, on all ranks.
    FileError, ResumeError
        ``out`` cannot be written, or is there already.

    Notes
    -----
    An exception of one rank is raised on all, also one of the consumer; its attribute `rank`, if it takes one, is that
    rank. Memory of a rank: 44 bytes for each of its points, 96 where parts are kept, and what its triangulations take. All
    ranks wait for each other after the leaves and each level of joins. Not for several threads of a rank at once.
    """
    private = comm.Dup()
    try:
        group = Group(private)
        where = group.together(lambda: _checked(Where(backend, device, threads, max_memory), tile_points, out))
        path = None if out is None else os.fspath(out)
        _require_equal(group, tile_points, path, consumer is None)
        run = _Run(group, xy, tile_points)
        try:
            return run.finish(_share(group, where, tile_points), path, consumer)
        finally:
            run.store = None  # no other run may write the directory as long as it is in the traceback of an error
    finally:
        private.Free()


class _Run:
    """The points of a rank, and the tree of all ranks."""

    def __init__(self, group: Group, xy: Any, tile_points: int) -> None:
        self.group, self.tile_points = group, tile_points
        self.store: _cadt.TileStore | None = None  # of the directory
        self.points: np.ndarray = group.together(lambda: normalized(xy))
        counts = group.comm.allgather(len(self.points))
        self.ends = np.cumsum(counts)
        self.first = int(self.ends[group.rank]) - len(self.points)
        group.together(self._require_finite)
        # The largest index of 64 bits is 2^64 - 1, which no memory reaches.
        self.tree = build_tree(int(self.ends[-1]), tile_points, self._look)
        # Leaves in their order, so many to each rank that their points are about equally many.
        inner = self.tree.counts.copy()
        inner[self.tree.children[:, 0] >= 0] = 0
        middle = np.cumsum(inner) - inner / 2
        share = middle / max(1, int(self.ends[-1])) * group.size
        self.owners = np.minimum(share.astype(np.int64), group.size - 1)
        for node, (left, _) in enumerate(self.tree.children.tolist()):
            if left >= 0:  # the lower rank of those of the children
                self.owners[node] = self.owners[left]

    def _require_finite(self) -> None:
        bad = first_not_finite(self.points)
        if bad is not None:  # the lowest rank's is that of the smallest index
            raise not_finite(self.points[bad], self.first + bad, f" (number {bad} of rank {self.group.rank})")

    def _look(self, builder: _cadt.TreeBuilder) -> _cadt.TreePass:
        group = self.group

        def look() -> _cadt.TreePass:
            found = builder.new_pass()
            builder.look_at(found, self.first, self.points)
            return found

        counts, bounds, sample = group.together(look).arrays()
        bounds = bounds.reshape(-1, 4)
        low, high = group.minimum(bounds[:, :2].ravel()), group.minimum(-bounds[:, 2:].ravel())
        bounds = np.concatenate([low.reshape(-1, 2), -high.reshape(-1, 2)], axis=1).reshape(-1, 2)
        return _cadt.TreePass.of_arrays(group.sum(counts), bounds, group.gather_rows(sample))

    def content(self) -> tuple[int, int]:
        """The hash of all points, of blocks that may belong to several ranks: that of their first point has them."""
        group, block, n = self.group, _cadt.block_points, len(self.points)
        head = min(n, -self.first % block)
        counts = np.zeros(group.size, np.int64)
        if head:
            counts[np.searchsorted(self.ends, self.first // block * block, side="right")] = head
        rest, _ = group.exchange(self.points[:head], counts)

        def own() -> np.ndarray:
            own = self.points[head:]
            whole = len(own) // block * block
            first = self.first + head
            tail = np.concatenate([own[whole:], rest])
            hashes = [_cadt.blocks_hash(first, own[:whole]), _cadt.blocks_hash(first + whole, tail)]
            return np.array(hashes, np.uint64).sum(axis=0, dtype=np.uint64)

        high, low = group.sum(group.together(own))
        return int(high), int(low)

    def shuffle(self) -> Callable[[int], tuple[np.ndarray, np.ndarray]]:
        """Points to the owners of their leaves; what is returned gives the points and ids of a leaf of this rank."""
        group, tree = self.group, self.tree
        counts, xy, ids = group.together(lambda: _cadt.distribute(tree._tree, self.first, self.points))
        self.points = np.empty((0, 2))
        leaves = tree.leaves
        owners = self.owners[leaves]
        leaves_of = np.bincount(owners, minlength=group.size)
        sent = np.bincount(owners, counts[leaves].astype(float), group.size).astype(np.int64)
        counts, _ = group.exchange(counts[leaves], leaves_of)
        xy, _ = group.exchange(xy, sent)
        ids, _ = group.exchange(ids, sent)
        mine = leaves[owners == group.rank]
        ends = np.cumsum(counts.astype(np.int64)).reshape(group.size, len(mine))  # by source and leaf
        begins = ends - counts.astype(np.int64).reshape(ends.shape)
        column = {int(leaf): k for k, leaf in enumerate(mine)}

        def take(leaf: int) -> tuple[np.ndarray, np.ndarray]:
            k = column[leaf]
            pieces = [slice(b, e) for b, e in zip(begins[:, k], ends[:, k])]  # by source: ids ascend
            return np.concatenate([xy[p] for p in pieces]), np.concatenate([ids[p] for p in pieces])

        return take

    def finish(self, where: Where, out: str | None, consumer: Callable[[Part], Any] | None) -> Mesh:
        group, tree, owners = self.group, self.tree, self.owners
        if out is not None:
            plan = (out, tree._tree, self.tile_points, self.content())
            self.store = group.together(lambda: _cadt.TileStore(*plan, True) if group.rank == 0 else None)
            self.store = group.together(lambda: self.store or _cadt.TileStore(*plan, False))
        take = self.shuffle()
        opens: dict[int, Open] = {}
        links: dict[int, np.ndarray] = {}
        parts: dict[int, Part] = {}
        values: dict[int, Any] = {}
        told: list[np.ndarray] = []
        triangles = np.zeros(len(tree), np.uint64)
        sums = Sums()

        def make(node: int) -> Open:
            nonlocal sums
            left, right = tree.children[node].tolist()
            if left < 0:
                made = where.leaf(*take(node), tree.boxes[node], node)
            else:
                made = where.join([opens.pop(left), opens.pop(right)], tree.boxes[node], node)
                told.append(made.messages)
            if self.store is not None:
                self.store.write(made)
            part = Part(made)
            if consumer is not None:
                values[node] = consumer(part)
            elif self.store is None:
                parts[node] = part
            links[node] = part.links if node in parts else made.links  # a copy: that of a consumer's part is its own
            triangles[node] = len(part.triangles)
            sums += part.sums
            return made.open

        def make_all(level: list[int]) -> dict[int, Open]:
            return {node: make(node) for node in level}

        for height in range(int(tree.heights.max()) + 1):
            level = np.flatnonzero((tree.heights == height) & (owners == group.rank)).tolist()
            opens.update(self._pass_up(group.together(functools.partial(make_all, level))))
        del take
        rows = _rows(told)
        receivers = owners[(rows[:, 0] >> np.uint64(LOCAL_BITS)).astype(np.int64)]
        order = np.argsort(receivers, kind="stable")
        rows, _ = group.exchange(rows[order], np.bincount(receivers, minlength=group.size))
        group.together(lambda: apply_links(links, rows))
        sums = sum(group.comm.allgather(sums), Sums())
        check_complete(sums)
        if sums.points != int(self.ends[-1]):
            raise InternalError(f"the leaves have {sums.points} points, and the ranks {int(self.ends[-1])}")
        if (store := self.store) is not None:
            group.together(store.finish if group.rank == 0 else lambda: None)
        bases = np.concatenate([np.zeros(1, np.uint64), np.cumsum(group.sum(triangles), dtype=np.uint64)])
        return Mesh(tree, owners, parts, values, self.first, bases, sums, mesh_hash(sums))

    def _pass_up(self, opens: dict[int, Open]) -> dict[int, Open]:
        """What is open in the nodes of a level, to the owners of their parents."""
        messages: list[list[np.ndarray]] = [[] for _ in range(self.group.size)]
        for node, open_part in opens.items():
            if node + 1 < len(self.tree):
                words = open_part.__getstate__()
                header = np.array([node, len(words)], np.uint64)
                messages[self.owners[self.tree.parents[node]]] += [header, words]
        counts = np.array([sum(map(len, m)) for m in messages], np.int64)
        words, _ = self.group.exchange(np.concatenate([*sum(messages, []), np.empty(0, np.uint64)]), counts)
        received: dict[int, Open] = {}
        at = 0
        while at < len(words):
            node, size = words[at : at + 2].tolist()
            received[node] = _cadt.open_of_words(words[at + 2 : at + 2 + size])
            at += 2 + size
        return received


def _rows(told: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([*told, np.empty((0, 3), np.uint64)])


def _checked(where: Where, tile_points: int, out: Any) -> Where:
    where.check()
    new_builder(0, tile_points)
    if out is not None:
        os.fspath(out)
    return where


def _require_equal(group: Group, *arguments: Any) -> None:
    """Ranks that were called differently would wait for each other for ever."""
    names = ("version of cadt", "tile_points", "out", "consumer")
    all_of = group.comm.allgather((_cadt.version, *arguments))
    for name, values in zip(names, zip(*all_of)):
        for rank, value in enumerate(values):
            if value != values[0]:
                said = "is there on one and not on the other" if name == "consumer" else f"{values[0]} and {value}"
                raise OptionError(f"ranks 0 and {rank} must have the same {name}: {said}", name)


def _share(group: Group, where: Where, tile_points: int) -> Where:
    """The cores and cards of each machine among its ranks."""
    from mpi4py import MPI

    local = group.comm.Split_type(MPI.COMM_TYPE_SHARED)
    number = local.rank
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set(range(os.cpu_count() or 1))
    together = sum(other == cores for other in local.allgather(cores))  # not where each is bound to its own
    local.Free()

    threads = where.threads or max(1, len(cores) // together)
    return group.together(lambda: share(replace(where, threads=threads), tile_points, number))
