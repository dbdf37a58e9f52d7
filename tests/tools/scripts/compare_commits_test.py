#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/compare_commits: its arithmetic with made-up times, and the whole of it with programs that make times up, with
two commits of a small repository, and with what is built here against itself."""
import contextlib
import importlib.util
import io
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

SOURCE = Path(os.environ.get("CADT_SOURCE", Path(__file__).resolve().parents[3]))
BUILT = os.environ.get("CADT_BUILD_FOLDER", "")
loader = SourceFileLoader("compare_commits", str(SOURCE / "scripts" / "compare_commits"))
script = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare_commits", loader))
loader.exec_module(script)

# Programs that make the times up: `ms` for a call, of which a quarter is copying.
PROGRAM = """#!/usr/bin/env python3
import json, sys
if sys.argv[1] == "devices":
    print(json.dumps({{"devices": [{{"backend": who, "name": "A " + who, "gpu": who == "cuda", "usable": who in {usable}}}
                                 for who in ("host", "opencl", "cuda")]}}))
elif sys.argv[1] == "generate":
    open(sys.argv[sys.argv.index("-o") + 1], "w").write("{points}")
else:
    print(json.dumps({{"mesh": {{"hash": "{hash}"}}}}))
"""
BENCH = """#!/usr/bin/env python3
import json, random, sys
noise = 1 + {noise} * random.random()
said = {{"contestant": sys.argv[sys.argv.index("-w") + 1], "seconds": [noise * {ms} / 1000] * 3,
        "milliseconds": {{"upload": 0.25 * {ms}, "insert": 0.5 * {ms} * noise, "output": {device}, "copy": 0}}}}
json.dump([said], open(sys.argv[sys.argv.index("--json") + 1], "w"))
"""


class Arithmetic(unittest.TestCase):
    STEADY = [10.0, 10.1, 9.9, 10.05, 9.95, 10.0, 10.02]

    def verdict(self, a, b, threshold=0.05):
        return script.judge(a, b, threshold)

    def times(self, factor):
        return [factor * value for value in reversed(self.STEADY)]

    def test_slower_and_faster_and_neither(self):
        for factor, verdict in ((1.2, "slower"), (1 / 1.2, "faster"), (1.0, "no difference"), (1.03, "no difference"),
                                (0.97, "no difference")):
            answer = self.verdict(self.STEADY, self.times(factor))
            self.assertEqual((answer.verdict, answer.noisy), (verdict, False), answer)
            self.assertAlmostEqual(answer.ratio, factor, places=2)
            self.assertLessEqual(answer.low, answer.ratio)
            self.assertGreaterEqual(answer.high, answer.ratio)

    def test_the_threshold_counts(self):
        self.assertEqual(self.verdict(self.STEADY, self.times(1.2), 0.25).verdict, "no difference")
        self.assertEqual(self.verdict(self.STEADY, self.times(1.03), 0.02).verdict, "slower")
        self.assertEqual(self.verdict(self.STEADY, self.times(1 / 1.03), 0.02).verdict, "faster")

    def test_exchanged_sides_give_the_opposite(self):
        there, back = self.verdict(self.STEADY, self.times(1.3)), self.verdict(self.times(1.3), self.STEADY)
        self.assertAlmostEqual(there.ratio * back.ratio, 1)
        self.assertEqual((there.verdict, back.verdict), ("slower", "faster"))

    def test_noise_is_no_difference_and_is_named(self):
        a, b = [10, 30, 11, 28, 10, 31, 29], [12, 31, 29, 12, 33, 30, 11]
        answer = self.verdict(a, b)
        self.assertEqual((answer.verdict, answer.noisy), ("no difference", True), answer)

    def test_a_large_ratio_of_noisy_times_is_none(self):
        answer = self.verdict([10, 30, 11, 28, 10, 31, 11], [12, 31, 29, 12, 33, 30, 11])
        self.assertGreater(answer.ratio, 2)
        self.assertLess(answer.low, 1)
        self.assertEqual((answer.verdict, answer.noisy), ("no difference", True), answer)

    def test_one_outlier_changes_nothing(self):
        answer = self.verdict(self.STEADY, [*self.times(1.0)[:-1], 500.0])
        self.assertEqual(answer.verdict, "no difference")
        self.assertAlmostEqual(answer.ratio, 1, places=2)

    def test_the_interval_holds_the_ratio_and_is_the_same_each_time(self):
        draw = script.random.Random(7)
        a, b = ([draw.uniform(9, 11) for _ in range(30)] for _ in range(2))
        low, high = script.interval(a, b)
        self.assertEqual((low, high), script.interval(a, b))
        self.assertNotEqual((low, high), script.interval(a, b, seed=2))
        ratio = script.ratio_of_medians(a, b)
        self.assertTrue(0.85 < low < 0.98 * ratio and 1.02 * ratio < high < 1.15, (low, ratio, high))

    def test_measures_of_old_and_new_commits(self):
        old = {"seconds": [0.003, 0.001, 0.002], "milliseconds": {"upload": 1, "insert": 2, "output": 3, "copy": 4}}
        self.assertEqual(script.measures_of(old), {"whole": 2, "device": 5})
        self.assertEqual(script.measures_of({**old, "device_seconds": [0.004, 0.006, 0.005]}),
                         {"whole": 2, "device": 5})
        self.assertEqual(script.measures_of({"seconds": [0.001]}), {"whole": 1})


class ScriptTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="cadt-compare-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def fake(self, name, ms=10.0, device=1.0, noise=0.001, mesh="ab", usable=("host",), points="xy"):
        folder = self.folder / name
        (folder / "bin").mkdir(parents=True)
        texts = {"cadt": PROGRAM.format(usable=usable, hash=mesh, points=points),
                 "cadt-bench": BENCH.format(ms=ms, device=device, noise=noise)}
        for program, text in texts.items():
            (folder / "bin" / program).write_text(text)
            (folder / "bin" / program).chmod(0o755)
        return folder

    def compare(self, *arguments, expect=0):
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            code = script.main([*map(str, arguments), "--json", str(self.folder / "out.json")])
        self.assertEqual(code, expect, out.getvalue() + errors.getvalue())
        return out.getvalue() + errors.getvalue()

    def few(self, a, b, *arguments, expect=0):
        said = self.compare(a, b, "-n", "1k", "-d", "uniform", "--rounds", 3, *arguments, expect=expect)
        return said, json.loads((self.folder / "out.json").read_text()) if expect < 2 else None


class MadeUpPrograms(ScriptTest):
    def test_equal_ones(self):
        said, result = self.few(self.fake("a"), self.fake("b"))
        self.assertIn("B is not slower", said)
        self.assertEqual((result["slower"], result["same_meshes"], result["schema"]), (False, True, 1))
        one, = result["results"]
        self.assertEqual((one["backend"], one["device"], one["points"]), ("host", "A host", "1k"))
        self.assertEqual([m["measure"] for m in one["measures"]], ["whole", "device"])
        self.assertEqual({len(m[side]) for m in one["measures"] for side in ("a_ms", "b_ms")}, {3}, "without warm-up")

    def test_a_slower_one(self):
        said, result = self.few(self.fake("a"), self.fake("b", ms=12), expect=1)
        self.assertIn("B is slower", said)
        self.assertAlmostEqual(result["results"][0]["measures"][0]["ratio"], 1.2, places=2)
        said, _ = self.few(self.folder / "b", self.folder / "a")
        self.assertRegex(said, r"host +1k +uniform +whole +12\.\d+ +10\.\d+ +0\.83\d .* faster")
        self.few(self.folder / "a", self.folder / "b", "--threshold", 30)

    def test_slower_on_the_device_only(self):
        said, result = self.few(self.fake("a"), self.fake("b", device=2.0), expect=1)
        self.assertEqual([m["verdict"] for m in result["results"][0]["measures"]], ["no difference", "slower"])
        self.few(self.folder / "a", self.folder / "b", "--measures", "whole")

    def test_another_mesh(self):
        said, result = self.few(self.fake("a"), self.fake("b", mesh="cd"), expect=1)
        self.assertIn("DIFFERENT MESH: host, uniform, 1k points: ab and cd", said)
        self.assertEqual((result["slower"], result["same_meshes"]), (False, False))

    def test_back_ends(self):
        a, b = self.fake("a", usable=("host", "cuda")), self.fake("b", usable=("host", "opencl", "cuda"))
        said, result = self.few(a, b)
        self.assertEqual([one["backend"] for one in result["results"]], ["host", "cuda"])
        self.assertIn("opencl is left out", said)
        said, _ = self.few(a, b, "--backends", "opencl", expect=2)
        self.assertIn(f"opencl is not usable in {a}", said)
        self.assertEqual([one["backend"] for one in self.few(a, b, "--backends", "cuda")[1]["results"]], ["cuda"])

    def test_what_cannot_be_told(self):
        a = self.fake("a")
        self.assertIn("different points", self.few(a, self.fake("b", points="yx"), expect=2)[0])
        self.assertIn("no_such_commit", self.few(a, "no_such_commit", expect=2)[0])
        (self.fake("c") / "bin" / "cadt-bench").write_text("#!/bin/sh\necho what is wrong >&2\nexit 3\n")
        said, _ = self.few(a, self.folder / "c", expect=2)
        self.assertRegex(said, r"ended with 3:\nwhat is wrong")


class Commits(ScriptTest):
    """Two commits of a repository whose programs are made up."""

    def git(self, *arguments):
        return subprocess.run(["git", "-C", str(self.folder / "repository"), "-c", "user.name=a", "-c", "user.email=b",
                               *arguments], check=True, capture_output=True, text=True).stdout.strip()

    def commit(self, **times):
        repository = self.fake("repository", **times)
        (repository / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(made_up NONE)\nfile(COPY bin DESTINATION .)\n"
            "add_custom_target(cadt-bench)\nadd_custom_target(cadt_app)\n")
        if not (repository / ".git").exists():
            self.git("init", "-q")
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "a commit")
        shutil.rmtree(repository / "bin")
        return self.git("rev-parse", "HEAD")

    def test_they_are_built_and_told_apart(self):
        first, second = self.commit(), self.commit(ms=13)
        repository, builds = self.folder / "repository", self.folder / "builds"
        said, result = self.few(first, second, "--repository", repository, "--builds", builds, expect=1)
        self.assertEqual((result["a"], result["b"]), (first[:12], second[:12]))
        self.assertIn(f"building {first[:12]}", said)
        self.assertEqual(len(self.git("worktree", "list").splitlines()), 1, "the sources are gone again")
        said, result = self.few("HEAD~1", "HEAD~1", "--repository", repository, "--builds", builds)
        self.assertNotIn("building", said, "it is there already")
        self.assertEqual(result["a"], f"HEAD~1 ({first[:12]})")


@unittest.skipUnless(BUILT, "CADT_BUILD_FOLDER names no build")
class ThisBuild(ScriptTest):
    def test_is_as_fast_as_itself(self):
        # A call must take longer than a time slice of whatever else runs.
        _, result = self.few(BUILT, BUILT, "-n", "200k", "--backends", "host", "--threshold", 400)
        self.assertRegex(result["results"][0]["hash_a"], "^[0-9a-f]{32}$")
        for measured in result["results"][0]["measures"]:
            self.assertGreater(measured["median_a_ms"], 0)


if __name__ == "__main__":
    unittest.main()
