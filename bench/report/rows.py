# SPDX-License-Identifier: Apache-2.0
"""Reads what cadt-bench wrote and groups its rows. Whatever is missing or broken is named, never raised: a report of
the rest is worth more than none. Standard library only."""
import csv
import io
import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

EXPERIMENTS = ("sizes", "blocks", "breakdown", "distributions", "snapshots", "flips", "thresholds", "works", "bunny",
               "statistics", "devices", "kernels")
CONTESTANTS = ("sequential", "cgal", "scipy", "cupy", "host", "opencl", "cuda")
CADT = ("host", "opencl", "cuda")
MODES = ("off", "defer", "paper")
DETAILS = ("none", "counters", "timing")
FLIP_BINS = 16  # Statistics::flips_per_edge: the last one counts all from 15 on


def to_number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


class Row:
    """One line of a CSV file. An empty cell, one that is no number and a column that is not there are None."""

    def __init__(self, machine: str, cells: dict[str, str]):
        self.machine, self.cells = machine, cells

    def text(self, column: str) -> str:
        return self.cells.get(column, "").strip()

    def number(self, column: str) -> float | None:
        return to_number(self.cells.get(column, ""))

    def whole(self, column: str) -> int | None:
        value = self.number(column)
        return None if value is None else round(value)

    def pairs(self, column: str) -> dict[str, float]:
        """"sort=0.6;insert=2" as a dictionary, in order."""
        found = {}
        for part in self.text(column).split(";"):
            name, _, value = part.partition("=")
            if (share := to_number(value)) is not None and share >= 0:
                found[name.strip()] = share
        return found

    def flips(self) -> list[int] | None:
        """Edges by their number of flips, or None if the row does not say."""
        counts = [self.whole(f"flips_{k}") for k in range(FLIP_BINS)]
        return None if None in counts or min(counts) < 0 or not sum(counts) else counts


@dataclass
class Table:
    rows: list[Row] = field(default_factory=list)
    columns: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)


@dataclass
class Machine:
    name: str
    folder: Path
    info: dict
    tables: dict[str, Table]
    problems: list[str]

    def rows(self, experiment: str) -> list[Row]:
        """The rows that have numbers."""
        return [row for row in self.tables[experiment].rows if not row.text("skipped")]

    def skipped(self, experiment: str) -> list[Row]:
        return [row for row in self.tables[experiment].rows if row.text("skipped")]

    def missing(self, experiment: str, columns: Iterable[str]) -> list[str]:
        """What a section about these columns has to say about this machine's file."""
        table = self.tables[experiment]
        lines = [f"{self.name}: {problem}" for problem in table.problems]
        absent = [column for column in columns if column not in table.columns]
        if table.columns and absent:
            lines.append(f"{self.name}: {experiment}.csv lacks the column{'s' * (len(absent) > 1)} {', '.join(absent)}")
        return lines

    def devices(self, usable: bool = True) -> list[dict]:
        return [d for d in self.listed("devices") if bool(d.get("usable")) == usable]

    def listed(self, what: str) -> list[dict]:
        found = self.info.get(what)
        return [entry for entry in found if isinstance(entry, dict)] if isinstance(found, list) else []


def read_table(machine: str, path: Path) -> Table:
    """Rows that are cut off are left out and named: half a row would pass for a whole one with other numbers."""
    table = Table()
    try:
        text = path.read_text(encoding="utf-8", errors="replace").replace("\0", "")
    except OSError as error:
        table.problems.append(f"{path.name} is missing ({error.strerror})")
        return table
    lines = list(csv.reader(io.StringIO(text)))
    table.columns = [name.strip() for name in lines[0]] if lines else []
    for number, cells in enumerate(lines[1:], 2):
        cut = number == len(lines) and not text.endswith("\n")
        if len(cells) != len(table.columns) or cut:
            if cells:
                why = "ends in the middle of" if cut else f"{len(cells)} of {len(table.columns)} fields in"
                table.problems.append(f"{path.name}: {why} row {number}, which is left out")
            continue
        table.rows.append(Row(machine, dict(zip(table.columns, cells))))
    if not table.rows:
        table.problems.append(f"{path.name} has no rows")
    return table


def read_machine(folder: Path) -> Machine:
    problems = []
    try:
        info = json.loads((folder / "machine.json").read_text(encoding="utf-8"))
        if not isinstance(info, dict):
            raise ValueError("no object")
    except OSError as error:
        info = {}
        problems.append(f"machine.json is missing ({error.strerror})")
    except ValueError as error:
        info = {}
        problems.append(f"machine.json cannot be read ({error})")
    name = str(info.get("name") or folder.resolve().name)
    return Machine(name, folder, info, {}, problems)


def read_machines(folders: Iterable[Path]) -> list[Machine]:
    machines = [read_machine(Path(folder)) for folder in folders]
    names = [machine.name for machine in machines]
    for machine in machines:
        if names.count(machine.name) > 1:  # two folders of one machine must stay two
            machine.name = f"{machine.name} ({machine.folder.resolve().name})"
        for experiment in EXPERIMENTS:
            machine.tables[experiment] = read_table(machine.name, machine.folder / f"{experiment}.csv")
    return machines


@dataclass(frozen=True)
class Contestant:
    """Who was measured: one line of a plot, one column of a table."""
    machine: str
    who: str
    device: str
    variant: str = ""

    def name(self, width: int = 0) -> str:
        """"cuda (NVIDIA H200)"; a device longer than `width` is cut."""
        device = self.device
        if width and len(device) > width:
            device = device[:width - 1].rstrip() + "…"
        inside = ", ".join(part for part in (device, self.variant) if part)
        return f"{self.who} ({inside})" if inside and self.who in CADT + ("cupy",) else self.who


def rank(name: str, order: tuple[str, ...]) -> tuple[int, str]:
    """Sort key: the known names in their order, then the others by name."""
    return (order.index(name) if name in order else len(order), name)


def contestants(rows: list[Row]) -> dict[Contestant, list[Row]]:
    """Rows by contestant. What tells two runs of one device apart (mode, detail, strategy) is part of its name if it varies."""
    varying = [c for c in ("stabilize", "detail", "strategy") if len({row.text(c) for row in rows if row.text("who") in CADT}) > 1]
    threads = {row.text("threads") for row in rows if row.text("who") == "host"}
    groups: dict[Contestant, list[Row]] = {}
    for row in rows:
        variant = ", ".join(row.text(c) for c in varying if row.text(c) and row.text("who") in CADT)
        if row.text("who") == "host" and len(threads) > 1:
            one = row.text("threads") == "1"
            variant = ", ".join(filter(None, [variant, f"{row.text('threads')} thread{'s' * (not one)}"]))
        key = Contestant(row.machine, row.text("who"), row.text("device"), variant)
        groups.setdefault(key, []).append(row)
    return dict(sorted(groups.items(), key=lambda item: (rank(item[0].who, CONTESTANTS), item[0].device,
                                                         item[0].variant)))


def group(rows: Iterable[Row], *columns: str) -> dict[tuple[str, ...], list[Row]]:
    """Rows by the text of these columns, in order of appearance."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row.text(column) for column in columns), []).append(row)
    return groups


def by_points(rows: Iterable[Row]) -> list[Row]:
    return sorted((row for row in rows if (row.number("points") or 0) > 0), key=lambda row: row.number("points"))


def sizes_of(rows: Iterable[Row], column: str = "points") -> list[int]:
    return sorted(size for size in {row.whole(column) for row in rows} if size and size > 0)


def pick(rows: Iterable[Row], **wanted: object) -> Row | None:
    """The first row whose cells have these values; numbers are compared as numbers."""
    for row in rows:
        if all((row.whole(c) if isinstance(v, int) else row.text(c)) == v for c, v in wanted.items()):
            return row
    return None


def like(points: float | None, wanted: float) -> bool:
    """About as many: some distributions are made in whole circles, and come out a little larger than asked for."""
    return points is not None and abs(points - wanted) <= 0.05 * wanted


def ratio(above: float | None, below: float | None) -> float | None:
    return None if above is None or not below else above / below


def per_point(row: Row, column: str) -> float | None:
    return ratio(row.number(column), row.number("points"))


def measured(row: Row) -> str:
    """Which time `device_or_whole` is."""
    return "whole call" if row.number("device_ms") is None else "on the device"


def device_or_whole(row: Row) -> float | None:
    """Milliseconds on the device where they are known, else those of the whole call."""
    value = row.number("device_ms")
    return row.number("median_ms") if value is None else value


def hash_groups(rows: Iterable[Row]) -> dict[tuple[str, str], dict[str, list[Row]]]:
    """For each distribution and size, the rows by hash. Stabilize::paper promises no hash."""
    found: dict[tuple[str, str], dict[str, list[Row]]] = {}
    for row in rows:
        if row.text("hash") and row.text("stabilize") != "paper":
            key = (row.text("distribution"), row.text("points"))
            found.setdefault(key, {}).setdefault(row.text("hash"), []).append(row)
    return found


def each(machines: Iterable[Machine], read: Callable[[Machine], list[Row]]) -> list[Row]:
    return [row for machine in machines for row in read(machine)]


def per_device(machines: Sequence[Machine], experiment: str, modes: bool = True) -> list[
        tuple[Machine, Contestant, list[Row]]]:
    """The devices of all machines that have rows of an experiment. With `modes`, what varies in how a device ran makes
    it several; else all of its rows stay together."""
    found = []
    for machine in machines:
        if modes:
            found += [(machine, who, rows) for who, rows in contestants(machine.rows(experiment)).items()]
            continue
        groups = group(machine.rows(experiment), "who", "device").items()
        found += [(machine, Contestant(machine.name, *key), rows)
                  for key, rows in sorted(groups, key=lambda item: (rank(item[0][0], CONTESTANTS), item[0][1]))]
    return found


def reference_rows(rows: Sequence[Row], reference: str) -> dict[int, Row]:
    return {row.whole("points"): row for row in rows if row.text("distribution") == reference
            and (row.whole("points") or 0) > 0}


def synthetic(rows: Sequence[Row], reference: str) -> list[str]:
    """Distributions that were measured at a size of the reference; the others are real sets of their own sizes."""
    known = reference_rows(rows, reference)
    return list(dict.fromkeys(r.text("distribution") for r in rows if r.whole("points") in known))
