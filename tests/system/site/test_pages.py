# SPDX-License-Identifier: Apache-2.0
"""Every command and every program in C++ on the pages of the site does what is shown beside it."""
import gzip
import json
import pathlib
import re
import struct
import subprocess
import sys
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "cli"))
from documentation import DocumentationTest
from harness import PROGRAM, SECONDS, SOURCE

SITE = SOURCE / "docs" / "site"
sys.path.insert(0, str(SITE / "tools"))
import pages
import pictures


class PageTest(DocumentationTest):
    def programs(self, page):
        """Runs the programs of a page. Behind each that prints stands a block with what it prints."""
        blocks = pages.of_page(page)
        count = 0
        for block, after in zip(blocks, [*blocks[1:], None]):
            if block.language != "cpp":
                continue
            self.assertTrue(block.caption, f"{page}:{block.line}: a program needs a caption, its name")
            count += 1
            program = pathlib.Path(PROGRAM).parent / f"cadt-site-{page.stem}.{pathlib.Path(block.caption).stem}"
            done = subprocess.run([program], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            if after is not None and after.language == "text":
                self.same_words(after.text, done.stdout)
        return count


class StartPage(PageTest):
    def setUp(self):
        super().setUp()
        self.blocks = pages.of_page(SITE / "index.md")

    def test_the_shell_tab(self):
        for block in self.blocks:
            if block.tab == "Shell":
                self.run_commands(f"```console\n{block.text}```")
        self.assertEqual(self.names(), ["hills.ply", "hills.png", "hills.xyz", "where.xy"])

    def test_the_programs_picture_is_that_of_the_shell_and_of_the_page(self):
        self.assertEqual(self.programs(SITE / "index.md"), 1)
        picture = self.path("hills.png").read_bytes()
        self.test_the_shell_tab()
        self.assertEqual(picture, self.path("hills.png").read_bytes())
        self.assertLess(pictures.difference(self.path("hills.png"), SITE / "figures" / "hills.png"), 0.01)

    def test_the_tabs_are_three(self):
        self.assertEqual(list(dict.fromkeys(block.tab for block in self.blocks)), ["Python", "C++", "Shell"])


class IndentedCommands(PageTest):
    """The lines of README.md and docs/cli.md that begin with `cadt`, but for synopses, run with files of the names
    that they have. Points are fewer, to save time; LAS and GeoTIFF are for the Python package's tests."""

    def setUp(self):
        super().setUp()
        rows = [(i % 7 + 0.013 * i, i // 7 - 0.021 * i, 1 + i % 5) for i in range(70)]
        self.write("survey.csv", "lon,lat,easting,northing,depth\n" + "".join(f"{x},{y},{x},{y},{z}\n" for x, y, z in rows))
        self.write("stations.csv", "lon,lat\n" + "".join(f"{x},{y}\n" for x, y, _ in rows))
        self.write("dots.node", "5 2 0 0\n1 0 0\n2 4 0\n3 4 3\n4 0 3\n5 2 1\n")
        self.write("path.xy", "0.5 0.5\n0.6 0.5\n")
        self.write("where.xy", "0.5 0.5\n")
        text = "".join(f"{x} {y}\n" for x, y, _ in rows)
        self.write("points.xy", text)
        self.path("points.txt.gz").write_bytes(gzip.compress(text.encode()))
        self.shell("cadt generate terrain -n 2000 -q -o terrain.xyz")
        self.write_segments()
        for scan in ("scan_1.npy", "scan_2.npy"):
            self.shell(f"cadt generate uniform -n 500 -q -o {scan}")

    def write_segments(self):
        """A plate with a hole, two countries, breaklines of the terrain, and an image of two grains."""
        corners = [(0, 0), (4, 0), (4, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
        sides = [(1, 2), (2, 3), (3, 4), (4, 1), (5, 6), (6, 7), (7, 8), (8, 5)]
        self.write("plate.poly", "8 2 0 0\n" + "".join(f"{i + 1} {x} {y}\n" for i, (x, y) in enumerate(corners)) +
                   "8 0\n" + "".join(f"{i + 1} {a} {b}\n" for i, (a, b) in enumerate(sides)) + "1\n1 1.5 1.5\n")
        square = lambda x: [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]]]
        for name in ("land.geojson", "countries.geojson"):
            self.write(name, json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": square(x)}}
                for x in (0, 3)]}))
        self.write("breaklines.obj", "v 0.1 0.2 1\nv 0.5 0.6 1\nv 0.9 0.6 2\nl 1 2 3\n")
        rows = b"".join(b"\0" + bytes(1 + (i + j > 12) for i in range(12)) for j in range(10))
        chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        self.path("grains.png").write_bytes(
            b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 12, 10, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))

    def run_lines(self, path):
        count = 0
        for line in re.findall(r"(?m)^    ((?:zcat .* \| )?cadt .*)$", path.read_text()):
            command = line.split(" # ")[0].strip()
            if re.search(r"[\[\]]|\b[A-Z]{2,}\b|\.\.\.|\.la[sz]\b|\.tif", re.sub(r"-?\w*\d\w*", "", command)):
                continue
            if re.search(r"  +", command):  # a synopsis with its explanation
                continue
            count += 1
            if command.startswith("cadt render"):  # smaller and shorter
                command = re.sub(r" --(size|fps|seconds) \S+", "", command) + " --size 200"
                if re.search(r"\.mp4|frames/", command):
                    command += " --seconds 1 --fps 4"
            self.shell(re.sub(r"(-n \w*1)M\b", r"\g<1>0000", command))
        return count

    def test_the_readme(self):
        self.assertGreaterEqual(self.run_lines(SOURCE / "README.md"), 10)

    def test_the_programs_page(self):
        self.assertGreaterEqual(self.run_lines(SOURCE / "docs" / "cli.md"), 8)

    def test_the_page_on_segments(self):
        self.assertGreaterEqual(self.run_lines(SOURCE / "docs" / "constrained.md"), 3)


class FirstBlocks(PageTest):
    """Python on the start page and in the READMEs. Each document's blocks are one program."""

    def run_python(self, text):
        program = self.write("blocks.py", text)
        done = subprocess.run([sys.executable, program], cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_python_tab(self):
        program, = (block.text for block in pages.of_page(SITE / "index.md") if block.language == "python")
        self.assertRegex(self.run_python(program), r"^3982 triangles; in the middle: \[-0\.11428\d+\]\n$")
        self.assertLess(pictures.difference(self.path("hills.png"), SITE / "figures" / "hills_python.png"), 4)

    def test_the_readmes(self):
        count = 0
        for readme in (SOURCE / "README.md", SOURCE / "python" / "README.md"):
            blocks = re.findall(r"(?ms)^```python\n(.*?)^```", readme.read_text())
            count += len(blocks)
            self.run_python("\n".join(blocks))
        self.assertGreaterEqual(count, 1)


class Pages(PageTest):
    def test_commands(self):
        count = 0
        for page in sorted([*SITE.glob("*.md"), *SITE.glob("coming_from/*.md")]):
            if page.stem != "index":
                with self.subTest(page=page.name):
                    count += self.run_commands(page.read_text())
        self.assertEqual(count, 8)

    def test_programs(self):
        count = 0
        for page in sorted(SITE.glob("coming_from/*.md")):
            with self.subTest(page=page.name):
                count += self.programs(page)
        self.assertGreaterEqual(count, 2)

    def test_no_block_is_left_out(self):
        """Each language is one that a test runs (Python: sybil), or output and files that are shown."""
        for page in sorted(SITE.rglob("*.md")):
            for block in pages.of_page(page):
                self.assertIn(block.language, ["console", "cpp", "cmake", "python", "text"], f"{page}:{block.line}")


if __name__ == "__main__":
    unittest.main()
