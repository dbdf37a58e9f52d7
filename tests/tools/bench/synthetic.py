# SPDX-License-Identifier: Apache-2.0
"""Folders as cadt-bench writes them, with made-up numbers of a plausible shape: for tests of the report, and to look at
its figures without measuring.

usage: synthetic.py DIR      writes DIR/one and DIR/two
"""
import csv
import hashlib
import json
import math
import random
import sys
from pathlib import Path

COUNTERS = ("launches walk_steps lock_attempts lock_failures invalid_restarts insert_retries stale_edges deferred_points "
            "deferred_edges splits edge_splits flips incircle_tests orientation_tests exact_orientations "
            "exact_incircles ties legality_sweeps sweep_repairs certified_edges stabilized_edges illegal_edges "
            "refined_points bytes_device_peak").split()
COLUMNS = ("experiment distribution points who backend device threads block stabilize threshold epsilon detail strategy "
           "warmups runs median_ms min_ms max_ms device_ms triangles hash occupancy differing_triangles".split() + COUNTERS +
           ["certified"] + [f"flips_{k}" for k in range(16)] + ["phases", "thread_time"] +
           "kernel kernel_launches kernel_ms kernel_share kernel_bytes bandwidth_gbs copy_gbs issue_active "
           "dram_throughput dram_bytes operations profiler skipped".split())
SIZES = [8192, 65536, 524288, 1 << 20, 1 << 21, 1 << 22, 1 << 23, 1 << 24, 1 << 25, 1 << 26, 1 << 27]
# A point's nanoseconds, milliseconds of a call, and of these the share that upload and copy take.
COSTS = {"sequential": (900, 0, 0), "cgal": (450, 0, 0), "scipy": (1900, 1, 0), "cupy": (60, 6, 0.2),
         "host": (70, 0.4, 0.01), "opencl": (14, 1.1, 0.6), "cuda": (11, 0.5, 0.7)}
HARDER = {"uniform": 1, "circles": 1.22, "gaussian": 1.05, "kuzmin": 1.31, "line": 2.4, "grid": 1.8}
FLIPS = {"off": (0.66, 0.245), "defer": (0.67, 0.21), "paper": (0.68, 0.16)}  # share of edges never flipped, and decay
LIMIT_MS = 20000


class Writer:
    """Makes the rows of one machine; the random numbers are the same each time."""

    def __init__(self, folder: Path, name: str, devices: dict[str, list[str]], slower: float):
        self.folder, self.name, self.devices, self.slower = folder, name, devices, slower
        self.random = random.Random(name)
        self.rows: dict[str, list[dict]] = {}

    def row(self, experiment: str, who: str, device: str, points: int, factor: float = 1, distribution: str = "uniform",
            **cells: object) -> dict:
        slope, fixed, copied = COSTS[who]
        second = 1.6 if device in self.devices.get(who, [])[1:] else 1
        level = 1 + (0.03 if who == "host" else 0.002) * math.log2(points)
        time = (slope * points * 1e-6 * level + fixed) * factor * HARDER.get(distribution, 1.1) * self.slower * second
        time *= self.random.uniform(0.97, 1.03)
        row = dict(experiment=experiment, distribution=distribution, points=points, who=who, device=device, warmups=2,
                   runs=5)
        if who in self.devices:
            row.update(backend=who, stabilize="off", epsilon=1e-4, detail="counters", threads=16)
        if time > LIMIT_MS:
            row["skipped"] = f"predicted {time / 1000:.0f} s, limit {LIMIT_MS // 1000} s"
        elif who == "cupy" and self.slower > 1:
            row["skipped"] = "not installed: no module named cupy"
        else:
            on_device = time * (1 - copied)
            row.update(median_ms=time, min_ms=time * self.random.uniform(0.93, 0.99), triangles=2 * points - 60,
                       max_ms=time * self.random.uniform(1.01, 1.12), hash=hash_of(distribution, points))
            if who == "cupy":
                row.update(median_ms="", min_ms="", max_ms="", device_ms=on_device, hash="")
            if who in self.devices:
                row.update(device_ms=on_device, certified=1, phases=phases(on_device, time),
                           **counters(points, distribution))
        row.update(cells)
        self.rows.setdefault(experiment, []).append(row)
        return row

    def everyone(self):
        return [(who, device) for who, names in self.devices.items() for device in names]

    def write(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        for experiment, rows in self.rows.items():
            with open(self.folder / f"{experiment}.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
        peers = [{"name": who, "version": "1.0", "usable": True, "reason": ""}
                 for who in ("sequential", "cgal", "scipy")]
        peers.append({"name": "cupy", "version": "", "usable": self.slower == 1,
                      "reason": "" if self.slower == 1 else "not installed: no module named cupy"})
        devices = [{"backend": who, "index": index, "usable": True, "reason": "", "platform": who, "name": device,
                    "driver": "1.2.3", "gpu": who != "host", "memory_bytes": 8 << 30, "compute_units": 16}
                   for who, names in self.devices.items() for index, device in enumerate(names)]
        if "cuda" not in self.devices:
            devices.append({"backend": "cuda", "index": -1, "usable": False, "reason": "no CUDA driver is installed",
                            "platform": "", "name": "", "driver": "", "gpu": False})
        machine = {"schema": 1, "name": self.name, "cpu": "Example Processor 9000", "cores": 16,
                   "memory_bytes": 64 << 30,
                   "os": "Example Linux 12", "compiler": "GCC 12.2.0", "cadt": "0.2.0",
                   "commit": "0123456789abcdef0123456789abcdef01234567", "date": "2030-01-02T03:04:05Z",
                   "devices": devices, "peers": peers}
        (self.folder / "machine.json").write_text(json.dumps(machine, indent=1), encoding="utf-8")


def hash_of(distribution: str, points: int) -> str:
    return hashlib.sha256(f"{distribution} {points}".encode()).hexdigest()[:32]


def phases(on_device: float, whole: float) -> str:
    shares = {"bounds": 0.01, "sort": 0.12, "refine": 0.02, "gather": 0.05, "seed": 0.01, "insert": 0.64,
              "certify": 0.08,
              "output": 0.07}
    parts = {"upload": (whole - on_device) * 0.4, **{k: v * on_device for k, v in shares.items()},
             "copy": (whole - on_device) * 0.6}
    return ";".join(f"{name}={value:.6g}" for name, value in parts.items())


def counters(points: int, distribution: str) -> dict:
    crowded = 0.3 * points ** 0.75 * HARDER.get(distribution, 1)
    return {"launches": 20 + int(math.log2(points)), "walk_steps": int(4.2 * points),
            "lock_attempts": int(4 * points + 3 * crowded),
            "lock_failures": int(3 * crowded), "invalid_restarts": int(crowded), "insert_retries": int(1.5 * crowded),
            "stale_edges": int(2 * crowded), "deferred_points": int(0.4 * crowded),
            "deferred_edges": int(0.2 * crowded),
            "splits": points - 3, "flips": int(2.96 * points), "incircle_tests": 9 * points,
            "certified_edges": 3 * points,
            "stabilized_edges": 0, "illegal_edges": 0, "bytes_device_peak": 120 * points}


def stabilized(points: int, mode: str, threshold: int) -> dict:
    """Flips an edge, and what a mode leaves illegal."""
    never, decay = FLIPS[mode]
    edges, harder = 3 * points - 60, 1 if mode == "off" else 0.7 + 0.03 * threshold
    counts = [int(edges * never)] + [int(edges * (1 - never) * (1 - decay * harder) * (decay * harder) ** k)
                                     for k in range(15)]
    if mode != "off":
        counts[threshold + 1:] = [value // 3 for value in counts[threshold + 1:]]
    counts[1] += edges - sum(counts)
    bad = edges * 8e-4 / threshold if mode == "paper" else 0
    return {"stabilize": mode, "threshold": "" if mode == "off" else threshold, "illegal_edges": int(bad),
            "stabilized_edges": 0 if mode == "off" else int(edges * 0.01 / threshold),
            "certified": int(mode != "paper"),
            "differing_triangles": int(1.7 * bad), **{f"flips_{k}": value for k, value in enumerate(counts)}}


def lattice(size: int) -> tuple[list[tuple[float, float]], list[tuple[int, int, int]]]:
    """A square of size x size points that are moved a little, with a diagonal in each cell."""
    noise = random.Random(size)
    points = [(x + noise.uniform(-0.2, 0.2), y + noise.uniform(-0.2, 0.2)) for y in range(size) for x in range(size)]
    triangles = []
    for y in range(size - 1):
        for x in range(size - 1):
            a = y * size + x
            triangles += [(a, a + 1, a + size + 1), (a, a + size + 1, a + size)]
    return points, triangles


def turned(triangles: list[tuple[int, int, int]], every: int) -> list[tuple[int, int, int]]:
    """The lattice with the other diagonal in some cells: two triangles that differ in each."""
    changed = list(triangles)
    for k in range(0, len(triangles) - 1, 2 * every):
        (a, b, c), (_, _, d) = triangles[k], triangles[k + 1]
        changed[k:k + 2] = [(a, b, d), (b, c, d)]
    return changed


def write_lines(path: Path, rows: list, separator: str = ",") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(separator.join(map(repr, row)) + "\n" for row in rows), encoding="utf-8")


def pictures(writer: Writer) -> None:
    """The folders of meshes, and the rows that belong to them."""
    who, device = writer.everyone()[-1]
    points, triangles = lattice(20)
    write_lines(writer.folder / "snapshots" / "points.csv", points)
    for step in range(1, 9):
        part = triangles[:len(triangles) * step // 8]
        write_lines(writer.folder / "snapshots" / f"step-{step}.csv", part)
        writer.row("snapshots", who, device, len(points) * step // 8, block=step, triangles=len(part))
    for name, size in (("bunny_res4", 10), ("bunny_res3", 20), ("bunny_res2", 40)):
        points, triangles = lattice(size)
        write_lines(writer.folder / "bunny" / f"{name}.xy", points, " ")
        write_lines(writer.folder / "bunny" / f"{name}-exact.tri", triangles)
        write_lines(writer.folder / "bunny" / f"{name}-paper.tri", turned(triangles, 40))
        for mode in ("off", "paper"):
            writer.row("bunny", who, device, size * size, distribution=name, stabilize=mode, triangles=len(triangles),
                       differing_triangles=0 if mode == "off" else len(range(0, len(triangles) - 1, 80)) * 2)


def times(writer: Writer) -> None:
    for points in SIZES:
        for who in ("sequential", "cgal", "scipy", "cupy"):
            writer.row("sizes", who, "", points)
        for who, device in writer.everyone():
            writer.row("sizes", who, device, points)
            if who == "host" and points <= 1 << 20:
                writer.row("sizes", who, device, points, 11, threads=1)
    for who, device in writer.everyone():
        for name, factor in HARDER.items():
            for points in (1 << 16, 1 << 20, 1 << 23):
                writer.row("distributions", who, device, points, distribution=name)
        for name, points in (("terrain", 1_102_345), ("tsp_usa", 13_509)):
            writer.row("distributions", who, device, points, distribution=name, factor=1.1)
        for name in ("uniform", "circles"):
            row = writer.row("breakdown", who, device, 1 << 20, distribution=name, detail="timing")
            row["thread_time"] = "locate=0.31;lock=0.12;split=0.08;test=0.14;flip=0.19;neighbors=0.11;other=0.05"
        for name, points in (("uniform", 477), ("bunny_res4", 453), ("uniform", 1_000_000), ("uniform", 21_214_412)):
            writer.row("works", who, device, points, distribution=name)
        for points in SIZES[:8]:
            writer.row("statistics", who, device, points)
        for detail, factor in (("none", 0.985), ("timing", 1.14)):
            writer.row("statistics", who, device, SIZES[7], factor, detail=detail)
        for name in ("uniform", "circles", "grid"):
            for points in (100_000, 1_000_000):
                writer.row("devices", who, device, points, distribution=name)


def kernels(writer: Writer) -> None:
    for who, device in writer.everyone():
        if who == "host":
            continue
        for points in (8192, 131072, 1 << 20, 1 << 23):
            for block in (32, 64, 128, 256, 512, 1024):
                if block == 1024 and who == "opencl":
                    writer.row("blocks", who, device, points, block=block, median_ms="",
                               skipped="does not start with 1024 "
                               "threads")
                    continue
                used = {32: 0.5, 64: 0.75, 128: 0.75, 256: 0.75, 512: 0.75, 1024: 0.5}[block] if who == "cuda" else ""
                writer.row("blocks", who, device, points, 1 + 0.05 * abs(math.log2(block / 128)), block=block,
                           occupancy=used)
        for name, points in (("uniform", 100_000), ("circles", 1_002_528)):  # whole circles
            for mode in ("off", "defer", "paper"):
                writer.row("flips", who, device, points, distribution=name, **stabilized(points, mode, 3))
            writer.row("thresholds", who, device, points, distribution=name, **stabilized(points, "off", 3))
            for threshold in range(1, 11):
                for mode, gain in (("defer", 0.07), ("paper", 0.14)):
                    writer.row("thresholds", who, device, points, 1 - gain / threshold ** 0.6, distribution=name,
                               **stabilized(points, mode, threshold))


# Name, share of the time, bytes a point, launches; "insert" and the join have walks and hash tables in the place of a
# model.
KERNELS = {"locks": [("cadt_insert", 0.61, 148, 24), ("cadt_legality_sweep", 0.1, 80, 1), ("sort", 0.08, 64, 1),
                     ("cadt_write_ranked", 0.07, 124, 1), ("cadt_flag_triangles", 0.05, 72, 1),
                     ("cadt_gather_points", 0.04, 36, 1), ("cadt_unique_pack", 0.02, 64, 1),
                     ("scan", 0.01, 16, 1), ("cadt_hilbert_keys", 0.006, 20, 1), ("cadt_bounds", 0.005, 16, 1),
                     ("cadt_unique_flags", 0.004, 20, 1), ("cadt_sort_runs", 0.002, 4, 1),
                     ("cadt_flag_overfull", 0.002, 8, 1), ("cadt_legalize_edges", 0.001, None, 7)],
           "stars": [("cadt_prove_stars", 0.7, 68, 1), ("cadt_star_half_edges", 0.2, 120, 1), ("cadt_stitch_cover", 0.1, None, 1)]}


def roofs(writer: Writer) -> None:
    points = 1 << 23
    for who, device in writer.everyone():
        copy = {"host": 21.5, "opencl": 3900.0, "cuda": 4100.0}[who] / writer.slower
        for strategy, kernels in KERNELS.items():
            for name, share, size, launches in kernels:
                row = writer.row("kernels", who, device, points, 1 if strategy == "locks" else 0.5, strategy=strategy,
                                 kernel=name, kernel_launches=launches, kernel_share=share, copy_gbs=copy,
                                 profiler="ncu knows CUDA's kernels only")
                row["kernel_ms"] = time = 0.9 * share * row["device_ms"]
                if size is not None:
                    row.update(kernel_bytes=size * points, bandwidth_gbs=size * points / time / 1e6)
                if who == "cuda":
                    row.update(profiler="ncu", issue_active=100 * (1 - share), dram_throughput=20 + 50 * (1 - share),
                               dram_bytes=1.5 * (size or 30) * points, operations=(3 + 700 * share) * points)


def write_machine(folder: Path, name: str = "one", devices: dict[str, list[str]] | None = None,
                  slower: float = 1) -> Writer:
    """A whole folder. The rows may be changed afterwards, and written again."""
    writer = Writer(Path(folder), name, devices or {"host": ["Example Processor 9000"], "opencl": ["Example Card 1"],
                                                    "cuda": ["Example Card 1"]}, slower)
    times(writer)
    kernels(writer)
    roofs(writer)
    pictures(writer)
    writer.write()
    return writer


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write_machine(Path(sys.argv[1]) / "one")
    write_machine(Path(sys.argv[1]) / "two", "two", {"host": ["Another Processor, of a rather long name indeed"],
                                                     "opencl": ["pthread-Another Processor", "Example Card 2"]}, 3.1)
