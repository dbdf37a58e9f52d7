#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes one report of what cadt-bench wrote on one or several machines: OUT/report.md with tables, and each figure as
PNG and SVG. All numbers come from the CSV files; the paper's own are in paper.json, each with its place."""
import argparse
import json
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

try:
    import matplotlib  # noqa: F401
except ImportError as error:
    print(f"report: error: matplotlib cannot be loaded ({error}); on Debian and Ubuntu: apt-get install "
          "python3-matplotlib, and run this with /usr/bin/python3", file=sys.stderr)
    sys.exit(2)

import meshes  # noqa: E402
import plots_bars  # noqa: E402
import plots_kernels  # noqa: E402
import plots_mesh  # noqa: E402
import plots_time  # noqa: E402
import style  # noqa: E402
import tables  # noqa: E402
import tables_kernels  # noqa: E402
import tables_time  # noqa: E402
import tables_work  # noqa: E402
from rows import EXPERIMENTS, Machine, read_machines  # noqa: E402
from words import bullets  # noqa: E402

TIMES = ("who", "device", "points", "median_ms", "min_ms", "max_ms")


@dataclass
class Report:
    machines: list[Machine]
    paper: dict
    out: Path
    files: list[str]
    failed: list[str]

    def show(self, name: str, text: str, figure) -> list[str]:
        """The lines that embed a figure, which is written; none if there is nothing to draw."""
        if figure is None:
            return []
        files = style.save(figure, self.out, name)
        self.files += files
        return [f"![{text}]({files[0]})", "", f"[as SVG]({files[1]})", ""]


@dataclass(frozen=True)
class Section:
    experiment: str
    title: str
    columns: tuple[str, ...]
    body: Callable[[Report], list[str]]


def drawn(name: str, text: str, figure: Callable, lines: Callable) -> Callable[[Report], list[str]]:
    """A section of one figure and its tables."""
    def body(report: Report) -> list[str]:
        return report.show(name, text, figure(report.machines, report.paper)) + lines(report.machines, report.paper)
    return body


def sizes(report: Report) -> list[str]:
    lines = report.show("sizes", "Time against points", plots_time.sizes(report.machines, report.paper))
    lines += report.show("throughput", "Points a second against points",
                         plots_time.throughput(report.machines, report.paper))
    return lines + tables_time.sizes(report.machines, report.paper)


def file_name(prefix: str, report: Report, machine: Machine) -> str:
    """A figure a machine; with one machine its name is not needed."""
    number = report.machines.index(machine) + 1
    return prefix if len(report.machines) == 1 else f"{prefix}-{number}"


def snapshots(report: Report) -> list[str]:
    lines = []
    for machine in report.machines:
        found = meshes.read_snapshots(machine)
        lines += bullets(f"{machine.name}: {problem}" for problem in found.problems)
        lines += report.show(file_name("snapshots", report, machine), f"The growing mesh, {machine.name}",
                             plots_mesh.snapshots(machine, found))
        lines += tables_work.snapshots(machine, found, report.paper)
    return lines


def bunny(report: Report) -> list[str]:
    lines, sets = [], {}
    for machine in report.machines:
        problems: list[str] = []
        sets[machine.name] = meshes.read_bunnies(machine, problems)
        lines += bullets(f"{machine.name}: {problem}" for problem in problems)
        lines += report.show(file_name("bunny", report, machine), f"The bunny, {machine.name}",
                             plots_mesh.bunny(machine, sets[machine.name]))
    return lines + tables_work.bunny(report.machines, sets, report.paper)


def kernels(report: Report) -> list[str]:
    lines = report.show("kernels", "Time and bandwidth of the kernels",
                        plots_kernels.kernels(report.machines, report.paper))
    lines += report.show("roofline", "Roofline of the kernels", plots_kernels.roofline(report.machines, report.paper))
    return lines + tables_kernels.kernels(report.machines, report.paper)


def works(report: Report) -> list[str]:
    return tables_time.works(report.machines, report.paper)


STABILIZED = ("stabilize", "threshold", "flips", "stabilized_edges", "illegal_edges", "triangles",
              "differing_triangles")
SECTIONS = (
    Section("sizes", "Time against points (Table 3)", (*TIMES, "device_ms", "hash"), sizes),
    Section("blocks", "Block size and occupancy (Fig. 4 and 5)", (*TIMES, "device_ms", "block", "occupancy"),
            drawn("blocks", "Time and occupancy against block size", plots_time.blocks, tables_time.blocks)),
    Section("breakdown", "Where the time goes (Fig. 6)",
            ("who", "device", "points", "distribution", "phases", "thread_time"),
            drawn("breakdown", "Shares of the time", plots_bars.breakdown, tables_work.breakdown)),
    Section("distributions", "Distributions and real sets (Fig. 7)", (*TIMES, "device_ms", "distribution"),
            drawn("distributions", "Time a point by distribution", plots_bars.distributions,
                  tables_time.distributions)),
    Section("snapshots", "The mesh while it grows (Fig. 8)", ("block", "points", "triangles"), snapshots),
    Section("flips", "Flips an edge (Fig. 9 and 10)",
            ("who", "device", "distribution", "points", *STABILIZED, "flips_0", "flips_15"),
            drawn("flips", "Edges by their flips", plots_mesh.flips, tables_work.flips)),
    Section("thresholds", "Time against R (Fig. 11)", (*TIMES, "device_ms", "distribution", *STABILIZED),
            drawn("thresholds", "Time against R", plots_time.thresholds, tables_time.thresholds)),
    Section("works", "Other works (Table 4)", (*TIMES, "device_ms", "distribution"), works),
    Section("bunny", "The Stanford bunny (Fig. 12)",
            ("distribution", "points", "stabilize", "triangles", "differing_triangles"), bunny),
    Section("statistics", "What the statistics cost and count", (*TIMES, "detail", *tables_work.COUNTED),
            drawn("statistics", "Cost of the statistics", plots_bars.statistics, tables_work.statistics)),
    Section("devices", "Every device",
            (*TIMES, "device_ms", "distribution", "hash", "lock_attempts", "lock_failures", "certified"),
            drawn("devices", "Every device", plots_bars.devices, tables_work.devices)),
    Section("kernels", "The kernels of a run",
            ("who", "device", "points", "device_ms", "strategy", "kernel", "kernel_launches", "kernel_ms",
             "kernel_share", "kernel_bytes", "bandwidth_gbs", "copy_gbs", "issue_active", "dram_throughput",
             "dram_bytes", "operations", "profiler"), kernels),
)
assert tuple(section.experiment for section in SECTIONS) == EXPERIMENTS


def section_lines(report: Report, section: Section) -> list[str]:
    missing = [line for m in report.machines for line in m.missing(section.experiment, section.columns)]
    try:
        body = section.body(report)
    except Exception as error:  # a fault in one section must not cost the others; the exit code tells
        traceback.print_exc()
        report.failed.append(section.experiment)
        body = [f"**This section could not be made: {type(error).__name__}: {error}**", ""]
    if not any(m.rows(section.experiment) for m in report.machines):
        body += ["Nothing was measured.", ""]
    return [f"## {section.title}", "", *bullets(f"**{line}**" for line in missing), *body,
            *tables.left_out(report.machines, section.experiment)]


def write(report: Report, title: str) -> None:
    machine = report.paper["machine"]
    lines = [f"# {title}", "", f"Repeats the evaluation of \"{report.paper['title']}\", whose numbers were measured on "
             f"{machine['gpu']} and {machine['cpu']}.", "",
             *tables.head(report.machines), *tables.method(report.machines, EXPERIMENTS)]
    for section in SECTIONS:
        lines += section_lines(report, section)
    report.out.joinpath("report.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
    report.files.insert(0, "report.md")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", metavar="DIR", nargs="+", type=Path,
                        help="what cadt-bench wrote, a folder a machine")
    parser.add_argument("--out", required=True, type=Path, help="folder of the report; made if it is not there")
    parser.add_argument("--title", default="cadt: evaluation")
    arguments = parser.parse_args()
    absent = [str(folder) for folder in arguments.folders if not folder.is_dir()]
    if absent:
        parser.error(f"no such folder: {', '.join(absent)}")
    try:
        arguments.out.mkdir(parents=True, exist_ok=True)
        paper = json.loads((HERE / "paper.json").read_text(encoding="utf-8"))
        report = Report(read_machines(arguments.folders), paper, arguments.out, [], [])
        write(report, arguments.title)
    except OSError as error:
        print(f"report: error: {error}", file=sys.stderr)
        return 1
    print(f"{arguments.out}: {', '.join(report.files)}")
    if report.failed:
        print(f"report: error: could not be made: {', '.join(report.failed)}", file=sys.stderr)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
