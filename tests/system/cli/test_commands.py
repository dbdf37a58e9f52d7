# SPDX-License-Identifier: Apache-2.0
"""verify, generate, devices, info, help."""
import json
import re
import unittest

from harness import SOURCE, CliTest, in_circle, integer_points, off_text, read_off, twice_area, xy_text


class Verify(CliTest):
    def setUp(self):
        super().setUp()
        self.points = integer_points(60)
        self.write("in.xy", xy_text(self.points))
        self.cadt("triangulate", "in.xy", "-o", "m.off", "-q")
        self.triangles = read_off(self.path("m.off").read_text())[1]

    def test_accepts_what_triangulate_writes(self):
        for suffix in ("ele", "obj", "off", "ply", "vtu", "npz"):
            self.cadt("triangulate", "in.xy", "-o", f"good.{suffix}", "-q")
            result = self.cadt("verify", "in.xy", f"good.{suffix}", "--canonical")
            self.assertNotIn("FAIL", result.out, suffix)
            for name in ("counts", "orientation", "delaunay", "hull", "euler"):
                self.assertRegex(result.out, rf"(?m)^pass  {name}$", suffix)

    def test_either_base(self):
        for base in (0, 1):
            self.cadt("triangulate", "in.xy", "-o", "m.ele", "--base", base, "-q")
            self.cadt("verify", "in.xy", "m.ele")
            self.cadt("verify", "in.xy", "m.ele", "--base", base)
        self.fails(3, "verify", "in.xy", "m.ele", "--base", "0", says="m.ele:")  # an index is one too large

    def flip(self, wanted):
        """The triangles with one inner edge flipped whose four points satisfy `wanted`."""
        apex = {}
        for t in self.triangles:
            for k in range(3):
                apex[t[k], t[(k + 1) % 3]] = t[(k + 2) % 3]
        for (a, b), c in apex.items():
            d = apex.get((b, a))
            if d is None:
                continue
            p, q, r, s = (self.points[i] for i in (a, b, c, d))
            if twice_area(s, q, r) <= 0 or twice_area(r, p, s) <= 0 or not wanted(in_circle(p, q, r, s)):
                continue
            old = [t for t in self.triangles if {a, b} <= set(t)]
            self.assertEqual(len(old), 2)
            return [t for t in self.triangles if t not in old] + [(d, b, c), (c, a, d)]
        self.fail("no edge can be flipped")

    def test_finds_a_flipped_edge(self):
        self.write("bad.off", off_text(self.points, self.flip(lambda sign: sign < 0)))
        result = self.cadt("verify", "in.xy", "bad.off", expect=7)
        self.assertRegex(result.out, r"(?m)^FAIL  delaunay +1 failure")
        self.assertRegex(result.out, r"(?m)^pass  orientation$")
        self.assertRegex(result.err, r"(?m)^cadt: error: bad.off: ")

    def test_says_how_a_mesh_with_segments_is_checked(self):
        hint = "check it with `cadt triangulate IN --verify`"
        self.assertIn(hint, self.cadt("verify", "--help").out)
        self.write("in.poly", "4 2 0 0\n0 0 0\n1 4 -1\n2 8 0\n3 4 1\n1 0\n0 0 2\n0\n")
        self.cadt("triangulate", "in.poly", "-o", "s.off", "-q", "--verify")
        self.write("in.xy", "0 0\n4 -1\n8 0\n4 1\n")
        self.assertIn(hint, self.cadt("verify", "in.xy", "s.off", expect=7).err)
        ring = "0 0\n9 0\n9 9\n0 9\n3 3\n6 3\n6 6\n3 6\n"
        self.write("hole.txt", "8 8\n" + ring + "0 1\n1 2\n2 3\n3 0\n4 5\n5 6\n6 7\n7 4\n")
        self.write("ring.xy", ring)
        self.cadt("triangulate", "ring.xy", "--segments", "hole.txt", "--domain", "even_odd", "-o", "h.off", "-q", "--verify")
        self.assertIn(hint, self.cadt("verify", "ring.xy", "h.off", expect=7).err)
        self.write("bad.off", off_text([(0, 0), (4, -1), (8, 0), (4, 1)], [(0, 1, 2)]))
        self.assertNotIn(hint, self.cadt("verify", "in.xy", "bad.off", expect=7).err)

    def test_ties_count_only_when_asked_for(self):
        self.points = [(x, y) for x in range(4) for y in range(4)]
        self.write("in.xy", xy_text(self.points))
        self.cadt("triangulate", "in.xy", "-o", "m.off", "-q")
        self.triangles = read_off(self.path("m.off").read_text())[1]
        self.write("other.off", off_text(self.points, self.flip(lambda sign: sign == 0)))
        self.cadt("verify", "in.xy", "m.off", "--canonical")
        self.cadt("verify", "in.xy", "other.off")
        result = self.cadt("verify", "in.xy", "other.off", "--canonical", expect=7)
        self.assertRegex(result.out, r"(?m)^FAIL  ties ")

    def test_finds_missing_and_reversed_triangles(self):
        for name, triangles in [("missing", self.triangles[1:]),
                                ("reversed", [self.triangles[0][::-1]] + self.triangles[1:]),
                                ("twice", self.triangles + self.triangles[:1])]:
            self.write("bad.off", off_text(self.points, triangles))
            self.assertIn("FAIL", self.cadt("verify", "in.xy", "bad.off", expect=7).out, name)

    def test_an_unused_point(self):
        self.write("more.xy", xy_text(self.points + [(2000, 2000)]))
        self.write("m.ele", f"{len(self.triangles)} 3 0\n" +
                   "".join(f"{i} {a} {b} {c}\n" for i, (a, b, c) in enumerate(self.triangles)))
        self.cadt("verify", "more.xy", "m.ele", expect=7)

    def test_on_a_device(self):
        on_host = self.cadt("verify", "in.xy", "m.off").out
        result = self.cadt("verify", "in.xy", "m.off", "--backend", "host")
        self.assertEqual(result.out.splitlines()[:-1], on_host.splitlines())
        counts = [int(n) for n in re.findall(r"\d+", result.out.splitlines()[-1])]
        self.assertEqual(len(counts), 3)
        edges = int(re.search(r"(\d+) edges examined", on_host)[1])
        self.assertEqual(sum(counts), len(self.triangles) + edges)
        self.write("bad.off", off_text(self.points, self.flip(lambda sign: sign < 0)))
        result = self.cadt("verify", "in.xy", "bad.off", "--backend", "host", "--threads", "2", expect=7)
        self.assertRegex(result.out, r"(?m)^FAIL  delaunay +1 failure")
        self.fails(5, "verify", "in.xy", "m.off", "--device", "no such device", says="no such device")
        self.fails(2, "verify", "in.xy", "m.off", "--backend", "abacus", says="abacus")

    def test_quiet(self):
        self.assertEqual(self.cadt("verify", "-q", "in.xy", "m.off").out, "")

    def test_mesh_from_stdin(self):
        text = self.path("m.off").read_text()
        self.assertIn("pass", self.cadt("verify", "in.xy", "-", "-t", "off", stdin=text).out)
        self.assertIn("pass", self.cadt("verify", "-", "m.off", "-f", "xy", stdin=xy_text(self.points)).out)

    def test_malformed_mesh_is_located(self):
        self.write("bad.ele", "1 3 0\n0 0 1 999\n")
        self.fails(3, "verify", "in.xy", "bad.ele", says="bad.ele:2: ")
        self.fails(3, "verify", "in.xy", "absent.off", says="absent.off")

    def test_columns_and_projection(self):
        corners = [(1, 20, 3), (4, 50, 9), (7, 90, 1), (8, 10, 2), (3, 40, 5)]
        self.write("in.csv", "a,b,c\n" + "".join("{},{},{}\n".format(*p) for p in corners))
        self.cadt("triangulate", "in.csv", "--columns", "c,b", "-o", "m.ele", "-q")
        self.cadt("verify", "in.csv", "m.ele", "--columns", "c,b")
        self.cadt("triangulate", "in.csv", "--columns", "a,b,c", "--project", "zx", "-o", "m.ele", "-q")
        self.cadt("verify", "in.csv", "m.ele", "--columns", "a,b,c", "--project", "zx")
        self.cadt("verify", "in.csv", "m.ele", "--columns", "a,b,c", "--project", "yz", expect=7)


class Generate(CliTest):
    def test_every_listed_set_can_be_made_and_triangulated(self):
        names = [line.split()[0] for line in self.cadt("generate", "--list").out.splitlines()]
        self.assertGreater(len(names), 5)
        self.assertIn("uniform", names)
        for name in names:
            self.cadt("generate", name, "-n", "300", "-o", "p.xyz" if name == "terrain" else "p.xy", "-q")
            file = "p.xyz" if name == "terrain" else "p.xy"
            result = self.cadt("triangulate", file, "--verify", "-q")
            self.assertRegex(result.out, r"(?m)^verified +ok", name)

    def test_count_and_seed(self):
        for name, seed in (("a.xy", 1), ("b.xy", 1), ("c.xy", 2)):
            self.cadt("generate", "uniform", "-n", "1.5k", "--seed", seed, "-o", name)
        a, b, c = (self.path(name).read_text() for name in ("a.xy", "b.xy", "c.xy"))
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)
        self.assertEqual(self.cadt("triangulate", "a.xy").fields()["points"], "1500")

    def test_options_of_circles(self):
        def ties(*more):
            self.cadt("generate", "circles", "-n", "400", *more, "-o", "p.xy", "-q")
            return self.path("p.xy").read_text()
        texts = {ties(), ties("--k", "12"), ties("--radius", "0.2"), ties("--epsilon", "0.01")}
        self.assertEqual(len(texts), 4, "each option changes the points")

    def test_formats(self):
        for suffix in ("xy", "csv", "npy", "f64", "node", "ply"):
            self.cadt("generate", "uniform", "-n", "200", "-o", f"p.{suffix}", "-q")
        hashes = {self.cadt("triangulate", f"p.{suffix}").fields()["hash"]
                  for suffix in ("xy", "csv", "npy", "f64", "node", "ply")}
        self.assertEqual(len(hashes), 1, "the points do not depend on the format")


class Devices(CliTest):
    def test_table_names_every_back_end(self):
        result = self.cadt("devices")
        for backend in ("host", "opencl", "cuda"):
            self.assertRegex(result.out, rf"(?m)^{backend} ")
        self.assertRegex(result.out, r"(?m)^host +0 +yes ")
        for line in result.out.split("Not usable:\n")[1:]:
            self.assertRegex(line, r"^\w+( \d+)?: \S", "a reason for each")

    def test_json(self):
        devices = json.loads(self.cadt("devices", "--json").out)["devices"]
        self.assertEqual({d["backend"] for d in devices}, {"host", "opencl", "cuda"})
        for device in devices:
            self.assertNotEqual(device["usable"], bool(device["reason"]), device)
        host = next(d for d in devices if d["backend"] == "host")
        self.assertTrue(host["usable"] and host["fp64"] and host["compute_units"] > 0)

    def test_device_of_the_list_can_be_chosen(self):
        self.write("in.xy", xy_text(integer_points(50)))
        hashes = set()
        for device in json.loads(self.cadt("devices", "--json").out)["devices"]:
            if device["usable"]:
                result = self.cadt("triangulate", "in.xy", "--backend", device["backend"], "--device", device["index"])
                self.assertIn(device["backend"], result.fields()["back end"])
                hashes.add(result.fields()["hash"])
        self.assertEqual(len(hashes), 1, "one mesh from all devices")


class Info(CliTest):
    def test_text_and_json(self):
        self.write("in.xyz", "0 1 5\n-0.0 1 6\n4 -2 7\n0.25 1024 8\n4 -2 9\n")
        fields = self.cadt("info", "in.xyz").fields()
        self.assertEqual((fields["format"], fields["points"], fields["distinct"], fields["duplicates"]),
                         ("xyz", "5", "3", "2"))
        self.assertEqual((fields["x"], fields["y"]), ("0 to 4", "-2 to 1024"))
        self.assertEqual((fields["exponents"], fields["heights"]), ("2^-2 to 2^10", "5 to 9"))
        data = json.loads(self.cadt("info", "--json", "in.xyz").out)
        self.assertEqual((data["distinct"], data["exponents"], data["y"]), (3, [-2, 10], [-2, 1024]))

    def test_plane_points_have_no_heights(self):
        self.write("in.xy", "0 0\n0 0\n")
        fields = self.cadt("info", "in.xy").fields()
        self.assertEqual((fields["heights"], fields["distinct"]), ("none", "1"))
        self.assertIn("zero", fields["exponents"])

    def test_columns_and_projection(self):
        self.write("in.csv", "1,2,3\n4,5,6\n")
        self.assertEqual(self.cadt("info", "in.csv", "--columns", "3,1").fields()["x"], "3 to 6")
        self.assertEqual(self.cadt("info", "in.csv", "--columns", "1,2,3", "--project", "yz").fields()["x"], "2 to 5")


class Help(CliTest):
    COMMANDS = ("triangulate", "triangle", "verify", "locate", "interpolate", "raster", "voronoi", "generate", "devices",
                "info")

    def test_version(self):
        header = (SOURCE / "include" / "cadt" / "version.hpp").read_text()
        version = re.search(r'CADT_VERSION "([^"]+)"', header).group(1)
        self.assertEqual(self.cadt("--version").out, f"cadt {version}\n")

    def test_main_help_teaches(self):
        text = self.cadt("--help").out
        for command in self.COMMANDS:
            self.assertRegex(text, rf"(?m)^  {command} ")
        for code in (0, 1, 2, 3, 4, 5, 6, 7, 8, 130):
            self.assertRegex(text, rf"(?m)^ +{code}  [\w-]")
        self.assertGreaterEqual(text.count("\n\n  cadt ") + text.count("Examples:\n  cadt "), 3)
        self.assertEqual(self.cadt("-h").out, text)
        self.assertEqual(self.cadt("help").out, text)
        self.assertEqual(self.cadt("help", "raster").out, self.cadt("raster", "--help").out)
        self.fails(2, "help", "me", says="there is no command 'me'; there are: triangulate, ")
        self.fails(2, "traingulate", "a.xy", says="there is no command 'traingulate'; did you mean triangulate?")
        for name, advice in (("tile", "did you mean tiles? To triangulate a file: cadt triangulate tile"),
                             ("points", "view, generate, devices, info. To triangulate a file: cadt triangulate points")):
            self.write(name, "0 0\n")
            self.fails(2, name, says=advice)

    def test_words_that_are_no_options(self):
        options = "cadt triangulate has no option"
        self.fails(2, "triangulate", "a.xy", "--ouput", "a.ply", says=options + " --ouput; did you mean --output?")
        self.fails(2, "triangulate", "a.xy", "--dmoain=outer", says=options + " --dmoain; did you mean --domain?")
        self.fails(2, "triangulate", "a.xy", "--zzz", says=options + " --zzz; see: cadt triangulate --help")
        self.fails(2, "triangulate", "a.xy", "-n", "5", says=options + " -n; see: cadt triangulate --help")
        self.fails(2, "triangulate", "a.xy", "b.xy", says="not expected: b.xy; see: cadt triangulate --help")
        # before what is missing
        self.fails(2, "triangulate", "--bogus", says=options + " --bogus; see: cadt triangulate --help")
        self.fails(2, "raster", "a.xyz", "-o", "b.asc", "--rse", "1", says="has no option --rse; did you mean --res?")
        self.fails(2, "raster", "a.xyz", "-o", "b.asc", says="--res is required")

    def test_each_command_has_an_example(self):
        for command in self.COMMANDS:
            self.assertRegex(self.cadt(command, "--help").out, rf"Examples?:\n(.*\n)*?.*cadt {command}")

    def test_lines_fit(self):
        for arguments in [["--help"]] + [[command, "--help"] for command in self.COMMANDS]:
            for line in self.cadt(*arguments).out.splitlines():
                self.assertLessEqual(len(line), 120, line)

    def test_every_option_is_documented(self):
        text = (SOURCE / "docs" / "cli.md").read_text()
        commands = set(re.findall(r"(?m)^  ([a-z]+) ", self.cadt("--help").out.split("Subcommands:")[1].split("\n\n")[0]))
        self.assertLessEqual(set(self.COMMANDS), commands)
        for command in commands - {"contour", "tin"}:  # those of cadt-terrain
            options = set(re.findall(r"(?m)^  (?:-\w, )?(--[\w-]+)", self.cadt(command, "--help").out)) - {"--help"}
            section = text.split(f"\n## cadt {command}\n")[1].split("\n## ")[0]
            for option in options:
                self.assertRegex(section, rf"`{option}\b(?!-)", command)


if __name__ == "__main__":
    unittest.main()
