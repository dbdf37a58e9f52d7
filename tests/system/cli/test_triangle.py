# SPDX-License-Identifier: Apache-2.0
"""cadt triangle as those meet it who come from Triangle."""
import importlib.util
import random
import unittest

from harness import SOURCE, CliTest

FOUR = "4 2 1 1\n1 0 0 5 0\n2 4 0 6 0\n3 4 2 7 12\n4 0 3 8 0\n"


def node_text(points, base=0):
    return f"{len(points)} 2 0 0\n" + "".join(f"{i + base} {x!r} {y!r}\n" for i, (x, y) in enumerate(points))


def rows(path):
    """The numbers of a file without its header, as lists of text."""
    lines = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    return [line for line in lines if line][1:]


class TriangleCommand(CliTest):
    def test_writes_what_the_switches_ask_for(self):
        self.write("dots.node", FOUR)
        result = self.cadt("triangle", "-nev", "dots")
        self.assertEqual(self.names(), ["dots.1.edge", "dots.1.ele", "dots.1.neigh", "dots.1.node", "dots.1.v.edge",
                                        "dots.1.v.node", "dots.node"])
        self.assertEqual(result.err, "")
        self.assertIn("cadt: wrote dots.1.v.edge\n", result.out)
        self.assertRegex(result.out, r"(?m)^triangles   2$")
        self.assertRegex(result.out, r"(?m)^edges       5$")
        self.assertEqual(rows(self.path("dots.1.ele")), [["1", "1", "2", "3"], ["2", "1", "3", "4"]])
        self.assertEqual(rows(self.path("dots.1.node"))[2], ["3", "4", "2", "7", "12"])
        self.assertEqual(rows(self.path("dots.1.node"))[3], ["4", "0", "3", "8", "1"])

    def test_switches_stand_anywhere(self):
        self.write("dots.node", FOUR)
        self.cadt("triangle", "-n", "dots.node", "-eQ", "-N")
        self.assertEqual(self.names(), ["dots.1.edge", "dots.1.ele", "dots.1.neigh", "dots.node"])

    def test_iterations_go_on(self):
        self.write("dots.node", FOUR)
        self.cadt("triangle", "dots")
        self.cadt("triangle", "-Q", "dots.1")
        self.assertEqual(self.path("dots.2.ele").read_text(), self.path("dots.1.ele").read_text())
        self.assertEqual(self.path("dots.2.node").read_text(), self.path("dots.1.node").read_text())
        before = self.path("dots.node").read_text()
        self.cadt("triangle", "-QIe", "dots")
        self.assertTrue(self.path("dots.ele").exists() and self.path("dots.edge").exists())
        self.assertEqual(self.path("dots.node").read_text(), before)

    def test_cadt_reads_what_it_writes(self):
        generator = random.Random(3)
        self.write("dots.node", node_text([(generator.random(), generator.random()) for _ in range(500)], 1))
        self.cadt("triangle", "-nevg", "dots")
        self.cadt("verify", "dots.1.node", "dots.1.ele", "--canonical")
        self.cadt("verify", "dots.1.node", "dots.1.off")
        self.cadt("info", "dots.1.v.node")

    def test_quiet_and_verbose(self):
        self.write("dots.node", FOUR)
        quiet = self.cadt("triangle", "-QiFls", "dots")
        self.assertEqual((quiet.out, quiet.err), ("", ""))
        self.assertNotIn("launches", self.cadt("triangle", "dots").out)
        self.assertRegex(self.cadt("triangle", "-V", "dots").out, r"(?m)^launches +\d")

    def test_switches_without_effect_say_so(self):
        self.write("dots.node", FOUR)
        plain = self.cadt("triangle", "dots")
        self.assertEqual(plain.err, "")
        text = self.path("dots.1.ele").read_text()
        err = self.cadt("triangle", "-iFls", "dots").err
        for letter in "iFls":
            self.assertRegex(err, rf"(?m)^cadt: -{letter} has no effect: \S")
        self.assertEqual(self.path("dots.1.ele").read_text(), text)

    def test_others_are_refused(self):
        self.write("dots.node", FOUR)
        for switches in ["r", "q", "q30", "a.1", "u", "A", "D", "Y", "X", "o2", "C", "O", "S5", "T", "w"]:
            self.fails(8, "triangle", "-ne" + switches, "dots", says=[f"-{switches[0]} ", "cadt triangle --help"])
        self.fails(8, "triangle", "-rq", "dots", says=["-r refines", "-q adds"])
        self.fails(8, "triangle", "-ps", "dots", says="-s splits segments")
        for file, switch in [("dots.1.ele", "-r"), ("dots.area", "-ra")]:
            self.fails(8, "triangle", file, says=[file, f"stands for {switch}:"])
        self.assertEqual(self.names(), ["dots.node"])

    def test_wrong_command_lines(self):
        self.write("dots.node", FOUR)
        self.fails(2, "triangle", says="a file is missing")
        self.fails(2, "triangle", "-ne", says="a file is missing")
        self.fails(2, "triangle", "dots", "more", says="2 files are named: dots, more")
        self.fails(2, "triangle", "dots", "--quiet", says="no option '--quiet'")
        self.fails(2, "triangle", "dots", "--backend", "abacus", says="--backend")
        self.fails(3, "triangle", "absent", says="absent.node: ")
        self.fails(3, "triangle", "dots.", says="dots..node: ")
        self.write("wrong.node", "2 2 0 1\n1 0 0 1\n2 1 1\n")
        self.fails(3, "triangle", "wrong", says="wrong.node:3: ")
        self.path("dots.1.ele").mkdir()
        self.fails(3, "triangle", "dots", says="dots.1.ele: is a folder")
        self.assertEqual(self.names(), ["dots.1.ele", "dots.node", "wrong.node"])

    def test_help_is_help_among_other_switches(self):
        text = self.cadt("triangle", "--help").out
        self.assertIn("-v  Voronoi diagram", text)
        for arguments in (["-h"], ["-Qh"], ["-neh", "dots"], ["dots", "-hV"]):
            self.assertEqual(self.cadt("triangle", *arguments).out, text)

    def test_where_to_compute(self):
        self.write("dots.node", FOUR)
        self.cadt("triangle", "-V", "dots", "--backend", "host", "--threads", "1")
        self.fails(5, "triangle", "dots", "--backend", "host", "--device", "none", says="none")

    def test_points_on_a_line_and_duplicates(self):
        self.write("line.node", node_text([(0, 0), (1, 1), (2, 2)]))
        result = self.cadt("triangle", "-ne", "line")
        self.assertIn("cadt: warning: line.node: no triangles", result.err)
        self.assertEqual(rows(self.path("line.1.ele")), [])
        self.assertEqual(len(rows(self.path("line.1.node"))), 3)
        self.write("twice.node", node_text([(0, 0), (1, 0), (0, 1), (1, 0)]))
        self.assertRegex(self.cadt("triangle", "twice").out, r"(?m)^duplicates  1$")
        self.assertEqual([row[-1] for row in rows(self.path("twice.1.node"))], ["1", "1", "1", "0"])
        self.cadt("triangle", "-j", "twice")
        self.assertEqual(len(rows(self.path("twice.1.node"))), 3)

    def test_documentation_has_every_switch(self):
        text = (SOURCE / "docs" / "triangle.md").read_text()
        for letter in "nevcgjzBPNEIQVhiFlsprqauDAYSOXoC":
            self.assertRegex(text, rf"`-[A-Za-z]*{letter}[A-Za-z0-9]*`|`-{letter}", letter)


BOX = ("# a box with a hole, of the examples of Triangle\n8 2 0 1\n1 0 0 0\n2 0 3 0\n3 3 0 0\n4 3 3 33\n5 1 1 0\n6 1 2 0\n7 2 1 0\n"
       "8 2 2 0\n5 1\n1 1 2 5\n2 5 7 0\n3 7 8 0\n4 8 6 10\n5 6 5 0\n1\n1 1.5 1.5\n")


class TriangleSegments(CliTest):
    def setUp(self):
        super().setUp()
        self.write("box.poly", BOX)

    def test_hull_and_hole(self):
        result = self.cadt("triangle", "-pce", "box")
        self.assertEqual(self.names(), ["box.1.edge", "box.1.ele", "box.1.node", "box.1.poly", "box.poly"])
        self.assertEqual(len(rows(self.path("box.1.ele"))), 8)
        self.assertEqual([row[-1] for row in rows(self.path("box.1.node"))], ["5", "5", "1", "33", "1", "10", "1", "10"])
        markers = {tuple(row[1:3]): row[3] for row in rows(self.path("box.1.poly"))[1:-2]}
        self.assertEqual(markers, {("1", "2"): "5", ("1", "3"): "1", ("2", "4"): "1", ("3", "4"): "1", ("5", "6"): "1",
                                   ("5", "7"): "1", ("6", "8"): "10", ("7", "8"): "1"})
        self.assertEqual(rows(self.path("box.1.poly"))[-2:], [["1"], ["1", "1.5", "1.5"]])
        self.assertIn("segments    5, which are 8 edges\n", result.out)

    def test_the_suffix_stands_for_the_switch(self):
        self.cadt("triangle", "-Qc", "box.poly")
        text = self.path("box.1.ele").read_text()
        self.cadt("triangle", "-Q", "-p", "-c", "box")
        self.assertEqual(self.path("box.1.ele").read_text(), text)
        self.cadt("triangle", "-AQ", "box.poly")
        self.cadt("triangle", "-pQc", "box.1")
        self.assertTrue(self.path("box.2.poly").exists())

    def test_what_is_outside_is_eaten(self):
        err = self.cadt("triangle", "-p", "box").err
        self.assertIn("no triangles: the segments enclose nothing", err)
        self.assertEqual(rows(self.path("box.1.ele")), [])
        self.assertIn("-c has the edges of the hull as segments, too", err)
        self.write("eaten.poly", "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n1 0\n1 1 2\n1\n1 2 2\n")
        self.assertNotIn("; -c", self.cadt("triangle", "-pc", "eaten").err)
        self.cadt("triangle", "-pcO", "box")
        self.assertEqual(len(rows(self.path("box.1.ele"))), 10)

    def test_regions_are_attributes(self):
        self.write("two.poly", "6 2 0 0\n0 0 0\n1 2 0\n2 4 0\n3 4 2\n4 2 2\n5 0 2\n7 0\n0 0 1\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n5 5 0\n"
                               "6 1 4\n0\n1\n0 3 1 2.5 0.1\n")
        self.cadt("triangle", "-pAQ", "two")
        self.assertEqual(sorted(row[4] for row in rows(self.path("two.1.ele"))), ["0", "0", "2.5", "2.5"])
        self.assertEqual(len(rows(self.path("two.1.poly"))), 1 + 7 + 1 + 2)
        self.assertEqual(rows(self.path("two.1.poly"))[-1], ["0", "3", "1", "2.5", "0.1"])

    def test_segments_that_cross_get_a_vertex(self):
        self.write("x.poly", "4 2 1 0\n1 0 0 1\n2 4 0 2\n3 4 4 3\n4 0 4 4\n2 1\n1 1 3 7\n2 2 4 8\n0\n")
        self.cadt("triangle", "-pcQ", "x")
        self.assertEqual(rows(self.path("x.1.node"))[4], ["5", "2", "2", "2", "7"])
        self.assertEqual(len(rows(self.path("x.1.ele"))), 4)

    def test_points_of_a_poly_are_written_without_iteration_numbers_too(self):
        self.write("x.poly", "4 2 0 0\n1 0 0\n2 4 4\n3 0 4\n4 4 0\n2 0\n1 1 2\n2 3 4\n0\n")
        poly = self.path("x.poly").read_text()
        self.cadt("triangle", "-pcIQ", "x")
        self.assertEqual(self.path("x.poly").read_text(), poly)
        self.assertEqual(rows(self.path("x.node"))[4], ["5", "2", "2", "0"])
        nodes = node_text([(0, 0), (4, 4), (0, 4), (4, 0), (0, 0)], 1)
        self.write("y.node", nodes)
        self.write("y.poly", "0 2 0 0\n2 0\n1 1 2\n2 3 4\n0\n")
        self.assertEqual(self.cadt("triangle", "-pcI", "y").err, "")
        self.assertEqual(self.path("y.node").read_text(), nodes)
        self.assertIn("-j left out 1 of the points, and no .node file", self.cadt("triangle", "-pcIj", "y").err)
        self.assertEqual(self.path("y.node").read_text(), nodes)

    def test_crossings_too_close_to_others_are_named(self):
        self.write("x.poly", "9 2 0 0\n1 1031.9802955665025 332\n2 968 332\n3 1024 512\n4 1033 309\n5 0 0\n6 2000 0\n"
                             "7 2000 2000\n8 500 -1\n9 500 1\n6 0\n1 5 6\n2 6 7\n3 7 5\n4 1 2\n5 8 9\n6 3 4\n0\n")
        self.fails(3, "triangle", "-p", "x", says=["1 pair of segments crosses so close to others", "3 (1031.9802955665025, 332)",
                                                   "5 (1024, 512) - (1033, 309)", "cadt triangulate --domain seeds"])

    def test_errors(self):
        self.write("bad.poly", BOX.replace("8 6 10", "8 9 10"))
        self.fails(3, "triangle", "-p", "bad", says="bad.poly:15: index 9 is out of range")
        self.fails(3, "triangle", "-p", "absent", says="absent.poly: ")
        self.fails(8, "triangle", "-A", "box", says="-A is about regions")
        self.fails(3, "triangle", "box", says="box.node: there is no such file; -p reads box.poly")
        self.assertEqual(self.names(), ["bad.poly", "box.poly"])


def sorted_triangles(triangles):
    return sorted(tuple(sorted(int(v) for v in triangle)) for triangle in triangles)


@unittest.skipUnless(importlib.util.find_spec("triangle") and importlib.util.find_spec("numpy"),
                     "the Python package triangle is not installed (pip install triangle)")
class TriangleOracle(CliTest):
    """Triangle itself, through the package of that name: on points in general position both find the same."""

    def sets(self):
        """60 sets of up to 2,000 points of several shapes."""
        for seed in range(60):
            generator = random.Random(seed)
            count = [3, 4, 5, 10, 50, 200, 1000, 2000][seed % 8]
            shape = seed % 5
            points = []
            for _ in range(count):
                x, y = generator.random(), generator.random()
                if shape == 1:
                    x, y = generator.gauss(0, 1), generator.gauss(0, 1e-3)
                elif shape == 2:
                    x, y = x * 1e6, y ** 4
                elif shape == 3:
                    x, y = x ** 3 + 1000, x + y * 1e-4
                elif shape == 4:
                    x, y = round(x * 40) + generator.random() * 1e-3, round(y * 40) + generator.random() * 1e-3
                points.append((x, y))
            yield seed, points

    def test_same_triangles_edges_and_markers(self):
        import numpy
        import triangle
        compared = 0
        for seed, points in self.sets():
            with self.subTest(seed=seed, points=len(points)):
                oracle = triangle.triangulate({"vertices": numpy.array(points)}, "ne")
                self.write("dots.node", node_text(points))
                self.cadt("triangle", "-neQ", "dots", "--backend", "host")
                found = [row[1:] for row in rows(self.path("dots.1.ele"))]
                self.assertEqual(sorted_triangles(found), sorted_triangles(oracle["triangles"]))
                edges = {tuple(sorted(map(int, row[1:3]))): int(row[3]) for row in rows(self.path("dots.1.edge"))}
                markers = oracle["edge_markers"].ravel().tolist()
                self.assertEqual(edges, {tuple(sorted(e)): m for e, m in zip(oracle["edges"].tolist(), markers)})
                self.assertEqual([int(row[-1]) for row in rows(self.path("dots.1.node"))],
                                 oracle["vertex_markers"].ravel().tolist())
                compared += 1
        self.assertEqual(compared, 60)

    def test_same_voronoi_vertices(self):
        import numpy
        import triangle
        for seed, points in self.sets():
            with self.subTest(seed=seed, points=len(points)):
                points = points[:200]
                vertices, edges, rays, directions = triangle.voronoi(numpy.array(points))
                self.write("dots.node", node_text(points))
                self.cadt("triangle", "-vQ", "dots", "--backend", "host")
                found = numpy.array([[float(x), float(y)] for _, x, y in rows(self.path("dots.1.v.node"))])
                self.assertEqual(found.shape, vertices.shape)
                distances = numpy.abs(found[:, None, :] - vertices[None, :, :]).max(axis=2)
                sizes = 1 + numpy.abs(found).max(axis=1)
                self.assertLess((distances.min(axis=1) / sizes).max(), 1e-7)
                lines = rows(self.path("dots.1.v.edge"))
                self.assertEqual(len([line for line in lines if line[2] != "-1"]), len(edges))
                self.assertEqual(sorted((float(x), float(y)) for _, _, end, *direction in lines if end == "-1"
                                        for x, y in [direction]), sorted(map(tuple, directions.tolist())))


if __name__ == "__main__":
    unittest.main()
