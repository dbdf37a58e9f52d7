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

        def claims(change, says):
            wrong = json.loads(json.dumps(right))
            change(wrong)
            self.write("m.cadt/manifest.json", json.dumps(wrong))
            result = self.cadt("verify", "m.cadt", expect=7)
            self.assertIn(says, result.out + result.err)

        claims(lambda m: m.update(hash="f" * 32), "hash is not that of the triangles")
        claims(lambda m: m["nodes"][1].update(base=1), "triangles before a node")
        claims(lambda m: m["nodes"][0]["sums"].update(certified_edges=1), "not the sum of its nodes")
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
