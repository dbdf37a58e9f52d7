# SPDX-License-Identifier: Apache-2.0
"""Signals, and the line of progress on a terminal."""
import os
import pathlib
import signal
import subprocess
import time
import unittest

from harness import PROGRAM, CliTest, read_off


class Interrupt(CliTest):
    def large(self):
        self.scattered("in.f64", 2000000)

    def wait_until_signals_are_caught(self, process):
        end = time.monotonic() + 20
        while time.monotonic() < end:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            caught = int(next(line for line in status.splitlines() if line.startswith("SigCgt")).split()[1], 16)
            if caught & (1 << (signal.SIGINT - 1)):
                return
            time.sleep(0.01)
        self.fail("SIGINT is never caught")

    def test_during_the_triangulation(self):
        self.large()
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.on_terminal("triangulate", "in.f64", "-o", "m.off", "--stats=s.json", "--backend", "host") as (
                    process, terminal):
                terminal.wait_for("%")
                process.send_signal(number)
                terminal.wait_for()
                self.assertEqual(process.wait(timeout=60), 130, terminal.text)
                self.assertIn("interrupted", terminal.text)
            self.assertEqual(self.names(), ["in.f64"], "no output, no temporary file")

    def test_in_a_pipe(self):
        self.large()
        with self.started("triangulate", "in.f64", "-o", "m.off", "--backend", "host") as process:
            self.wait_until_signals_are_caught(process)
            time.sleep(0.3)
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=60)
            self.assertEqual((process.returncode, err), (130, b"cadt: interrupted\n"))
        self.assertEqual(self.names(), ["in.f64"])

    def test_second_signal_ends_at_once(self):
        self.large()
        for _ in range(5):  # the file may be complete before it
            with self.on_terminal("triangulate", "in.f64", "-o", "m.off", "--backend", "host") as (process, terminal):
                terminal.wait_for("writing m.off")
                process.send_signal(signal.SIGINT)
                time.sleep(0.25)
                process.send_signal(signal.SIGTERM)
                code = process.wait(timeout=60)
            if code == -signal.SIGTERM:
                return
            self.assertEqual(code, 130)
        self.fail("no second signal ended the program at once")

    def test_two_signals_at_the_same_time_are_one(self):
        self.large()
        for _ in range(5):  # Slurm sends two; the kernel keeps one of two equal ones that come close together
            with self.on_terminal("triangulate", "in.f64", "-o", "m.off", "--backend", "host") as (process, terminal):
                terminal.wait_for("%")
                process.send_signal(signal.SIGINT)
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(timeout=60), 130)

    def test_during_the_writing_the_file_is_completed_and_the_next_not_begun(self):
        self.large()
        with self.on_terminal("triangulate", "in.f64", "-o", "a.off", "-o", "b.off") as (process, terminal):
            terminal.wait_for("writing a.off")
            process.send_signal(signal.SIGINT)
            terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 130, terminal.text)
        self.assertEqual(self.names(), ["a.off", "in.f64"])
        self.assertIn("complete before the interruption: a.off", terminal.text)
        self.assertEqual(len(read_off(self.path("a.off").read_text())[0]), 2000000)

    def test_every_command_names_what_is_complete(self):
        if os.environ.get("CADT_SANITIZE"):
            self.skipTest("the sanitizers' library has to be the first one")
        self.write("t.xyz", "0 0 1\n1 0 2\n0 1 3\n1 1 5\n")
        self.write("q.xy", "0.2 0.2\n")
        commands = [("voronoi", "t.xyz", "-o", "a.geojson"), ("locate", "t.xyz", "q.xy", "-o", "a.csv"),
                    ("interpolate", "t.xyz", "q.xy", "-o", "a.xyz"), ("raster", "t.xyz", "--res", "0.5", "-o", "a.asc"),
                    ("generate", "uniform", "-n", "50", "-o", "a.xy"), ("triangulate", "t.xyz", "-o", "a.off", "-o", "b.off")]
        there = self.cadt("--help").out
        if "  merge " in there:
            self.cadt("tiles", "t.xyz", "-o", "m.cadt", "--backend", "host", "-q")
            commands.append(("merge", "m.cadt", "-o", "a.off", "-o", "b.off"))
        if "  render " in there:
            commands.append(("render", "t.xyz", "-o", "a.svg"))
        before = self.names()
        for command in commands:
            output = command[command.index("-o") + 1]
            at = {"LD_PRELOAD": os.environ["CADT_SIGNAL_AT"], "CADT_TEST_SIGNAL_AT": f"rename {output} 1 {signal.SIGTERM.value}"}
            err = self.cadt(*command, "-q", expect=130, environment={**os.environ, **at}).err
            self.assertEqual(err, f"cadt: complete before the interruption: {output}\ncadt: interrupted\n", command)
            self.assertEqual(self.names(), sorted(before + [output]))
            self.path(output).unlink()

    def test_reports_and_pieces_leave_no_temporary_file(self):
        if os.environ.get("CADT_SANITIZE"):
            self.skipTest("the sanitizers' library has to be the first one")
        if "  merge " not in self.cadt("--help").out:
            self.skipTest("this program has no meshes in tiles")
        self.scattered("in.f64", 3000)
        tiles = ("tiles", "in.f64", "--tile-points", "1000", "--backend", "host", "-q")
        self.cadt(*tiles, "-o", "m.cadt")
        for command, there, complete in (
                ((*tiles, "--stats", "s.json"), "s.json", ["s.json"]), ((*tiles, "--picture", "t.svg"), "t.svg", ["t.svg"]),
                (("triangulate", "in.f64", "--stats=s.json", "-q"), "s.json", ["s.json"]),
                (("merge", "m.cadt", "--ply", "pieces"), "node-000001.ply", ["pieces/node-000000.ply", "pieces/node-000001.ply"]),
                (("merge", "m.cadt", "--pvtu", "pieces"), "node-000000.vtu", ["pieces/node-000000.vtu"])):
            at = {"LD_PRELOAD": os.environ["CADT_SIGNAL_AT"],
                  "CADT_TEST_SIGNAL_AT": f"before-rename {there} 1 {signal.SIGTERM.value}"}
            self.cadt(*command, expect=130 if command[0] == "merge" else 0, environment={**os.environ, **at})
            folder = self.path("pieces")
            left = [f"pieces/{name.name}" for name in folder.iterdir()] if folder.exists() else []
            left += [name for name in self.names() if name not in ("in.f64", "m.cadt", "pieces")]
            self.assertEqual(sorted(left), complete, command)
            for name in left:
                self.path(name).unlink()

    def test_killed_during_the_writing_the_old_file_stays(self):
        self.large()
        self.write("a.off", "old")
        with self.on_terminal("triangulate", "in.f64", "-o", "a.off", "--backend", "host") as (process, terminal):
            terminal.wait_for("writing a.off")
            end = time.monotonic() + 60
            while not any(self.path(name).stat().st_size for name in self.names() if name.endswith(".tmp")):
                self.assertLess(time.monotonic(), end, "nothing was written")
                self.assertIsNone(process.poll(), "it was too quick")
            process.kill()
            self.assertEqual(process.wait(timeout=60), -signal.SIGKILL)
        self.assertEqual(self.path("a.off").read_text(), "old")
        left = [name for name in self.names() if name not in ("a.off", "in.f64")]
        self.assertEqual(len(left), 1)
        self.assertRegex(left[0], r"^\.cadt-\d+-\d+\.tmp$")
        # What is left has a name that no format has, and as a mesh it is refused.
        self.fails(2, "verify", "in.f64", left[0], says=left[0])
        self.fails(3, "verify", "in.f64", left[0], "-t", "off", says=left[0])
        self.cadt("triangulate", "in.f64", "-o", "a.off", "--backend", "host")
        self.assertEqual(self.path("a.off").read_text().split(None, 2)[:2], ["OFF", "2000000"])

    def test_while_waiting_for_input(self):
        with self.started("triangulate", "-", "-f", "xy", "-o", "m.off", stdin=subprocess.PIPE) as process:
            self.wait_until_signals_are_caught(process)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=20), 130)
        self.assertEqual(self.names(), [])

    def test_an_ignored_signal_stays_ignored(self):
        def ignore():
            signal.signal(signal.SIGINT, signal.SIG_IGN)
        process = subprocess.Popen([PROGRAM, "triangulate", "-", "-f", "xy"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, preexec_fn=ignore)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(b"0 0\n1 0\n0 1\n", timeout=60)
        self.assertEqual((process.returncode, err), (0, b""))
        self.assertRegex(out.decode(), r"(?m)^triangles +1$")


class ProgressLine(CliTest):
    def test_is_drawn_on_a_terminal_and_removed(self):
        # Ten times as long as the line stands before it is drawn anew, on a processor of today.
        self.scattered("in.f64", 2000000)
        with self.on_terminal("triangulate", "in.f64", "-o", "m.ply", "--backend", "host", "--threads", "1") as (
                process, terminal):
            text = terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 0)
        self.assertRegex(text, r"\r[a-z]+ +\d+ %  [\d.]+[Mk]? points/s")
        # What is on the last line before the summary is blank.
        self.assertRegex(text, r"\r +\rpoints +2000000\r\n")

    def test_is_not_drawn_when_quiet(self):
        self.scattered("in.f64", 100000)
        with self.on_terminal("triangulate", "in.f64", "-o", "m.ply", "-q") as (process, terminal):
            text = terminal.wait_for()
            self.assertEqual((process.wait(timeout=60), text), (0, ""))


if __name__ == "__main__":
    unittest.main()
