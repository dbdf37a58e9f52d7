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
