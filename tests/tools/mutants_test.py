# SPDX-License-Identifier: Apache-2.0
"""scripts/mutants: what it takes for noticed, and what for a table that does not fit. A tool that calls everything noticed
would be worse than none."""
import importlib.machinery
import importlib.util
import pathlib
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "mutants"
loader = importlib.machinery.SourceFileLoader("mutants", str(SCRIPT))
mutants = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutants", loader))
loader.exec_module(mutants)

RECORD = "[a name]\nfile a.cpp\nold x + 1\nnew x\ntest program *\n"


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cadt-mutants-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Table(InAFolder):
    def read(self, text):
        path = self.folder / "mutants.txt"
        path.write_text(text)
        return mutants.read_table(path)

    def test_records(self):
        first, second = self.read("# comment\n" + RECORD + "tier all\n\n[no test]\nfile b.h\nold  && y)\nequivalent why\n")
        self.assertEqual(first[:7], ("a name", "a.cpp", "x + 1", "x", ["program *"], "all", None))
        self.assertEqual((second.old, second.new, second.tests, second.equivalent), ("&& y)", "", [], "why"))

    def test_refuses_what_is_not_complete(self):
        for text in (RECORD.replace("file a.cpp\n", ""), RECORD.replace("old x + 1\n", ""), RECORD.replace("test program *\n", ""),
                     RECORD + "tier third\n", RECORD + "colour red\n", RECORD + "old y\n", RECORD + RECORD, "file a.cpp\n"):
            with self.assertRaises(SystemExit, msg=text):
                self.read(text)

    def test_stale_records(self):
        mutants.ROOT, before = self.folder, mutants.ROOT
        self.addCleanup(setattr, mutants, "ROOT", before)
        record = self.read(RECORD)[0]
        self.assertIn("there is no a.cpp", mutants.staleness(record))
        for text, stale in (("y = x + 1;", ""), ("y = x;", "0 times"), ("x + 1; x + 1;", "2 times")):
            (self.folder / "a.cpp").write_text(text)
            self.assertIn(stale, mutants.staleness(record) or "")
            self.assertEqual(bool(stale), bool(mutants.staleness(record)))
        (self.folder / "a.cpp").write_text("y = x + 1;")
        self.assertIn("changes nothing", mutants.staleness(record._replace(new=record.old)))

    def test_the_table_of_this_tree_fits(self):
        table = mutants.read_table(mutants.TABLE)
        self.assertGreaterEqual(len(table), 44)
        self.assertEqual([m.name for m in table if mutants.staleness(m)], [])


class Outcomes(InAFolder):
    """Programs that behave as tests do."""

    def setUp(self):
        super().setUp()
        for name in ("BUILD", "WORK"):
            self.addCleanup(setattr, mutants, name, getattr(mutants, name))
            setattr(mutants, name, self.folder)
        (self.folder / "bin").mkdir()

    def outcome(self, text, seconds=20):
        program = self.folder / "bin" / "program"
        program.write_text("#!/bin/sh\n" + text)
        program.chmod(0o755)
        return tuple(mutants.run("program *", seconds))

    def test_passed(self):
        self.assertEqual(self.outcome("echo '[ RUN      ] A.B'; echo '[  PASSED  ] 1 test.'"), ("passed", ""))

    def test_noticed(self):
        run = "echo '[ RUN      ] A.B'; "
        self.assertEqual(self.outcome(run + "echo '[  FAILED  ] A.B, where x = 1 (3 ms)'; exit 1"), ("failed", "A.B"))
        self.assertEqual(self.outcome(run + "exit 3"), ("failed", "exit 3: A.B"))
        self.assertEqual(self.outcome(run + "kill -SEGV $$"), ("failed", "signal 11: A.B"))
        self.assertEqual(self.outcome(run + "sleep 60", seconds=5), ("failed", "hung: A.B"))

    def test_nothing_ran(self):
        self.assertEqual(self.outcome("echo '[==========] 0 tests from 0 test suites ran.'; echo '[  PASSED  ] 0 tests.'")[0], "empty")
        self.assertEqual(self.outcome("echo '[  SKIPPED ] A.B'; echo '[  PASSED  ] 0 tests.'")[0], "skipped")

    def test_pytest(self):
        self.assertEqual(mutants.of_pytest(0, "===== 2 passed, 1 skipped in 0.1s =====").kind, "passed")
        self.assertEqual(mutants.of_pytest(0, "===== 1 skipped in 0.1s =====").kind, "skipped")
        self.assertEqual(mutants.of_pytest(4, "ERROR: not found: test_x.py::test_y").kind, "empty")
        self.assertEqual(mutants.of_pytest(5, "no tests ran").kind, "empty")
        failed = "FAILED ../python/tests/test_x.py::test_y[host] - AssertionError"
        self.assertEqual(tuple(mutants.of_pytest(1, failed)), ("failed", "test_x.py::test_y[host]"))
        self.assertEqual(tuple(mutants.of_pytest(-11, "")), ("failed", "signal 11"))
        self.assertEqual(tuple(mutants.of_pytest(None, "")), ("failed", "hung"))
        self.assertEqual(mutants.targets_of("pytest test_x.py"), ["cadt_python"])

    def test_ctest(self):
        self.assertEqual(mutants.of_ctest(0, "100% tests passed").kind, "passed")
        self.assertEqual(mutants.of_ctest(8, "No tests were found!!!").kind, "empty")
        self.assertEqual(mutants.of_ctest(0, "1/1 Test #1: cli.X ....***Skipped   0.1 sec").kind, "skipped")
        failed = "1/1 Test #9: cli.Files ....***Failed  1.0 sec\nFAIL: test_full_disk (__main__.Files)"
        self.assertEqual(tuple(mutants.of_ctest(8, failed)), ("failed", "cli.Files.test_full_disk"))
        self.assertEqual(tuple(mutants.of_ctest(None, "    Start 9: cli.Files")), ("failed", "hung: cli.Files"))


if __name__ == "__main__":
    unittest.main()
