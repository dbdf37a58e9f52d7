# SPDX-License-Identifier: Apache-2.0
"""What the program hands to cadt-terrain, and what it says where that is not installed."""
import json
import os
import shutil
import sys
import unittest
from unittest import mock

from harness import PROGRAM, CliTest

STAND_IN = """#!{python}
import json, os, sys
json.dump({{"name": os.path.basename(sys.argv[0]), "words": sys.argv[1:], "from": {place!r}}}, sys.stdout)
sys.exit(42)
"""


class TerrainHandOver(CliTest):
    def setUp(self):
        super().setUp()
        for name in ("path", "beside", "empty"):
            self.path(name).mkdir()
        self.look_in("path")

    def look_in(self, *folders):
        """Nothing but these folders is on PATH."""
        patch = mock.patch.dict(os.environ, {"PATH": ":".join(str(self.path(folder)) for folder in folders)})
        patch.start()
        self.addCleanup(patch.stop)

    def install(self, folder, name="cadt-terrain", mode=0o755):
        script = self.path(folder) / name
        script.write_text(STAND_IN.format(python=sys.executable, place=folder))
        script.chmod(mode)

    def handed(self, *words, **more):
        """The words that the stand-in got."""
        answer = json.loads(self.cadt(*words, expect=42, **more).out)
        self.assertEqual(answer["name"], "cadt-terrain")
        return answer

    def test_words_and_exit_code_pass_through(self):
        self.install("path")
        for words in (["contour", "in.laz", "out.gpkg", "--interval", "5"], ["tin", "a b.las", "o.glb"], ["tin", "--help"],
                      ["raster", "in.laz", "out.tif", "--res", "1", "--class", "2"], ["raster", "p.xyz", "-o", "x.TIFF"],
                      ["raster", "p.xyz", "--output=x.tif", "--res=1"], ["raster", "p.xyz", "-ox.tif"],
                      ["raster", "--res", "1", "in.LAZ", "-o", "d.asc"], ["raster", "x.parquet"], ["raster", "x.fgb"],
                      ["raster", "x.geojson"], ["raster", "x.gpkg"], ["raster", "p.xyz", "d.asc", "--align=g.asc"],
                      ["raster", "p.xyz", "d.asc", "--breaklines", "g.shp"],
                      ["raster", "in.laz", "", "-q"]):
            self.assertEqual(self.handed(*words)["words"], words)

    def test_everything_else_is_done_here(self):
        self.install("path")
        self.write("p.xyz", "0 0 1\n2 0 1\n0 2 1\n2 2 1\n")
        self.cadt("raster", "p.xyz", "--res", "1", "-o", "d.asc")
        self.assertIn("d.asc", self.names())
        self.assertIn("cadt raster scan.laz", self.cadt("raster", "--help").out)
        self.fails(2, "triangulate", "p.xyz", "-o", "m.tif", says="unknown suffix '.tif'")
        self.fails(2, "contours", says="did you mean contour?")

    def test_the_one_beside_the_program_comes_first(self):
        self.install("path")
        self.install("beside")
        shutil.copy(PROGRAM, self.path("beside") / "cadt")
        program = self.path("beside") / "cadt"
        self.assertEqual(self.handed("tin", program=program)["from"], "beside")
        os.symlink(program, self.path("empty") / "cadt")  # as in ~/bin
        self.assertEqual(self.handed("tin", program=self.path("empty") / "cadt")["from"], "beside")
        self.look_in("beside", "path")
        self.assertEqual(self.handed("tin", program="cadt")["from"], "beside")

    def test_without_it_the_message_says_what_to_install(self):
        self.install("path", mode=0o644)  # cannot be executed
        self.look_in("path", "empty", "missing")
        self.write("in.laz", "")
        for words in (["raster", "in.laz", "out.tif", "--res", "1"], ["contour", "in.laz"], ["tin"]):
            self.fails(5, *words, says=[f"cadt {words[0]}:", 'pip install "cadt[terrain]"', "not installed"])
        self.assertEqual(self.names(), ["beside", "empty", "in.laz", "path"])

    def test_one_that_cannot_be_started_is_named(self):
        self.path("path").joinpath("cadt-terrain").write_text("#!/no/such/interpreter\n")
        self.path("path").joinpath("cadt-terrain").chmod(0o755)
        self.fails(5, "tin", says=["cannot be started", "path/cadt-terrain: No such file", "pip install"])

    def test_help_lists_the_commands(self):
        self.look_in("empty")
        text = self.cadt("--help").out
        for words in ("\n  contour  ", "\n  tin  ", 'pip install "cadt[terrain]"'):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
