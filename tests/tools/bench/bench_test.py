#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cadt-bench as its users meet it, at its smallest scale. Standard library only."""
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ.get("CADT_BENCH_PROGRAM", "cadt-bench")
SECONDS = 240

EXPERIMENTS = ["sizes", "blocks", "breakdown", "distributions", "snapshots", "flips", "thresholds", "works", "bunny",
               "statistics", "devices", "kernels"]
COUNTERS = ["launches", "walk_steps", "lock_attempts", "lock_failures", "invalid_restarts", "insert_retries", "stale_edges",
            "deferred_points", "deferred_edges", "splits", "edge_splits", "flips", "incircle_tests",
            "orientation_tests", "exact_orientations", "exact_incircles", "ties", "legality_sweeps", "sweep_repairs",
            "certified_edges", "stabilized_edges", "illegal_edges", "refined_points", "bytes_device_peak"]
# What the report reads: a change here is one there.
COLUMNS = (["experiment", "distribution", "points", "who", "backend", "device", "threads", "block", "stabilize",
            "threshold", "epsilon", "detail", "strategy", "warmups", "runs", "median_ms", "min_ms", "max_ms",
            "device_ms", "triangles", "hash", "occupancy", "differing_triangles"] + COUNTERS + ["certified"] +
           [f"flips_{k}" for k in range(16)] + ["phases", "thread_time"] +
           ["kernel", "kernel_launches", "kernel_ms", "kernel_share", "kernel_bytes", "bandwidth_gbs", "copy_gbs",
            "issue_active", "dram_throughput", "dram_bytes", "operations", "profiler"] + ["skipped"])


def default_signals():
    """A shell in the background ignores SIGINT, and children inherit that."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


class BenchTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cadt-bench-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = self.folder / "out"
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()
        # Without data unless a test makes some, and with the temporary files where they can be counted.
        self.environment = {**os.environ, "CADT_DATA_DIR": str(self.folder / "data"), "TMPDIR": str(self.temporary)}

    def bench(self, *arguments, expect=0):
        done = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              timeout=SECONDS, cwd=self.folder, env=self.environment, preexec_fn=default_signals)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def tiny(self, *arguments, **more):
        return self.bench(*arguments, "--out", self.out, "--scale", "tiny", **more)

    def rows(self, experiment):
        with open(self.out / f"{experiment}.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file, strict=True))
        for row in rows:
            self.assertEqual(list(row), COLUMNS)
            self.assertEqual(row["experiment"], experiment)
            self.assertNotEqual(bool(row["skipped"]), bool(row["triangles"]), row)
        self.assertTrue(rows)
        return rows

    def usable(self):
        devices = json.loads((self.out / "machine.json").read_text())["devices"]
        return {device["backend"] for device in devices if device["usable"]}


class Results(BenchTest):
    def test_sizes_blocks_and_flips(self):
        said = self.tiny("sizes", "blocks", "flips")
        self.assertEqual(said.stdout, "")
        self.assertEqual(sorted(p.name for p in self.out.iterdir()),
                         sorted(["machine.json"] + [f"{e}.{s}" for e in ("sizes", "blocks", "flips")
                                                    for s in ("csv", "json")]))
        machine = json.loads((self.out / "machine.json").read_text())
        self.assertEqual(list(machine), ["schema", "name", "cpu", "cores", "memory_bytes", "os", "compiler", "cadt",
                                         "commit", "date", "devices", "peers"])
        self.assertEqual({peer["name"] for peer in machine["peers"]}, {"cgal", "scipy", "cupy"})

        sizes = self.rows("sizes")
        self.assertEqual({row["who"] for row in sizes},
                         {"sequential", "cgal", "scipy", "cupy", "host", "opencl", "cuda"})
        self.same_meshes(sizes)
        for row in sizes:
            if row["skipped"]:
                continue
            self.assertLessEqual(float(row["min_ms"] or 0), float(row["median_ms"] or 0))
            self.assertGreaterEqual(int(row["runs"]), 1)
            if row["backend"]:
                self.assertEqual(row["certified"], "true")
                self.assertLessEqual(float(row["device_ms"]), float(row["max_ms"]))
                self.assertIn("sort=", row["phases"])
                self.assertGreater(int(row["launches"]), 0)
        # Half the points' files stay behind if one is forgotten.
        self.assertEqual(list(self.temporary.iterdir()), [])

        blocks = self.rows("blocks")
        self.assertNotIn("host", {row["who"] for row in blocks})
        self.same_meshes(blocks)
        for row in self.rows("flips"):
            if row["skipped"]:
                continue
            self.assertEqual(row["threshold"], "" if row["stabilize"] == "off" else "3")
            self.assertEqual(row["differing_triangles"] == "", row["stabilize"] == "off")
            if row["stabilize"] == "defer":
                self.assertEqual(row["differing_triangles"], "0")
            # Euler: points - edges + triangles = 1, all points being distinct.
            self.assertEqual(sum(int(row[f"flips_{k}"]) for k in range(16)),
                             int(row["points"]) + int(row["triangles"]) - 1)

    def same_meshes(self, rows):
        """All back ends, threads and blocks made the same mesh, and all others as many triangles."""
        meshes, counts, who = {}, {}, set()
        for row in rows:
            if row["skipped"]:
                continue
            key = row["distribution"], row["points"]
            counts.setdefault(key, set()).add(row["triangles"])
            if row["backend"]:
                who.add(row["who"])
                meshes.setdefault(key, set()).add(row["hash"])
        self.assertTrue(counts)
        for found in [*meshes.values(), *counts.values()]:
            self.assertEqual(len(found), 1, found)
        self.assertLessEqual(who, self.usable())

    def test_all_of_them(self):
        self.tiny("all", "--who", "host,opencl,cuda")
        for experiment in EXPERIMENTS:
            rows = self.rows(experiment)
            with open(self.out / f"{experiment}.json", encoding="utf-8") as file:
                self.assertEqual([list(row) for row in json.load(file)], [COLUMNS] * len(rows))
        details = {row["detail"] for row in self.rows("statistics") if not row["skipped"]}
        self.assertEqual(details, {"none", "counters", "timing"})
        for row in self.rows("statistics"):
            self.assertEqual(row["lock_attempts"] == "", row["detail"] in ("", "none"), "a count that nobody counted")
        timed = [row for row in self.rows("breakdown") if not row["skipped"] and row["who"] == "host"]
        self.assertTrue(timed)
        for row in timed:
            shares = [float(part.split("=")[1]) for part in row["thread_time"].split(";")]
            self.assertAlmostEqual(sum(shares), 1, places=2)
        steps = [row for row in self.rows("snapshots") if not row["skipped"]]
        self.assertGreater(len(steps), 2)
        for row in steps:
            lines = (self.out / "snapshots" / f"step-{row['block']}.csv").read_text().splitlines()
            self.assertEqual(len(lines) - 1, int(row["triangles"]))
        self.assertEqual(len((self.out / "snapshots" / "points.csv").read_text().splitlines()), 2049)
        self.assertIn("no data folder", " ".join(row["skipped"] for row in self.rows("bunny")))

    def test_kernels(self):
        self.tiny("kernels", "--who", "host", "--points", "3000")
        self.assertEqual({row["profiler"] for row in self.rows("kernels")}, {"not asked for (--profile)"})
        self.tiny("kernels", "--who", "host,opencl", "--points", "3000", "--profile")
        done = [row for row in self.rows("kernels") if not row["skipped"]]
        runs = {}
        for row in done:
            runs.setdefault((row["who"], row["strategy"]), []).append(row)
            self.assertEqual(row["points"], "3000")
            self.assertGreater(float(row["copy_gbs"]), 0)
            if row["kernel_bytes"]:
                gigabytes = 1e-9 * int(row["kernel_bytes"])
                self.assertAlmostEqual(float(row["bandwidth_gbs"]) * 1e-3 * float(row["kernel_ms"]) / gigabytes, 1,
                                       places=3)
            self.assertEqual((row["issue_active"], row["operations"]), ("", ""))
            self.assertEqual(row["profiler"], "ncu knows CUDA's kernels only")
        self.assertEqual(set(runs), {(who, strategy) for who in self.usable() - {"cuda"}
                                     for strategy in ("locks", "stars")})
        for (_, strategy), rows in runs.items():
            self.assertAlmostEqual(sum(float(row["kernel_share"]) for row in rows), 1, places=4)
            kernels = {row["kernel"]: row for row in rows}
            self.assertEqual(len(kernels), len(rows))
            self.assertEqual("cadt_prove_stars" in kernels, strategy == "stars")
            self.assertEqual(int(kernels["cadt_gather_points"]["kernel_bytes"]), 36 * 3000)
            times = [float(row["kernel_ms"]) for row in rows]
            self.assertEqual(times, sorted(times, reverse=True))
            self.assertLessEqual(sum(times), 1.5 * float(rows[0]["max_ms"]))  # medians of each, so about

    def test_once(self):
        done = [self.bench("once", "-n", "2000", "--backend", "host", "--strategy", how).stdout
                for how in ("locks", "stars")]
        self.assertRegex(done[0], r"^[0-9a-f]{32}\n$")
        self.assertEqual(done[0], done[1])

    def test_bunnies(self):
        real = self.folder / "data" / "real"
        real.mkdir(parents=True)
        points = [(i % 21 + 0.37 * (i % 7), i // 21 + 0.11 * (i % 5)) for i in range(453)]
        (real / "INDEX.md").write_text("| name | split | core | n |\n| bunny_res4 | dev | yes | 453 |\n")
        (real / "bunny_res4.xy").write_text("".join(f"{x} {y}\n" for x, y in points))
        self.tiny("bunny", "--who", "host")
        folder = self.out / "bunny"
        self.assertEqual(sorted(p.name for p in folder.iterdir()),
                         ["bunny_res4-exact.png", "bunny_res4-exact.tri", "bunny_res4-paper.png",
                          "bunny_res4-paper.tri", "bunny_res4.xy"])
        done = [row for row in self.rows("bunny") if not row["skipped"]]
        self.assertEqual([row["stabilize"] for row in done], ["off", "paper"])
        self.assertRegex(done[1]["differing_triangles"], r"^\d+$")


class Keeping(BenchTest):
    def test_what_is_there_is_kept_and_what_is_not_is_made(self):
        self.tiny("statistics", "breakdown", "--who", "host")
        (self.out / "breakdown.csv").unlink()
        before = (self.out / "statistics.csv").read_text()
        (self.out / "statistics.csv").write_text(before + "\n")
        self.tiny("statistics", "breakdown", "--who", "host", "--keep")
        self.assertEqual((self.out / "statistics.csv").read_text(), before + "\n")
        self.rows("breakdown")
        self.tiny("statistics", "--who", "host")
        self.assertNotEqual((self.out / "statistics.csv").read_text(), before + "\n")


class Limits(BenchTest):
    def test_what_would_take_too_long_is_left_out(self):
        self.tiny("sizes", "--who", "sequential", "--time-limit", "0.0001")
        first, second = [row for row in self.rows("sizes")]
        self.assertEqual((first["points"], first["skipped"]), ("500", ""))
        self.assertRegex(second["skipped"], r"^predicted .* s, limit 0.0001 s$")

    def test_the_warm_ups_of_a_peer_are_those_it_made(self):
        self.tiny("sizes", "--who", "cgal", "--warm-up", "100000000", "--runs", "1")
        done = [row for row in self.rows("sizes") if not row["skipped"]]
        for row in done:  # the time ends before
            self.assertEqual(row["runs"], "1")
            self.assertLess(int(row["warmups"]), 100000000)
        if done:
            self.assertGreater(int(done[0]["warmups"]), 0)

    def test_runs_and_warm_up(self):
        self.tiny("works", "--who", "host", "--warm-up", "2", "--runs", "3")
        self.assertEqual({(row["warmups"], row["runs"]) for row in self.rows("works") if not row["skipped"]},
                         {("2", "3")})


class Errors(BenchTest):
    def fails(self, code, *arguments, says):
        said = self.bench(*arguments, expect=code)
        self.assertRegex(said.stderr, r"(?m)^cadt-bench: error: \S")
        for text in says:
            self.assertIn(text, said.stderr)

    def test_command_lines(self):
        self.fails(2, "nothing", "--out", self.out, says=["nothing", *EXPERIMENTS])
        self.fails(2, "--out", self.out, says=EXPERIMENTS)
        self.fails(2, "sizes", says=["--out"])
        self.fails(2, "sizes", "--out", self.out, "--who", "nobody", says=["nobody", "sequential"])
        self.fails(2, "sizes", "--out", self.out, "--backend", "metal", says=["metal", "opencl"])
        self.fails(2, "sizes", "--out", self.out, "--scale", "huge", says=["huge", "small"])
        self.fails(2, "sizes", "--out", self.out, "--runs", "0", says=["--runs"])
        self.fails(2, "sizes", "--out", self.out, "--data", "absent", says=["absent"])
        self.fails(2, "sizes", "--wrong", says=["--wrong", "--help"])
        self.fails(2, "compare", "-d", "nothing", says=["nothing"])
        self.assertFalse(self.out.exists())

    def test_folder_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        self.fails(3, "sizes", "--scale", "tiny", "--out", self.folder / "file" / "out", says=["file"])
        self.fails(3, "sizes", "--scale", "tiny", "--out", "/proc/out", says=["/proc/out"])

    def test_help_and_list(self):
        self.assertIn("--time-limit", self.bench("--help").stdout)
        said = self.bench("--list").stdout
        for experiment in EXPERIMENTS:
            self.assertIn(experiment, said)


class Interrupts(BenchTest):
    def test_nothing_half_is_left(self):
        # The peers get files of the points; a limit and runs that last.
        process = subprocess.Popen([PROGRAM, "sizes", "--scale", "small", "--runs", "1000", "--time-limit", "1000",
                                    "--out", str(self.out), "--who", "cgal,sequential,host"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder,
                                   env=self.environment, preexec_fn=default_signals, start_new_session=True)
        try:
            end = time.monotonic() + SECONDS
            while not list(self.temporary.iterdir()) and time.monotonic() < end:
                time.sleep(0.01)
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does
            said = process.communicate(timeout=SECONDS)[1]
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted", said)
        self.assertEqual([p.name for p in self.out.iterdir()], ["machine.json"])
        self.assertEqual(list(self.temporary.iterdir()), [])


class Compare(BenchTest):
    def test_table_and_check(self):
        said = self.bench("compare", "-d", "uniform,grid", "-n", "2k", "-w", "host,cgal", "-r", "2", "--check",
                          "--json", "numbers.json").stdout
        self.assertIn("All meshes equal CGAL's", said)
        for word in ("uniform", "grid", "host", "cgal", "x CGAL"):
            self.assertIn(word, said)
        self.assertEqual(len(json.loads((self.folder / "numbers.json").read_text())), 4)


if __name__ == "__main__":
    unittest.main()
