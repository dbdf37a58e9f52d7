# SPDX-License-Identifier: Apache-2.0
"""What the tests of the report share: it needs matplotlib, and each test has a folder of its own."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib.image  # noqa: F401
except ImportError as error:
    print(f"skipped: matplotlib is not there ({error}; package python3-matplotlib)")
    sys.exit(77)

SOURCE = Path(os.environ.get("CADT_SOURCE", Path(__file__).resolve().parents[3]))
REPORT = SOURCE / "bench" / "report" / "report.py"
sys.path[:0] = [str(REPORT.parent), str(Path(__file__).resolve().parent)]

from synthetic import Writer  # noqa: E402

TITLES = ("Time against points (Table 3)", "Block size and occupancy (Fig. 4 and 5)", "Where the time goes (Fig. 6)",
          "Distributions and real sets (Fig. 7)", "The mesh while it grows (Fig. 8)", "Flips an edge (Fig. 9 and 10)",
          "Time against R (Fig. 11)", "Other works (Table 4)", "The Stanford bunny (Fig. 12)",
          "What the statistics cost and count", "Every device", "The kernels of a run")


def run(*arguments: object, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", str(REPORT), *map(str, arguments)], capture_output=True, text=True,
                          timeout=250, env={**os.environ, **(environment or {})})


def section(text: str, title: str) -> str:
    """What the report has under a title."""
    return text.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


class FolderTest(unittest.TestCase):
    """Each test has its own folder."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="cadt-report-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = self.folder / "out"

    def report(self, *folders: Path) -> str:
        done = run(*folders, "--out", self.out)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return (self.out / "report.md").read_text(encoding="utf-8")

    def writer(self, name: str = "one") -> Writer:
        """A machine without rows."""
        return Writer(self.folder / name, name, {"host": ["A Processor"], "cuda": ["A Card"], "opencl": ["A Card"]}, 1)
