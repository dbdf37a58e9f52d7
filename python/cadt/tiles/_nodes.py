# SPDX-License-Identifier: Apache-2.0
"""Leaves and joins of a tree of tiles."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cadt import _cadt, _devices
from cadt._errors import InputError
from cadt._points import as_points, contiguous
from cadt._progress import reporter
from cadt.tiles import _module as _module

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

Open = _cadt.Open
Sums = _cadt.NodeSums

PLANE = (-np.inf, -np.inf, np.inf, np.inf)
OUTSIDE: int = _cadt.outside_hull
PENDING: int = _cadt.pending_triangle
LOCAL_BITS: int = _cadt.local_bits


class Part:
    """The final triangles of a node. Arrays may be written to where a pickle has made them, and `links` always.

    Triangles of the whole mesh have ids: ``node << 40 | row``, the node that made the triangle final and its row there.

    Attributes
    ----------
    node : int
    points : (n, 2) float64
        Of the node: of the leaf, or the open vertices of the children by ascending id.
    ids : (n,) uint64
        Their input indices, ascending.
    triangles : (t, 3) int32
        Rows of `points`, counterclockwise. Each begins with its lowest one, and they ascend.
    neighbors : (t, 3) int32
        What is opposite each vertex: a row of `triangles`, -1 outside of the hull, or -2 - k: what ``links[k]`` says.
    links : (k,) uint64
        Ids of triangles of other nodes; `OUTSIDE` of the hull, or `PENDING`: a later node will tell (`apply_links`).
    duplicates : (d, 2) uint64
        Of a leaf: input indices of points and of the lowest one that they equal, which is the vertex; by point.
    sums : Sums
        Counts, certificate and hash, to be added up over all nodes.
    statistics : dict
        Of the triangulation, as of `Delaunay`.
    """

    def __init__(self, node: _cadt.TileNode) -> None:
        self.node: int = node.node
        self.points: np.ndarray = _cadt.node_points(node)
        self.ids: np.ndarray = _cadt.node_ids(node)
        self.triangles: np.ndarray = _cadt.node_triangles(node)
        self.neighbors: np.ndarray = _cadt.node_neighbors(node)
        self.links: np.ndarray = node.links
        self.duplicates: np.ndarray = node.duplicates
        self.sums: _cadt.NodeSums = node.sums
        self.statistics: dict[str, Any] = node.statistics

    @functools.cached_property
    def vertices(self) -> np.ndarray:
        """(t, 3) uint64: the triangles by input indices."""
        return self.ids[self.triangles]

    def apply_links(self, links: Any) -> None:
        """Completes `links` with all rows that joins return for this node: those with ``links[:, 0] >> 40 == node``.

        Raises
        ------
        InternalError
            A row is told twice or never.
        """
        _cadt.apply_links(self.node, contiguous(np.asarray(links), np.uint64).reshape(-1, 3), self.links)

    def __repr__(self) -> str:
        return f"<cadt.tiles.Part: node {self.node}, {len(self.ids):,} points, {len(self.triangles):,} triangles>"


def finish_leaf(
    xy: Any,
    ids: Any = None,
    box: Any = PLANE,
    node: int = 0,
    *,
    backend: str | None = None,
    device: int | str | None = None,
    threads: int | None = None,
    max_memory: int | None = None,
    progress: bool | Callable[[str, float], object] | None = None,
) -> tuple[Part, Open]:
    """Triangulates the points of a tile alone.

    Parameters
    ----------
    xy : array_like, shape (n, 2)
        All points of the input that lie in the box; points of equal coordinates are in one tile.
    ids : array_like of int, shape (n,), optional
        Their input indices, ascending; default 0, 1, ...
    box : (min_x, min_y, max_x, max_y)
        The tile: ``min_x <= x < max_x``, ``min_y <= y < max_y``. Infinite sides have nothing beyond. Default: the plane.
    node : int
        Number of the node in the tree, below 2**24.

    Returns
    -------
    part : Part
        The final triangles, which no point outside of the box can change.
    open : Open
        For the parent. Empty if the box is the plane.

    Raises
    ------
    InputError
        NaN or infinity (`index` is the input index), ids that do not ascend, a point outside of the box.
    BackendUnavailable
        Also for a device without double precision.

    Notes
    -----
    The other parameters are those of `Delaunay`. The result is the same on every device. Costs about a tenth more than
    the triangulation. The GIL is released; calls of several threads on one device take turns.

    Examples
    --------
    >>> part, above = cadt.tiles.finish_leaf([[0, 0], [1, 0], [0, 1], [1, 1]])
    >>> part.triangles, len(above)
    (array([[0, 1, 2],
           [1, 3, 2]], dtype=int32), 0)
    """
    made = Where(backend, device, threads, max_memory).leaf(xy, ids, box, node, progress)
    return Part(made), made.open


def finish_join(
    opens: Sequence[Open],
    box: Any = PLANE,
    node: int = 0,
    *,
    backend: str | None = None,
    device: int | str | None = None,
    threads: int | None = None,
    max_memory: int | None = None,
    progress: bool | Callable[[str, float], object] | None = None,
) -> tuple[Part, Open, np.ndarray]:
    """Triangulates what is open in the children of a node.

    Parameters
    ----------
    opens : sequence of Open
        Of the children, any number in any order.
    box : (min_x, min_y, max_x, max_y)
        The union of their boxes. Default: the plane, where everything becomes final.
    node : int
        Number of the node in the tree, below 2**24.

    Returns
    -------
    part : Part
        The final triangles that no child had.
    open : Open
        For the parent. Empty if the box is the plane.
    links : (k, 3) uint64
        For nodes below: triangle id, row of the links of its node (``triangle >> 40``), and the id of what lies
        across (`Part.apply_links`).

    Raises
    ------
    LimitError
        More than 536,870,910 open vertices, as of points on one circle.
    InternalError
        The children contradict each other.

    Notes
    -----
    The other parameters, and what else is raised, are as for `finish_leaf`. O(m log m) for m open vertices.

    Examples
    --------
    >>> left, right = [[0, 0], [0, 3], [1, 1]], [[5, 0], [5, 3]]
    >>> a, open_a = cadt.tiles.finish_leaf(left, [0, 1, 2], (-np.inf, -np.inf, 3, np.inf), 0)
    >>> b, open_b = cadt.tiles.finish_leaf(right, [3, 4], (3, -np.inf, np.inf, np.inf), 1)
    >>> part, above, links = cadt.tiles.finish_join([open_a, open_b], node=2)
    >>> part.vertices.tolist()
    [[0, 2, 1], [0, 3, 2], [1, 2, 4], [2, 3, 4]]
    """
    made = Where(backend, device, threads, max_memory).join(opens, box, node, progress)
    return Part(made), made.open, made.messages


def check_complete(sums: Sums) -> None:
    """The certificate of the whole mesh, from the sums over all nodes.

    It has ``2 * distinct - 2 - hull`` triangles, and the circle of each of its edges was examined once.

    Raises
    ------
    InternalError
        The sums are not what they must be: a node is missing, or was added twice.
    """
    _cadt.require_complete(sums)


def mesh_hash(sums: Sums) -> str:
    """`Delaunay.hash` of the mesh of all points in one call, from the sums over all nodes."""
    return _cadt.mesh_hash(sums)


def apply_links(links: dict[int, np.ndarray], told: np.ndarray) -> None:
    """Completes the links of nodes from all rows for them."""
    nodes = (told[:, 0] >> np.uint64(LOCAL_BITS)).astype(np.int64)
    order = np.argsort(nodes, kind="stable")
    told, nodes = told[order], nodes[order]
    for node, of_node in links.items():
        begin, end = np.searchsorted(nodes, [node, node + 1])
        _cadt.apply_links(node, told[begin:end], of_node)


def as_box(box: Any) -> list[float]:
    sides = [float(v) for v in box]
    if len(sides) != 4 or not (sides[0] < sides[2] and sides[1] < sides[3]):
        raise InputError(f"a box is (min_x, min_y, max_x, max_y), each minimum below its maximum, not {box!r}", 0)
    return sides


def as_node(node: int) -> int:
    if not 0 <= node < 1 << (64 - LOCAL_BITS):
        raise InputError(f"nodes have numbers from 0 to 2**24 - 1, not {node}", 0)
    return int(node)


def as_ids(ids: Any, n: int) -> np.ndarray:
    a = np.asarray(ids)
    if a.size == 0 and n == 0:
        return np.empty(0, np.uint64)
    if a.ndim != 1 or a.dtype.kind not in "iu" or len(a) != n:
        raise InputError(f"ids must be integers of shape ({n},), not {a.dtype} of {a.shape}", 0)
    if a.dtype.kind == "i" and a.min() < 0:
        raise InputError("ids must not be negative", int(np.argmin(a)))
    return contiguous(a, np.uint64)


@dataclass(frozen=True)
class Where:
    """The device that makes nodes, as for `Delaunay`; its triangulator stays open."""

    backend: str | None = None
    device: int | str | None = None
    threads: int | None = None
    max_memory: int | None = None

    def leaf(self, xy: Any, ids: Any, box: Any, node: int, progress: Any = None) -> _cadt.TileNode:
        points = contiguous(as_points(xy), np.float64)
        numbers = np.arange(len(points), dtype=np.uint64) if ids is None else as_ids(ids, len(points))
        options, triangulator = self._open(len(points))
        with reporter(progress) as report:
            return _cadt.finish_leaf(triangulator, points, numbers, as_box(box), as_node(node), options, report)

    def join(self, opens: Iterable[Open], box: Any, node: int, progress: Any = None) -> _cadt.TileNode:
        children = list(opens)
        for child in children:
            if not isinstance(child, Open):
                raise TypeError(f"opens must be what finish_leaf and finish_join return, not {type(child).__name__}")
        options, triangulator = self._open(sum(len(c) for c in children))
        with reporter(progress) as report:
            return _cadt.finish_join(triangulator, children, as_box(box), as_node(node), options, report)

    def check(self) -> None:
        """Raises OptionError or TypeError for what no device can be."""
        self._options()

    def _options(self) -> _cadt.Options:
        return _devices.make_options(
            self.backend, self.device, "canonical", self.threads, self.max_memory, "counters"
        )

    def _open(self, n: int) -> tuple[_cadt.Options, _cadt.Triangulator]:
        """The same choice as Delaunay's: without a name, the host for what is small."""
        options = _devices.placed(self._options(), n)
        return options, _devices.open_device(options, (options.backend, self.device, self.threads, None))


def share(where: Where, tile_points: int, number: int) -> Where:
    """The card of one of several processes of a machine, `number` of them before it; the host where there is none that
    would be worth it."""
    backend, device = where.backend, where.device
    cards: list[int] = []
    if device is None and backend != "host" and (backend is not None or tile_points >= _devices.SMALL):
        wanted = backend or "cuda"
        cards = [d.index for d in _known_devices() if d.backend == wanted and d.usable]
    if cards:
        backend, device = backend or "cuda", cards[number % len(cards)]
    return replace(where, backend=backend or "host", device=device)


@functools.cache
def _known_devices() -> list[_devices.DeviceInfo]:
    return _devices.devices()
