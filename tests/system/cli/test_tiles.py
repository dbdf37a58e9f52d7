#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cadt tiles and cadt merge: one mesh of many tiles, in a directory that can be resumed."""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import unittest
from unittest import mock

from harness import PROGRAM, SOURCE, CliTest, as_ordinary_user, default_signals, digest


def limit(what, size):
    def apply():
        resource.setrlimit(what, (size, size))
    return apply


class TilesTest(CliTest):
    def points(self, name="points.f64", count=3000, seed=1):
        return self.scattered(name, count, seed)

    def tiles(self, *arguments, output="mesh.cadt", **more):
        return self.cadt("tiles", *arguments, "-o", output, "--backend", "host", **more)

    def test_one_mesh_after_merging(self):
        self.points()
        done = self.tiles("points.f64", "--tile-points", 300)
        whole = self.cadt("triangulate", "points.f64").fields()
        self.assertIn(whole["hash"], done.err)
        for name in ("mesh.ele", "mesh.npz", "mesh.ply"):
            self.cadt("merge", "mesh.cadt", "-o", name)
            self.cadt("triangulate", "points.f64", "-o", "one-" + name)
            self.assertEqual(self.path(name).read_bytes(), self.path("one-" + name).read_bytes(), name)
        self.cadt("verify", "mesh.cadt")

    def test_directory_does_not_depend_on_devices_and_threads(self):
        self.points()
        self.tiles("points.f64", "--tile-points", 400, output="a.cadt")
        self.tiles("points.f64", "--tile-points", 400, "--devices", "0,0,0", "--threads", 1, output="b.cadt")
        self.path("scratch").mkdir()
        self.tiles("points.f64", "--tile-points", 400, "--scratch", "scratch", "--host-memory", "1K", output="c.cadt")
        self.assertEqual(digest(self.path("a.cadt")), digest(self.path("b.cadt")))
        self.assertEqual(digest(self.path("a.cadt")), digest(self.path("c.cadt")))
        self.assertEqual(list(self.path("scratch").iterdir()), [], "bucket files are removed")

    def test_files_are_one_set_however_split(self):
        self.points()
        data = self.path("points.f64").read_bytes()
        for name, part in (("a.f64", data[:16 * 700]), ("b.f64", data[16 * 700:16 * 701]), ("c.f64", data[16 * 701:])):
            self.path(name).write_bytes(part)
        self.tiles("points.f64", "--tile-points", 300, output="whole.cadt")
        self.tiles("a.f64", "b.f64", "c.f64", "--tile-points", 300, output="split.cadt")
        self.assertEqual(digest(self.path("whole.cadt")), digest(self.path("split.cadt")))

    def test_duplicates_in_different_files(self):
        self.points()
        self.write("again.xy", "5 5\n")
        shutil.copy(self.path("points.f64"), self.path("copy.f64"))
        self.tiles("points.f64", "again.xy", "copy.f64", "again.xy", "--tile-points", 200)
        self.assertEqual(self.cadt("info", "mesh.cadt").fields()["duplicates"], "3001")
        self.cadt("verify", "mesh.cadt")

    def test_generated_set_is_that_of_generate(self):
        for name in ("uniform", "ring", "grid"):
            self.cadt("generate", name, "-n", "2000", "--seed", 3, "-o", "p.npy")
            hashes = [re.search(r"hash +(\w+)", self.cadt(*command).out)[1] for command in (
                ("tiles", "--generate", name, "-n", "2000", "--seed", 3, "--tile-points", 100), ("triangulate", "p.npy"))]
            self.assertEqual(hashes[0], hashes[1], name)

    def test_without_output_nothing_is_written(self):
        self.points()
        done = self.cadt("tiles", "points.f64", "--tile-points", 300)
        self.assertEqual(done.fields()["hash"], self.cadt("triangulate", "points.f64").fields()["hash"])
        self.assertEqual(self.names(), ["points.f64"])

    def test_points_without_triangles(self):
        for number, text in enumerate(("1 2\n", "3 3\n" * 9, "".join(f"{i} {2 * i}\n" for i in range(20)))):
            self.write("in.xy", text)
            done = self.tiles("in.xy", "--tile-points", 3, output=f"{number}.cadt")
            self.assertIn("warning: no triangles", done.err)
            self.cadt("verify", f"{number}.cadt", "-q")
            self.cadt("merge", f"{number}.cadt", "-o", "m.off")
            self.cadt("triangulate", "in.xy", "-o", "one.off")
            self.assertEqual(self.path("m.off").read_bytes(), self.path("one.off").read_bytes())

    def test_merge_refuses_triangles_of_others(self):
        self.cadt("tiles", "--generate", "uniform", "-n", "600", "--tile-points", "200", "-o", "mesh.cadt", "-q")
        path = next(path for path in sorted(self.path("mesh.cadt").glob("node-*/triangles.npy")))
        whole = path.read_bytes()
        for byte in (-4, -1):  # another vertex, and one that there is not
            damaged = bytearray(whole)
            damaged[byte] ^= 1
            path.write_bytes(damaged)
            err = self.cadt("merge", "mesh.cadt", "-o", "m.off", expect=7).err
            self.assertNotIn("defect of cadt", err)
            self.assertNotIn("m.off", self.names())
        path.write_bytes(whole)
        self.cadt("merge", "mesh.cadt", "-o", "m.off")

    def test_statistics_and_picture(self):
        self.points()
        self.tiles("points.f64", "--tile-points", 300, "--stats", "run.json", "--picture", "tree.svg")
        report = json.loads(self.path("run.json").read_text())
        self.assertEqual(report["mesh"]["points"], 3000)
        self.assertEqual(len(report["nodes"]), report["tree"]["nodes"])
        self.assertEqual(sum(node["triangles"] for node in report["nodes"]), report["mesh"]["triangles"])
        self.assertEqual(report, json.loads(self.path("mesh.cadt/run.json").read_text()))
        svg = self.path("tree.svg").read_text()
        self.assertEqual(svg.count("<rect"), report["tree"]["leaves"])

    def test_pieces(self):
        self.points()
        self.tiles("points.f64", "--tile-points", 300)
        self.cadt("merge", "mesh.cadt", "--pvtu", "vtk", "--ply", "ply")
        pieces = re.findall(r'<Piece Source="([^"]+)"', self.path("vtk/mesh.pvtu").read_text())
        self.assertTrue(pieces)
        cells = 0
        for piece in pieces:
            head = self.path("vtk/" + piece).read_bytes()[:2000].decode(errors="replace")
            self.assertIn('GlobalIds="GlobalNodeIds"', head)
            cells += int(re.search(r'NumberOfCells="(\d+)"', head)[1])
        self.assertEqual(str(cells), self.cadt("info", "mesh.cadt").fields()["triangles"])
        self.assertEqual(len(list(self.path("ply").iterdir())), len(pieces))

    def test_info_as_json(self):
        self.points()
        self.tiles("points.f64", "--tile-points", 300)
        manifest = json.loads(self.cadt("info", "mesh.cadt", "--json").out)
        self.assertTrue(manifest["complete"])
        self.assertEqual(manifest["nodes"][-1]["base"] + manifest["nodes"][-1]["triangles"], manifest["whole"]["triangles"])


class TilesResumeTest(CliTest):
    """Four leaves and three joins, since a disk takes some 50 ms for the files of a node."""
    COMMAND = ("tiles", "points.f64", "--tile-points", 800, "--backend", "host", "--threads", 1, "-q", "-o")

    def setUp(self):
        super().setUp()
        self.scattered("points.f64", 3000)
        self.cadt(*self.COMMAND, "whole.cadt")
        self.expected = digest(self.path("whole.cadt"))

    def ended(self, at, time=1, number=signal.SIGKILL):
        """The exit code and the messages of a new run that gets a signal once a call, say "mkdir mesh.cadt", is done."""
        if os.environ.get("CADT_SANITIZE"):
            self.skipTest("the sanitizers' library has to be the first one")
        shutil.rmtree(self.path("mesh.cadt"), ignore_errors=True)
        at = f"{at} {time} {int(number)}"
        with mock.patch.dict(os.environ, {"LD_PRELOAD": os.environ["CADT_SIGNAL_AT"], "CADT_TEST_SIGNAL_AT": at}):
            with self.started(*self.COMMAND, "mesh.cadt") as process:
                _, text = process.communicate(timeout=60)
        return process.returncode, text.decode()

    def kill(self, at, time=1):
        self.assertEqual(self.ended(at, time), (-signal.SIGKILL, ""))

    def resume(self):
        self.cadt(*self.COMMAND, "mesh.cadt", "--resume")
        self.assertEqual(digest(self.path("mesh.cadt")), self.expected)
        self.cadt("verify", "mesh.cadt", "-q")

    def test_killed_in_each_phase(self):
        for at, time in (("mkdir mesh.cadt", 1), ("rename mesh.cadt/manifest.json", 1), ("mkdir mesh.cadt/node-000000.tmp", 1),
                         ("rename mesh.cadt/node-000000", 1), ("mkdir unfinished/node-000000.tmp", 1),
                         ("rename unfinished/node-000000", 1), ("rename mesh.cadt/node-000002", 1), ("rename unfinished/node-000003", 1),
                         ("rename unfinished/node-000006", 1), ("rename node-000000/links.npy", 1),
                         ("rename node-000006/links.npy", 1), ("rename mesh.cadt/manifest.json", 2)):
            with self.subTest(f"{at} {time}"):
                self.kill(at, time)
                self.resume()

    def test_killed_while_reading(self):
        with self.started(*self.COMMAND, "mesh.cadt") as process:
            process.kill()
        self.resume()

    def test_nodes_that_are_there_are_not_made_again(self):
        self.kill("rename unfinished/node-000005")  # a join: leaf 4 may be there before join 2
        before = {p: p.stat().st_mtime_ns for p in self.path("mesh.cadt").glob("node-00000?/points.npy")}
        self.assertEqual(len(before), 6)
        self.resume()
        self.assertEqual(before, {p: p.stat().st_mtime_ns for p in before})

    def test_damaged_nodes_are_made_again(self):
        for damage in ("node-000003/triangles.npy", "unfinished/node-000002/open.npy", "unfinished/node-000001/node.json"):
            for how in ("cut", "changed", "gone"):
                with self.subTest(f"{damage} {how}"):
                    self.kill("rename unfinished/node-000005")
                    path = self.path("mesh.cadt") / damage
                    data = bytearray(path.read_bytes())
                    if how == "cut":
                        path.write_bytes(data[:-3])
                    elif how == "changed":
                        data[-5] ^= 1
                        path.write_bytes(data)
                    else:
                        path.unlink()
                    self.resume()

    def test_complete_directory_is_left_alone_or_mended(self):
        shutil.copytree(self.path("whole.cadt"), self.path("mesh.cadt"))
        before = self.path("mesh.cadt/run.json").stat()
        result = self.cadt(*[a for a in self.COMMAND if a != "-q"], "mesh.cadt", "--resume")
        self.assertIn("7 of 7 nodes were there", result.err)
        after = self.path("mesh.cadt/run.json").stat()
        self.assertEqual((after.st_ino, after.st_mtime_ns), (before.st_ino, before.st_mtime_ns), "that of another run")
        self.path("mesh.cadt/run.json").unlink()
        self.resume()
        self.assertTrue(self.path("mesh.cadt/run.json").exists())
        self.path("mesh.cadt/node-000004/links.npy").write_bytes(b"")
        self.resume()

    def test_complete_directory_that_cannot_be_written(self):
        mesh = self.path("whole.cadt")
        mesh.joinpath("run.json").unlink()
        program = shutil.copy(PROGRAM, self.path("program"))  # the build folder may be closed to others
        self.folder.chmod(0o755)
        mesh.chmod(0o555)
        self.addCleanup(mesh.chmod, 0o755)
        self.cadt(*self.COMMAND, mesh, "--resume", before=as_ordinary_user, program=program)
        self.assertFalse(mesh.joinpath("run.json").exists())

    def test_interrupted(self):
        code, text = self.ended("rename unfinished/node-000000", number=signal.SIGINT)
        self.assertEqual(code, 130)
        self.assertIn("mesh.cadt can be continued with --resume", text)
        self.resume()

    def test_progress_on_a_terminal(self):
        # At most ten lines a second are drawn: enough tiles for some of them.
        with self.on_terminal("tiles", "points.f64", "--tile-points", 50, "-o", "mesh.cadt") as (process, terminal):
            self.assertRegex(terminal.wait_for(), r"(?s)tiles \d+/127 .*\rpoints")
            self.assertEqual(process.wait(timeout=60), 0)

    def test_other_runs_are_refused(self):
        self.fails(3, *self.COMMAND, "whole.cadt", says=("whole.cadt", "--resume"))
        self.fails(3, *self.COMMAND[:3], 810, *self.COMMAND[4:], "whole.cadt", "--resume", says=("--tile-points 800", "810"))
        self.scattered("points.f64", 3000, seed=2)
        self.fails(3, *self.COMMAND, "whole.cadt", "--resume", says="other points")
        self.scattered("points.f64", 2999)
        self.fails(3, *self.COMMAND, "whole.cadt", "--resume", says=("3000", "2999"))
        manifest = self.path("whole.cadt/manifest.json")
        manifest.write_text(manifest.read_text().replace('"version": 1', '"version": 77', 1))
        for command in ((*self.COMMAND, "whole.cadt", "--resume"), ("info", "whole.cadt"), ("verify", "whole.cadt")):
            self.fails(3, *command, says="version 77")


class TilesFailureTest(CliTest):
    def test_file_that_cannot_grow(self):
        self.scattered("points.f64", 3000)
        command = ("tiles", "points.f64", "--tile-points", 1000, "--backend", "host", "-o")
        self.fails(3, *command, "mesh.cadt", before=limit(resource.RLIMIT_FSIZE, 9000), says=("mesh.cadt/node-00000", "File too large"))
        joins = {"node-000002", "node-000005", "node-000006"}  # small enough, and complete if another thread was fast
        named = {p.name for p in self.path("mesh.cadt").glob("node-*")}
        self.assertLessEqual(named, joins, "nothing half-written has a name")
        self.cadt(*command, "mesh.cadt", "--resume")
        self.cadt(*command, "whole.cadt")
        self.assertEqual(digest(self.path("mesh.cadt")), digest(self.path("whole.cadt")))

    def test_scratch_file_that_cannot_grow(self):
        self.scattered("points.f64", 3000)
        self.path("scratch").mkdir()
        self.fails(3, "tiles", "points.f64", "--tile-points", 1000, "--scratch", "scratch", "--host-memory", "1K",
                   before=limit(resource.RLIMIT_FSIZE, 9000), says=("scratch/", "File too large"))
        self.assertEqual(list(self.path("scratch").iterdir()), [])

    def test_folders_that_cannot_be_used(self):
        self.scattered("points.f64", 300)
        self.write("file", "")
        self.path("full").mkdir()
        self.write("full/a", "")
        self.fails(3, "tiles", "points.f64", "-o", "file", says="file: is there already")
        self.fails(3, "tiles", "points.f64", "-o", "full", says="full: the folder is there already")
        self.fails(3, "tiles", "points.f64", "-o", "no/mesh.cadt", says="no/mesh.cadt")
        self.fails(3, "tiles", "points.f64", "--tile-points", 30, "--host-memory", "1K", "--scratch", "nowhere", says="nowhere")
        self.fails(3, "verify", "full/mesh.cadt", "full/a", says="full/mesh.cadt")
        self.fails(2, "verify", "points.f64", says="MESH")
        self.fails(2, "tiles", says="--generate")
        self.fails(2, "tiles", "points.f64", "--generate", "uniform", says="not both")
        self.fails(2, "tiles", "points.f64", "--tile-points", 2, says="at least 3")
        self.fails(2, "tiles", "points.f64", "--resume", says="-o")
        self.fails(2, "tiles", "points.f64", "-o", "", says="empty name")
        self.fails(6, "tiles", "points.f64", "--tile-points", 30, "--host-memory", "1K", says=("--scratch", "7.0 KiB", "1.0 KiB"))
        self.fails(3, "tiles", "points.f64", "--tile-points", "1G", says="536870910")
        for option in ("--stats", "--picture"):
            self.fails(2, "tiles", "points.f64", f"{option}=./points.f64", says="this is the input")
        self.fails(2, "tiles", "points.f64", "--stats=a", "--picture=a", says="--picture and --stats both go to a")
        for name in ("x.png", "x", "svg"):
            self.fails(2, "tiles", "points.f64", "--picture", name, says=("--picture", ".svg"))
        for option, value in (("-n", "10"), ("--seed", "3")):
            self.fails(2, "tiles", "points.f64", option, value, says=(option, "requires --generate"))
        self.fails(2, "tiles", "points.stl", says=("points.stl: unknown suffix '.stl'", "-f"))
        self.fails(2, "tiles", "points.f64", "--columns", "1", says="--columns 1: two or three")
        self.path("some").mkdir()
        self.fails(3, "tiles", "some", says="some: is a folder")
        self.path("some").rmdir()

    def test_devices_that_are_not_there(self):
        """Two threads open devices at the same time, which is the first question of both to the drivers."""
        if "opencl: not compiled in" in self.cadt("devices").out:
            self.skipTest("this program has no OpenCL")
        self.scattered("points.f64", 300)
        for _ in range(8):
            self.fails(5, "tiles", "points.f64", "--backend", "opencl", "--devices", "0,7", says="7")

    def test_disk_that_is_too_small(self):
        self.path("disk").mkdir()
        self.scattered("points.f64", 100_000)
        script = ('mount -t tmpfs -o size=2m none disk || exit 77; "$0" tiles points.f64 -o disk/mesh.cadt --tile-points 9000; '
                  'code=$?; ls disk; exit $code')
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script, os.environ.get("CADT_PROGRAM", "cadt")],
                              cwd=self.folder, capture_output=True, text=True)
        if done.returncode in (77, 127) or "unshare" in done.stderr:
            self.skipTest("no tmpfs can be mounted here: " + done.stderr.strip())
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, r"disk/mesh.cadt: the disk is too small: about [\d.]+ MiB are needed, and 2.0 MiB are free")
        self.assertEqual(done.stdout, "")

    def test_point_that_is_not_finite(self):
        self.scattered("a.f64", 70_000)
        self.scattered("b.f64", 200_000)
        with open(self.path("b.f64"), "r+b") as file:
            for point in (150_001, 70_000, 199_999):
                file.seek(16 * point + 8)
                file.write(b"\0\0\0\0\0\0\xf8\x7f")
        self.fails(3, "tiles", "a.f64", "b.f64", "--tile-points", 9000, "-o", "mesh.cadt",
                   says=("b.f64: point 70000 ", "point 140000 of all", "NaN"))
        self.assertFalse(self.path("mesh.cadt").exists())

    def test_damaged_mesh_is_found(self):
        self.scattered("points.f64", 2000)
        self.cadt("tiles", "points.f64", "--tile-points", 200, "-o", "mesh.cadt", "-q")
        path = self.path("mesh.cadt/node-000001/neighbors.npy")
        data = bytearray(path.read_bytes())
        data[-1] ^= 1
        path.write_bytes(data)
        result = self.cadt("verify", "mesh.cadt", expect=7)
        self.assertIn("node-000001/neighbors.npy is not what was written", result.out)

    def test_many_tiles_through_the_memory_of_one(self):
        """200 tiles: less memory than the whole set takes, of the device and of the process."""
        self.cadt("generate", "uniform", "-n", "3M", "-o", "points.npy", "-q")
        self.path("scratch").mkdir()
        whole = self.cadt("triangulate", "points.npy", "--backend", "host", "--threads", 2).fields()["hash"]
        budget = ("--backend", "host", "--threads", 2, "--max-memory", "16M")
        self.fails(6, "triangulate", "points.npy", *budget, says="max-memory")
        # The whole set takes 480 MB of address space, and tiles 180 MB: each thread reserves some for its allocations.
        address_space = limit(resource.RLIMIT_AS, 380 << 20)
        if os.environ.get("CADT_SANITIZE"):  # sanitizers need all of it
            address_space = default_signals
        else:
            self.fails(6, "triangulate", "points.npy", *budget[:4], before=address_space, says="out of memory")
        done = self.cadt("tiles", "points.npy", "--tile-points", 16000, *budget, "--scratch", "scratch", "--host-memory", "8M",
                         before=address_space)
        self.assertEqual(done.fields()["hash"], whole)
        self.assertGreaterEqual(int(done.fields()["tiles"].split()[0]), 200)


class TilesHelpTest(CliTest):
    COMMANDS = ("tiles", "merge")

    def test_each_command_has_examples_and_fits(self):
        for command in self.COMMANDS:
            self.assertRegex(self.cadt("--help").out, rf"(?m)^  {command} ")
            text = self.cadt(command, "--help").out
            self.assertRegex(text, rf"Examples:\n(.*\n)*?.*cadt {command}")
            for line in text.splitlines():
                self.assertLessEqual(len(line), 120, line)
        for code in (4, 7, 8):  # of options that are not here
            self.assertNotRegex(self.cadt("tiles", "--help").out, rf"(?m)^ +{code}  ")

    def test_every_option_and_key_is_documented(self):
        text = (SOURCE / "docs" / "cli.md").read_text()
        for command in self.COMMANDS:
            section = text.split(f"\n## cadt {command}\n")[1].split("\n## ")[0]
            options = set(re.findall(r"(?m)^  (?:-\w, )?(--[\w-]+)", self.cadt(command, "--help").out)) - {"--help"}
            self.assertGreater(len(options), 5)
            for option in options:
                self.assertIn(option, section, command)
        report = json.loads(self.cadt("tiles", "--generate", "uniform", "-n", 500, "--tile-points", 100, "--stats=-").out)
        section = text.split("\n## cadt tiles\n")[1].split("\n## ")[0]
        keys = {*report, *report["mesh"], *report["tree"], *report["seconds"], *report["nodes"][0], *report["nodes"][0]["seconds"]}
        for key in keys:
            self.assertIn(f"`{key}`", section)


if __name__ == "__main__":
    unittest.main()
