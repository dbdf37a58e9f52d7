# SPDX-License-Identifier: Apache-2.0
"""Segments: cadt triangulate and cadt info with segments."""
import json
import unittest

from harness import SOURCE, CliTest, read_off
from shapes import HOLE, SQUARE, ConstraintTest, area_of, geojson, polygon

# An outer square of 6 with a hole of 2, a loose point, and a segment that hangs loose outside.
PLATE = ("10 2 0 0\n0 0 0\n1 6 0\n2 6 6\n3 0 6\n4 2 2\n5 4 2\n6 4 4\n7 2 4\n8 5 5\n9 8 8\n"
         "8 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n4 4 5\n5 5 6\n6 6 7\n7 7 4\n1\n0 3 3\n")


class Segments(CliTest):
    off, edges = ConstraintTest.off, ConstraintTest.edges

    def setUp(self):
        super().setUp()
        self.write("plate.poly", PLATE)

    def test_are_edges_of_the_mesh(self):
        points = [(0, 0), (10, 0), (5, 1), (5, -1), (2, 5), (8, 5)]
        self.write("points.xy", "".join(f"{x} {y}\n" for x, y in points))
        self.cadt("triangulate", "points.xy", "-o", "plain.off")
        self.assertNotIn((0, 1), self.edges(self.off("plain.off")[1]))
        self.write("line.edg", "1\n0 0 10 0\n")
        err = self.cadt("triangulate", "points.xy", "--segments", "line.edg", "-o", "m.off", "--verify").err
        found, triangles = self.off("m.off")
        self.assertEqual(found, points + [(0, 0), (10, 0)])
        self.assertIn((0, 1), self.edges(triangles))
        self.assertRegex(err, r"(?m)^segments    1, which are 1 edges$")
        self.assertRegex(err, r"(?m)^duplicates  2$")

    def test_options_of_points_that_do_not_reach_the_segments(self):
        self.write("a.obj", "v 0 0 0\nv 5 1 0\nv 5 0 1\nv 5 1 1\nl 1 4\n")
        self.write("a.txt", "4 1\n0 0\n1 0\n1 1\n0 1\n0 2\n")
        self.fails(2, "triangulate", "a.obj", "--segments", "a.obj", "--project", "yz", says="--project")
        self.fails(2, "triangulate", "a.txt", "--segments", "a.txt", "--columns", "2,1", says="leave --columns")
        self.fails(2, "triangulate", "a.txt", "--segments", "a.txt", "-f", "xy", says="leave --columns and --from")

    def test_a_domain_with_nothing_inside(self):
        self.write("open.poly", "4 2 0 0\n0 0 0\n1 1 0\n2 1 1\n3 0 1\n3 0\n0 0 1\n1 1 2\n2 2 3\n0\n")
        said = self.cadt("triangulate", "open.poly", "--domain", "seeds", "-o", "m.off").err
        self.assertIn("no triangles: no region is inside by --domain seeds", said)
        self.fails(4, "triangulate", "open.poly", "--domain", "seeds", "--strict", says="--domain hull keeps all")
        self.assertNotIn("warning", self.cadt("triangulate", "open.poly", "-o", "m.off").err)
        self.write("one.json", '{"type":"Point","coordinates":[1,1]}')
        self.assertNotIn("--columns", self.cadt("triangulate", "one.json", "-o", "m.off").err)

    def test_indices_beside_a_node_file(self):
        """From where it counts, as that is how they are read."""
        self.write("k.node", "5 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 2 1\n")
        self.write("k.poly", "0 2\n1 0\n1 2 4\n0\n")
        self.cadt("triangulate", "k.poly", "-o", "k.edge", "-o", "k.ele", "-q")
        self.assertEqual(self.path("k.edge").read_text().splitlines()[1].split(), ["1", "2", "4"])
        self.assertEqual(self.path("k.ele").read_text().splitlines()[1].split()[0], "1")
        self.cadt("triangulate", "k.node", "-o", "k.ele", "-q")
        self.cadt("verify", "k.node", "k.ele")
        self.cadt("triangulate", "k.edge", "-o", "other.poly", "-q")
        self.assertIn("0  1  3", self.path("other.poly").read_text())
        self.write("o.node", "5 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 2 1\n")
        for output, more in (("k.edge", ["--base", "0"]), ("o.edge", ["-o", "o.node"])):
            self.cadt("triangulate", "k.poly", "-o", output, *more, "-q")
            self.assertEqual(self.path(output).read_text().splitlines()[1].split(), ["0", "1", "3"], more)

    def test_domains_leave_triangles_out(self):
        areas = {}
        for domain in ("hull", "outer", "even_odd", "layers", "seeds"):
            self.cadt("triangulate", "plate.poly", "--domain", domain, "-o", "m.off")
            points, triangles = self.off("m.off")
            self.assertEqual(len(points), 10)
            areas[domain] = area_of(points, triangles) / 2
        hull = areas.pop("hull")
        self.assertGreater(hull, 36)
        self.assertEqual(areas, {"outer": 36, "even_odd": 32, "layers": 32, "seeds": 32})
        self.cadt("triangulate", "plate.poly", "-o", "m.off")
        self.assertEqual(area_of(*self.off("m.off")) / 2, hull)

    def test_winding_numbers(self):
        # Two squares one in the other, both counterclockwise, and a third one clockwise.
        ring = lambda low, high: [[low, low], [high, low], [high, high], [low, high]]
        self.write("a.json", json.dumps([ring(0, 9), ring(1, 8), ring(2, 3)[::-1]]))
        self.write("b.json", json.dumps([ring(0, 9), ring(1, 8)[::-1], ring(2, 3)[::-1]]))
        for file, domain, area in (("a.json", "nonzero", 81), ("a.json", "even_odd", 81 - 49 + 1),
                                   ("b.json", "nonzero", 81 - 49 + 1)):
            self.cadt("triangulate", file, "--domain", domain, "-o", "m.off")
            self.assertEqual(area_of(*self.off("m.off")) / 2, area, (file, domain))

    def test_all_formats_at_once(self):
        suffixes = ["node", "ele", "obj", "off", "ply", "vtu", "glb", "poly", "edge", "geojson", "svg", "pdf", "png"]
        files = [f"m.{suffix}" for suffix in suffixes]
        self.cadt("triangulate", *[word for file in files for word in ("-o", file)], "plate.poly", "--domain", "seeds")
        self.assertEqual(self.names(), sorted(files + ["plate.poly"]))
        features = json.loads(self.path("m.geojson").read_text())["features"]
        self.assertEqual(len(features), len(read_off(self.path("m.off").read_text())[1]))
        for feature in features:
            ring = feature["geometry"]["coordinates"][0]
            self.assertEqual((len(ring), ring[0]), (4, ring[3]))
            self.assertIsInstance(feature["properties"]["region"], int)
        self.assertTrue(self.path("m.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("<svg", self.path("m.svg").read_text())
        # What is written is read again, and means the same.
        self.cadt("triangulate", "m.poly", "--domain", "even_odd", "-o", "again.off")
        self.assertEqual(self.path("again.off").read_text(), self.path("m.off").read_text())
        self.cadt("triangulate", "m.edge", "--domain", "even_odd", "-o", "again.off")
        self.assertEqual(self.path("again.off").read_text(), self.path("m.off").read_text())
        self.cadt("verify", "m.node", "m.ele", expect=7)  # not a mesh of all points

    def test_heights_are_kept_where_all_have_some(self):
        self.write("p.xyz", "0 0 1\n9 0 2\n9 9 3\n0 9 4\n")
        self.write("lines.obj", "v 2 2 7\nv 5 6 8\nl 1 2\n")
        self.cadt("triangulate", "p.xyz", "--segments", "lines.obj", "-o", "m.off")
        vertices, triangles = read_off(self.path("m.off").read_text())
        self.assertEqual([z for _, _, z in vertices], ["1", "2", "3", "4", "7", "8"])
        self.cadt("triangulate", "p.xyz", "--segments", "lines.obj", "-o", "m.edge", "-o", "m.node")
        self.assertEqual([line.split() for line in self.path("m.edge").read_text().splitlines()[:2]],
                         [["1", "0"], ["0", "4", "5"]])
        self.write("same.obj", "v 0 0 7\nv 9 0 7\nv 9 9 7\nv 0 9 7\nl 1 3\n")
        self.cadt("triangulate", "p.xyz", "--segments", "same.obj", "-o", "m.off")
        self.assertEqual([z for _, _, z in read_off(self.path("m.off").read_text())[0]], ["1", "2", "3", "4"])
        self.assertIn("warning: same.obj has other heights at the same points: those of the input are taken",
                      self.cadt("triangulate", "p.xyz", "--segments", "same.obj", "-o", "m.off").err)
        self.assertEqual(self.cadt("triangulate", "p.xyz", "--segments", "same.obj", "-o", "m.off", "-q").err, "")
        self.write("equal.obj", "v 0 0 1\nv 9 0 2\nv 9 9 3\nv 0 9 4\nl 1 3\n")
        self.assertNotIn("heights", self.cadt("triangulate", "p.xyz", "--segments", "equal.obj", "-o", "m.off").err)
        self.write("p.xy", "0 0\n9 0\n9 9\n0 9\n")
        self.assertNotIn("heights", self.cadt("triangulate", "p.xy", "--segments", "same.obj", "-o", "m.off").err)
        self.assertEqual([z for _, _, z in read_off(self.path("m.off").read_text())[0]], ["7"] * 4)
        self.write("flat.edg", "1\n2 2 5 6\n")
        err = self.cadt("triangulate", "p.xyz", "--segments", "flat.edg", "-o", "m.off").err
        self.assertIn("cadt: heights are left out: flat.edg has none\n", err)
        self.assertEqual({z for _, _, z in read_off(self.path("m.off").read_text())[0]}, {"0"})

    def test_heights_that_some_positions_lack(self):
        self.write("p.xyz", "0 0 1\n9 0 2\n9 9 3\n0 9 4\n")
        for name, text in (("a.json", '{"type":"MultiPoint","coordinates":[[0,0,1],[4,0,2],[4,4]]}'),
                           ("b.json", '{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[0,0,1]},'
                                      '{"type":"LineString","coordinates":[[4,0],[4,4]]}]}')):
            self.write(name, text)
            for line in ((name,), ("p.xyz", "--segments", name)):
                err = self.cadt("triangulate", *line, "-o", "m.off").err
                self.assertIn(f"cadt: heights are left out: {name} has none at some points\n", err)
                self.assertEqual({z for _, _, z in read_off(self.path("m.off").read_text())[0]}, {"0"})
        self.assertNotIn("heights", self.cadt("triangulate", "a.json", "-o", "m.off", "-q").err)

    def test_messages_name_both_files(self):
        self.write("p.xyz", "0 0 1\n9 0 2\n9 9 3\n0 9 4\n")
        self.write("x.edg", "2\n1 1 3 3\n1 3 3 1\n")
        for command in (("triangulate",), ("render", "-o", "m.png")):
            says = "p.xyz with x.edg: 1 pair of segments crosses"
            self.fails(3, *command, "p.xyz", "--segments", "x.edg", says=says)
        self.write("lines.obj", "v 0 0 0\nv 9 9 0\nv 9 0 0\nv 0 9 0\nl 1 2\nl 3 4\n")
        self.fails(3, "triangulate", "lines.obj", "--segments", "lines.obj", says="error: lines.obj: 1 pair")

    def test_points_that_are_the_same_are_taken_once(self):
        self.write("lines.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 1 5 0\nl 1 3\n")
        fields = self.cadt("triangulate", "lines.obj", "--segments", "lines.obj").fields()
        self.assertEqual((fields["points"], fields["duplicates"]), ("4", "0"))
        self.write("p.xy", "0 0\n9 0\n9 9\n1 5\n")
        self.assertEqual(self.cadt("triangulate", "p.xy", "--segments", "lines.obj").fields()["points"], "4")
        self.write("c.txt", "4 1\n0 0\n9 0\n9 9\n1 5\n0 2\n")
        self.assertEqual(self.cadt("triangulate", "c.txt", "--segments", "c.txt").fields()["points"], "4")

    def test_hash_does_not_depend_on_order_and_direction(self):
        rows = PLATE.splitlines()
        segments = [row.split() for row in rows[12:20]]
        turned = [f"{i} {b} {a}" for i, (_, a, b) in enumerate(reversed(segments))]
        self.write("other.poly", "\n".join(rows[:12] + turned + rows[20:]) + "\n")
        hashes = {self.cadt("triangulate", file, "--backend", "host", "--threads", threads).fields()["hash"]
                  for file in ("plate.poly", "other.poly") for threads in (1, 2)}
        self.assertEqual(len(hashes), 1)
        self.write("fewer.poly", "\n".join(rows[:11] + ["7 0"] + rows[12:19] + rows[20:]) + "\n")
        self.assertNotIn(self.cadt("triangulate", "fewer.poly").fields()["hash"], hashes)

    def test_statistics_have_the_constraints(self):
        self.cadt("triangulate", "plate.poly", "--domain", "seeds", "--stats=s.json", "-o", "m.off")
        found = json.loads(self.path("s.json").read_text())["constraints"]
        self.assertEqual((found["segments"], found["edges"], found["domain"], found["crossing"], found["regions"]),
                         (8, 8, "seeds", "error", 3))
        self.write("p.xy", "0 0\n1 0\n0 1\n")
        self.cadt("triangulate", "p.xy", "--stats=s.json", "-o", "m.off")
        self.assertIsNone(json.loads(self.path("s.json").read_text())["constraints"])

    def test_seeds_beyond_the_hull_are_named(self):
        square = "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n"
        self.write("far.poly", square + "2\n1 4 5\n2 9 9\n3\n1 4 4 7 0\n2 2 -1 8 0\n3 1 1 9 0\n")
        self.write("near.poly", square + "1\n1 4 2\n1\n1 2 2 7 0\n")
        for words in (["triangulate", "--domain", "seeds"], ["triangle", "-pA"]):
            err = self.cadt(*words, "far.poly").err
            self.assertIn("warning: far.poly: 2 of its holes are outside of the points' extent, and without effect; the first is at 4 5\n", err)
            self.assertIn("warning: far.poly: 1 of its regions is outside of the points' extent, and without effect; the first is at 2 -1\n", err)
            self.assertNotIn("outside of", self.cadt(*words, "near.poly").err)
        for words in (["triangulate"], ["triangulate", "--domain", "seeds", "-q"], ["triangle", "-pQ"]):
            self.assertNotIn("outside of", self.cadt(*words, "far.poly").err)
        self.assertIn("holes", self.cadt("triangle", "-p", "far").err)
        self.assertNotIn("regions", self.cadt("triangle", "-p", "far").err)
        self.assertNotIn("holes", self.cadt("triangle", "-pO", "far").err)
        # On a grid the extent is that of the moved points.
        self.write("grid.poly", "4 2 0 0\n1 0.4 0.4\n2 3.6 0.4\n3 3.6 3.6\n4 0.4 3.6\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n1\n1 0.2 0.3\n")
        words = ["triangulate", "--domain", "seeds", "--crossing", "grid=1", "grid.poly"]
        self.assertNotIn("outside of", self.cadt(*words).err)

    def test_notes_and_empty_meshes(self):
        self.assertIn("--domain seeds uses them", self.cadt("triangulate", "plate.poly").err)
        self.assertEqual(self.cadt("triangulate", "plate.poly", "-q").err, "")
        self.write("line.edg", "2\n0 0 1 1\n1 1 3 3\n")
        result = self.cadt("triangulate", "line.edg")
        self.assertIn("no triangles: all 3 distinct points lie on one line", result.err)
        self.fails(4, "triangulate", "line.edg", "--strict", says="no triangles")


class Crossings(CliTest):
    off = ConstraintTest.off

    def setUp(self):
        super().setUp()
        self.write("x.edg", "3\n0 0 4 4\n0 4 4 0\n9 0 9 1\n")

    def test_are_errors_that_name_the_segments(self):
        self.fails(3, "triangulate", "x.edg", "-o", "m.off",
                   says=["x.edg: 1 pair of segments cross", "0 (0, 0) - (4, 4)  and  1 (0, 4) - (4, 0)",
                         "--crossing exact", "--crossing grid=G"])
        self.write("many.edg", "6\n0 5 9 5\n" + "".join(f"{x} 0 {x} 9\n" for x in range(1, 6)))
        self.write("more.edg", "7\n0 5 9 5\n" + "".join(f"{x} 0 {x} 9\n" for x in range(1, 7)))
        self.assertNotIn("...", self.fails(3, "triangulate", "many.edg", says="5 pairs").err)
        self.assertIn("...", self.fails(3, "triangulate", "more.edg", says="6 pairs").err)
        self.assertEqual(self.names(), ["many.edg", "more.edg", "x.edg"])

    def test_can_become_vertices(self):
        err = self.cadt("triangulate", "x.edg", "--crossing", "exact", "-o", "m.off").err
        points, triangles = self.off("m.off")
        self.assertEqual(points[6:], [(2, 2)])
        self.assertEqual(sum(6 in triangle for triangle in triangles), 4)
        self.assertRegex(err, r"segments    3, which are 5 edges, with 1 points added where they cross")
        self.write("heights.obj", "v 0 0 1\nv 8 0 5\nv 2 3 9\nv 2 -3 9\nl 1 2\nl 3 4\n")
        self.cadt("triangulate", "heights.obj", "--segments", "heights.obj", "--crossing", "exact", "-o", "m.off")
        self.assertEqual(read_off(self.path("m.off").read_text())[0][4], ("2", "0", "2"))
        # A point on the segment is nearer than its end.
        for scale in ("", "e307"):
            rows = [(0, 0, 0), (10, 0, 0), (5, 0, 100), (6, -1, 7), (6, 1, 7)]
            self.write("h.poly", "5 2 1 0\n" + "".join(f"{i} {x}{scale} {y}{scale} {z}\n" for i, (x, y, z) in
                                                      enumerate(rows)) + "2 0\n0 0 1\n1 3 4\n0\n")
            self.cadt("triangulate", "h.poly", "--crossing", "exact", "-o", "m.off")
            self.assertAlmostEqual(float(read_off(self.path("m.off").read_text())[0][5][2]), 80)

    def test_crossings_too_close_for_doubles_are_explained(self):
        ends = [(0, 0), (1, 1), (0, 1), (1, 0), (0, 0.5), (1, 0.5 + 2**-52), (0.25, 0), (0.75, 1)]
        self.write("near.poly", "8 2 0 0\n" + "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(ends)) +
                   "4 0\n" + "".join(f"{i} {2 * i} {2 * i + 1}\n" for i in range(4)) + "0\n")
        err = self.cadt("triangulate", "near.poly", "--crossing", "exact", "-o", "m.off").err
        self.assertIn("turned over or flat", err)
        err = self.cadt("triangulate", "near.poly", "--crossing", "exact", "-q", "--verify", "-o", "n.off", expect=7).err
        self.assertIn("--crossing grid=G", err)
        self.assertNotIn("defect of cadt", err)
        self.assertNotIn("n.off", self.names())
        self.cadt("triangulate", "near.poly", "--crossing", "grid=0.001", "--verify", "-o", "n.off")

    def test_can_move_to_a_grid(self):
        self.write("y.edg", "2\n0 0 4.1 4.1\n0 4 4 0.2\n")
        self.cadt("triangulate", "y.edg", "--crossing", "grid=1", "-o", "m.off")
        points = self.off("m.off")[0]
        self.assertTrue(all(x == int(x) and y == int(y) for x, y in points), points)
        self.assertEqual(points[:4], [(0, 0), (4, 4), (0, 4), (4, 0)])

    def test_wrong_rules(self):
        for rule in ("grid", "grid=", "grid=0", "grid=-1", "grid=x", "grid=1x", "grid=inf", "grid=nan", "round"):
            self.fails(2, "triangulate", "x.edg", "--crossing", rule, says=f"--crossing {rule}:")
        err = self.fails(2, "triangulate", "x.edg", "--crossing", "grid=1e-300", says="--crossing grid: coordinates").err
        self.assertNotIn("Options::", err)


class SegmentErrors(CliTest):
    def setUp(self):
        super().setUp()
        self.write("plate.poly", PLATE)
        self.write("p.xy", "0 0\n1 0\n0 1\n")

    def test_command_lines(self):
        self.fails(2, "triangulate", "p.xy", "--domain", "outer", says="--domain is about segments")
        self.fails(2, "triangulate", "p.xy", "--crossing", "exact", says="--crossing is about segments")
        self.fails(2, "triangulate", "plate.poly", "--domain", "inside", says="--domain")
        self.fails(2, "triangulate", "plate.poly", "--segments", "plate.poly", says="has segments of its own")
        self.fails(2, "triangulate", "p.xy", "--segments", "-", says="--segments: standard input is for IN; name a file")
        self.fails(2, "triangulate", "plate.poly", "--stabilize", "defer", says="--stabilize is for points")
        self.fails(2, "triangulate", "plate.poly", "--columns", "1,2", says="--columns and --project")
        self.fails(2, "triangulate", "plate.poly", "-o", "m.npz", says="unknown suffix '.npz'")
        self.fails(2, "triangulate", "p.xy", "-o", "m.geojson", says="unknown suffix '.geojson'")
        self.fails(2, "triangulate", "plate.poly", "-o", "plate.poly", says="this is the input")
        self.fails(2, "triangulate", "p.xy", "--segments", "plate.poly", "-o", "plate.poly", says="this is the input")
        self.fails(3, "triangulate", "p.xy", "--segments", "absent.poly", says="absent.poly: ")
        unknown = "p.xy: unknown suffix '.xy'; it has to be one of: poly edge"
        self.fails(2, "triangulate", "p.xy", "--segments", "p.xy", says=unknown)
        self.assertEqual(self.names(), ["p.xy", "plate.poly"])

    def test_files(self):
        self.write("bad.poly", PLATE.replace("7 7 4\n", "7 7 10\n"))
        self.fails(3, "triangulate", "bad.poly", says="bad.poly:20: index 10 is out of range")
        self.fails(3, "info", "bad.poly", says="bad.poly:20: ")
        for name, text, says in (("a.json", "[[0, 0], [1, 0], [0, 1]]", "positions are in 2 arrays"),
                                 ("b.json", "[0, 0]", "positions are in 1 array"),
                                 ("c.json", "[[[[0, 0], [1, 0], [0, 1]]]]", "positions are in 4 arrays")):
            self.write(name, text)
            err = self.fails(3, "triangulate", name, says=(says, "a bare array is taken for the rings of one polygon",
                                                           "GeoJSON", "table of points")).err
            self.assertNotIn("the Polygon", err)
        self.write("bad.geojson", '{"type": "Polygon",\n"coordinates": [[[0, 0], [1, 1], [2]]]}')
        self.fails(3, "triangulate", "bad.geojson", says="bad.geojson:2: a position needs two numbers")

    def test_loose_ends_bound_no_domain(self):
        self.write("open.edg", "3\n0 0 4 0\n4 0 4 4\n4 4 1 3\n")
        for domain in ("even_odd", "nonzero"):
            err = self.fails(3, "triangulate", "open.edg", "--domain", domain,
                             says=["open.edg: the segments do not close at point", "--domain layers"]).err
            self.assertNotIn("Domain::", err)
        self.cadt("triangulate", "open.edg", "--domain", "layers")

    def test_pipes(self):
        out = self.cadt("triangulate", "-", "-f", "poly", "-o", "-", "-t", "off", "--domain", "seeds", stdin=PLATE).out
        self.assertEqual(len(read_off(out)[1]), 10)
        self.fails(3, "triangulate", "-", "-f", "poly", stdin="0 2 0 0\n0\n0\n", says="<stdin>:1: the points are in a .node")


class NodeFiles(CliTest):
    NODES = "4 2 1 0\n0 0 0 1\n1 4 0 2\n2 4 4 3\n3 0 4 4\n"
    RINGS = "4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n"

    def test_points_beside_a_poly_are_not_lost(self):
        self.write("a.node", self.NODES)
        self.write("a.poly", "0 2 0 0\n" + self.RINGS + "0\n")
        self.write("a.edge", self.RINGS)
        self.write("in.xy", "1 1\n")
        for command in (["triangulate", "a.poly"], ["triangulate", "a.edge"], ["triangulate", "in.xy", "--segments", "a.poly"]):
            self.fails(2, *command, "-o", "a.node", says="a.node: this has the points of a.")
            self.fails(2, *command, "--stats=./a.node", says="this has the points of a.")
        self.assertEqual(self.path("a.node").read_text(), self.NODES)
        self.write("b.node", "old")
        self.write("b.poly", self.NODES + self.RINGS + "0\n")  # which has its points itself
        self.cadt("triangulate", "b.poly", "-o", "b.node")
        self.assertTrue(self.path("b.node").read_text().startswith("4"))

    def test_holes_and_regions_stay(self):
        self.write("plate.poly", PLATE)
        mesh = self.cadt("triangulate", "plate.poly", "--domain", "seeds", "-o", "again.poly", "-o", "m.off")
        again = self.cadt("triangulate", "again.poly", "--domain", "seeds", "-o", "n.off")
        self.assertIn("inside", mesh.err)
        line = next(line for line in mesh.err.splitlines() if line.startswith("inside"))
        self.assertIn(line, again.err)
        tail = self.path("again.poly").read_text().splitlines()
        self.assertGreater(len(tail), 10)


class GraphInfo(CliTest):
    def test_text_and_json(self):
        self.write("plate.poly", PLATE.replace("8 0\n0 0 1", "9 0\n8 8 8\n0 0 1"))
        fields = self.cadt("info", "plate.poly").fields()
        self.assertEqual((fields["points"], fields["segments"], fields["holes"], fields["regions"]),
                         ("10", "9, 1 of them of zero length", "1", "0"))
        found = json.loads(self.cadt("info", "plate.poly", "--json").out)
        self.assertEqual((found["segments"], found["zero_length"], found["holes"], found["regions"]), (9, 1, 1, 0))
        self.write("p.xy", "0 0\n1 0\n")
        self.assertNotIn("segments", self.cadt("info", "p.xy").out)
        self.assertNotIn("segments", self.cadt("info", "p.xy", "--json").out)
        self.write("a.geojson", geojson(polygon(SQUARE, HOLE)))
        self.assertEqual(self.cadt("info", "a.geojson").fields()["segments"], "8")


class ConstraintDocumentation(CliTest):
    def test_every_option_is_described(self):
        text = (SOURCE / "docs" / "cli.md").read_text()
        for word in ("--segments FILE", "--domain RULE", "--crossing RULE", "cadt polygons", "cadt labels"):
            self.assertIn(word, text)
        for command in ("triangulate", "polygons", "labels"):
            self.assertIn("-o", self.cadt(command, "--help").out)


if __name__ == "__main__":
    unittest.main()
