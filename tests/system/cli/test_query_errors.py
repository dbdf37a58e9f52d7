# SPDX-License-Identifier: Apache-2.0
"""What the commands that ask a mesh refuse and show, and what their page says."""
import math
import re
import signal
import unittest

from answers import npy_bytes
from documentation import DocumentationTest
from harness import SOURCE, CliTest


class QueryErrors(CliTest):
    """Each says what to do, has its exit code, and leaves nothing."""

    def setUp(self):
        super().setUp()
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n")
        self.write("p.xy", "0 0\n1 0\n0 1\n")
        self.write("q.xy", "0.2 0.2\n")
        self.before = self.names()

    def tearDown(self):
        self.assertEqual(self.names(), self.before)
        super().tearDown()

    def test_outputs(self):
        self.fails(2, "locate", "p.xy", "q.xy", "-o", "a.off", says=["unknown suffix '.off'", "csv, txt, npy, npz"])
        self.fails(2, "voronoi", "p.xy", "-o", "a.csv", says="npz, geojson, svg")
        self.fails(2, "raster", "p.xyz", "--res", "1", "-o", "a.gif", says="asc, npy, png")
        self.fails(2, "raster", "p.xyz", "--res", "1", says="--output")
        self.fails(2, "raster", "p.xyz", "--res", "1", "-o", "-", says="-t asc")
        self.fails(2, "voronoi", "p.xy", says="--output")
        self.fails(2, "locate", "p.xy", "q.xy", "-o", "q.xy", "-t", "txt", says="this is the input")
        self.fails(2, "interpolate", "p.xy", "q.xy", "--values", "p.xyz", "-o", "p.xyz", says="this is the input")
        self.fails(3, "locate", "p.xy", "q.xy", "-o", "none/a.csv", says="there is no folder")
        self.fails(2, "locate", "p.xy", "q.xy", "--barycentric", "-o", "a.npy", says="write an .npz or a .csv")

    def test_options(self):
        self.fails(2, "locate", "p.xy", says="QUERIES")
        self.fails(2, "locate", "-", "-", "-f", "xy", says="only one of POINTS and QUERIES")
        self.fails(2, "locate", "p.xy", "q.xy", "-k", "3", says="--nearest")
        self.fails(2, "locate", "p.xy", "q.xy", "--nearest", "-k", "0", says="-k")
        self.write("many.xy", "0.2 0.2\n" * 3000)
        self.before = sorted(self.before + ["many.xy"])
        self.fails(2, "locate", "p.xy", "many.xy", "--nearest", "-k", "1000000", says="3000000000 results")
        self.write("many.xy", "0.2 0.2\n" * 4096)  # 2^31 results, one too many
        self.fails(2, "locate", "p.xy", "many.xy", "--nearest", "-k", "524288", says=["2147483648 results", "at most 2147483647"])
        self.fails(2, "locate", "p.xy", "q.xy", "--nearest", "--barycentric", says="leave one of them out")
        self.fails(2, "interpolate", "p.xyz", "q.xy", "--method", "cubic", says="--method")
        self.fails(2, "interpolate", "p.xyz", "q.xy", "--values", "-", says="not standard input")
        self.fails(2, "raster", "p.xyz", "-o", "a.asc", says="--res")
        for wrong in ("0", "-1", "nan", "inf"):
            self.fails(2, "raster", "p.xyz", f"--res={wrong}", "-o", "a.asc", says="--res")
        self.fails(2, "raster", "p.xyz", "--res", "1", "--nodata", "0", "-o", "a.npy", says="--nodata belongs to .asc")
        self.fails(2, "raster", "p.xyz", "--res", "1", "--max-edge=-1", "-o", "a.npy", says="--max-edge")
        for wrong in ("1,2,3", "0,0,1,x", "0,0,1,1,", "0,0,1,inf", "0;0;1;1", "nan,0,1,1"):
            self.fails(2, "raster", "p.xyz", "--res", "1", "--bounds", wrong, "-o", "a.asc", says="four numbers")
            self.fails(2, "voronoi", "p.xyz", "--box", wrong, "-o", "a.svg", says="four numbers")
        self.fails(2, "voronoi", "p.xy", "--box", "1,0,0,1", "-o", "a.svg", says="x0 < x1")
        self.fails(5, "locate", "p.xy", "q.xy", "--backend", "host", "--device", "none", says="none")
        self.fails(6, "locate", "p.xy", "q.xy", "--max-memory", "10", says="--max-memory")

    def test_grids(self):
        self.write("line.xyz", "0 0 1\n0 1 2\n0 2 3\n")
        self.before.append("line.xyz")
        self.before.sort()
        self.fails(2, "raster", "line.xyz", "--res", "1", "-o", "a.asc", says=["no cells", "--bounds"])
        self.fails(2, "raster", "p.xyz", "--res", "1e-6", "-o", "a.asc", says=["1000000 x 1000000 cells", "larger --res"])
        self.fails(2, "raster", "p.xyz", "--res", "1", "--bounds", "0,0,46341,46341", "-o", "a.asc",
                   says=["46341 x 46341 cells, at most 2147483647", "larger --res"])
        self.fails(2, "raster", "p.xyz", "--res", "1e-320", "-o", "a.asc", says="larger --res")
        self.fails(3, "raster", "p.xyz", "--res", "1e-5", "--bounds", "0,0,1,1e-5", "-o", "a.png", says="too many for a picture")

    def test_values(self):
        self.fails(3, "interpolate", "p.xy", "q.xy", says=["p.xy: no values", "--values FILE"])
        self.fails(3, "raster", "p.xy", "--res", "1", "-o", "a.asc", says="no values")
        files = {"two.txt": ("1\n2\n", "two.txt: 2 rows of values for the 3 points of p.xy"),
                 "word.txt": ("1\nx\n3\n", "word.txt:2: column 1"),
                 "nan.txt": ("1\nnan\n3\n", "nan.txt:2: column 1"),
                 "ragged.csv": ("1,2\n1\n1,2\n", "ragged.csv:2: the line has 1 fields"),
                 "head.csv": ("a,b\n", "only a header"),
                 "none.txt": ("", "none.txt: is empty")}
        for name, (text, says) in files.items():
            self.write(name, text)
            self.fails(3, "interpolate", "p.xy", "q.xy", "--values", name, says=says)
        arrays = {"nan.npy": (npy_bytes("<f8", (3,), "d", [1, math.nan, 3]), "nan.npy: byte "),
                  "bool.npy": (npy_bytes("|b1", (3,), "B", [1, 0, 1]), "float32, float64 or integers"),
                  "cube.npy": (npy_bytes("<f8", (3, 1, 1), "d", [1, 2, 3]), "(n,) or (n, m)")}
        for name, (data, says) in arrays.items():
            self.path(name).write_bytes(data)
            self.fails(3, "interpolate", "p.xy", "q.xy", "--values", name, says=says)
        self.write("pair.csv", "1,2\n3,4\n5,6\n")
        self.fails(3, "raster", "p.xy", "--values", "pair.csv", "--res", "1", "-o", "a.asc", says="2 values a point")
        self.fails(2, "interpolate", "p.xy", "q.xy", "--values", "pair.csv", "-o", "a.xyz", says="room for one")
        self.fails(3, "interpolate", "p.xy", "q.xy", "--values", "absent.txt", says="absent.txt")
        self.before = sorted(self.before + list(files) + list(arrays) + ["pair.csv"])

    def test_queries(self):
        self.write("bad.xy", "0 0\n1 nan\n")
        self.before = sorted(self.before + ["bad.xy"])
        self.fails(3, "locate", "p.xy", "bad.xy", says="bad.xy:2: ")
        self.fails(3, "locate", "p.xy", "absent.xy", says="absent.xy")

    def test_coordinates_that_natural_neighbours_do_not_take(self):
        self.write("w.xyz", "0 0 1\n1e300 0 2\n0 1e-300 3\n")
        self.before = sorted(self.before + ["w.xyz"])
        self.fails(3, "interpolate", "w.xyz", "q.xy", "--method", "natural", says="w.xyz: natural neighbours need")
        self.fails(3, "raster", "w.xyz", "--res", "1e299", "--bounds", "0,0,1e300,1e300", "--method", "natural",
                   "-o", "a.asc", says="w.xyz: natural neighbours need")

    def test_a_failure_while_writing_keeps_the_old_file(self):
        self.write("a.asc", "old")
        self.before = sorted(self.before + ["a.asc"])
        self.fails(3, "raster", "p.xyz", "--res", "0.25", "--method", "nearest", "--nodata", "3", "-o", "a.asc",
                   says=["a.asc: a cell has the value 3", "--nodata"])
        self.assertEqual(self.path("a.asc").read_text(), "old")


class QueryProgress(CliTest):
    def test_line_on_a_terminal_none_in_a_pipe(self):
        self.scattered("p.f64", 1000000)
        self.write("q.xy", "1.5 1.5\n")
        arguments = ["p.f64", "q.xy", "-o", "t.txt", "--backend", "host", "--threads", "1"]
        with self.on_terminal("locate", *arguments) as (process, terminal):
            text = terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 0)
        self.assertRegex(text, r"\r[a-z]+ +\d+ %  [\d.]+[Mk]? points/s")
        self.assertRegex(text, r"\r +\rpoints      1000000\r\n")
        self.assertNotIn("\r", self.cadt("locate", *arguments).err)
        self.assertEqual(self.cadt("locate", *arguments, "-q").err, "")


class QueryInterruption(CliTest):
    def test_leaves_nothing(self):
        self.scattered("p.f64", 1000000)
        self.path("v.npy").write_bytes(npy_bytes("<f8", (1000000,), "d", [1.0] * 1000000))
        with self.on_terminal("raster", "p.f64", "--values", "v.npy", "--method", "natural", "--res", "0.0002", "-o",
                              "d.npy", "--backend", "host") as (process, terminal):
            terminal.wait_for("filling the cells")
            process.send_signal(signal.SIGINT)
            terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 130, terminal.text)
        self.assertEqual(self.names(), ["p.f64", "v.npy"])


class QueryDocumentation(DocumentationTest):
    """docs/queries.md shows what is."""

    def setUp(self):
        super().setUp()
        self.text = (SOURCE / "docs" / "queries.md").read_text()

    def test_commands_have_the_output_that_is_shown(self):
        self.assertEqual(self.run_commands(self.text), 9)

    def test_programs_are_the_examples(self):
        shown = re.findall(r"```cpp\n(.*?)```", self.text, re.S)
        files = [(SOURCE / "examples" / name).read_text() for name in ("queries.cpp", "device_queries.cpp")]
        self.assertEqual(shown, [text[text.index("#include"):] for text in files])


if __name__ == "__main__":
    unittest.main()
