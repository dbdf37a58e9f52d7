# SPDX-License-Identifier: Apache-2.0
"""Every exit code but 0, and that nothing is left behind."""
import json
import os
import pathlib
import resource
import shutil
import signal
import stat
import struct
import tempfile
import unittest

from harness import PROGRAM, CliTest, as_ordinary_user, default_signals, integer_points, xy_text


class Usage(CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.xy", xy_text(integer_points(20)))

    def test_wrong_command_lines(self):
        for arguments, says in [
                ([], "cadt --help"),
                (["frobnicate"], "triangulate"),
                (["in.xy"], "cadt triangulate in.xy"),
                (["triangulate"], "IN"),
                (["triangulate", "in.xy", "more.xy"], "more.xy"),
                (["triangulate", "in.xy", "--frobnicate"], "--frobnicate"),
                (["triangulate", "in.xy", "--backend", "gpu"], "--backend"),
                (["triangulate", "in.xy", "--threads", "-1"], "--threads"),
                (["triangulate", "in.xy", "--threads", "many"], "--threads"),
                (["triangulate", "in.xy", "--base", "2"], "--base"),
                (["triangulate", "in.xy", "--project", "xz"], "--project"),
                (["triangulate", "in.xy", "--order", "none"], "--order"),
                (["triangulate", "in.xy", "--width", "0"], "--width"),
                (["triangulate", "in.xy", "-f", "xls"], "--from"),
                (["triangulate", "in.xy", "--max-memory", "4X"], "4G"),
                (["triangulate", "in.xy", "--max-memory", "-4G"], ""),
                (["triangulate", "in.xy", "--max-memory", "0"], "4G"),
                (["triangulate", "-"], "-f"),
                (["triangulate", "in.xy", "-t", "off"], "-o"),
                (["verify", "in.xy"], "MESH"),
                (["verify", "-", "-", "-f", "xy", "-t", "off"], "standard input"),
                (["verify", "in.xy", "-"], "-t"),
                (["generate"], "--list"),
                (["generate", "nothing", "-o", "x.xy"], "nothing"),
                (["generate", "uniform"], "-o"),
                (["generate", "uniform", "-n", "many", "-o", "x.xy"], "many"),
                (["generate", "uniform", "-n", "1.5", "-o", "x.xy"], "1.5"),
                (["generate", "uniform", "-n", "1e18", "-o", "x.xy"], "1e18"),
                (["generate", "uniform", "-o", "-"], "-t"),
                (["info"], "FILE"),
                (["triangulate", "in.xy", "--width", "1e3"], "--width: a whole number from 16 to 32000 is expected, not '1e3'"),
                (["triangulate", "in.xy", "--threads", "abc"], "--threads: a whole number from 0 to 4096 is expected"),
                (["triangulate", "in.xy", "--threads", "4097"], "--threads"),
                (["verify", "in.xy", "in.off", "--threads", "-1"], "--threads"),
                (["triangulate", "in.xy", "--stabilize", "paper", "--epsilon", "nan"], "--epsilon: a number of at least 0"),
                (["triangulate", "in.xy", "--stabilize", "paper", "--epsilon", "-1"], "--epsilon"),
                (["triangulate", "in.xy", "--stabilize", "defer", "--flip-threshold", "1.5"], "--flip-threshold"),
                (["generate", "circles", "--radius", "nan", "-o", "x.xy"],
                 "--radius: a number from 0 to 1000000 is expected, not 'nan'"),
                (["generate", "circles", "--radius", "2e6", "-o", "x.xy"], "--radius"),
                (["generate", "circles", "--epsilon", "-nan", "-o", "x.xy"], "--epsilon"),
                (["generate", "circles", "--k", "2", "-o", "x.xy"], "--k: a whole number from 3"),
                (["generate", "uniform", "--k", "3", "-o", "x.xy"], "--k belongs to the set circles"),
                (["generate", "uniform", "--radius", "0.2", "-o", "x.xy"], "--radius belongs to the set circles"),
                (["generate", "uniform", "--epsilon", "0", "-o", "x.xy"], "--epsilon belongs to the set circles"),
                (["generate", "uniform", "--seed", "-1", "-o", "x.xy"], "--seed: a whole number from 0 to 18446744073709551615"),
                (["generate", "uniform", "--seed", "18446744073709551616", "-o", "x.xy"], "not '18446744073709551616'"),
                (["generate", "uniform", "--seed", "+1", "-o", "x.xy"], "--seed"),
                (["generate", "uniform", "--seed", "0x10", "-o", "x.xy"], "--seed"),
                (["triangulate", "foo.stl"], "foo.stl: unknown suffix '.stl'; name the format with -f, one of: xy txt csv"),
                (["triangulate", "foo.stl"], "geojson"),
                (["triangulate", "foo"], "foo: no suffix"),
                (["locate", "in.xy", "foo.stl"], "name the format with --query-format"),
                (["verify", "in.xy", "foo.stl"], "name the format with -t, one of: ele obj off"),
                (["triangulate", "in.xy", "--columns", "1"], "cadt: error: --columns 1: two or three columns are needed"),
                (["triangulate", "in.xy", "--columns", "1,2,3,4"], "cadt: error: --columns 1,2,3,4: two or three"),
                (["triangulate", "in.xy", "--columns", "0,1"], "cadt: error: --columns 0,1: columns are counted from 1"),
                (["triangulate", "in.xy", "--columns", "1,"], "cadt: error: --columns 1,: a column is missing"),
                (["locate", "in.xy", "in.xy", "--query-columns", "1"], "--query-columns 1: two or three"),
                (["devices", "all"], "all")]:
            with self.subTest(arguments=arguments):
                self.fails(2, *arguments, says=says)

    def test_zeros_in_front_are_decimal(self):
        for name, seed in (("a.xy", "010"), ("b.xy", "10"), ("c.xy", "8")):
            self.cadt("generate", "uniform", "-n", "20", "--seed", seed, "-o", name, "-q")
        a, b, c = (self.path(name).read_text() for name in ("a.xy", "b.xy", "c.xy"))
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)
        self.cadt("generate", "uniform", "-n", "20", "--seed", 2**64 - 1, "-o", "d.xy", "-q")
        self.assertEqual(len(self.cadt("locate", "in.xy", "in.xy", "--nearest", "-k", "010").out.split("\n")[0].split()), 10)

    def test_folders_are_no_files_of_points(self):
        for name in ("folder", "folder.xy"):
            self.path(name).mkdir()
            for arguments in (["triangulate", name], ["info", name], ["locate", "in.xy", name], ["verify", "in.xy", name]):
                self.fails(3, *arguments, says=(f"cadt: error: {name}: is a folder", "cadt merge", "cadt verify"))

    def test_columns_of_a_table_of_two(self):
        self.fails(3, "triangulate", "in.xy", "--columns", "1,3",
                   says="in.xy:1: the line has 2 fields, column 3 is expected")
        self.write("in.xy", "0 0\n1 1\n1 1 1\n")
        self.fails(3, "triangulate", "in.xy", says="in.xy:3: the line has 3 fields, 2 are expected")
        self.fails(3, "triangulate", "in.xy", "--columns", "1,2", says="in.xy:3: the line has 3 fields, 2 are expected")

    def test_outputs_that_cannot_be_are_found_before_the_work(self):
        # The input does not exist: whoever looks at it first says 3.
        for arguments, says in [(["-o", "m.xls"], "obj"), (["-o", "mesh"], "obj"), (["-o", "-"], "-t"),
                                (["-o", "m.obj", "-t", "xls"], "xls"),
                                (["-o", "m.obj", "-o", "./m.obj"], "twice"), (["-o", "-", "-o", "-", "-t", "off"], "twice"),
                                (["-o", "m.obj", "-t", "obj", "-t", "off"], "-t")]:
            with self.subTest(arguments=arguments):
                self.fails(2, "triangulate", "absent.xy", *arguments, says=says)

    def test_the_input_is_not_overwritten(self):
        self.path("in.ply").write_bytes(b"ply")
        self.fails(2, "triangulate", "in.ply", "-o", "./in.ply", says="input")
        self.assertEqual(self.path("in.ply").read_bytes(), b"ply")


class Files(CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.xy", xy_text(integer_points(20)))

    def test_malformed_input_is_located(self):
        for text, line in [("0 0\n1 x\n", 2), ("0 0\n1 1\n2\n", 3), ("0 0\nnan 1\n", 2), ("0 0\n1 1\n1 inf\n", 3)]:
            self.write("bad.xy", text)
            for command in (["triangulate"], ["info"]):
                self.fails(3, *command, "bad.xy", says=f"bad.xy:{line}: ")

    def test_stdin_is_located_too(self):
        self.fails(3, "triangulate", "-", "-f", "xy", stdin="0 0\n1 x\n", says=":2: ")

    def test_inputs_that_cannot_be_read(self):
        self.path("folder.xy").mkdir()
        self.write("empty.xy", "")
        self.path("odd.f64").write_bytes(struct.pack("<2d", 1, 2) + b"abc")
        for name in ("absent.xy", "folder.xy", "empty.xy", "odd.f64", "absent/in.xy"):
            for command in ("triangulate", "info"):
                self.fails(3, command, name, says=name)

    def test_outputs_that_cannot_be_written_are_found_before_the_work(self):
        self.path("folder.obj").mkdir()
        self.write("file", "")
        for name in ("absent/m.obj", "folder.obj", "file/m.obj"):
            self.fails(3, "triangulate", "absent.xy", "-o", name, says=name)
            self.fails(3, "generate", "uniform", "-o", name, "-t", "xy", says=name)

    def test_permissions(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="cadt-cli-"))
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        program = shutil.copy(PROGRAM, folder / "program")  # the build folder may be closed to others
        shutil.copy(self.path("in.xy"), folder / "in.xy")
        self.write("closed.xy", "0 0\n")
        shutil.copy(self.path("closed.xy"), folder / "closed.xy")
        os.chmod(folder / "closed.xy", 0)
        os.chmod(folder, 0o555)
        os.chmod(self.folder, 0o755)

        run = dict(before=as_ordinary_user, program=program)
        self.fails(3, "triangulate", folder / "closed.xy", says="closed.xy", **run)
        self.fails(3, "triangulate", "absent.xy", "-o", folder / "m.obj", says="m.obj", **run)
        self.cadt("triangulate", folder / "in.xy", **run)

    def test_full_disk(self):
        before = os.stat("/dev/full")
        with open("/dev/full", "wb") as full:
            for arguments in (["triangulate", "in.xy"], ["triangulate", "in.xy", "-o", "-", "-t", "off"],
                              ["triangulate", "in.xy", "--stats=-"], ["info", "in.xy"], ["devices"], ["generate", "--list"],
                              ["generate", "uniform", "-n", "100", "-o", "-", "-t", "xy"]):
                with self.subTest(arguments=arguments):
                    result = self.cadt(*arguments, stdout=full, expect=3)
                    self.assertIn("cadt: error:", result.err)
        self.fails(3, "triangulate", "in.xy", "-o", "/dev/full", "-t", "off", says="/dev/full")
        self.fails(3, "triangulate", "in.xy", "-o", "m.off", "--stats=/dev/full", says="/dev/full")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode))
        self.assertEqual(os.stat("/dev/full").st_ino, before.st_ino)

    def test_a_failing_write_leaves_nothing(self):
        def small_files():
            default_signals()
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
        self.scattered("big.f64", 5000)
        self.write("m.off", "old")
        self.fails(3, "triangulate", "big.f64", "-o", "m.off", says="m.off", before=small_files)
        self.assertEqual(self.names(), ["big.f64", "in.xy", "m.off"])
        self.assertEqual(self.path("m.off").read_text(), "old")

    def test_each_kind_of_output_that_fails_leaves_nothing(self):
        """A disk that is full from the first byte on, and one that a small file still fits."""
        for limit, arguments, name in [(0, ["triangulate", "in.xy", "--stats=OUT"], "s.json"),
                                       (512, ["triangulate", "in.xy", "--stats=OUT"], "s.json"),
                                       (0, ["triangulate", "in.xy", "-o", "OUT"], "m.off"),
                                       (0, ["triangulate", "in.xy", "-o", "OUT"], "m.npz"),
                                       (0, ["triangulate", "in.xy", "-o", "OUT"], "m.svg"),
                                       (64, ["triangulate", "in.xy", "-o", "OUT"], "m.png"),
                                       (0, ["generate", "uniform", "-n", "100", "-o", "OUT"], "p.f64"),
                                       (512, ["generate", "uniform", "-n", "100", "-o", "OUT"], "p.npy")]:
            def little_room():
                default_signals()
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            arguments = [word.replace("OUT", name) for word in arguments]
            for old in (None, "old"):
                with self.subTest(limit=limit, arguments=arguments, old=old):
                    if old:
                        self.write(name, old)
                    result = self.cadt(*arguments, before=little_room, expect=3)
                    self.assertRegex(result.err, rf"(?m)^cadt: error: {name}: cannot be written")
                    self.assertEqual(self.names(), sorted(["in.xy"] + [name] * bool(old)))
                    if old:
                        self.assertEqual(self.path(name).read_text(), old)
                        self.path(name).unlink()

    def test_the_statistics_fail_after_the_mesh_is_there(self):
        """The mesh has its name by then, and keeps it."""
        def room_for_the_mesh():
            default_signals()
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))
        self.fails(3, "triangulate", "in.xy", "-o", "m.off", "--stats=s.json", says="s.json", before=room_for_the_mesh)
        self.assertEqual(self.names(), ["in.xy", "m.off"])
        self.cadt("verify", "in.xy", "m.off")


class Resources(CliTest):
    def test_back_end_that_is_not_there(self):
        devices = json.loads(self.cadt("devices", "--json").out)["devices"]
        usable = {device["backend"] for device in devices if device["usable"]}
        self.assertIn("host", usable)
        self.write("in.xy", "0 0\n1 0\n0 1\n")
        for backend in ("host", "opencl", "cuda"):
            if backend in usable:
                self.cadt("triangulate", "in.xy", "--backend", backend)
                self.fails(5, "triangulate", "in.xy", "--backend", backend, "--device", "no such device", says=backend)
            else:
                self.fails(5, "triangulate", "in.xy", "--backend", backend, "-o", "m.off", says=[backend, "cadt devices"])
        self.assertEqual(self.names(), ["in.xy"])

    def test_more_points_than_fit(self):
        with self.path("in.f64").open("wb") as file:
            file.truncate(200 << 30)  # takes neither disk nor time
        self.fails(3, "triangulate", "in.f64", says=["in.f64 holds more points than fit", "at most 536870910"])
        self.fails(3, "triangulate", "in.f64", "-f", "f32", says="26843545600 points")

    def test_memory_bound(self):
        self.scattered("in.f64", 20000)
        self.fails(6, "triangulate", "in.f64", "-o", "m.off", "--max-memory", "64K", says=["needed: ", "free: "])
        self.cadt("triangulate", "in.f64", "--max-memory", "4GiB")
        self.assertEqual(self.names(), ["in.f64"])

    @unittest.skipIf(os.environ.get("CADT_SANITIZE"), "sanitizers need the address space that this test takes away")
    def test_allocation_that_fails(self):
        def little_memory():
            default_signals()
            resource.setrlimit(resource.RLIMIT_AS, (1 << 29, 1 << 29))
        def available():
            lines = pathlib.Path("/proc/meminfo").read_text().splitlines()
            return int(next(line for line in lines if line.startswith("MemAvailable:")).split()[1]) / (1 << 20)
        for _ in range(5):  # other tests take and give back memory meanwhile
            before = available()
            err = self.fails(6, "generate", "uniform", "-n", "200M", "-o", "x.f64", before=little_memory, says="out of memory").err
            bounds = sorted([before, available()])
            free = float(err.partition("free: ")[2].split()[0])
            if fits := 0.9 * bounds[0] - 0.1 <= free <= 1.1 * bounds[1] + 0.1:
                break
        self.assertTrue(fits, f"{free} GiB, of {bounds} with the page cache")
        # What is verified has other limits than what is triangulated.
        with self.path("in.f64").open("wb") as file:
            file.truncate(9 << 30)  # 604 million points
        self.write("m.off", "OFF\n0 0 0\n")
        self.fails(6, "verify", "in.f64", "m.off", before=little_memory, says="out of memory")
        self.path("in.f64").unlink()
        self.path("m.off").unlink()
        self.assertEqual(self.names(), [])


class ClosedStreams(CliTest):
    """Their numbers must not become those of other files."""

    @staticmethod
    def without(*streams):
        def close():
            default_signals()
            for stream in streams:
                os.close(stream)
        return close

    def test_reading_and_writing_fail(self):
        self.write("in.xy", "0 0\n1 0\n0 1\n")
        self.fails(3, "triangulate", "-", "-f", "xy", before=self.without(0), says="<stdin>")
        for closed in ((1,), (0, 1)):
            self.fails(3, "triangulate", "in.xy", "-o", "-", "-t", "off", before=self.without(*closed), says="<stdout>")
        self.cadt("triangulate", "in.xy", "-o", "m.off", "-q", before=self.without(0, 1, 2))
        self.assertTrue(self.path("m.off").read_text().startswith("OFF"))


if __name__ == "__main__":
    unittest.main()
