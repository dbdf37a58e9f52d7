# SPDX-License-Identifier: Apache-2.0
"""Figures of time: over points, block size and R. Each function gives a figure, or None where there is nothing to
draw."""
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import style
from rows import (CONTESTANTS, MODES, Contestant, Machine, Row, by_points, contestants, each, group, per_device, pick,
                  rank, ratio, sizes_of, to_number)
from style import Page
from words import short

def styles(rows: list[Row]) -> dict[Contestant, dict]:
    """Colour, marker and label of everybody on one machine: a colour for each program and back end, darker for its
    second device, lighter for the third."""
    seen: dict[str, int] = {}
    found = {}
    for who in contestants(rows):
        index = seen[who.who] = seen.get(who.who, -1) + 1
        towards, share = ((0, 0), (0, 0.45), (1, 0.5), (0, 0.7), (1, 0.7))[min(index, 4)]
        found[who] = {"color": tuple(c + (towards - c) * share for c in to_rgb(style.OF_WHO.get(who.who, style.GREY))),
                      "marker": style.MARKERS[(rank(who.who, CONTESTANTS)[0] + 3 * index) % len(style.MARKERS)],
                      "label": who.name(34)}
    return found


def heading(machine: Machine, who: Contestant, machines: Sequence[Machine]) -> str:
    return f"{machine.name}: {who.name(38)}" if len(machines) > 1 else who.name(56)


def over_points(machines: Sequence[Machine], paper: dict, title: str, label: str, value) -> Figure | None:
    """One panel a machine; `value` turns a row and its milliseconds into what is drawn."""
    shown = [m for m in machines if m.rows("sizes")]
    if not shown:
        return None
    columns = min(2, len(shown))
    page = Page(title, shown, -(-len(shown) // columns), columns, 6.2 if columns == 1 else 5.8, sharey=True)
    for axes, machine in zip(page.panels(len(shown)), shown):
        reference = [(r[0], r[3]) for r in paper["sizes"]["rows"]]
        rows = [Row("", {"points": str(n)}) for n, _ in reference]
        axes.plot([n for n, _ in reference], [value(row, ms) for row, (_, ms) in zip(rows, reference)], ":",
                  color=style.GREY, marker=".")
        look = styles(machine.rows("sizes"))
        for who, rows in contestants(machine.rows("sizes")).items():
            draw_contestant(axes, by_points(rows), look[who], value)
        style.points_axis(axes)
        style.log_y(axes, label)
        axes.set_title(machine.name)
        # Whose devices they are differs from panel to panel, so each has a legend of its own, below it.
        axes.legend(handles=[style.line(**one) for one in look.values()], loc="upper center",
                    bbox_to_anchor=(0.5, -0.13), ncol=3 if columns == 1 else 2, borderaxespad=0)
    page.legend(style.line("solid: whole call, median, bar from fastest to slowest run", color=style.GREY),
                style.line("dashed: on the device only", color=style.GREY, ls="--"),
                style.line(f"paper: cuDT ({paper['machine']['gpu'].partition('(')[0].strip()})", color=style.GREY,
                           ls=":", marker="."))
    return page.finish()


def draw_contestant(axes: Axes, rows: list[Row], look: dict, value) -> None:
    points = [row.number("points") for row in rows]
    plain = {k: v for k, v in look.items() if k != "label"}
    style.spread_line(axes, points, rows, value, **plain)
    on_device = [row.number("device_ms") for row in rows]
    style.plain_line(axes, points, [None if ms is None else value(row, ms) for row, ms in zip(rows, on_device)],
                     color=look["color"], marker=look["marker"], ls="--", markerfacecolor="white", lw=1.3)


def sizes(machines: Sequence[Machine], paper: dict) -> Figure | None:
    return over_points(machines, paper, "Time against points (uniform)", "time, ms", lambda row, ms: ms)


def throughput(machines: Sequence[Machine], paper: dict) -> Figure | None:
    return over_points(machines, paper, "Throughput against points (uniform)", "million points a second",
                       lambda row, ms: ratio(row.number("points"), 1000 * ms))


def blocks(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A row a device: time, time over that of the fastest block, theoretical occupancy; a line a size."""
    shown = per_device(machines, "blocks")
    if not shown:
        return None
    page = Page("Block size: time and theoretical occupancy", [m for m in machines if m.rows("blocks")], len(shown), 3,
                3.5)
    sizes_drawn = sizes_of(each(machines, lambda m: m.rows("blocks")))
    for panels, (machine, who, rows) in zip(page.axes, shown):
        for index, size in enumerate(sizes_drawn):
            look = {"color": style.ramp(index, len(sizes_drawn)), "marker": style.MARKERS[index % 10]}
            block_lines(panels, [row for row in rows if row.whole("points") == size], look)
            page.legend(style.line(f"{size:,} points", **look))
        for axes, label in zip(panels, ("time, ms", "time over the fastest block's", "theoretical occupancy")):
            block_axis(axes, sizes_of(rows, "block"), paper["blocks"]["marks"])
            axes.set_ylabel(label)
        style.log_y(panels[0], "time, ms")
        panels[2].set_ylim(0, 1.05)
        if not panels[2].has_data() or not any(row.number("occupancy") is not None for row in rows):
            panels[2].clear()
            panels[2].set_axis_off()
            panels[2].text(0.5, 0.5, "theoretical occupancy:\nthe device does not tell", transform=panels[2].transAxes,
                           ha="center", va="center", color=style.GREY)
        panels[0].set_title(heading(machine, who, machines), loc="left", pad=18)
    page.legend(style.line("whole call, fastest to slowest run", color=style.GREY),
                style.line("on the device only", color=style.GREY, ls="--"))
    return page.finish()


def block_lines(panels: Sequence[Axes], rows: list[Row], look: dict) -> None:
    rows = sorted((row for row in rows if (row.number("block") or 0) > 0), key=lambda row: row.number("block"))
    at = [row.number("block") for row in rows]
    for column, more in (("median_ms", {}), ("device_ms", {"ls": "--", "markerfacecolor": "white", "lw": 1.3})):
        values = [row.number(column) for row in rows]
        fastest = min(filter(None, values), default=None)
        if column == "device_ms":
            style.plain_line(panels[0], at, values, **look, **more)
        else:
            style.spread_line(panels[0], at, rows, **look)
        style.plain_line(panels[1], at, [ratio(value, fastest) for value in values], **look, **more)
    style.plain_line(panels[2], at, [row.number("occupancy") for row in rows], **look)


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
    """A row a device; for each distribution a panel on the device and one of whole calls, as one scale for both would
    show neither."""
    # Each device has panels for what it was measured with only: the machines do not have the same sizes.
    shown = [(machine, who, rows, [(*case, whole) for case in group(rows, "distribution", "points")
                                   for whole in (False, True)])
             for machine, who, rows in per_device(machines, "thresholds", modes=False)]
    if not shown:
        return None
    columns = min(4, max(len(cases) for *_, cases in shown))
    deep = [-(-len(cases) // columns) for *_, cases in shown]
    page = Page("Stabilised flipping: time against R", [m for m in machines if m.rows("thresholds")], sum(deep),
                columns, 3.0)
    for index, (machine, who, rows, cases) in enumerate(shown):
        panels = list(page.axes[sum(deep[:index]):sum(deep[:index + 1])].flat)
        for axes, (distribution, points, whole) in zip(panels, cases):
            chosen = [r for r in rows if (r.text("distribution"), r.text("points")) == (distribution, points)]
            threshold_panel(axes, page, chosen, whole)
            axes.axvline(paper["thresholds"]["threshold"], color="#E69F00", lw=6, alpha=0.25, zorder=0)
            axes.set_title(f"{distribution}, {short(to_number(points))} points\n"
                           f"{'whole call' if whole else 'on the device'}", fontsize=10)
        for unused in panels[len(cases):]:
            unused.remove()
        # The layout makes room for a letter that is not seen: the name itself is wider than a panel and would widen it.
        for text, more in ((heading(machine, who, machines), {"in_layout": False}), ("X", {"alpha": 0})):
            panels[0].annotate(text, (0, 1), xycoords="axes fraction", xytext=(-30, 36), textcoords="offset points",
                               weight="bold", fontsize=10, **more)
    page.legend(style.line(f"R of the paper ({paper['thresholds']['threshold']})", color="#E69F00", lw=6, alpha=0.25))
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
    axes.set_xlabel("R, flips of an edge")
    axes.set_ylabel("time, ms")
    axes.margins(y=0.15)
