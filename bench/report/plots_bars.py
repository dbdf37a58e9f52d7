# SPDX-License-Identifier: Apache-2.0
"""Figures of bars: shares of the time, distributions, devices, what statistics cost."""
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import style
from plots_time import heading, styles
from rows import (DETAILS, Machine, Row, by_points, contestants, each, group, per_device, pick, rank, ratio,
                  reference_rows, sizes_of, synthetic, to_number)
from style import Page
from words import short, significant

COUNTERS = ("lock_attempts", "lock_failures", "invalid_restarts", "insert_retries", "stale_edges", "deferred_points",
            "deferred_edges", "flips", "walk_steps")


def breakdown(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """Shares of the threads' time above, with the paper's one number, and shares of the phases below."""
    bars = [(f"{heading(m, who, machines)}\n{row.text('distribution')}, {short(row.number('points'))} points", row)
            for m, who, rows in per_device(machines, "breakdown") for row in rows]
    threads = [(name, row.pairs("thread_time"), "") for name, row in bars if row.pairs("thread_time")]
    phases = [(name, row.pairs("phases"), f"{significant(sum(row.pairs('phases').values()))} ms")
              for name, row in bars if row.pairs("phases")]
    if not threads and not phases:
        return None
    reference = [("paper, uniform", dict(paper["breakdown"]["shares"]), "the text gives one number")]
    drawn = [("How the threads of the insertion spend their time", (threads + reference) if threads else []),
             ("Phases of a run with clocks in its kernels, and the sum of their times", phases)]
    drawn = [(title, rows) for title, rows in drawn if rows]
    page = Page("Where the time goes", [m for m in machines if m.rows("breakdown")], len(drawn), 1,
                0.55 * max(len(rows) for _, rows in drawn) + 1.7,
                gridspec_kw={"height_ratios": [len(rows) + 1.5 for _, rows in drawn]})
    for axes, (title, rows) in zip(page.axes.flat, drawn):
        stacked(axes, rows)
        axes.set_title(title, loc="left")
    return page.finish()


def stacked(axes: Axes, rows: list[tuple[str, dict[str, float], str]]) -> None:
    """Horizontal bars that add up to 1; what a bar leaves open is light grey."""
    names = list(dict.fromkeys(name for _, parts, _ in rows for name in parts))
    for at, (_, parts, note) in enumerate(rows):
        total = max(sum(parts.values()), 1e-300)
        total = total if total > 1.02 or note.endswith(" ms") else 1
        start = 0.0
        for name in names:
            share = parts.get(name, 0) / total
            index = names.index(name)
            colour = style.COLOURS[index % len(style.COLOURS)]
            axes.barh(at, share, left=start, color=colour, height=0.62, edgecolor="white", linewidth=0.8,
                      hatch="//" if index >= len(style.COLOURS) else None)
            if share >= 0.035:
                dark = sum(c * w for c, w in zip(to_rgb(colour), (0.3, 0.59, 0.11))) < 0.58
                axes.text(start + share / 2, at, f"{100 * share:.0f}", ha="center", va="center", fontsize=9,
                          color="white" if dark else "black")
            start += share
        if start < 0.98:
            axes.barh(at, 1 - start, left=start, color="#ececec", height=0.62)
        axes.text(1.005, at, note, va="center", fontsize=9)
    style.ticks(axes, range(len(rows)), [name for name, _, _ in rows], "y", fontsize=9)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.grid(False)
    axes.set_xlim(0, 1)
    axes.set_xlabel("share, %")
    style.ticks(axes, [k / 5 for k in range(6)], [str(20 * k) for k in range(6)])
    handles = [style.patch(name, color=style.COLOURS[i % len(style.COLOURS)]) for i, name in enumerate(names)]
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.12, 1.03), borderaxespad=0)


def distributions(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A panel a device: time a point over that of uniform points of the same number, a bar a size."""
    reference = paper["distributions"]["reference"]
    shown = [s for s in per_device(machines, "distributions") if len(synthetic(s[2], reference)) > 1]
    if not shown:
        return None
    all_sizes = sizes_of(row for _, _, rows in shown for row in rows
                         if row.whole("points") in reference_rows(rows, reference))
    columns = 2 if len(shown) > 1 else 1
    page = Page(f"Time a point relative to {reference} points", [m for m in machines if m.rows("distributions")],
                -(-len(shown) // columns), columns, 3.7)
    for axes, (machine, who, rows) in zip(page.panels(len(shown)), shown):
        distribution_bars(axes, rows, reference, all_sizes)
        axes.set_title(heading(machine, who, machines), loc="left")
        axes.set_ylabel(f"time a point, {reference} = 1")
    for index, size in enumerate(all_sizes):
        page.legend(style.patch(f"{size:,} points", color=style.ramp(index, len(all_sizes))))
    page.legend(style.line("bar: whole call, fastest to slowest run", color="#333333", marker="|", markersize=9, ls=""),
                style.line("on the device only", color="black", marker="D", ls="", markerfacecolor="white"))
    return page.finish()


def distribution_bars(axes: Axes, rows: list[Row], reference: str, all_sizes: list[int]) -> None:
    names = synthetic(rows, reference)
    base = reference_rows(rows, reference)
    own = [size for size in all_sizes if size in base]
    width = 0.82 / max(len(own), 3)  # with one size or two the bars are no wider than with three
    highest = 0.0
    for index, size in enumerate(own):
        colour = style.ramp(all_sizes.index(size), len(all_sizes))
        for at, name in enumerate(names):
            row = pick(rows, distribution=name, points=size)
            if row is None:
                continue
            values = [ratio(row.number(c), base[size].number("median_ms")) for c in ("median_ms", "min_ms", "max_ms")]
            x = at + (index - (len(own) - 1) / 2) * width
            highest = max([highest, *filter(None, values)])
            if None not in values:
                axes.bar(x, values[0], width * 0.92, color=colour,
                         yerr=[[max(0, values[0] - values[1])], [max(0, values[2] - values[0])]], ecolor="#333333",
                         error_kw={"elinewidth": 1, "capsize": 2})
            on_device = ratio(row.number("device_ms"), base[size].number("device_ms"))
            if on_device is not None:
                axes.plot(x, on_device, "D", color="black", markerfacecolor="white", markersize=4.5)
                highest = max(highest, on_device)
    axes.axhline(1, color="black", lw=1, ls=":")
    style.ticks(axes, range(len(names)), names)
    axes.grid(False, axis="x")
    if highest > 8:
        style.log_y(axes, "")


def statistics(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A row a device: what counting and timing cost, and what was counted a point, over the points."""
    shown = per_device(machines, "statistics", modes=False)
    if not shown:
        return None
    page = Page("What the statistics cost, and what they count", [m for m in machines if m.rows("statistics")],
                len(shown), 2, 3.3, gridspec_kw={"width_ratios": [1, 2]})
    for (left, right), (machine, who, rows) in zip(page.axes, shown):
        cost_bars(left, rows)
        left.set_title(heading(machine, who, machines), loc="left")
        rows = by_points(row for row in rows if row.text("detail") in ("counters", ""))
        for index, name in enumerate(COUNTERS):
            look = {"color": style.COLOURS[index % 10], "marker": style.MARKERS[index % 10]}
            values = [ratio(row.number(name), row.number("points")) or None for row in rows]
            if any(values):
                style.plain_line(right, [row.number("points") for row in rows], values, **look)
                page.legend(style.line(name.replace("_", " "), **look))
        style.points_axis(right)
        style.log_y(right, "events a point")
    page.legend(style.line("fastest to slowest run", color="#333333", marker="|", markersize=10, ls=""))
    return page.finish()


def cost_size(rows: Sequence[Row]) -> int | None:
    """The largest size that was measured without statistics, which the others are compared with."""
    return max(sizes_of(row for row in rows if row.text("detail") == "none"), default=None)


def cost_bars(axes: Axes, rows: Sequence[Row]) -> None:
    size = cost_size(rows)
    base = pick(rows, detail="none", points=size) if size else None
    drawn = sorted((r for r in rows if base and r.whole("points") == size),
                   key=lambda r: rank(r.text("detail"), DETAILS))
    for at, row in enumerate(drawn):
        values = [ratio(row.number(c), base.number("median_ms")) for c in ("median_ms", "min_ms", "max_ms")]
        if None in values:
            continue
        middle, low, high = (100 * (value - 1) for value in values)
        axes.bar(at, middle, 0.6, color=style.COLOURS[0], yerr=[[max(0, middle - low)], [max(0, high - middle)]],
                 ecolor="#333333", capsize=4)
    style.ticks(axes, range(len(drawn)), [row.text("detail") for row in drawn])
    axes.axhline(0, color="black", lw=0.8)
    axes.grid(False, axis="x")
    axes.set_ylabel("more time than none, %")
    axes.set_xlabel(f"statistics, {short(size)} points" if size else "not measured")


def devices(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A panel for each distribution and size, a bar a device of all machines."""
    rows = each(machines, lambda m: m.rows("devices"))
    cases = sorted((case for case in group(rows, "distribution", "points") if to_number(case[1]) is not None),
                   key=lambda case: to_number(case[1]))  # a row a size; the distributions stay in their order
    if not cases:
        return None
    everybody = [who for m in machines for who in contestants(m.rows("devices"))]
    machine_rows = {m.name: m.rows("devices") for m in machines}
    look = {who: one for m in machines for who, one in styles(m.rows("devices")).items()}
    columns = min(3, len({distribution for distribution, _ in cases}))
    page = Page("Every device, whole call and on the device", [m for m in machines if m.rows("devices")],
                -(-len(cases) // columns), columns, 0.42 * len(everybody) + 1.3, sharey=True)
    for axes, (distribution, points) in zip(page.panels(len(cases)), cases):
        for at, who in enumerate(everybody):
            chosen = [r for r in contestants(machine_rows[who.machine])[who]
                      if (r.text("distribution"), r.text("points")) == (distribution, points)]
            for row in chosen[:1]:
                device_bar(axes, at, row, look[who])
            if not chosen:  # the machines do not have the same sizes
                axes.annotate("not measured", (0, at), xytext=(5, 0), textcoords="offset points", va="center",
                              fontsize=8.5, color=style.GREY)
        axes.set_title(f"{distribution}, {short(to_number(points))} points")
        several = len({who.machine for who in everybody}) > 1
        style.ticks(axes, range(len(everybody)),
                    [f"{w.machine}: {w.name(22)}" if several else w.name(30) for w in everybody],
                    "y", fontsize=8.5)
        axes.set_xlabel("time, ms")
        axes.grid(False, axis="y")
    if page.axes.size:
        page.axes.flat[0].invert_yaxis()
    page.legend(style.patch("whole call, fastest to slowest run", color=style.GREY),
                style.line("on the device only", color="black", marker="D", ls="", markerfacecolor="white"))
    return page.finish()


def device_bar(axes: Axes, at: int, row: Row, look: dict) -> None:
    middle, low, high = (row.number(c) for c in ("median_ms", "min_ms", "max_ms"))
    if middle is None:
        return
    low, high = (middle if low is None else low), (middle if high is None else high)
    axes.barh(at, middle, 0.66, color=look["color"], xerr=[[max(0, middle - low)], [max(0, high - middle)]],
              ecolor="#333333", error_kw={"elinewidth": 1, "capsize": 2})
    if row.number("device_ms") is not None:
        axes.plot(row.number("device_ms"), at, "D", color="black", markerfacecolor="white", markersize=4.5)
    axes.annotate(significant(middle), (max(high, middle), at), xytext=(5, 0), textcoords="offset points", va="center",
                  fontsize=8.5)
    axes.margins(x=0.2)
