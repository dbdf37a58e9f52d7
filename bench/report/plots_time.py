# SPDX-License-Identifier: Apache-2.0
"""Figures of time: over points, block size and R. Each function gives a figure, or None where there is nothing to
draw."""
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import style
from rows import (CONTESTANTS, MODES, Contestant, Machine, Row, by_points, contestants, each, group, per_device, pick,
                  rank, sizes_of)
from style import Page
from words import short

def styles(rows: Sequence[Row]) -> dict[tuple[str, str, str], dict]:
    """Colour, marker and label of everybody: a colour for each program and back end, darker for its further devices."""
    seen: dict[str, int] = {}
    found = {}
    for who, device, variant in dict.fromkeys((c.who, c.device, c.variant) for c in contestants(list(rows))):
        index = seen[who] = seen.get(who, -1) + 1
        colour = to_rgb(style.OF_WHO.get(who, style.GREY))
        found[who, device, variant] = {
            "color": tuple(channel * 0.55 ** index for channel in colour),
            "marker": style.MARKERS[(rank(who, CONTESTANTS)[0] + 3 * index) % len(style.MARKERS)],
            "label": Contestant("", who, device, variant).name(34)}
    return found


def heading(machine: Machine, who: Contestant, machines: Sequence[Machine]) -> str:
    return f"{machine.name}: {who.name(38)}" if len(machines) > 1 else who.name(56)


def over_points(machines: Sequence[Machine], paper: dict, title: str, label: str, value) -> Figure | None:
    """One panel a machine; `value` turns a row and its milliseconds into what is drawn."""
    shown = [m for m in machines if m.rows("sizes")]
    if not shown:
        return None
    look = styles(each(shown, lambda m: m.rows("sizes")))
    columns = min(2, len(shown))
    page = Page(title, shown, -(-len(shown) // columns), columns, 5.6 if columns == 1 else 4.8, sharey=True)
    for axes, machine in zip(page.panels(len(shown)), shown):
        reference = [(r[0], r[3]) for r in paper["sizes"]["rows"]]
        rows = [Row("", {"points": str(n)}) for n, _ in reference]
        axes.plot([n for n, _ in reference], [value(row, ms) for row, (_, ms) in zip(rows, reference)], ":",
                  color=style.GREY, marker=".")
        for who, rows in contestants(machine.rows("sizes")).items():
            draw_contestant(axes, page, by_points(rows), look[who.who, who.device, who.variant], value)
        style.points_axis(axes, "points")
        style.log_y(axes, label)
        axes.set_title(machine.name)
    page.legend(style.line("solid: whole call, median, bar from fastest to slowest run", color=style.GREY),
                style.line("dashed: on the device only", color=style.GREY, ls="--"),
                style.line(f"paper: cuDT ({paper['machine']['gpu'].partition('(')[0].strip()})", color=style.GREY,
                           ls=":", marker="."))
    return page.finish()


def draw_contestant(axes: Axes, page: Page, rows: list[Row], look: dict, value) -> None:
    points = [row.number("points") for row in rows]
    plain = {k: v for k, v in look.items() if k != "label"}
    style.spread_line(axes, points, rows, value, **plain)
    on_device = [row.number("device_ms") for row in rows]
    style.plain_line(axes, points, [None if ms is None else value(row, ms) for row, ms in zip(rows, on_device)],
                     color=look["color"], marker=look["marker"], ls="--", markerfacecolor="white", lw=1.3)
    page.legend(style.line(**look))


def sizes(machines: Sequence[Machine], paper: dict) -> Figure | None:
    return over_points(machines, paper, "Time against points (uniform)", "time, ms", lambda row, ms: ms)


def throughput(machines: Sequence[Machine], paper: dict) -> Figure | None:
    return over_points(machines, paper, "Throughput against points (uniform)", "million points a second",
                       lambda row, ms: row.number("points") / ms / 1000)


def blocks(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A row a device: time on the left, theoretical occupancy on the right, a line a size."""
    shown = per_device(machines, "blocks")
    if not shown:
        return None
    page = Page("Block size: time and theoretical occupancy", [m for m in machines if m.rows("blocks")], len(shown), 2)
    sizes_drawn = sizes_of(each(machines, lambda m: m.rows("blocks")))
    for (left, right), (machine, who, rows) in zip(page.axes, shown):
        for index, size in enumerate(sizes_drawn):
            block_lines(left, right, [row for row in rows if row.whole("points") == size],
                        color=style.ramp(index, len(sizes_drawn)), marker=style.MARKERS[index % 10])
        if not right.lines:
            right.text(0.5, 0.5, "the device does not tell", transform=right.transAxes, ha="center", color=style.GREY)
        right.set_ylim(0, 1.08)
        right.set_ylabel("theoretical occupancy, 1 = all warps")
        style.log_y(left, "time, ms")
        for axes in (left, right):
            block_axis(axes, sizes_of(rows, "block"), paper["blocks"]["marks"])
        left.set_title(heading(machine, who, machines), loc="left", pad=18)
    for index, size in enumerate(sizes_drawn):
        page.legend(style.line(f"{size:,} points", color=style.ramp(index, len(sizes_drawn)),
                               marker=style.MARKERS[index % 10]))
    page.legend(style.line("whole call, fastest to slowest", color=style.GREY),
                style.line("on the device only", color=style.GREY, ls="--"))
    return page.finish()


def block_lines(left: Axes, right: Axes, rows: list[Row], **look) -> None:
    rows = sorted((row for row in rows if row.number("block")), key=lambda row: row.number("block"))
    at = [row.number("block") for row in rows]
    style.spread_line(left, at, rows, **look)
    style.plain_line(left, at, [row.number("device_ms") for row in rows], ls="--", markerfacecolor="white", lw=1.3, **look)
    style.plain_line(right, at, [row.number("occupancy") for row in rows], **look)


def block_axis(axes: Axes, sizes: list[int], marks: dict[str, str]) -> None:
    axes.set_xscale("log", base=2)
    style.ticks(axes, sizes, [str(size) for size in sizes])
    axes.set_xlabel("threads a block")
    for size, name in marks.items():
        if int(size) in sizes:
            axes.axvline(int(size), color="#E69F00", lw=6, alpha=0.25, zorder=0)
            axes.annotate(name, (int(size), 1), xycoords=("data", "axes fraction"), xytext=(0, 3),
                          textcoords="offset points", ha="center", fontsize=9, color="#8a5f00")


def thresholds(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """Two rows a device, on it and whole call, and a column a distribution: both scales at once would show neither."""
    shown = per_device(machines, "thresholds", modes=False)
    names = list(group(each(machines, lambda m: m.rows("thresholds")), "distribution", "points"))
    if not shown or not names:
        return None
    page = Page("Stabilised flipping: time against R", [m for m in machines if m.rows("thresholds")], 2 * len(shown),
                len(names), 2.9)
    for index, (machine, who, rows) in enumerate(shown):
        for column, (distribution, points) in enumerate(names):
            chosen = [r for r in rows if (r.text("distribution"), r.text("points")) == (distribution, points)]
            for whole in (False, True):
                axes = page.axes[2 * index + whole][column]
                threshold_panel(axes, page, chosen, whole)
                axes.set_title(f"{heading(machine, who, machines) if not column else ''}"
                               f"\n{distribution}, {short(float(points or 0))} points, "
                               f"{'whole call' if whole else 'on the device'}", loc="left")
    page.legend(style.line(f"R of the paper ({paper['thresholds']['threshold']})", color="#E69F00", lw=6, alpha=0.25))
    for axes in page.axes.flat:
        axes.axvline(paper["thresholds"]["threshold"], color="#E69F00", lw=6, alpha=0.25, zorder=0)
    return page.finish()


def threshold_panel(axes: Axes, page: Page, rows: list[Row], whole: bool) -> None:
    column = "median_ms" if whole else "device_ms"
    off = pick(rows, stabilize="off")
    if off is not None and off.number(column) is not None:
        axes.axhline(off.number(column), color=style.OF_MODE["off"], lw=1.3)
        page.legend(style.line("off", color=style.OF_MODE["off"], lw=1.3))
        if whole and off.number("min_ms") is not None and off.number("max_ms") is not None:
            axes.axhspan(off.number("min_ms"), off.number("max_ms"), color=style.OF_MODE["off"], alpha=0.1, lw=0)
            page.legend(style.patch("off, fastest to slowest run", color=style.OF_MODE["off"], alpha=0.1, lw=0))
    for index, mode in enumerate(MODES[1:]):
        chosen = sorted((r for r in rows if r.text("stabilize") == mode and r.number("threshold") is not None),
                        key=lambda row: row.number("threshold"))
        look = {"color": style.OF_MODE[mode], "marker": style.MARKERS[index]}
        at = [row.number("threshold") for row in chosen]
        if whole:
            style.spread_line(axes, [x + 0.08 * (2 * index - 1) for x in at], chosen, **look)
        else:
            style.plain_line(axes, at, [row.number(column) for row in chosen], **look)
        if chosen:
            page.legend(style.line(mode, **look))
    ends = sizes_of(rows, "threshold")
    style.ticks(axes, ends, [str(r) for r in ends])
    axes.set_xlabel("R, flips of an edge before it is stabilised")
    axes.set_ylabel("time, ms")
    axes.margins(y=0.15)
