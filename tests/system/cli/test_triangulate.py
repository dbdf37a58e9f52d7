# SPDX-License-Identifier: Apache-2.0
"""cadt triangulate: what comes out."""
import json
import os
import subprocess
import unittest
import zipfile

from harness import PROGRAM, SOURCE, CliTest, integer_points, read_off, why_not_delaunay, xy_text

MESH_FORMATS = ["node", "ele", "neigh", "obj", "off", "ply", "vtu", "glb", "npz", "svg", "pdf", "png"]


class Summary(CliTest):
    def setUp(self):
        super().setUp()
        self.points = integer_points(60) + [(500, 500), (500, 500)]
        self.write("in.xy", xy_text(self.points))

    def test_goes_to_stdout_without_output(self):
        result = self.cadt("triangulate", "in.xy")
        fields = result.fields()
        distinct = len(set(self.points))
        self.assertEqual(int(fields["points"]), len(self.points))
        self.assertEqual(int(fields["duplicates"]), len(self.points) - distinct)
        self.assertEqual(int(fields["triangles"]), 2 * distinct - 2 - int(fields["hull"]))
        self.assertRegex(fields["hash"], r"^[0-9a-f]{32}$")
        self.assertRegex(fields["time"], r"^\d+\.\d+ s ")
        self.assertTrue(fields["back end"])
        self.assertEqual(result.err, "")

    def test_goes_to_stderr_with_output(self):
        result = self.cadt("triangulate", "in.xy", "-o", "m.off")
        self.assertEqual(result.out, "")
        self.assertRegex(result.err, r"(?m)^triangles +\d+$")
        self.assertNotIn("\r", result.err, "no progress line in a pipe")

    def test_quiet_says_nothing(self):
        result = self.cadt("triangulate", "in.xy", "-o", "m.off", "-q")
        self.assertEqual((result.out, result.err), ("", ""))

    def test_hash_depends_on_the_points_alone(self):
        hashes = {self.cadt("triangulate", "in.xy", "--backend", "host", *more).fields()["hash"]
                  for more in ([], ["--threads", "1"], ["--threads", "2"], ["--order", "fast"])}
        self.assertEqual(len(hashes), 1)
        self.write("other.xy", xy_text(self.points[:-3]))
        self.assertNotIn(self.cadt("triangulate", "other.xy").fields()["hash"], hashes)


class Outputs(CliTest):
    def setUp(self):
        super().setUp()
        self.points = integer_points(80)
        self.write("in.xy", xy_text(self.points))

    def test_mesh_is_delaunay(self):
        self.cadt("triangulate", "in.xy", "-o", "m.off")
        vertices, triangles = read_off(self.path("m.off").read_text())
        self.assertEqual([(float(x), float(y)) for x, y, _ in vertices], [tuple(map(float, p)) for p in self.points])
        self.assertIsNone(why_not_delaunay(self.points, triangles))

    def test_all_formats_at_once(self):
        files = [f"m.{suffix}" for suffix in MESH_FORMATS]
        arguments = [word for file in files for word in ("-o", file)]
        self.cadt("triangulate", *arguments, "in.xy")
        self.assertEqual(self.names(), sorted(files + ["in.xy"]))
        for file in files:
            self.assertGreater(self.path(file).stat().st_size, 100, file)
        self.assertTrue(self.path("m.png").read_bytes().startswith(b"\x89PNG"))
        self.assertTrue(self.path("m.npz").read_bytes().startswith(b"PK"))
        self.assertIn("<svg", self.path("m.svg").read_text())
        glb = self.path("m.glb").read_bytes()
        described = json.loads(glb[20:20 + int.from_bytes(glb[12:16], "little")])
        self.assertEqual(described["accessors"][0]["count"], len(self.points))

    def test_archives_of_empty_arrays(self):
        self.write("line.xy", "0 0\n1 1\n2 2\n")
        self.write("one.xy", "0 0\n")
        for points in ("in.xy", "line.xy", "one.xy"):  # none has duplicates
            self.cadt("triangulate", points, "-o", "m.npz")
            self.cadt("voronoi", points, "-o", "v.npz")
            for archive in ("m.npz", "v.npz"):
                with zipfile.ZipFile(self.path(archive)) as members:
                    self.assertIsNone(members.testzip(), f"{points} {archive}")
            self.cadt("verify", points, "m.npz")

    def test_option_overrides_the_suffix(self):
        self.cadt("triangulate", "in.xy", "-o", "mesh.dat", "-t", "off")
        self.assertTrue(self.path("mesh.dat").read_text().startswith("OFF"))

    def test_one_format_for_each_output(self):
        result = self.cadt("triangulate", "in.xy", "-o", "m.obj", "-t", "auto", "-o", "-", "-t", "off")
        self.assertTrue(result.out.startswith("OFF"))
        self.assertNotIn("OFF", self.path("m.obj").read_text())

    def test_stdin_to_stdout(self):
        result = self.cadt("triangulate", "-", "-f", "xy", "-o", "-", "-t", "off", stdin=xy_text(self.points))
        self.assertIsNone(why_not_delaunay(self.points, read_off(result.out)[1]))

    def test_files_are_equal_for_any_number_of_threads(self):
        for threads in (1, 2, 4):
            self.cadt("triangulate", "in.xy", "-o", f"m{threads}.off", "--threads", threads, "--backend", "host")
        self.assertEqual(self.path("m1.off").read_bytes(), self.path("m2.off").read_bytes())
        self.assertEqual(self.path("m1.off").read_bytes(), self.path("m4.off").read_bytes())

    def test_base_counts_from_one(self):
        def corners(name):
            lines = [line.split() for line in self.path(name).read_text().splitlines() if not line.startswith("#")]
            return [[int(word) for word in line[1:4]] for line in lines[1:]]
        self.cadt("triangulate", "in.xy", "-o", "zero.ele")
        self.cadt("triangulate", "in.xy", "-o", "one.ele", "--base", "1")
        self.assertEqual([[i + 1 for i in row] for row in corners("zero.ele")], corners("one.ele"))
        self.assertEqual(min(map(min, corners("one.ele"))), 1)
        self.write("two.node", "1 2 0 0\n1 0 0\n")
        self.cadt("triangulate", "in.xy", "-o", "two.ele")
        self.assertEqual(corners("two.ele"), corners("one.ele"))
        os.mkfifo(self.path("pipe.node"))  # which nobody writes
        self.cadt("triangulate", "in.xy", "-o", "pipe.ele")
        self.assertEqual(corners("pipe.ele"), corners("zero.ele"))

    def test_fast_order_is_another_order_of_the_same_triangles(self):
        meshes = []
        for order in ("canonical", "fast"):
            self.cadt("triangulate", "in.xy", "-o", "m.off", "--order", order, "--backend", "host", "--threads", 1)
            meshes.append(read_off(self.path("m.off").read_text())[1])
        rotated = [[min(t[k:] + t[:k] for k in range(3)) for t in mesh] for mesh in meshes]
        self.assertEqual(rotated[0], sorted(rotated[0]), "canonical: ascending")
        self.assertNotEqual(rotated[0], rotated[1])
        self.assertEqual(rotated[0], sorted(rotated[1]))

    def test_ascii_is_text(self):
        self.cadt("triangulate", "in.xy", "-o", "b.ply", "-o", "c.ply", "--verify")
        self.cadt("triangulate", "in.xy", "-o", "a.ply", "--ascii")
        self.assertIn("format ascii", self.path("a.ply").read_text())
        self.assertIn(b"format binary", self.path("b.ply").read_bytes())

    def test_width_of_a_picture(self):
        self.cadt("triangulate", "in.xy", "-o", "m.png", "--width", "321")
        self.assertEqual(int.from_bytes(self.path("m.png").read_bytes()[16:20], "big"), 321)

    def test_an_existing_file_is_replaced(self):
        self.write("m.off", "old")
        self.cadt("triangulate", "in.xy", "-o", "m.off")
        self.assertTrue(self.path("m.off").read_text().startswith("OFF"))


class Inputs(CliTest):
    TABLE = "id,lon,lat,depth\n1,0,0,5\n2,10,0,6\n3,0,10,7\n4,9,8,8\n"

    def test_columns_by_name_and_by_number(self):
        self.write("in.csv", self.TABLE)
        for columns in ("lon,lat,depth", "2,3,4"):
            off = self.cadt("triangulate", "in.csv", "--columns", columns, "-o", "-", "-t", "off").out
            vertices = [tuple(map(float, v)) for v in read_off(off)[0]]
            self.assertEqual(vertices, [(0, 0, 5), (10, 0, 6), (0, 10, 7), (9, 8, 8)])

    def test_a_column_that_is_not_there(self):
        self.write("in.csv", self.TABLE)
        self.fails(3, "triangulate", "in.csv", "--columns", "lon,height", says=["in.csv", "height"])

    def test_projections_keep_the_third_coordinate(self):
        corners = [(1, 2, 30), (4, 5, 90), (7, 9, 10), (8, 1, 20)]
        self.write("in.xyz", xy_text(corners))
        orders = {"xy": (0, 1, 2), "yz": (1, 2, 0), "zx": (2, 0, 1)}
        for plane, order in orders.items():
            off = self.cadt("triangulate", "in.xyz", "--project", plane, "-o", "-", "-t", "off").out
            vertices, triangles = read_off(off)
            expected = [tuple(float(p[k]) for k in order) for p in corners]
            self.assertEqual([tuple(map(float, v)) for v in vertices], expected, plane)
            self.assertIsNone(why_not_delaunay([p[:2] for p in expected], triangles), plane)

    def test_format_overrides_the_suffix(self):
        self.write("points.dat", "0,0\n4,0\n0,3\n")
        self.fails(3, "triangulate", "points.dat", says="points.dat")
        self.assertEqual(self.cadt("triangulate", "points.dat", "-f", "csv").fields()["triangles"], "1")

    def test_a_pipeline(self):
        made = subprocess.Popen([PROGRAM, "generate", "terrain", "-n", "500", "-o", "-", "-t", "xyz", "-q"],
                                stdout=subprocess.PIPE)
        mesh = subprocess.run([PROGRAM, "triangulate", "-", "-f", "xyz", "-o", "-", "-t", "off"], stdin=made.stdout,
                              capture_output=True, timeout=60)
        made.stdout.close()
        self.assertEqual((made.wait(), mesh.returncode), (0, 0), mesh.stderr)
        vertices, triangles = read_off(mesh.stdout.decode())
        self.assertEqual(len(vertices), 500)
        self.assertGreater(len({z for _, _, z in vertices}), 100, "the heights are carried")
        self.assertGreater(len(triangles), 900)


class Statistics(CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.xy", xy_text(integer_points(50)))

    def keys(self, value):
        if isinstance(value, dict):
            return set(value) | {key for item in value.values() for key in self.keys(item)}
        if isinstance(value, list):
            return {key for item in value for key in self.keys(item)}
        return set()

    def test_file(self):
        result = self.cadt("triangulate", "in.xy", "--stats=s.json", "-o", "m.off", "--verify")
        self.assertEqual(result.out, "")
        data = json.loads(self.path("s.json").read_text())
        self.assertEqual(data["schema"], 2)
        self.assertEqual(data["input"], {"file": "in.xy", "format": "xy", "heights": False})
        self.assertEqual(data["outputs"], [{"file": "m.off", "format": "off"}])
        self.assertEqual(data["mesh"]["triangles"], len(read_off(self.path("m.off").read_text())[1]))
        self.assertEqual(data["mesh"]["dimension"], 2)
        self.assertTrue(data["verification"]["ok"])
        self.assertGreater(len(data["verification"]["checks"]), 3)
        self.assertGreater(data["counters"]["certified_edges"], 0)
        self.assertGreater(len(data["phases"]), 0)
        self.assertEqual(self.names(), ["in.xy", "m.off", "s.json"])

    def test_every_key_is_documented(self):
        self.cadt("triangulate", "in.xy", "--stats=s.json", "--kernel-times", "-o", "m.off", "--verify")
        report = json.loads(self.path("s.json").read_text())
        header = (SOURCE / "include" / "cadt" / "statistics.hpp").read_text()
        for counter in report.pop("counters"):
            self.assertRegex(header, rf"(?m)^  std::uint64_t {counter} = 0; +///< \w")
        text = (SOURCE / "docs" / "cli.md").read_text()
        for key in {"counters"} | self.keys(report):
            self.assertIn(f"`{key}`", text)

    def test_on_stdout_the_summary_goes_to_stderr(self):
        result = self.cadt("triangulate", "in.xy", "--stats=-")
        self.assertEqual(json.loads(result.out)["mesh"]["points"], 50)
        self.assertRegex(result.err, r"(?m)^points +50$")

    def test_table(self):
        result = self.cadt("triangulate", "--stats", "in.xy")
        self.assertRegex(result.err, r"(?m)^certified_edges +\d+")
        self.assertRegex(result.out, r"(?m)^points +50$")

    def test_summary_without_verification(self):
        self.cadt("triangulate", "in.xy", "--stats=s.json", "-q")
        self.assertIsNone(json.loads(self.path("s.json").read_text())["verification"])

    def test_unwritable_file_is_found_before_the_work(self):
        self.fails(3, "triangulate", "in.xy", "--stats=none/s.json", "-o", "m.off", says="none/s.json")
        self.assertEqual(self.names(), ["in.xy"])

    def test_the_input_is_not_lost(self):
        self.write("in.xy", "0 0\n1 0\n0 1\n")
        self.write("a.geojson", '{"type":"LineString","coordinates":[[0,0],[1,0]]}')
        for stats, more in (("in.xy", ()), ("./in.xy", ()), ("a.geojson", ("--segments", "a.geojson"))):
            self.fails(2, "triangulate", "in.xy", *more, f"--stats={stats}", says="this is the input")
        self.fails(2, "triangulate", "in.xy", "-o", "m.off", "--stats=./m.off", says="--stats and -o")
        self.assertEqual(self.path("in.xy").read_text(), "0 0\n1 0\n0 1\n")

    def test_two_things_for_one_place(self):
        self.fails(2, "triangulate", "in.xy", "--stats=-", "-o", "-", "-t", "off", says="standard output")
        self.fails(2, "triangulate", "in.xy", "--stats=m.off", "-o", "m.off", says="m.off")


class Strategies(CliTest):
    def setUp(self):
        super().setUp()
        self.cadt("generate", "uniform", "-n", 20000, "-o", "in.f64")

    def run_with(self, *options):
        result = self.cadt("triangulate", "in.f64", "--backend", "host", "--stats=s.json", "-o", "m.off", *options)
        return result, json.loads(self.path("s.json").read_text())["counters"], self.path("m.off").read_bytes()

    def test_the_mesh_is_the_same(self):
        _, _, expected = self.run_with()
        for strategy in ("auto", "locks", "stars"):
            _, counters, mesh = self.run_with("--strategy", strategy, "--verify")
            self.assertEqual(mesh, expected, strategy)
            if strategy == "locks":
                self.assertEqual((counters["tiles"], counters["proven_stars"]), (0, 0))
            if strategy == "stars":
                self.assertGreater(counters["tiles"], 20)
                self.assertGreater(counters["proven_stars"], 17000)
                self.assertLess(counters["proven_stars"], 20000)
                self.assertLess(counters["splits"], 20000 - counters["proven_stars"])

    def test_the_table_has_both_numbers(self):
        table = self.cadt("triangulate", "in.f64", "--backend", "host", "--strategy", "stars", "--stats").err
        self.assertRegex(table, r"(?m)^tiles +[1-9]\d+")
        self.assertRegex(table, r"(?m)^proven_stars +1\d{4} +0\.\d+")

    def test_other_words(self):
        for word in ("star", "Stars", "", "automatic", "1"):
            self.fails(2, "triangulate", "in.f64", "--strategy", word, says="--strategy")

    def test_stars_and_stabilize_exclude_each_other(self):
        for mode in ("defer", "paper"):
            self.fails(2, "triangulate", "in.f64", "--strategy", "stars", "--stabilize", mode,
                       says=["--stabilize", "--strategy stars"])
            self.cadt("triangulate", "in.f64", "--strategy", "locks", "--stabilize", mode)
        self.cadt("triangulate", "in.f64", "--strategy", "stars", "--stabilize", "off")

    def test_few_points(self):
        self.write("line.xy", "0 0\n1 1\n2 2\n")
        self.assertEqual(self.cadt("triangulate", "line.xy", "--strategy", "stars").fields()["triangles"], "0")
        self.write("four.xy", "0 0\n1 0\n1 1\n0 1\n")
        self.assertEqual(self.cadt("triangulate", "four.xy", "--strategy", "stars").fields()["triangles"], "2")


class Stabilized(CliTest):
    def setUp(self):
        super().setUp()
        self.cadt("generate", "circles", "-n", 20000, "-o", "in.f64")

    def run_with(self, *options):
        result = self.cadt("triangulate", "in.f64", "--backend", "host", "--stats=s.json", "-o", "m.off", *options)
        return result, json.loads(self.path("s.json").read_text()), self.path("m.off").read_bytes()

    def test_defer_is_the_same_mesh(self):
        _, off, exact = self.run_with()
        result, data, mesh = self.run_with("--stabilize", "defer", "--verify")
        self.assertEqual(mesh, exact)
        self.assertEqual(data["stabilize"], {"mode": "defer", "flip_threshold": 3, "epsilon": 1e-4})
        self.assertGreater(data["counters"]["stabilized_edges"], 0)
        self.assertEqual(off["counters"]["stabilized_edges"], 0)
        self.assertTrue(data["certified"])
        self.assertEqual(data["differing_triangles"], 0)
        self.assertNotIn("not exact", result.err)

    def test_paper_tells_how_far_it_is_off(self):
        _, _, exact = self.run_with()
        result, data, mesh = self.run_with("--stabilize", "paper", "--flip-threshold", "0", "--epsilon", "0.5")
        self.assertNotEqual(mesh, exact)
        self.assertFalse(data["certified"])
        self.assertGreater(data["counters"]["illegal_edges"], 0)
        theirs = set(exact.split(b"\n"))
        differing = sum(line not in theirs for line in mesh.split(b"\n"))
        self.assertEqual(data["differing_triangles"], differing)
        self.assertRegex(result.err, fr"(?m)^not exact +\d+ edges left illegal, {differing} triangles")

    def test_paper_and_verify_exclude_each_other(self):
        self.fails(2, "triangulate", "in.f64", "--stabilize", "paper", "--verify", says="--verify")

    def test_numbers_out_of_range(self):
        self.fails(2, "triangulate", "in.f64", "--stabilize", "sometimes", says="sometimes")
        self.fails(2, "triangulate", "in.f64", "--flip-threshold", "1001", says="--flip-threshold")
        self.fails(2, "triangulate", "in.f64", "--epsilon", "-1", says="--epsilon")
        self.fails(2, "triangulate", "in.f64", "--flip-threshold", "5", says="--stabilize")
        self.fails(2, "triangulate", "in.f64", "--stabilize", "defer", "--epsilon", "1", says="--stabilize paper")

    def test_timing(self):
        result, data, _ = self.run_with("--timing")
        self.assertAlmostEqual(sum(data["thread_time"].values()), 1)
        self.assertEqual(len(data["flips_per_edge"]), 16)
        self.assertEqual(self.run_with()[1]["thread_time"], {})
        table = self.cadt("triangulate", "in.f64", "--backend", "host", "--stats", "--timing").err
        self.assertRegex(table, r"(?m)^locate +\d+\.\d %")
        self.assertRegex(table, r"(?m)^15\+ +\d+")
        self.fails(2, "triangulate", "in.f64", "--timing", says="--stats")

    def test_kernel_times(self):
        _, data, mesh = self.run_with("--kernel-times")
        kernels = {kernel["name"]: kernel for kernel in data["kernels"]}
        self.assertEqual(len(kernels), len(data["kernels"]))
        self.assertGreater(kernels["cadt_insert"]["milliseconds"], 0)
        self.assertEqual(sum(kernel["launches"] for kernel in kernels.values()), data["counters"]["launches"])
        self.assertAlmostEqual(sum(kernel["share"] for kernel in kernels.values()), 1)
        self.assertLessEqual(sum(kernel["milliseconds"] for kernel in kernels.values()),
                             1000 * data["seconds"]["triangulate"])
        _, without, expected = self.run_with()
        self.assertEqual(without["kernels"], [])
        self.assertEqual(mesh, expected)
        table = self.cadt("triangulate", "in.f64", "--backend", "host", "--stats", "--kernel-times").err
        self.assertRegex(table, r"(?m)^cadt_insert +\d+ +\d+\.\d+ +\d+\.\d %")
        self.fails(2, "triangulate", "in.f64", "--kernel-times", says="--stats")


class Degenerate(CliTest):
    CASES = {"one": "1 2\n", "two": "0 0\n1 1\n", "same": "5 5\n5 5\n5 5\n5 5\n", "line": "0 0\n1 1\n2 2\n7 7\n"}

    def test_empty_mesh_with_a_warning(self):
        for name, text in self.CASES.items():
            self.write("in.xy", text)
            result = self.cadt("triangulate", "in.xy", "-o", "m.off", "-o", "m.ele", "-o", "m.svg", "-o", "m.png")
            self.assertIn("cadt: warning:", result.err, name)
            vertices, triangles = read_off(self.path("m.off").read_text())
            self.assertEqual((len(vertices), triangles), (text.count("\n"), []), name)

    def test_strict(self):
        for name, text in self.CASES.items():
            self.write("in.xy", text)
            self.fails(4, "triangulate", "in.xy", "-o", f"{name}.off", "--strict", says="in.xy")
        self.assertEqual(self.names(), ["in.xy"])

    def test_strict_lets_good_points_pass(self):
        self.write("in.xy", "0 0\n1 0\n0 1\n")
        result = self.cadt("triangulate", "in.xy", "--strict")
        self.assertEqual((result.fields()["triangles"], result.err), ("1", ""))


if __name__ == "__main__":
    unittest.main()
