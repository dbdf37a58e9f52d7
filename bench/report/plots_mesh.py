# SPDX-License-Identifier: Apache-2.0
"""Figures of meshes and of flips: the growing mesh, the bunny, flips an edge."""
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import style
from meshes import Bunny, Snapshots, chosen_steps
from rows import CADT, FLIP_BINS, MODES, Contestant, Machine, Row, each, group, pick, rank, to_number
from style import Page
from words import percent, short


def polygons(axes: Axes, points: Sequence, triangles: Sequence, **look) -> None:
    axes.add_collection(PolyCollection([[points[v] for v in t] for t in triangles], **look))


def edges(axes: Axes, points: Sequence, triangles: Sequence, **look) -> None:
    """Each edge once and all in one line with gaps: as polygons a large mesh makes an SVG of many megabytes."""
    pairs = sorted({(min(pair), max(pair)) for a, b, c in triangles for pair in ((a, b), (b, c), (c, a))})
    gap = (float("nan"), float("nan"))
    axes.plot(*zip(*(at for a, b in pairs for at in (points[a], points[b], gap))), **look)


def bare(axes: Axes, points: Sequence) -> None:
    """Axes for a mesh: as wide as high, no ticks, a little room around the points."""
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    room = 0.02 * max(max(xs) - min(xs), max(ys) - min(ys), 1e-300)
    axes.set_xlim(min(xs) - room, max(xs) + room)
    axes.set_ylim(min(ys) - room, max(ys) + room)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def snapshots(machine: Machine, found: Snapshots) -> Figure | None:
    """Four steps of the growing mesh; how many points each has is in the rows of the experiment."""
    steps = chosen_steps(list(found.steps))
    if not steps:
        return None
    page = Page(f"The mesh while it grows: {len(found.points):,} points, {machine.name}", [machine], 2, 2, 5.6)
    for letter, axes, step in zip("abcd", page.panels(len(steps)), steps):
        triangles = found.steps[step]
        row = pick(machine.rows("snapshots"), block=step)
        inserted = f"{row.whole('points'):,} points, " if row is not None and row.whole("points") is not None else ""
        polygons(axes, found.points, triangles, facecolor="#cfe3f1", edgecolor="#0072B2", linewidth=0.35)
        axes.plot(*zip(*found.points), ".", color="black", markersize=0.9)
        bare(axes, found.points)
        axes.set_title(f"({letter}) step {step}: {inserted}{len(triangles):,} live triangles")
    return page.finish()


def bunny(machine: Machine, sets: Sequence[Bunny]) -> Figure | None:
    if not sets:
        return None
    columns = min(3, len(sets))
    page = Page(f"The bunny, exact and stabilised as in the paper: {machine.name}", [machine], -(-len(sets) // columns),
                columns, 4.6)
    for axes, one in zip(page.panels(len(sets)), sets):
        differing = one.differing()
        points = one.exact.points
        # Denser meshes need thinner lines, or they are a grey area.
        width = max(0.15, min(0.7, 16 / len(points) ** 0.5))
        edges(axes, points, one.exact.triangles, color="#9a9a9a", linewidth=width)
        polygons(axes, points, differing, facecolor="#D55E00", edgecolor="#D55E00", linewidth=1.2, zorder=3)
        bare(axes, points)
        share = percent(len(differing) / len(one.paper.triangles), 2)
        axes.set_title(f"{one.name}: {len(points):,} points\n{len(differing):,} of {len(one.paper.triangles):,} "
                       f"triangles differ ({share})")
    page.legend(style.line("exact mesh", color="#9a9a9a", linewidth=0.7),
                style.patch("triangles of the paper's mode that the exact mesh does not have", color="#D55E00"))
    return page.finish()


def flips(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A row a device, a column a set: edges by their flips, the modes side by side."""
    rows = [row for row in each(machines, lambda m: m.rows("flips")) if row.flips()]
    cases = list(group(rows, "distribution", "points"))
    shown = sorted(group(rows, "who", "device"), key=lambda key: (rank(key[0], CADT), key[1]))
    shown = [(m, who, device) for m in machines for who, device in shown
             if any(r.machine == m.name and (r.text("who"), r.text("device")) == (who, device) for r in rows)]
    if not shown:
        return None
    page = Page("Flips an edge", [m for m in machines if m.rows("flips")], len(shown), len(cases), 3.7, sharey="row")
    for line, (machine, who, device) in zip(page.axes, shown):
        for axes, (distribution, points) in zip(line, cases):
            chosen = [r for r in rows if r.machine == machine.name
                      and (r.text("who"), r.text("device")) == (who, device)
                      and (r.text("distribution"), r.text("points")) == (distribution, points)]
            histogram(axes, page, chosen)
            name = Contestant(machine.name, who, device).name(44)
            heading = f"{machine.name}: {name}" if len(machines) > 1 else name
            axes.set_title(f"{heading if axes is line[0] else ''}\n{distribution}, {short(to_number(points))} points",
                           loc="left")
        line[0].set_ylabel("edges")
        line[0].set_ylim(bottom=0.6)  # at last: earlier it would end the row's own choice of the upper end
    page.handles.sort(key=lambda handle: "R:" in handle.get_label())
    return page.finish()


def histogram(axes: Axes, page: Page, rows: Sequence[Row]) -> None:
    modes = [mode for mode in MODES if pick(rows, stabilize=mode) is not None]
    for index, mode in enumerate(modes):
        row = pick(rows, stabilize=mode)
        at = [k + 0.28 * (index - (len(modes) - 1) / 2) for k in range(FLIP_BINS)]
        axes.bar(at, row.flips(), 0.26, color=style.OF_MODE[mode])
        page.legend(style.patch(mode, color=style.OF_MODE[mode]))
        if row.whole("threshold") is not None and mode != "off":
            axes.axvline(row.whole("threshold") + 0.5, color=style.GREY, ls="--", lw=1.1)
            page.legend(style.line("R: flips above it are counted by Eq. 9", color=style.GREY, ls="--", lw=1.1))
    style.log_y(axes, "")
    axes.tick_params(labelleft=True)
    style.ticks(axes, range(FLIP_BINS), [*map(str, range(FLIP_BINS - 1)), f"{FLIP_BINS - 1}+"],
                fontsize=9.5)
    axes.grid(False, axis="x")
    axes.set_xlabel("flips of the edge")
