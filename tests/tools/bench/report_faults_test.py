#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the report of the benchmarks says of folders that are broken or not complete."""
import csv
import json
import shutil
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from report_folder import FolderTest, TITLES, run, section  # noqa: E402, first: it sets the path
import words  # noqa: E402
from rows import EXPERIMENTS  # noqa: E402
from synthetic import COLUMNS, write_machine  # noqa: E402


class Broken(FolderTest):
    """Whatever is wrong is named, and the rest is reported."""

    def test_an_empty_folder(self):
        (self.folder / "nothing").mkdir()
        text = self.report(self.folder / "nothing")
        for experiment, title in zip(EXPERIMENTS, TITLES):
            self.assertIn(f"**nothing: {experiment}.csv is missing (No such file or directory)**", section(text, title))
            self.assertIn("Nothing was measured.", section(text, title))
        self.assertIn("machine.json is missing", text)
        self.assertEqual([path.name for path in self.out.iterdir()], ["report.md"])

    def one_experiment(self, experiment: str = "sizes") -> Path:
        writer = self.writer()
        for points in (8192, 65536):
            for who, device in (("cgal", ""), *writer.everyone()):
                writer.row(experiment, who, device, points)
        writer.write()
        return writer.folder / f"{experiment}.csv"

    def test_a_file_that_is_cut_off(self):
        file = self.one_experiment()
        whole = file.read_text()
        lines = whole.splitlines(keepends=True)
        for cut in (whole[:-len(lines[-1]) // 2], whole[:-1], "".join(lines[:-1]) + "sizes,uni\n"):
            file.write_text(cut)
            text = section(self.report(file.parent), TITLES[0])
            self.assertRegex(text, r"\*\*one: sizes.csv: (ends in the middle of|2 of \d+ fields in) row 9, which is ")
            self.assertRegex(text, r"(?m)^\| 65,536 \| [\d.]+ \| [^|]+ \| – \|",
                             "the last row is gone, the others are not")

    def test_only_a_heading_and_not_even_that(self):
        file = self.one_experiment()
        for left in (",".join(COLUMNS) + "\n", ""):
            file.write_text(left)
            self.assertIn("**one: sizes.csv has no rows**", section(self.report(file.parent), TITLES[0]))

    def test_columns_that_are_not_there(self):
        file = self.one_experiment()
        with open(file, newline="") as opened:
            rows = list(csv.DictReader(opened))
        with open(file, "w", newline="") as opened:
            writer = csv.DictWriter(opened, [c for c in COLUMNS if c not in ("device_ms", "min_ms")],
                                    extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)
        text = section(self.report(file.parent), TITLES[0])
        self.assertIn("**one: sizes.csv lacks the columns min_ms, device_ms**", text)
        self.assertIn(f"| {words.number(float(rows[0]['median_ms']))} |", text)

    def test_cells_that_are_no_numbers(self):
        all_of_them = ("?", "nan", "1e999", "a=b;c", "", "1e5", "-1")
        for number, values in enumerate((("-1",), ("0",), all_of_them)):
            writer = write_machine(self.folder / f"m{number}", "m", {"cuda": ["A Card"]})
            for rows in writer.rows.values():
                for index, row in enumerate(rows):
                    numbers = [c for c in row if c not in ("experiment", "distribution", "who", "device", "stabilize")]
                    for column in numbers[index % 3::3]:
                        row[column] = values[(index + len(column)) % len(values)]
            writer.write()
            done = run(writer.folder, "--out", self.out)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_machine_json(self):
        file = self.one_experiment().parent / "machine.json"
        for content in ("{", "[]", json.dumps({"devices": 3, "peers": [1], "memory_bytes": "much"})):
            file.write_text(content)
            self.report(file.parent)

    def test_two_folders_of_one_name_stay_two(self):
        file = self.one_experiment()
        shutil.copytree(file.parent, self.folder / "again")
        text = self.report(file.parent, self.folder / "again")
        self.assertIn("### one (one): times", text)
        self.assertIn("### one (again): times", text)

    def test_meshes_that_are_cut_off(self):
        writer = write_machine(self.folder / "one", "one", {"cuda": ["A Card"]})
        step, mesh = writer.folder / "snapshots" / "step-8.csv", writer.folder / "bunny" / "bunny_res3-paper.tri"
        step.write_text(step.read_text().rsplit(",", 1)[0])
        mesh.write_text("0,1,400\n" + mesh.read_text())
        (writer.folder / "bunny" / "bunny_res2.xy").unlink()
        text = self.report(writer.folder)
        self.assertIn("snapshots/step-8.csv: line 722 has no 3 numbers and is left out", text)
        self.assertIn("bunny/bunny_res3-paper.tri: 1 triangles of points that are not there are left out", text)
        self.assertIn("one, bunny_res4: ", text)
        self.assertNotIn("one, bunny_res2: ", text)

    def test_arguments(self):
        done = run(self.folder / "no such folder", "--out", self.out)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no such folder", done.stderr)

    def test_without_matplotlib(self):
        (self.folder / "matplotlib.py").write_text("raise ImportError('not here')\n")
        done = run(self.folder, "--out", self.out, environment={"PYTHONPATH": str(self.folder)})
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^report: error: matplotlib .*not here.*python3-matplotlib")


if __name__ == "__main__":
    unittest.main()
