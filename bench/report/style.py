# SPDX-License-Identifier: Apache-2.0
"""What all figures have in common: size, colours, legend, footer, files. No pyplot: figures do not share a state."""
import textwrap
from collections.abc import Sequence
from pathlib import Path

import matplotlib
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter

from rows import Machine, Row
from words import short, significant

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 11, "axes.titlesize": 11, "axes.labelsize": 11, "figure.titlesize": 13,
    "axes.grid": True, "grid.color": "#d9d9d9", "grid.linewidth": 0.7, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "legend.fontsize": 10,
    "lines.linewidth": 1.8, "lines.markersize": 5, "figure.facecolor": "white", "svg.hashsalt": "cadt",
    "text.parse_math": False})

# Okabe and Ito's palette, told apart by all; lines have the first ten, as their yellow is too light on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8c8c8c", "#7f4f24", "#5e3c99",
           "#000000", "#F0E442", "#004d40", "#c3b1e1")
GREY = "#777777"
OF_WHO = {"sequential": "#000000", "cgal": "#E69F00", "scipy": "#CC79A7", "cupy": "#56B4E9", "host": "#009E73",
          "opencl": "#0072B2", "cuda": "#D55E00"}
OF_MODE = {"off": "#000000", "defer": "#56B4E9", "paper": "#D55E00"}
MARKERS = "osD^vPX*<>"
WIDTH = 12.0  # inches; at 100 points an inch the 1200 of a page's width
DOTS = 150


def ramp(index: int, size: int) -> tuple[float, float, float, float]:
    """Colours of an ordered thing, e.g. sizes: from light to dark, without the lightest."""
    return matplotlib.colormaps["viridis"](0.88 - 0.85 * (index / (size - 1) if size > 1 else 1))


def footer(machine: Machine) -> str:
    """Where and when: machine, processor, devices with their drivers, date, commit."""
    info = machine.info
    drivers: dict[str, list[str]] = {}
    for device in machine.devices():
        of_name = drivers.setdefault(str(device.get("name", "?")), [])
        of_name.append(f"{device.get('backend', '?')} {device.get('driver', '?')}")
    devices = "; ".join(f"{name} ({', '.join(of_name)})" for name, of_name in drivers.items()) or "no usable device"
    commit = str(info.get("commit", ""))[:12] or "unknown"
    return (f"{machine.name}: {info.get('cpu', 'unknown processor')}, {info.get('cores', '?')} cores; {devices}; "
            f"{info.get('date', 'no date')}; cadt {info.get('cadt', '?')}, commit {commit}")


class Page:
    """A figure with panels, a legend below them that covers nothing, and a footer for each machine."""

    def __init__(self, title: str, machines: Sequence[Machine], rows: int, columns: int, height: float = 3.6, **more):
        lines = [line for m in machines for line in textwrap.wrap(footer(m), 180, subsequent_indent="    ")]
        self.footer, self.handles, self.title = lines, [], title
        self.rows, self.height = rows, height
        self.figure = Figure(figsize=(WIDTH, rows * height + 1), layout="constrained")
        FigureCanvasAgg(self.figure)
        self.axes = self.figure.subplots(rows, columns, squeeze=False, **more)

    def panels(self, used: int) -> list[Axes]:
        """The first `used` panels; the others are taken out."""
        flat = list(self.axes.flat)
        for unused in flat[used:]:
            unused.remove()
        return flat[:used]

    def legend(self, *handles: Artist) -> None:
        """Adds to the legend, each label once."""
        known = {h.get_label() for h in self.handles}
        for handle in handles:
            if handle.get_label() not in known:
                known.add(handle.get_label())
                self.handles.append(handle)

    def finish(self) -> Figure:
        """Makes room for legend and footer, which the layout of the panels knows nothing of, and puts them there."""
        widest = max((len(str(h.get_label())) for h in self.handles), default=1)
        columns = max(1, min(len(self.handles) or 1, int((WIDTH - 0.4) / (0.082 * widest + 0.62))))
        legend_rows = -(-len(self.handles) // columns)
        below = 0.16 * len(self.footer) + 0.12
        bottom = below + (0.205 * legend_rows + 0.1 if self.handles else 0)
        total = self.rows * self.height + bottom + 0.4
        self.figure.set_size_inches(WIDTH, total)
        self.figure.get_layout_engine().set(rect=(0, bottom / total, 1, 1 - bottom / total), w_pad=0.08, h_pad=0.06)
        self.figure.suptitle(self.title, x=0.01, ha="left", weight="bold")
        if self.handles:
            self.figure.legend(handles=self.handles, loc="lower center", bbox_to_anchor=(0.5, below / total),
                               ncol=columns, borderaxespad=0, columnspacing=1.6)
        self.figure.text(0.01, 0.06 / total, "\n".join(self.footer), fontsize=7.5, color="#444444", va="bottom",
                         linespacing=1.35)
        return self.figure


def save(figure: Figure, out: Path, name: str) -> list[str]:
    """NAME.png and NAME.svg, the same bytes for the same numbers."""
    dots = min(DOTS, 60000 / figure.get_figheight())  # Agg draws no picture of 2^16 rows or more
    figure.savefig(out / f"{name}.png", dpi=dots, metadata={"Software": None})
    figure.set_layout_engine("none")  # both alike, and laid out once
    figure.savefig(out / f"{name}.svg", metadata={"Date": None})
    return [f"{name}.png", f"{name}.svg"]


def line(label: str, **style) -> Line2D:
    return Line2D([], [], label=label, **style)


def patch(label: str, **style) -> Patch:
    return Patch(label=label, **style)


def spread_line(axes: Axes, x: Sequence[float], rows: Sequence[Row], scale=lambda row, ms: ms, **style) -> None:
    """Whole calls: median with a bar from the fastest to the slowest run. `scale` turns milliseconds into what is
    drawn."""
    points = [(at, [scale(row, row.number(c)) if row.number(c) is not None else None
                    for c in ("median_ms", "min_ms", "max_ms")]) for at, row in zip(x, rows)]
    points = [(at, v) for at, v in points if v[0] is not None and v[0] > 0]
    if not points:
        return
    middle = [v[0] for _, v in points]
    ends = [[v[0] if end is None else end for end in v[1:]] for _, v in points]
    # A throughput is high where the time is low; rounding may put an end on the wrong side by a digit.
    below = [max(0, m - min(e)) for m, e in zip(middle, ends)]
    above = [max(0, max(e) - m) for m, e in zip(middle, ends)]
    axes.errorbar([at for at, _ in points], middle, yerr=[below, above], capsize=3, elinewidth=1.1, **style)


def plain_line(axes: Axes, x: Sequence[float], values: Sequence[float | None], **style) -> None:
    known = [(at, value) for at, value in zip(x, values) if value is not None and value > 0]
    if known:
        axes.plot([at for at, _ in known], [value for _, value in known], **style)


def points_axis(axes: Axes, label: str = "points") -> None:
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(label)


def log_y(axes: Axes, label: str) -> None:
    """A logarithmic axis with plain numbers; between the powers of ten where there are few of them."""
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    if high < 30 * low:
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel(label)


def plain(value: float) -> str:
    if value >= 1 and value == round(value):
        return f"{value:,.0f}"
    return f"{value:.6g}" if value >= 1e-4 else significant(value, 1)


def ticks(axes: Axes, values: Sequence[float], labels: Sequence[str], which: str = "x", **more) -> None:
    axis = axes.xaxis if which == "x" else axes.yaxis
    axis.set_major_locator(FixedLocator(list(values)))
    axis.set_minor_locator(FixedLocator([]))
    axis.set_ticklabels(list(labels), **more)
