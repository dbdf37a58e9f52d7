# SPDX-License-Identifier: Apache-2.0
"""cadt.ConstrainedDelaunay: its arrays against each other, what it is asked, and what is refused."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cadt
import numpy as np
import pytest

SQUARES = [[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]]
CROSS = [[0, 0], [2, 2], [0, 2], [2, 0]]


def random_mesh(seed: int = 3, n: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """Points, and segments that do not cross: paths along a few rows of a shaken lattice."""
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2))
    order = np.argsort(xy[:, 0])
    low, high = order[xy[order, 1] < 0.5], order[xy[order, 1] >= 0.5]
    return xy, np.concatenate([np.stack([part[:-1:1], part[1:]], axis=1) for part in (low, high)])


def test_arrays_fit_together() -> None:
    xy, segments = random_mesh()
    mesh = cadt.ConstrainedDelaunay(xy, segments, domain="layers")
    assert mesh.verify()
    assert mesh.n_points == 200 and np.shares_memory(mesh.points, xy)
    edges = {tuple(e) for e in np.sort(segments, axis=1).tolist()}
    assert {tuple(e) for e in mesh.constrained_edges.tolist()} == edges
    flagged = set()
    for k in range(3):
        of = mesh.simplices[(mesh.edge_flags >> k & 1).astype(bool)]
        flagged |= {tuple(sorted((t[(k + 1) % 3], t[(k + 2) % 3]))) for t in of.tolist()}
    assert flagged == edges
    indptr, chain = mesh.chains
    assert np.array_equal(chain.reshape(-1, 2), segments) and np.array_equal(indptr, 2 * np.arange(len(segments) + 1))
    begin, sources = mesh.edge_sources
    for e, (a, b) in enumerate(mesh.constrained_edges.tolist()):
        for s in sources[begin[e] : begin[e + 1]].tolist():
            assert segments[s].tolist() == [a, b] if s >= 0 else segments[-1 - s].tolist() == [b, a]
    assert mesh.region.max() == mesh.n_regions - 1
    assert len(mesh.region_value) == len(mesh.region_attribute) == mesh.n_regions
    assert len(mesh.degenerate_segments) == 0
    # the same mesh in another order and direction, and pickled
    other = cadt.ConstrainedDelaunay(xy, segments[::-1, ::-1], domain="layers")
    assert other.hash == mesh.hash == pickle.loads(pickle.dumps(mesh)).hash
    assert mesh.hash != cadt.Delaunay(xy).hash
    for name in ("simplices", "edge_flags", "constrained_edges", "inside", "region"):
        with pytest.raises(ValueError):
            getattr(mesh, name)[0] = 0


def test_without_segments_it_is_delaunay() -> None:
    xy, _ = random_mesh()
    mesh, plain = cadt.ConstrainedDelaunay(xy), cadt.Delaunay(xy)
    assert np.array_equal(mesh.simplices, plain.simplices) and mesh.inside.all()
    assert mesh.nearest_vertex(xy[:5]).tolist() == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("domain,inside", [("hull", 10), ("outer", 10), ("even_odd", 8), ("nonzero", 10), ("layers", 8)])
def test_domains(domain: str, inside: int) -> None:
    mesh = cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8], domain=domain)
    assert np.count_nonzero(mesh.inside) == inside == len(mesh.triangles_inside)
    assert np.array_equal(mesh.simplices[mesh.inside], mesh.triangles_inside)
    x, y = mesh.points[mesh.triangles_inside].transpose(2, 1, 0)
    area = ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])).sum() / 2
    assert area == (8 if inside == 8 else 9)
    assert mesh.verify()


def test_holes_and_regions() -> None:
    mesh = cadt.ConstrainedDelaunay(
        SQUARES, rings=[0, 4, 8], domain="seeds", holes=[[1.5, 1.5]], regions=[[0.1, 0.1, 5.0]]
    )
    assert len(mesh.triangles_inside) == 8
    assert mesh.region_attribute[mesh.region[mesh.inside]].tolist() == [5.0] * 8
    for how in ({"holes": [[1, 1]]}, {"regions": [[1, 1, 1]]}):
        with pytest.raises(cadt.OptionError):
            cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8], **how)


def test_lines_and_rings_with_vertices() -> None:
    given = cadt.ConstrainedDelaunay(
        SQUARES, [[0, 4]], polylines=([0, 3], [1, 5, 6]), rings=(np.array([0, 4]), [4, 5, 6, 7])
    )
    assert given.segments.tolist() == [[0, 4], [1, 5], [5, 6], [4, 5], [5, 6], [6, 7], [7, 4]]
    assert given.verify()
    for wrong in ([0, 9], [0, 3, 2], (([0, 2], [1.5, 2])), [[0, 4]]):
        with pytest.raises(cadt.InputError):
            cadt.ConstrainedDelaunay(SQUARES, polylines=wrong)
    closed = cadt.ConstrainedDelaunay([*SQUARES[:4], SQUARES[0]], rings=[0, 5])
    assert closed.degenerate_segments.tolist() == [4]
    assert np.diff(closed.chains[0]).tolist() == [2, 2, 2, 2, 0]


def test_crossings() -> None:
    segments = [[0, 1], [2, 3], [0, 2]]
    assert cadt.find_crossings(CROSS, segments).tolist() == [[0, 1]]
    assert cadt.find_crossings(CROSS, polylines=[0, 2, 4]).tolist() == [[0, 1]]
    bow_tie = [[0, 0], [2, 2], [2, 0], [0, 2]]
    assert cadt.find_crossings(bow_tie, [[0, 3]], rings=[0, 4]).tolist() == [[1, 3]]
    with pytest.raises(cadt.CrossingError) as caught:
        cadt.ConstrainedDelaunay(CROSS, segments)
    error = pickle.loads(pickle.dumps(caught.value))
    assert error.pairs.tolist() == [[0, 1]] and isinstance(error, ValueError) and "0 and 1" in str(error)
    assert 'crossing="exact"' in str(error) and "::" not in str(error)
    exact = cadt.ConstrainedDelaunay(CROSS, segments, crossing="exact")
    assert exact.points.tolist() == [*CROSS, [1, 1]] and exact.added_parents.tolist() == [[0, 1]]
    assert exact.rounded_valid
    snapped = cadt.ConstrainedDelaunay([[0.2, 0], [2, 2], [0, 2], [2, 0]], segments, crossing=("grid", 1.0))
    assert snapped.points.tolist() == [*CROSS, [1, 1]]
    again = pickle.loads(pickle.dumps(snapped))
    assert again.hash == snapped.hash and np.array_equal(again.points, snapped.points)
    for wrong in ("grid", ("grid", 0), "round", ("exact", 1), 3):
        with pytest.raises(cadt.OptionError):
            cadt.ConstrainedDelaunay(CROSS, segments, crossing=wrong)


def test_level_segments_stay_level_at_crossings() -> None:
    ends = np.random.default_rng(1).random((300, 2))
    mesh = cadt.ConstrainedDelaunay(ends, np.arange(300).reshape(-1, 2), crossing="exact")
    assert len(mesh.added_points) > 2000
    assert (mesh.at_crossings(np.full(300, 5.1)) == 5.1).all()


def test_values_at_crossings() -> None:
    """A segment that others cross twice, with a given point on it in between."""
    xy = [[0, 0], [8, 0], [4, 0], [2, -1], [2, 1], [6, -1], [6, 1], [9, 9]]
    segments = [[7, 7], [0, 1], [3, 4], [5, 6]]
    mesh = cadt.ConstrainedDelaunay(xy, segments, crossing="exact")
    assert mesh.added_points.tolist() == [[2, 0], [6, 0]]
    z = np.array([0, 0, 4, 9, 9, 9, 9, 9.0])
    assert mesh.at_crossings(z)[8:].tolist() == [2, 2]
    assert mesh.at_crossings(np.stack([z, 2 * z], axis=1))[8:].tolist() == [[2, 4], [2, 4]]
    assert mesh.interpolate(z, [[2, 0], [3, 0], [6, 0]]).tolist() == [2, 3, 2]
    own = np.concatenate([z, [7, 7]])
    assert mesh.interpolate(own, [[2, 0]]).tolist() == [7]
    assert mesh.rasterize(z, bounds=(1.5, -0.5, 2.5, 0.5), shape=(1, 1)).item() == 2
    for wrong in (z[:-1], np.zeros(9)):
        with pytest.raises(cadt.InputError, match="8 rows, one a point that was given, or 10, with those of added_points"):
            mesh.interpolate(wrong, [[2, 0]])


def test_questions() -> None:
    xy, segments = [[0, 0], [4, 0], [2, 0.5], [2, -0.5]], [[0, 1]]
    mesh = cadt.ConstrainedDelaunay(xy, segments)
    assert mesh.find_simplex([[2, 0.1], [2, -0.1], [9, 9]]).tolist() == [0, 1, -1]
    assert mesh.interpolate([0, 0, 1, -1], [2, 0.25]) == 0.5
    assert mesh.interpolate([0, 0, 1, 1], [2, 0]) == 0  # along the segment, not across
    assert cadt.Delaunay(xy).interpolate([0, 0, 1, 1], [2, 0]) == 1
    assert mesh.circumcenters().shape == (2, 2)
    for question in (
        lambda: mesh.nearest_vertex([0, 0]),
        lambda: mesh.interpolate([0, 0, 1, -1], [2, 0], "natural"),
        lambda: mesh.interpolate([0, 0, 1, -1], [2, 0], outside="nearest"),
        mesh.voronoi,
        mesh.largest_empty_circles,
    ):
        with pytest.raises(cadt.NotDelaunay) as caught:
            question()
        t, k = divmod(pickle.loads(pickle.dumps(caught.value)).edge, 3)
        assert mesh.edge_flags[t] >> k & 1


def test_bad_input() -> None:
    for segments in ([[0, 8]], [[0, 1], [0, -1]], [[0, 1], [2**40, 1]]):
        with pytest.raises(cadt.InputError) as caught:
            cadt.ConstrainedDelaunay(SQUARES, segments)
        assert caught.value.index == len(segments) - 1
    for wrong in ([[0.0, 1.0]], [0, 1], [[0, 1, 2]]):
        with pytest.raises(cadt.InputError):
            cadt.ConstrainedDelaunay(SQUARES, wrong)
    with pytest.raises(cadt.InputError) as caught:
        cadt.ConstrainedDelaunay([[0, 0], [np.nan, 1], [1, 0]], [[0, 1]])
    assert caught.value.index == 1
    with pytest.raises(cadt.OptionError):
        cadt.ConstrainedDelaunay(SQUARES, domain="inside")
    with pytest.raises(cadt.DomainError) as open_end:
        cadt.ConstrainedDelaunay(SQUARES, [[0, 4]], domain="even_odd")
    assert pickle.loads(pickle.dumps(open_end.value)).vertex in (0, 4)
    assert 'domain="layers"' in str(open_end.value) and "::" not in str(open_end.value)
    with pytest.raises(cadt.InputError):
        cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8], domain="seeds", holes=[1, 1])


def test_no_lines() -> None:
    plain = cadt.ConstrainedDelaunay(SQUARES)
    for none in ([], np.empty(0, dtype=int), [0]):
        mesh = cadt.ConstrainedDelaunay(SQUARES, [], polylines=none, rings=none)
        assert len(mesh.segments) == 0 and mesh.hash == plain.hash
    assert cadt.ConstrainedDelaunay(SQUARES, rings=[0, 1, 1, 4]).segments.tolist() == [[1, 2], [2, 3], [3, 1]]


@pytest.mark.parametrize(
    "given,says",
    [
        ({"rings": [[0, 4], [0, 1, 2, 3]]}, r"rings must be offsets, .* or a tuple \(offsets, vertices\): "),
        ({"rings": [[0, 4], [0, 1]]}, r"rings must be offsets, .* or a tuple .*, not int64 of \(2, 2\)"),
        ({"polylines": ([[0, 4]], [0, 1, 2, 3])}, r"polylines must be offsets, .* not int64 of \(1, 2\)"),
        ({"polylines": ([[0], [1, 2]], [0, 1])}, r"polylines must be offsets, .* or a tuple"),
        ({"polylines": [0, 3, 2]}, "polylines: offset 2 is 2, below the one before: they must not descend"),
        ({"rings": [-1, 3]}, "rings: offset 0 is -1: it must not be below 0"),
        ({"rings": ([0, 5], [0, 1, 2])}, "rings: offset 1 is 5, more than 3, the number of vertices"),
        ({"polylines": ([0, 2], [0, [1]])}, "the vertices of polylines must be integers of one dimension: "),
        ({"segments": [[0, 1], [2]]}, r"segments must be integers of shape \(m, 2\): "),
        ({"holes": [["a", 1]]}, r"holes must be numbers of shape \(k, 2\), not <U21 of \(1, 2\)"),
        ({"holes": [[1, 1], [1]]}, r"holes must be numbers of shape \(k, 2\): "),
        ({"holes": [[1j, 1]]}, "holes must be numbers of shape .*, not complex128"),
        ({"holes": [[10**400, 1]]}, "holes must be numbers of shape .*, not object"),
        ({"regions": [[1, 1]]}, r"regions must be numbers of shape \(k, 3\), not int64 of \(1, 2\)"),
        ({"regions": [[1, 1, {}]]}, "regions must be numbers of shape .*, not object"),
    ],
)
def test_what_is_no_array_of_numbers(given: dict, says: str) -> None:
    with pytest.raises(cadt.InputError, match=says):
        cadt.ConstrainedDelaunay(SQUARES, domain="seeds", **given)


LARGE = pytest.param(10**400, id="large")


@pytest.mark.parametrize("width", ["a", None, [1], 1j, np.array([1.0, 2.0]), LARGE, np.nan, np.inf, -1])
def test_widths_that_are_no_numbers(width: Any) -> None:
    with pytest.raises(cadt.OptionError, match="the width of the grid must be a number above 0, not ") as caught:
        cadt.ConstrainedDelaunay(SQUARES, crossing=("grid", width))
    assert caught.value.option == "grid"


@pytest.mark.parametrize("option", ["crossing", "domain"])
@pytest.mark.parametrize("given", [np.array([1, 2]), np.array(["hull", "exact"]), np.array("exact"), (np.arange(2), 1)])
def test_options_that_are_no_strings(option: str, given: Any) -> None:
    with pytest.raises(cadt.OptionError, match=f"{option} must be .*, not ") as caught:
        cadt.ConstrainedDelaunay(SQUARES, **{option: given})
    assert caught.value.option == option


def test_messages_name_arguments_of_python() -> None:
    for name, places in (("holes", [[1, 1], [np.nan, 1]]), ("regions", [[1, 1, 1], [1, np.inf, 1]])):
        with pytest.raises(cadt.OptionError, match=f"^{name}: place 1 is not finite") as caught:
            cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8], domain="seeds", **{name: places})
        assert caught.value.option == name
        assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    with pytest.raises(cadt.OptionError, match="^grid: "):
        cadt.ConstrainedDelaunay(SQUARES, crossing=("grid", 1e-300))


def test_degenerate() -> None:
    none = cadt.ConstrainedDelaunay(np.empty((0, 2)))
    assert none.n_triangles == 0 and none.hash and none.n_regions == 0 and len(none.chains[1]) == 0
    line = cadt.ConstrainedDelaunay([[0, 0], [2, 2], [1, 1]], [[0, 1]])
    assert line.chains[1].tolist() == [0, 2, 1] and line.constrained_edges.tolist() == [[0, 2], [1, 2]]
    assert line.find_simplex([1, 1]) == -1 and line.verify()


def test_progress_and_backends() -> None:
    xy, segments = random_mesh(5, 3000)
    host = cadt.ConstrainedDelaunay(xy, segments, backend="host", threads=2)
    assert host.device == "host" and host.statistics["points"] == 3000
    for info in cadt.devices():
        if info.usable and info.backend != "host":
            other = cadt.ConstrainedDelaunay(xy, segments, backend=info.backend, device=info.index)
            assert other.hash == host.hash and other.device != "host"
    with pytest.raises(cadt.BackendUnavailable):
        cadt.ConstrainedDelaunay(xy, segments, backend="opencl", device="no such device")


@pytest.mark.parametrize("scale", [5e-324, 1e-310, 1e-170, 1.0, 1e170, 1e300, 8e307])
@pytest.mark.parametrize("crossing", ["exact", "grid"])
def test_values_at_crossings_of_any_size(scale: float, crossing: str) -> None:
    """Neither squares nor differences overflow or vanish, also beside points of another size."""
    xy = np.array([[-1.0, -1], [1, 1], [-1, 1], [1, -1]]) * scale
    if (crossing, scale) == ("grid", 8e307):
        pytest.skip("the next place of such a grid is no double")
    how = ("grid", scale) if crossing == "grid" else "exact"
    for points in (xy, xy - xy[0], np.concatenate([xy, [[0, 2 * scale]]])):
        mesh = cadt.ConstrainedDelaunay(points, [[0, 1], [2, 3]], crossing=how)
        assert mesh.at_crossings([0, 10, 7, 7, 9][: len(points)])[-1] == 5
    if crossing == "exact":
        mesh = cadt.ConstrainedDelaunay(np.concatenate([xy, [[1, 5]]]), [[0, 1], [2, 3]], crossing=how)
        assert mesh.at_crossings([0, 10, 7, 7, 9])[-1] == 5


@pytest.mark.parametrize("lines", ["polylines", "rings"])
def test_vertices_that_are_no_points(lines: str) -> None:
    """2**32 + 2 is not 2."""
    for wrong in (2**32 + 2, 2**31, -1, -(2**32)):
        with pytest.raises(cadt.InputError, match=f"vertex 1 of {lines} is no point: {wrong}") as caught:
            cadt.ConstrainedDelaunay(SQUARES, **{lines: ([0, 2], [0, wrong])})
        assert caught.value.index == 1


def test_masked_segments() -> None:
    pairs, line = [[0, 1], [1, 2]], [0, 2]
    given: list[tuple[str, list, Callable[[Any], Any]]] = [
        ("segments", pairs, lambda a: a),
        ("polylines", line, lambda a: a),
        ("rings", line, lambda a: a),
        ("rings", line, lambda a: ([0, 2], a)),
    ]
    for name, numbers, of in given:
        one = np.ma.array(numbers, mask=np.arange(np.size(numbers)).reshape(np.shape(numbers)) == 1)
        with pytest.raises(cadt.InputError, match=f"{name} are masked"):
            cadt.ConstrainedDelaunay(SQUARES, **{name: of(one)})
        none = cadt.ConstrainedDelaunay(SQUARES, **{name: of(np.ma.array(numbers))})
        assert np.array_equal(none.segments, cadt.ConstrainedDelaunay(SQUARES, **{name: of(numbers)}).segments)
    with pytest.raises(cadt.InputError, match="segments are masked"):
        cadt.find_crossings(SQUARES, np.ma.array(pairs, mask=True))
    for name in ("holes", "regions"):
        with pytest.raises(cadt.InputError, match=f"{name} are masked"):
            cadt.ConstrainedDelaunay(SQUARES, domain="seeds", **{name: np.ma.array([[1.5, 1.5, 1]], mask=True)})


def test_copies_do_not_see_what_the_caller_changes() -> None:
    holes, regions, crossing = np.array([[1.5, 1.5]]), [[0.5, 0.5, 7.0]], ["grid", 0.5]
    how: dict[str, Any] = {"rings": [0, 4, 8], "domain": "seeds", "holes": holes, "regions": regions, "crossing": crossing}
    mesh = cadt.ConstrainedDelaunay(SQUARES, **how)
    holes[:], crossing[1] = 0.5, 3.0
    regions.append([float("nan"), 0.0, 0.0])
    for again in (copy.copy(mesh), pickle.loads(pickle.dumps(mesh))):
        assert again.hash == mesh.hash and again.inside.sum() == mesh.inside.sum() == 8
        assert np.array_equal(again.points, mesh.points) and set(again.region_attribute) == {0, 7}


@pytest.mark.parametrize("kind", ["Int64", "UInt8", "int64[pyarrow]", "Float64"])
def test_segments_in_columns_that_can_have_gaps(kind: str) -> None:
    pandas = pytest.importorskip("pandas")
    if "pyarrow" in kind:
        pytest.importorskip("pyarrow")
    table = pandas.DataFrame([[0, 1], [1, 2]], columns=["from", "to"]).astype(kind)
    if kind != "Float64":
        assert cadt.ConstrainedDelaunay(SQUARES, table).segments.tolist() == [[0, 1], [1, 2]]
        table.iloc[1, 1] = pandas.NA
        with pytest.raises(cadt.InputError, match=r"segments: row 1 has a missing value \(NA\)"):
            cadt.ConstrainedDelaunay(SQUARES, table)
    else:
        with pytest.raises(cadt.InputError, match="segments must be integers"):
            cadt.ConstrainedDelaunay(SQUARES, table)


def test_plot(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    import matplotlib.pyplot as plt

    mesh = cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8], domain="even_odd")
    ax = mesh.plot(plt.figure().add_subplot())
    segments = [c for c in ax.collections if hasattr(c, "get_segments")]
    assert sum(len(c.get_segments()) for c in segments) == 8
    mask = mesh.to_matplotlib().mask
    assert mask.tolist() == (~mesh.inside).tolist()
    assert cadt.ConstrainedDelaunay(SQUARES, rings=[0, 4, 8]).to_matplotlib().mask is None
