#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The report of the benchmarks (bench/report), from folders that the tests write."""
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from report_folder import FolderTest, TITLES, run, section  # noqa: E402, first: it sets the path
import matplotlib.image  # noqa: E402
import meshes  # noqa: E402
import tables_work  # noqa: E402
import words  # noqa: E402
from synthetic import turned, lattice, write_machine  # noqa: E402

FIGURES = ("sizes", "throughput", "blocks", "breakdown", "distributions", "flips", "thresholds", "statistics",
           "devices", "kernels", "roofline")
TWO = {"host": ["Another Processor"], "opencl": ["pthread-Another Processor", "Example Card 2"]}


class TwoMachines(unittest.TestCase):
    """Everything was measured on two machines."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="cadt-report-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.one = write_machine(cls.folder / "a", "one")
        cls.two = write_machine(cls.folder / "b", "two", TWO, 3.1)
        cls.out = cls.folder / "out"
        cls.done = run(cls.folder / "a", cls.folder / "b", "--out", cls.out, "--title", "A title")
        cls.text = (cls.out / "report.md").read_text(encoding="utf-8") if cls.done.returncode == 0 else ""

    def test_has_every_section_and_nothing_is_missing(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        self.assertTrue(self.text.startswith("# A title\n"))
        for title in TITLES:
            self.assertGreater(len(section(self.text, title)), 300, title)
        for word in ("is missing", "lacks", "Nothing was measured", "left out.", "nan", "None"):
            self.assertNotIn(word, self.text)

    def test_tables_are_well_formed(self):
        width = 0
        for line in self.text.splitlines():
            cells = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else 0
            self.assertTrue(not cells or not width or cells == width, line)
            width = cells

    def test_figures_are_there_and_not_blank(self):
        shown = re.findall(r"\]\(([^)]+\.(?:png|svg))\)", self.text)
        expected = [*FIGURES, "snapshots-1", "snapshots-2", "bunny-1", "bunny-2"]
        self.assertEqual(sorted(shown), sorted(f"{name}.{kind}" for name in expected for kind in ("png", "svg")))
        self.assertEqual(sorted(["report.md", *shown]), sorted(path.name for path in self.out.iterdir()))
        for name in expected:
            picture = matplotlib.image.imread(self.out / f"{name}.png")
            self.assertGreaterEqual(picture.shape[1], 1200, name)
            inked = (picture[:, :, :3].min(axis=2) < 0.8).mean()
            self.assertTrue(0.005 < inked < 0.7, f"{name}: {inked} of the picture is not white")
            self.assertTrue((picture[:, :3, :3] == 1).all(), f"{name}: something is cut off on the left")
            self.assertTrue((picture[:, -3:, :3] == 1).all(), f"{name}: something is cut off on the right")
            text = (self.out / f"{name}.svg").read_text(encoding="utf-8")
            self.assertIn("<svg", text)
            self.assertNotIn("dc:date", text)

    def test_values_are_those_of_the_files(self):
        row = next(r for r in self.one.rows["sizes"] if r["who"] == "cuda" and r["points"] == 1 << 20)
        times = section(self.text, TITLES[0]).partition("### one: times")[2]
        line = next(line for line in times.splitlines() if line.startswith("| 1,048,576 |"))
        self.assertIn(f"{words.number(row['median_ms'])} ({words.number(row['device_ms'])})", line)
        self.assertTrue(line.endswith("| 30.2 | 8.14 | 1.10 |"), f"the paper's numbers: {line}")
        cgal = next(r for r in self.one.rows["sizes"] if r["who"] == "cgal" and r["points"] == 1 << 20)
        line = next(line for line in times.partition("speed-ups")[2].splitlines() if line.startswith("| 1,048,576 |"))
        self.assertIn(words.times(cgal["median_ms"] / row["median_ms"]), line)
        self.assertTrue(line.endswith("| ×7.40 | ×27.4 |"), line)

    def test_one_thread_and_all_are_two(self):
        rows = [r for r in self.one.rows["sizes"] if r["who"] == "host" and r["points"] == 65536]
        times = [words.number(row["median_ms"]) for row in rows]
        text = section(self.text, TITLES[0])
        self.assertIn("| host (Example Processor 9000, 1 thread) | host (Example Processor 9000, 16 threads) |", text)
        self.assertRegex(text, rf"\n\| 65,536 \|.* {times[1]} \([\d.]+\) \| {times[0]} \([\d.]+\) \|")

    def test_machines_stand_side_by_side(self):
        for title in (TITLES[1], TITLES[3], TITLES[5], TITLES[10]):
            self.assertIn("| one: cuda (Example Card 1) |", section(self.text, title))
            self.assertIn("| two: opencl (pthread-Another Processor) |", section(self.text, title))
        self.assertIn("| one: cuda (Example Card 1) | two: host", section(self.text, TITLES[0]))
        self.assertIn("over 6 devices and programs", section(self.text, TITLES[10]))

    def test_says_what_was_not_measured_and_why(self):
        self.assertIn("two: cupy, uniform, 8,192, 65,536, ", section(self.text, TITLES[0]))
        self.assertRegex(section(self.text, TITLES[0]),
                         r"- one: scipy, uniform, 33,554,432 points: predicted \d+ s, limit 20 s\n")
        self.assertIn("does not start with 1024 threads", section(self.text, TITLES[1]))
        self.assertIn("| two | cupy | – | missing: not installed: no module named cupy |", self.text)
        self.assertIn("two: cuda was not used: no CUDA driver is installed", self.text)

    def test_the_paper_stands_beside(self):
        for text, title in (("the paper: 35 %", 2), ("4,263", 4), ("78 %", 5), ("38,961", 5), ("66 %", 5), ("74 %", 5),
                            ("the paper: 74 % (Fig. 10 and section 5.4)", 5),
                            ("the paper: -17 %", 6), ("| 269 | 0.870 |", 7), ("3 of 945 (0.32 %)", 8), ("79 %", 1)):
            self.assertIn(text, section(self.text, TITLES[title]))

    def test_works_compare_with_the_nearest_one(self):
        row = next(r for r in self.one.rows["works"] if r["who"] == "cuda" and r["distribution"] == "bunny_res4")
        self.assertIn(f"one: cuda (Example Card 1), bunny_res4 | 453 |  |  | {words.number(row['median_ms'])} | "
                      f"{words.number(row['device_ms'])} | {words.times(268.55 / row['median_ms'])}", self.text)


    def test_cupy_is_on_the_device_only(self):
        row = next(r for r in self.one.rows["sizes"] if r["who"] == "cupy" and r["points"] == 1 << 20)
        times = section(self.text, TITLES[0]).partition("### one: times")[2]
        line = next(line for line in times.splitlines() if line.startswith("| 1,048,576 |"))
        self.assertIn(f"| ({words.number(row['device_ms'])}) |", line)

    def test_all_have_as_many_triangles(self):
        text = section(self.text, TITLES[0])
        self.assertRegex(text, r"\nThe other programs have as many triangles in each of \d+ cases\.\n")
        self.assertNotIn("Another number of triangles", self.text)


    def test_kernels(self):
        text = section(self.text, TITLES[11])
        self.assertIn("### one: cuda (Example Card 1, stars), 8,388,608 points", text)
        row = next(r for r in self.one.rows["kernels"] if (r["who"], r["kernel"]) == ("cuda", "cadt_legality_sweep"))
        self.assertIn(f"| cadt_legality_sweep | 1 | {words.number(row['kernel_ms'])} | 10.0 % | 671 | "
                      f"{words.number(row['bandwidth_gbs'])} | {words.percent(row['bandwidth_gbs'] / 4100)} | 90.0 % | "
                      "65.0 % | 0.608 |", text)
        self.assertRegex(text, r"\| cadt_legalize_edges \| 7 \| [\d.]+ \| 0.1 % \| – \| – \| – \|")
        self.assertRegex(text, r"- one: cuda \(Example Card 1, locks\): kernels take [\d.]+ ms of [\d.]+ ms on the "
                               r"device \(\d+\.\d %\); a copy moves 4,100 GB/s\.\n")
        self.assertRegex(text, r"- two: host .*, stars\): .* GB/s\. Not profiled: ncu knows CUDA's kernels only\.\n")


class OtherSizes(FolderTest):
    """Machines that were measured with different sizes."""

    def test_panels_are_those_of_each_machine(self):
        folders = []
        for name, points in (("one", 5000), ("two", 6000)):
            writer = self.writer(name)
            for experiment in ("thresholds", "devices"):
                writer.row(experiment, "cuda", "A Card", points)
            writer.write()
            folders.append(writer.folder)
        self.report(*folders)
        # As text in an SVG: two panels a device, and no empty one for the other's size.
        drawn = (self.out / "thresholds.svg").read_text(encoding="utf-8")
        self.assertEqual([len(re.findall(f"<!-- uniform, {size} points", drawn)) for size in (5000, 6000)], [2, 2])
        drawn = (self.out / "devices.svg").read_text(encoding="utf-8")
        self.assertEqual(len(re.findall("<!-- not measured -->", drawn)), 2)


class Counts(FolderTest):
    def test_another_number_of_triangles_is_named(self):
        writer = self.writer()
        for points in (5000, 6000):
            for who, device in (("cgal", ""), ("cupy", ""), ("cuda", "A Card")):
                writer.row("sizes", who, device, points)
        next(r for r in writer.rows["sizes"] if r["who"] == "cupy" and r["points"] == 6000)["triangles"] = 11938
        writer.row("sizes", "cgal", "", 7000, triangles=1)  # nothing to compare it with
        writer.write()
        text = section(self.report(writer.folder), TITLES[0])
        self.assertIn("**Another number of triangles: cupy, uniform: 11,938 of 11,940 with 6,000 points.**", text)
        self.assertNotIn("triangles: cgal", text)
        self.assertNotIn("as many triangles", text)


class Flips(FolderTest):
    def test_equation_9_by_hand(self):
        writer = self.writer()
        bins = {"off": [70, 20, 5, 0, 4, 0, 1], "paper": [75, 20, 3, 0, 2]}  # 5 and 2 of 100 edges above R = 3
        for mode, counts in bins.items():
            flips = {f"flips_{k}": counts[k] if k < len(counts) else 0 for k in range(16)}
            writer.row("flips", "cuda", "A Card", 1000, stabilize=mode, threshold="" if mode == "off" else 3,
                       triangles=66,
                       illegal_edges=0 if mode == "off" else 2, differing_triangles=0 if mode == "off" else 3, **flips)
        writer.write()
        text = section(self.report(writer.folder), TITLES[5])
        self.assertIn("| off | 1,000 | 3 | 100 | 70.0 % | 5 | 5.00 % | 6 | – |", text)
        self.assertIn("| paper | 1,000 | 3 | 100 | 75.0 % | 2 | 2.00 % | 4 | 60.0 % | 0 | 2 | 2.00 % | 3 | 4.55 % |",
                      text)

    def test_what_eq_9_gives_for_the_papers_own_numbers(self):
        self.assertEqual(round(100 * tables_work.reduction(151782, 38961)), 74)

    def test_what_cannot_be_told(self):
        self.assertIsNone(tables_work.reduction(0, 0))
        self.assertIsNone(tables_work.reduction(None, 3))
        self.assertIsNone(tables_work.over_threshold([1] * 16, 15), "the last bin holds 15 and more")
        self.assertEqual(tables_work.over_threshold([1] * 16, 14), 1)


class Hashes(FolderTest):
    def devices(self, **changed: str) -> str:
        writer = self.writer()
        for who, device in writer.everyone():
            writer.row("devices", who, device, 5000)
            writer.row("devices", who, device, 6000)
        for row in writer.rows["devices"]:
            if row["points"] == 5000:
                row["hash"] = changed.get(row["who"], row["hash"])
        writer.write()
        return section(self.report(writer.folder), TITLES[10])

    def test_equal_ones(self):
        text = self.devices()
        self.assertNotIn("DIFFERENT", text)
        self.assertIn("All hashes are equal in each of the 2 cases", text)
        self.assertIn("### uniform, 5,000 points: meshes equal", text)

    def test_one_differs(self):
        text = self.devices(opencl="bad0")
        self.assertIn("**DIFFERENT MESHES: uniform, 5,000 points: opencl (A Card) has bad0, the 2 others ", text)
        self.assertIn("### uniform, 5,000 points: meshes **DIFFERENT**", text)
        self.assertIn("### uniform, 6,000 points: meshes equal", text)
        self.assertNotIn("All hashes are equal", text)

    def test_nobody_is_in_the_majority(self):
        text = self.devices(opencl="bad0", cuda="bad1")
        for who in ("host (A Processor)", "opencl (A Card) has bad0", "cuda (A Card) has bad1"):
            self.assertIn(who, text.partition("**DIFFERENT MESHES")[2].partition("**")[0])

    def test_stabilised_meshes_need_not_be_equal(self):
        writer = self.writer()
        for who, device in writer.everyone():
            writer.row("devices", who, device, 5000)
        writer.row("devices", "cuda", "A Card", 5000, stabilize="paper", hash="other")
        writer.write()
        self.assertNotIn("DIFFERENT", self.report(writer.folder))

    def test_across_machines(self):
        folders = []
        for name, value in (("one", "0a"), ("two", "0b")):
            writer = self.writer(name)
            writer.row("devices", "cuda", "A Card", 5000, hash=value)
            writer.write()
            folders.append(writer.folder)
        self.assertIn("**DIFFERENT MESHES: uniform, 5,000 points: one: cuda (A Card) has 0a and two: cuda (A Card) has "
                      "0b.**", self.report(*folders))


class Parts(FolderTest):
    def test_the_same_bytes_each_time(self):
        writer = self.writer()
        for points in (8192, 65536):
            for who, device in writer.everyone():
                writer.row("sizes", who, device, points)
        writer.write()
        found = []
        for _ in range(2):
            self.report(writer.folder)
            found.append({path.name: path.read_bytes() for path in self.out.iterdir()})
            shutil.rmtree(self.out)
        self.assertEqual(sorted(found[0]), ["report.md", "sizes.png", "sizes.svg", "throughput.png", "throughput.svg"])
        for name in found[0]:
            self.assertEqual(found[0][name], found[1][name], name)

    def test_steps_of_the_four_panels(self):
        self.assertEqual(meshes.chosen_steps(list(range(1, 13))), [3, 6, 9, 12])
        self.assertEqual(meshes.chosen_steps([4, 7]), [4, 7])
        self.assertEqual(meshes.chosen_steps([]), [])

    def test_differing_triangles(self):
        points, triangles = lattice(5)
        rotated = [(b, c, a) for a, b, c in triangles]
        one = meshes.Bunny("x", meshes.Mesh(points, triangles), meshes.Mesh(points, rotated))
        self.assertEqual(one.differing(), [])
        one.paper.triangles = turned(triangles, 8)
        self.assertEqual(len(one.differing()), 4)

    def test_numbers(self):
        shown = {0: "0", 0.26: "0.260", 9.999: "10.0", 12.345: "12.3", 457.17: "457", 4570.4: "4,570",
                 0.00012: "0.000120",
                 1.5e-7: "1.50e-07"}
        for value, text in shown.items():
            self.assertEqual(words.number(value), text)
        self.assertEqual([words.short(n) for n in (8192, 131072, 1e6, 33554432)], ["8192", "131k", "1M", "33.6M"])
        self.assertEqual([words.percent(s) for s in (0, 0.5, 2e-5, None)], ["0 %", "50.0 %", "0.002 %", "–"])
        self.assertEqual(words.table(["a|b"], [["c|d"]]), ["| a\\|b |", "| :--- |", "| c\\|d |", ""])


if __name__ == "__main__":
    unittest.main()


if __name__ == "__main__":
    unittest.main()
