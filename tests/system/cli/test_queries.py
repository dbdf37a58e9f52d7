# SPDX-License-Identifier: Apache-2.0
"""locate and interpolate, against brute force on small sets."""
import math
import random
import unittest

from answers import npy_bytes, plane, read_npy, read_npz, sibson, xyz_text
from harness import CliTest, integer_points, read_off, twice_area, xy_text


class LocateCommand(CliTest):
    def sets(self):
        yield integer_points(60, 30), integer_points(300, 40, seed=9)
        yield [(x, y) for x in range(6) for y in range(6)], [(x, y) for x in range(-1, 8) for y in range(-1, 8)]

    def triangles(self):
        self.cadt("triangulate", "p.xy", "-o", "m.off", "-q")
        return read_off(self.path("m.off").read_text())[1]

    def test_triangles_are_those_of_triangulate_the_lowest_one(self):
        for points, queries in self.sets():
            self.write("p.xy", xy_text(points))
            self.write("q.xy", xy_text(queries))
            triangles = self.triangles()

            def brute(q):
                for i, (a, b, c) in enumerate(tuple(points[v] for v in t) for t in triangles):
                    if min(twice_area(a, b, q), twice_area(b, c, q), twice_area(c, a, q)) >= 0:
                        return i
                return -1

            expected = [brute(q) for q in queries]
            self.assertIn(-1, expected)
            result = self.cadt("locate", "p.xy", "q.xy")
            self.assertEqual([int(line) for line in result.out.splitlines()], expected)
            self.assertEqual(result.err, "")
            summary = self.cadt("locate", "p.xy", "q.xy", "-o", "t.npy")
            self.assertEqual(summary.out, "")
            inside = len(queries) - expected.count(-1)
            self.assertRegex(summary.err, rf"(?m)^inside      {inside} of {len(queries)}$")
            self.assertEqual(read_npy(self.path("t.npy").read_bytes()), ((len(queries),), expected))

    def test_barycentric(self):
        points, queries = next(self.sets())
        self.write("p.xy", xy_text(points))
        self.write("q.xy", xy_text(queries))
        triangles = self.triangles()
        self.cadt("locate", "p.xy", "q.xy", "--barycentric", "-o", "b.csv", "-q")
        lines = self.path("b.csv").read_text().splitlines()
        self.assertEqual(lines[0], "triangle,barycentric0,barycentric1,barycentric2")
        self.assertEqual(len(lines), len(queries) + 1)
        for q, line in zip(queries, lines[1:]):
            t, *weights = line.split(",")
            if t == "-1":
                self.assertEqual(weights, ["nan"] * 3)
                continue
            weights = [float(w) for w in weights]
            self.assertGreaterEqual(min(weights), 0)
            for axis in (0, 1):
                back = sum(w * points[v][axis] for w, v in zip(weights, triangles[int(t)]))
                self.assertAlmostEqual(back, q[axis], places=9)
        self.cadt("locate", "p.xy", "q.xy", "--barycentric", "-o", "b.npz", "-q")
        arrays = read_npz(self.path("b.npz"))
        self.assertEqual(arrays["triangle"][0], (len(queries),))
        self.assertEqual(arrays["barycentric"][0], (len(queries), 3))
        self.assertEqual(arrays["triangle"][1], [int(line.split(",")[0]) for line in lines[1:]])

    def test_nearest(self):
        for points, queries in self.sets():
            points = list(dict.fromkeys(points))
            self.write("p.xy", xy_text(points))
            self.write("q.xy", xy_text(queries))
            distance = lambda q, v: (points[v][0] - q[0]) ** 2 + (points[v][1] - q[1]) ** 2
            brute = [min(range(len(points)), key=lambda v: distance(q, v)) for q in queries]
            out = self.cadt("locate", "p.xy", "q.xy", "--nearest").out
            self.assertEqual([int(line) for line in out.splitlines()], brute)
            self.cadt("locate", "p.xy", "q.xy", "--nearest", "-k", "4", "-o", "n.csv", "-q")
            header, *rows = self.path("n.csv").read_text().splitlines()
            self.assertEqual(header, "point0,point1,point2,point3")
            for q, first, row in zip(queries, brute, rows):
                row = [int(v) for v in row.split(",")]
                self.assertEqual(row[0], first)
                self.assertEqual(len(set(row)), 4)
                self.assertEqual([distance(q, v) for v in row], sorted(distance(q, v) for v in range(len(points)))[:4])
        self.write("few.xy", xy_text([(0, 0), (1, 0), (0, 1)]))
        self.assertEqual(self.cadt("locate", "few.xy", "-", "--nearest", "-k", "5", stdin="2 0.5\n").out, "1 0 2 -1 -1\n")

    def test_queries_from_a_pipe_and_by_columns(self):
        self.write("p.xy", xy_text([(0, 0), (4, 0), (0, 4), (4, 4)]))
        self.assertEqual(self.cadt("locate", "p.xy", "-", stdin="9 9\n").out, "-1\n")
        self.assertEqual(self.cadt("locate", "p.xy", "-", stdin="x,y\n9,9\n", ).out, "-1\n")
        self.write("q.csv", "name,north,east\na,4,0\nb,9,9\n")
        out = self.cadt("locate", "p.xy", "q.csv", "--query-columns", "east,north", "--nearest").out
        self.assertEqual(out.split(), ["2", "3"])
        self.assertEqual(self.cadt("locate", "-", "-f", "xy", "q.csv", "--query-columns", "2,3", "--nearest",
                                   stdin=xy_text([(0, 0), (4, 0), (0, 4)])).out.split(), ["1", "1"])

    def test_without_triangles(self):
        self.write("p.xy", xy_text([(0, 0), (1, 1), (2, 2)]))
        result = self.cadt("locate", "p.xy", "-", stdin="1 1\n")
        self.assertEqual(result.out, "-1\n")
        self.assertRegex(result.err, r"^cadt: warning: p.xy: no triangles")
        self.assertEqual(self.cadt("locate", "p.xy", "-", "-q", stdin="1 1\n").err, "")


class InterpolateCommand(CliTest):
    def test_a_plane_is_reproduced(self):
        points = integer_points(200, 100)
        self.write("p.xyz", xyz_text(points))
        source = random.Random(5)
        queries = [(source.uniform(25, 75), source.uniform(25, 75)) for _ in range(200)]
        self.write("q.xy", xy_text(queries))
        for method in ("linear", "natural"):
            out = self.cadt("interpolate", "p.xyz", "q.xy", "--method", method).out.split()
            self.assertEqual(len(out), len(queries))
            for q, value in zip(queries, out):
                self.assertAlmostEqual(float(value), plane(*q), places=9)
        nearest = self.cadt("interpolate", "p.xyz", "q.xy", "--method", "nearest").out.split()
        for q, value in zip(queries, nearest):
            self.assertEqual(float(value), plane(*min(points, key=lambda p: math.dist(p, q))))

    def test_natural_neighbours_are_sibsons(self):
        points = list(dict.fromkeys(integer_points(40, 100)))
        values = [math.sin(x / 20) + (y / 30) ** 2 for x, y in points]
        self.write("p.xyz", "".join(f"{x} {y} {v!r}\n" for (x, y), v in zip(points, values)))
        source = random.Random(6)
        queries = [(source.uniform(35, 65), source.uniform(35, 65)) for _ in range(30)]
        self.write("q.xy", xy_text(queries))
        out = self.cadt("interpolate", "p.xyz", "q.xy", "--method", "natural").out.split()
        for q, value in zip(queries, out):
            self.assertAlmostEqual(float(value), sibson(points, values, q, (-900, -900, 1000, 1000)), places=9)

    def test_values_from_files(self):
        points = [(0, 0), (10, 0), (0, 10), (10, 10)]
        self.write("p.xy", xy_text(points))
        self.write("v.txt", "0\n10\n20\n30\n")
        self.write("v.csv", "a,b\n0,1\n10,1\n20,1\n30,1\n")
        self.path("f.npy").write_bytes(npy_bytes("<f8", (4,), "d", [0, 10, 20, 30]))
        self.path("h.npy").write_bytes(npy_bytes("<i2", (4, 2), "h", [0, 1, 10, 1, 20, 1, 30, 1]))
        for values, expected in [("v.txt", "13"), ("v.csv", "13 1"), ("f.npy", "13"), ("h.npy", "13 1")]:
            out = self.cadt("interpolate", "p.xy", "-", "--values", values, stdin="3 5\n").out
            self.assertEqual(out, expected + "\n", values)
        self.cadt("interpolate", "p.xy", "-", "--values", "v.csv", "-o", "o.csv", stdin="3 5\n")
        self.assertEqual(self.path("o.csv").read_text(), "value0,value1\n13,1\n")
        self.cadt("interpolate", "p.xy", "-", "--values", "v.csv", "-o", "o.npy", stdin="3 5\n")
        self.assertEqual(read_npy(self.path("o.npy").read_bytes()), ((1, 2), [13.0, 1.0]))
        self.write("t.csv", "lon,lat,depth,name\n0,0,1,a\n1,0,2,b\n0,1,3,c\n")
        out = self.cadt("interpolate", "t.csv", "-", "--columns", "lon,lat,depth", stdin="0.5 0.5\n").out
        self.assertEqual(out, "2.5\n")

    def test_of_equal_points_the_first_value_counts(self):
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n1 0 70\n0 0 80\n")
        for method in ("linear", "natural", "nearest"):
            self.assertEqual(self.cadt("interpolate", "p.xyz", "-", "--method", method, stdin="1 0\n0 0\n").out, "2\n1\n")

    def test_outside(self):
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n")
        self.assertEqual(self.cadt("interpolate", "p.xyz", "-", stdin="5 0.1\n").out, "nan\n")
        for method in ("linear", "natural", "nearest"):
            self.assertEqual(self.cadt("interpolate", "p.xyz", "-", "--method", method, "--outside", "nearest",
                                       stdin="5 0.1\n").out, "2\n")
        summary = self.cadt("interpolate", "p.xyz", "-", "-o", "o.xyz", stdin="5 0.1\n0 0.5\n")
        self.assertRegex(summary.err, r"(?m)^without     1 ")
        self.assertEqual(self.path("o.xyz").read_text(), "5 0.1 nan\n0 0.5 2\n")


class SegmentsOfQueries(CliTest):
    """A flat square with a wall between two of its points, 10 high."""

    def setUp(self):
        super().setUp()
        self.write("flat.xyz", "0 0 0\n10 0 0\n10 10 0\n0 10 0\n5 1 0\n5 9 0\n")
        self.write("wall.obj", "v 1 5 10\nv 9 5 10\nl 1 2\n")

    def test_values_bend_at_segments(self):
        ask = "5 5\n5 4\n3 5\n5 1\n20 20\n"
        self.assertEqual(self.cadt("interpolate", "flat.xyz", "-", stdin=ask).out, "0\n0\n0\n0\nnan\n")
        result = self.cadt("interpolate", "flat.xyz", "-", "--segments", "wall.obj", stdin=ask)
        self.assertEqual((result.out, result.err), ("10\n7.5\n10\n0\nnan\n", ""))
        self.cadt("raster", "flat.xyz", "--segments", "wall.obj", "--res", "2", "-o", "d.npy", "-q")
        self.assertEqual(read_npy(self.path("d.npy").read_bytes())[1][2::5], [0, 5, 10, 5, 0])  # the cells around x = 5
        self.write("v.txt", "0 1\n" * 6 + "8 2\n" * 2)
        words = ("interpolate", "flat.xyz", "-", "--segments", "wall.obj", "--values", "v.txt")
        self.assertEqual(self.cadt(*words, stdin="5 4\n").out, "6 1.75\n")
        self.write("v.txt", "0\n" * 6)
        self.fails(3, *words, stdin="5 4\n", says="6 rows of values for the 8 points of flat.xyz with wall.obj")

    def test_triangles_are_those_of_triangulate(self):
        self.cadt("triangulate", "flat.xyz", "--segments", "wall.obj", "-o", "m.off", "-q")
        points, triangles = read_off(self.path("m.off").read_text())
        centres = [tuple(sum(float(points[v][k]) for v in t) / 3 for k in (0, 1)) for t in triangles]
        out = self.cadt("locate", "flat.xyz", "-", "--segments", "wall.obj", stdin=xy_text(centres)).out
        self.assertEqual([int(word) for word in out.split()], list(range(len(triangles))))
        self.assertTrue(any({6, 7} <= set(t) for t in triangles))

    def test_crossings_become_vertices_with_values_of_the_first_segment(self):
        self.write("x.poly", "4 2 1 0\n1 0 0 1\n2 4 4 3\n3 0 4 5\n4 4 0 7\n2 0\n1 1 2\n2 3 4\n1\n1 1 2\n")
        self.fails(3, "interpolate", "x.poly", "-", stdin="2 2\n", says=["1 pair of segments crosses", "--crossing exact"])
        for rule in ("exact", "grid=1"):
            result = self.cadt("interpolate", "x.poly", "-", "--crossing", rule, stdin="2 2\n1 2\n")
            self.assertEqual((result.out, result.err), ("2\n2.5\n", ""))  # holes are no business of queries
        self.cadt("raster", "x.poly", "--crossing", "exact", "--res", "4", "-o", "d.npy", "-q")
        self.assertEqual(read_npy(self.path("d.npy").read_bytes()), ((1, 1), [2]))

    def test_heights_at_the_same_places(self):
        """Those of the points count, and a warning says so."""
        self.write("line.geojson", '{"type":"LineString","coordinates":[[0,0,7],[5,1,0],[10,0,9]]}')
        warning = "line.geojson: 2 of its points have other heights than those of the input at the same places, the first at 0 0"
        words = ("flat.xyz", "--segments", "line.geojson")
        result = self.cadt("raster", *words, "--res", "5", "-o", "d.npy")  # .geojson, but not for cadt-terrain
        self.assertIn(warning, result.err)
        self.assertEqual(read_npy(self.path("d.npy").read_bytes())[1], [0, 0, 0, 0])
        self.cadt("raster", "flat.xyz", "--segments=line.geojson", "--res", "5", "-o", "d.npy", "-q")
        self.assertIn(warning, self.cadt("triangulate", *words, "-o", "m.off").err)
        self.assertEqual(self.cadt("triangulate", *words, "-o", "m.off", "-q").err, "")
        self.write("same.obj", "v 10 0 0\nv 0 0 0\nv 1 3 8\nl 1 2 3\n")
        self.assertNotIn("warning", self.cadt("triangulate", "flat.xyz", "--segments", "same.obj", "-o", "m.off").err)

    def test_what_is_refused(self):
        self.write("thin.xyz", "0 0 0\n10 0 0\n5 1 1\n5 -1 1\n")
        self.write("long.edg", "1\n0 0 10 0\n")
        self.write("q.xy", "5 0\n")
        ask = ("thin.xyz", "q.xy", "--segments", "long.edg")
        self.assertEqual(self.cadt("locate", *ask).out, "0\n")
        for words in (("locate", *ask, "--nearest"), ("interpolate", *ask, "--values", "v.txt", "--method", "natural")):
            self.write("v.txt", "1\n" * 6)
            self.fails(2, *words, says="not all triangles are Delaunay")
        self.fails(3, "interpolate", *ask, says=["heights are left out: long.edg has none", "with long.edg: no values", "third coordinate each"])
        self.fails(2, "locate", *ask, "-o", "long.edg", "-t", "txt", says="this is the input")
        self.fails(2, "locate", "thin.xyz", "q.xy", "--crossing", "exact", says="--crossing is about segments")
        self.fails(2, "raster", "thin.xyz", "--segments", "-", "--res", "1", "-o", "d.npy", says="standard input is for IN")
        self.fails(3, "locate", "thin.xyz", "q.xy", "--segments", "no.edg", says="no.edg: ")
        self.fails(2, "voronoi", "thin.xyz", "--segments", "long.edg", "-o", "v.svg", says="no option --segments")


if __name__ == "__main__":
    unittest.main()
