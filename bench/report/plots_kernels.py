# SPDX-License-Identifier: Apache-2.0
"""Figures of the kernels: their times, their bandwidth beside that of a copy, and the roofline where a profiler counted
operations."""
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

import style
from plots_time import heading
from rows import Contestant, Machine, Row, per_device, ratio
from style import Page
from words import percent, significant

SHOWN = 11  # kernels; the others are one bar


def longest(rows: Sequence[Row]) -> tuple[list[Row], list[Row]]:
    """The kernels that take the most time, and the others."""
    known = [row for row in rows if (row.number("kernel_ms") or 0) > 0]
    known.sort(key=lambda row: -row.number("kernel_ms"))
    return (known, []) if len(known) <= SHOWN + 1 else (known[:SHOWN], known[SHOWN:])


def short_name(row: Row) -> str:
    return row.text("kernel").removeprefix("cadt_")


def moved(row: Row) -> float | None:
    """GB/s by the bytes that a profiler counted."""
    return ratio(row.number("dram_bytes"), 1e6 * (row.number("kernel_ms") or 0))


def counted(row: Row) -> bool:
    return min(row.number(column) or 0 for column in ("operations", "dram_bytes")) > 0


def groups(machines: Sequence[Machine]) -> list[tuple[Machine, Contestant, list[Row]]]:
    return [(machine, who, rows) for machine, who, rows in per_device(machines, "kernels") if longest(rows)[0]]


def kernels(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """A row a device and strategy: times on the left, bandwidths on the right."""
    shown = groups(machines)
    if not shown:
        return None
    bars = max(min(len(rows), SHOWN + 1) for _, _, rows in shown)
    page = Page("Kernels: time, and bandwidth of the bytes that they must move",
                [m for m in machines if m.rows("kernels")], len(shown), 2, 0.235 * bars + 1.0)
    for (left, right), (machine, who, rows) in zip(page.axes, shown):
        most, others = longest(rows)
        time_bars(left, most, others)
        bandwidth_bars(right, most, len(most) + bool(others))
        points = next((row.whole("points") for row in rows if row.whole("points")), 0)
        left.set_title(f"{heading(machine, who, machines)}, {points:,} points", loc="left")
    page.legend(style.patch("bytes that the kernel must move at least", color=style.COLOURS[0]),
                style.line("a copy on the same device", color="black", ls="--"))
    if any(moved(row) for _, _, rows in shown for row in rows):
        page.legend(style.line("bytes moved, by the profiler", color="black", marker="D", ls="",
                               markerfacecolor="white"))
    return page.finish()


def time_bars(axes: Axes, most: Sequence[Row], others: Sequence[Row]) -> None:
    names = [short_name(row) for row in most]
    times = [row.number("kernel_ms") for row in most]
    shares = [row.number("kernel_share") for row in most]
    if others:
        names.append(f"{len(others)} others")
        times.append(sum(row.number("kernel_ms") for row in others))
        shares.append(sum(row.number("kernel_share") or 0 for row in others))
    axes.barh(range(len(names)), times, 0.7, color=[style.COLOURS[1]] * len(most) + [style.GREY] * bool(others))
    for at, (time, share) in enumerate(zip(times, shares)):
        axes.annotate(f"{significant(time)} ms, {percent(share)}", (time, at), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=8)
    style.ticks(axes, range(len(names)), names, "y", fontsize=8.5)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlim(0, 1.3 * max(times, default=1))
    axes.grid(False, axis="y")
    axes.set_xlabel("time of all launches, ms")


def bandwidth_bars(axes: Axes, most: Sequence[Row], bars: int) -> None:
    copy = next((row.number("copy_gbs") for row in most if row.number("copy_gbs")), None)
    highest = copy or 0
    for at, row in enumerate(most):
        value, real = row.number("bandwidth_gbs"), moved(row)
        if value is None:
            axes.annotate("depends on the input", (real or 0, at), xytext=(7, 0), textcoords="offset points",
                          va="center", fontsize=8, color=style.GREY)
        else:
            axes.barh(at, value, 0.7, color=style.COLOURS[0])
            share = percent(ratio(value, copy)) if copy else ""
            axes.annotate(share, (max(value, real or 0), at), xytext=(7, 0), textcoords="offset points", va="center",
                          fontsize=8)
        if real is not None:
            axes.plot(real, at, "D", color="black", markerfacecolor="white", markersize=4.5)
        highest = max(highest, value or 0, real or 0)
    if copy:
        axes.axvline(copy, color="black", ls="--", lw=1.1)
        axes.annotate(f"copy: {significant(copy)} GB/s", (copy, -0.6), xytext=(-2, 2), textcoords="offset points",
                      ha="right", va="bottom", fontsize=8)
    style.ticks(axes, range(len(most)), [""] * len(most), "y")
    axes.set_ylim(bars - 0.4, -0.6)
    axes.set_xlim(0, 1.15 * (highest or 1))
    axes.grid(False, axis="y")
    axes.set_xlabel("bandwidth, GB/s (per cent of the copy)")


def roofline(machines: Sequence[Machine], paper: dict) -> Figure | None:
    """Operations a second against operations a byte, as the profiler counted both; the roof is the copy's bandwidth."""
    shown = [(machine, who, [row for row in longest(rows)[0] if counted(row)])
             for machine, who, rows in groups(machines)]
    shown = [one for one in shown if one[2]]
    if not shown:
        return None
    page = Page("Roofline: operations in floating point against bytes moved, by the profiler",
                [m for m in machines if any(m is one[0] for one in shown)], len(shown), 1, 3.4)
    for axes, (machine, who, rows) in zip(page.panels(len(shown)), shown):
        roof(axes, rows)
        axes.set_title(heading(machine, who, machines), loc="left")
    page.legend(style.line("a kernel: the larger, the more time it takes", color=style.GREY, marker="o", ls=""),
                style.line("roof: the bandwidth of a copy", color="black", ls="--"))
    return page.finish()


def roof(axes: Axes, rows: Sequence[Row]) -> None:
    """A circle a kernel, with its number in the list at the side."""
    xs = [row.number("operations") / row.number("dram_bytes") for row in rows]
    ys = [1e-6 * row.number("operations") / row.number("kernel_ms") for row in rows]
    handles = []
    for at, (x, y, row) in enumerate(zip(xs, ys, rows)):
        colour = style.COLOURS[at % len(style.COLOURS)]
        size = 5 + 14 * max(row.number("kernel_share") or 0, 0) ** 0.5
        axes.plot(x, y, "o", color=colour, markersize=size, alpha=0.75)
        axes.annotate(str(at + 1), (x, y), xytext=(6, 5), textcoords="offset points", fontsize=8)
        handles.append(style.line(f"{at + 1}  {short_name(row)}", color=colour, marker="o", ls=""))
    copy = next((row.number("copy_gbs") for row in rows if row.number("copy_gbs")), None)
    axes.set_xscale("log")
    if copy:
        ends = [min(xs) / 1.5, max(xs) * 1.5]
        axes.plot(ends, [copy * x for x in ends], color="black", ls="--", lw=1.1)
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: style.plain(value)))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("operations a byte")
    style.log_y(axes, "operations, 10⁹ a second")
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.03), borderaxespad=0, fontsize=8.5)
