# SPDX-License-Identifier: Apache-2.0
"""Directories of cadt tiles: names, manifests, copies."""
import json
import unittest

from harness import CliTest, digest


class TilesDirectoryTest(CliTest):
    def test_names_that_cannot_be_looked_at(self):
        self.scattered("points.f64", 300)
        self.path("loop").symlink_to("pool")
        self.path("pool").symlink_to("loop")
        for name in ("loop", "x" * 300):
            self.fails(3, "tiles", name, "-f", "f64", says=name)
            self.fails(3, "tiles", "points.f64", "-o", name, says=name)

    def test_manifests_that_claim_something_else(self):
        self.scattered("points.f64", 300)
        self.cadt("tiles", "points.f64", "--tile-points", 30, "-o", "m.cadt", "--backend", "host")
        right = json.loads(self.path("m.cadt/manifest.json").read_text())

        def claims(change, says, code=7):
            wrong = json.loads(json.dumps(right))
            change(wrong)
            self.write("m.cadt/manifest.json", json.dumps(wrong))
            result = self.cadt("verify", "m.cadt", expect=code)
            self.assertIn(says, result.out + result.err)
            return wrong

        def contradicts(change, says):
            claims(change, says, 3)
            self.fails(3, "info", "m.cadt", says=("is damaged", says))
            self.fails(3, "tiles", "points.f64", "--tile-points", 30, "-o", "m.cadt", "--backend", "host", "--resume",
                       says=("is damaged", says))

        node = right["nodes"][0]
        self.assertTrue(node["links"] > 0 and node["open"] > 0)
        claims(lambda m: m["nodes"][1].update(base=1), "triangles before a node")
        for key in ("points", "triangles", "links", "duplicates", "open"):
            claims(lambda m, key=key: m["nodes"][0].update({key: node[key] + 1}), key)
        claims(lambda m: m["nodes"][-1].update(open=1), "open vertices of the whole mesh")

        def swap_hashes(m):
            first, second = (m["nodes"][i]["sums"] for i in (0, 1))
            first["hash"], second["hash"] = second["hash"], first["hash"]

        claims(swap_hashes, "hash of node-000000")
        contradicts(lambda m: m.update(hash="f" * 32), "its hash of the mesh")
        contradicts(lambda m: m["nodes"][0]["sums"].update(certified_edges=1), "not the sum of its nodes")
        contradicts(lambda m: m["whole"].update(distinct=299), "not the sum of its nodes")
        for dimension in (2**64 - 1, 2**64 - 2, 3, -2, 2.5, "2", None, True):
            contradicts(lambda m, d=dimension: m["nodes"][0]["sums"].update(dimension=d), "a dimension is from -1 to 2")
        for dimension in (-1, 1):
            contradicts(lambda m, d=dimension: m["nodes"][0]["sums"].update(dimension=d), "the dimension is not 2")
        contradicts(lambda m: m.update(points=301), "number of points")
        contradicts(lambda m: m["nodes"][0].update(files=[]), "a node has not its files")
        contradicts(lambda m: m["nodes"][0]["files"].reverse(), "a node has not its files")
        for key, value in (("tile_points", 30.5), ("tile_points", -30), ("first_id", 2**64), ("first_id", True), ("points", "300")):
            contradicts(lambda m, key=key, value=value: m.update({key: value}), "is no number")
        contradicts(lambda m: m["tree"][2].update(children=[2**32, 1]), "is no number")
        self.write("m.cadt/manifest.json", json.dumps(right))
        self.cadt("verify", "m.cadt")

    def test_merge_writes_nothing_into_its_input(self):
        self.scattered("points.f64", 300)
        self.cadt("tiles", "points.f64", "--tile-points", 30, "-o", "m.cadt", "--backend", "host")
        self.path("link.cadt").symlink_to("m.cadt")
        self.path("file.off").symlink_to("m.cadt/manifest.json")
        self.path("beside").mkdir()
        before = digest(self.path("m.cadt"))
        for name in ("m.cadt/manifest.json", "./m.cadt/manifest.json", "beside/../m.cadt/new.off", "link.cadt/run.json",
                     self.path("m.cadt/a.off"), "file.off"):
            for mesh in ("m.cadt", "link.cadt/", "./beside/../m.cadt"):
                self.fails(2, "merge", mesh, "-o", name, "-t", "off", says=("the input, which would be lost", str(name)))
        for option in ("--pvtu", "--ply"):
            for name in ("m.cadt", "m.cadt/pieces", "link.cadt/pieces/more"):
                self.fails(2, "merge", "m.cadt", option, name, says="the input, which would be lost")
        self.assertEqual(digest(self.path("m.cadt")), before)
        self.cadt("merge", "m.cadt", "-o", "m.cadt/../m.off", "-o", "beside/m.off", "-q")
        self.assertEqual(self.names(), ["beside", "file.off", "link.cadt", "m.cadt", "m.off", "points.f64"])

    def test_outputs_beside_a_mesh(self):
        self.scattered("points.f64", 300)
        command = ("tiles", "points.f64", "--tile-points", 30, "--backend", "host", "-o", "m.cadt")
        self.cadt(*command)
        before = digest(self.path("m.cadt"))
        for option, name in (("--stats", "manifest.json"), ("--stats", "node-000000/ids.npy"), ("--picture", "new.svg")):
            self.fails(2, *command, "--resume", option, f"m.cadt/{name}", says=(f"m.cadt/{name}", "outside of it"))
        for mesh in ("new.cadt", "new.cadt/", "./none/../new.cadt"):  # that is not there yet
            for option, name in (("--stats", "new.cadt"), ("--stats", "new.cadt/s.json"), ("--picture", "./new.cadt/s.svg")):
                self.fails(2, *command[:-1], mesh, option, name, says=(name, "outside of it"))
        self.assertNotIn("new.cadt", self.names())
        self.assertEqual(digest(self.path("m.cadt")), before)
        self.assertNotIn("new.svg", [path.name for path in self.path("m.cadt").iterdir()])
        self.cadt(*command, "--resume", "--stats", "beside.json", "--picture", "beside.svg")

    def test_merge_within_its_input(self):
        self.scattered("points.f64", 300)
        self.cadt("tiles", "points.f64", "--tile-points", 30, "-o", "m.cadt", "--backend", "host")
        self.folder = self.path("m.cadt")
        self.fails(2, "merge", ".", "-o", "new.off", says="the input, which would be lost")
        self.fails(2, "merge", "../m.cadt", "--ply", "new", says="the input, which would be lost")
        self.assertEqual({"new", "new.off"} & set(self.names()), set())

    def test_a_copy_without_empty_folders(self):
        self.scattered("points.f64", 300)
        command = ("tiles", "points.f64", "--tile-points", 30, "--backend", "host", "-o")
        self.cadt(*command, "m.cadt")
        self.path("part.cadt").mkdir()
        incomplete = {key: value for key, value in json.loads(self.path("m.cadt/manifest.json").read_text()).items()
                      if key not in ("nodes", "whole", "hash")}
        self.write("part.cadt/manifest.json", json.dumps({**incomplete, "complete": False}))
        self.cadt(*command, "part.cadt", "--resume")
        self.assertEqual(digest(self.path("part.cadt")), digest(self.path("m.cadt")))


if __name__ == "__main__":
    unittest.main()
