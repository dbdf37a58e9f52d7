# SPDX-License-Identifier: Apache-2.0
"""Points and triangles that cadt-bench wrote for the pictures. Standard library only."""
import re
from dataclasses import dataclass, field
from pathlib import Path

from rows import Machine

Point = tuple[float, float]
Triangle = tuple[int, int, int]
MODES = ("exact", "paper")


@dataclass
class Mesh:
    points: list[Point]
    triangles: list[Triangle]


@dataclass
class Snapshots:
    points: list[Point] = field(default_factory=list)
    steps: dict[int, list[Triangle]] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)


@dataclass
class Bunny:
    """One set: the exact mesh and that of the paper's stabilised flipping."""
    name: str
    exact: Mesh
    paper: Mesh

    def differing(self) -> list[Triangle]:
        """Triangles of the paper's mode that the exact mesh does not have."""
        known = {tuple(sorted(t)) for t in self.exact.triangles}
        return [t for t in self.paper.triangles if tuple(sorted(t)) not in known]


def read_numbers(path: Path, columns: int, problems: list[str]) -> list[list[float]]:
    """Lines of numbers, by commas or blanks. A heading is passed over; a line cut off is named and left out."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        problems.append(f"{path.parent.name}/{path.name} is missing ({error.strerror})")
        return []
    found = []
    for number, line in enumerate(lines, 1):
        try:
            values = [float(part) for part in re.split(r"[,\s]+", line.strip()) if part]
        except ValueError:
            values = []
            if number == 1 or line.startswith("#"):
                continue
        if len(values) == columns:
            found.append(values)
        elif line.strip():
            problems.append(f"{path.parent.name}/{path.name}: line {number} has no {columns} numbers and is left out")
    return found


def read_points(path: Path, problems: list[str]) -> list[Point]:
    return [(x, y) for x, y in read_numbers(path, 2, problems)]


def read_triangles(path: Path, points: int, problems: list[str]) -> list[Triangle]:
    all_of_them = [tuple(int(v) for v in line) for line in read_numbers(path, 3, problems)]
    inside = [t for t in all_of_them if all(0 <= v < points for v in t)]
    if len(inside) < len(all_of_them):
        problems.append(f"{path.parent.name}/{path.name}: {len(all_of_them) - len(inside)} triangles of points that "
                        "are not there are left out")
    return inside


def read_snapshots(machine: Machine) -> Snapshots:
    folder = machine.folder / "snapshots"
    found = Snapshots()
    found.points = read_points(folder / "points.csv", found.problems)
    for path in folder.glob("step-*.csv"):
        name = path.stem.removeprefix("step-")
        if name.isdigit():
            found.steps[int(name)] = read_triangles(path, len(found.points), found.problems)
    found.steps = {k: found.steps[k] for k in sorted(found.steps) if found.steps[k]}
    if not found.steps:
        found.problems.append("snapshots/step-<k>.csv: none is there")
    return found


def chosen_steps(steps: list[int], panels: int = 4) -> list[int]:
    """As many steps as there are panels, at equal distances, the last one with them."""
    return sorted({steps[max(0, round(len(steps) * (k + 1) / panels) - 1)] for k in range(panels)}) if steps else []


def read_bunnies(machine: Machine, problems: list[str]) -> list[Bunny]:
    """All sets of the folder, the smallest first."""
    folder = machine.folder / "bunny"
    found = []
    for path in folder.glob("*.xy"):
        points = read_points(path, problems)
        meshes = [Mesh(points, read_triangles(folder / f"{path.stem}-{mode}.tri", len(points), problems))
                  for mode in MODES]
        if all(mesh.triangles for mesh in meshes):
            found.append(Bunny(path.stem, *meshes))
    if not found:
        problems.append("bunny/<set>.xy, <set>-exact.tri, <set>-paper.tri: no complete set is there")
    return sorted(found, key=lambda b: (len(b.exact.points), b.name))
