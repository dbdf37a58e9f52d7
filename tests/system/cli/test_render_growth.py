# SPDX-License-Identifier: Apache-2.0
"""cadt render of the growing mesh: snapshots in one picture, films, frames."""
import os
import pathlib
import shutil
import sys
import time
import unittest

from harness import SECONDS, SOURCE, CliTest

sys.path.insert(0, str(SOURCE / "docs" / "site" / "tools"))
import pictures


def png_size(path):
    return pictures.pixels(path)[:2]


def png_rows(path):
    """The rows of a picture, three bytes a pixel."""
    width, height, channels, image = pictures.pixels(path)
    assert channels == 3, channels
    return [bytes(image[3 * y * width:3 * (y + 1) * width]) for y in range(height)]


class GrowthSheetTest(CliTest):
    def test_four_snapshots_in_one_picture(self):
        out = self.cadt("render", "--generate", "uniform", "-n", 2048, "-o", "growth.png", "--growth", 4, "--size", 404, "-q")
        self.assertEqual(out.out, "")
        out = self.cadt("render", "--generate", "uniform", "-n", 2048, "-o", "growth.png", "--growth", 4, "--size", 404)
        self.assertEqual(self.names(), ["growth.png"])
        rows = [line.split() for line in out.out.splitlines()[1:]]
        self.assertEqual([row[0] for row in rows], ["1", "2", "3", "4"])
        points = [int(row[2]) for row in rows]
        self.assertEqual(points, sorted(points))
        self.assertEqual(points[-1], 2048)
        for have, want in zip(points, (128, 512, 1152, 2048)):
            self.assertLessEqual(abs(have - want), 40)
        self.assertEqual(rows[-1][-2:], ["0", "0"], "nothing waits, no edge is illegal")
        triangles = [int(row[3]) for row in rows]
        self.assertTrue(all(t < 2 * p for t, p in zip(triangles, points)))
        width, height = png_size(self.path("growth.png"))
        self.assertEqual(width, 404)
        self.assertLess(abs(height - width), 12, "two rows of square pictures")
        pixels = png_rows(self.path("growth.png"))
        quarters = [{r[i:i + 3] for r in pixels[y:y + 190] for i in range(3 * x, 3 * x + 570, 3)}
                    for y in (4, 210) for x in (4, 210)]
        self.assertTrue(all(len(q) > 20 for q in quarters), "a picture is empty")

    def test_sizes_and_colours(self):
        for colour in ("level", "flips", "conflicts", "degree", "area", "nothing"):
            self.cadt("render", "--generate", "circles", "-n", 500, "-o", f"{colour}.png", "--growth", 3, "--size", "300x200",
                      "--colour", colour, "--backend", "host", "-q")
            self.assertEqual(png_size(self.path(f"{colour}.png")), (300, 200))
        self.assertNotEqual(self.path("flips.png").read_bytes(), self.path("level.png").read_bytes())

    def test_sizes_of_sheets(self):
        self.write("high.xy", "0 0\n1 0\n0 9\n1 9\n0.5 4\n")
        self.cadt("render", "high.xy", "-o", "a.png", "--growth", 4, "-q")
        width, height = png_size(self.path("a.png"))
        self.assertEqual(width, 1600)
        self.assertTrue(3900 < height <= 4000, height)
        self.cadt("render", "high.xy", "-o", "a.png", "--growth", 7, "--size", "101x97", "-q")
        self.assertEqual(png_size(self.path("a.png")), (101, 97))
        self.fails(5, "render", "high.xy", "-o", "b.png", "--growth", 100, "--size", "16384x16384", "--samples", 1, says="--size")
        self.assertEqual(self.names(), ["a.png", "high.xy"])

    def test_heights_of_which_floats_see_no_difference(self):
        for name, base in (("low", 0), ("high", 2**27)):
            self.write(f"{name}.xyz", "".join(f"{x} {y} {base + (7 * x + 3 * y) % 5}\n" for x in range(8) for y in range(8)))
            self.cadt("render", f"{name}.xyz", "-o", f"{name}.png", "--growth", 1, "--size", 90, "--colour", "height", "-q")
        self.assertEqual(self.path("low.png").read_bytes(), self.path("high.png").read_bytes())

    def test_the_output_is_no_input(self):
        for name in ("in.png", "in.gif"):
            self.write(name, "0 0\n1 0\n0 1\n")
            growth = ["--growth", 2] if name == "in.png" else []
            self.fails(2, "render", "-f", "xy", name, "-o", name, *growth, says="this is the input")
            self.assertEqual(self.path(name).read_text(), "0 0\n1 0\n0 1\n")

    def test_what_does_not_go_together(self):
        for name, says in (("a.svg", "png"), ("a.jpg", "png"), ("a", "png"), ("-", "name a file")):
            self.fails(2, "render", "--generate", "uniform", "-o", name, "--growth", 2, says=says)
        err = self.fails(2, "render", "--generate", "uniform", "-o", "a.svg", "--growth", 2, says="it has to be one of: png").err
        self.assertNotIn("-t", err)  # which is not for growth
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--growth", 2, "--no-hull", says="--no-hull")
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--growth", 2, "--camera", "0.5,0.5,1e-3", says="0.0625")
        self.fails(2, "render", "--generate", "uniform", "-o", "a.mp4", "--growth", 4, says=("--growth is for a picture", "growth.png"))
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--fps", 10, says="-o growth.mp4")
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--growth", 4, "--seconds", 3, says="frames/")
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--growth", 0)
        self.fails(2, "render", "--generate", "uniform", "-o", "a.gif", "--fps", 240, "--seconds", 3600, says="864000 pictures")
        for option, value in (("--fps", "nan"), ("--seconds", "nan"), ("--fps", "0.5"), ("--seconds", "inf")):
            self.fails(2, "render", "--generate", "uniform", "-o", "a.gif", option, value, says=f"{option}: a number from ")
        self.fails(2, "render", "--generate", "uniform", "-o", "a.png", "--growth", "1e1", says="--growth: a whole number")
        self.fails(3, "render", "--generate", "uniform", "-o", "nowhere/a.png", "--growth", 4, says="nowhere")
        self.assertEqual(self.names(), [])

    def test_points_without_triangles(self):
        self.write("line.xy", "0 0\n1 1\n2 2\n")
        self.fails(4, "render", "line.xy", "-o", "a.png", "--growth", 4, says="on one line")
        self.assertEqual(self.names(), ["line.xy"])


class GrowthFilmTest(CliTest):
    def test_frames_in_a_folder(self):
        self.cadt("render", "--generate", "uniform", "-n", 300, "-o", "frames/", "--size", "64x48", "--fps", 5, "--seconds", 2, "-q")
        names = sorted(f.name for f in self.path("frames").iterdir())
        self.assertEqual(names, [f"{i:04}.png" for i in range(1, 11)])
        pictures = [(self.path("frames") / name).read_bytes() for name in names]
        self.assertEqual({png_size(self.path("frames") / name) for name in names}, {(64, 48)})
        self.assertGreater(len(set(pictures)), 5, "it does not move")
        self.assertEqual(pictures[-1], pictures[-2], "the end stands still")
        self.fails(3, "render", "--generate", "uniform", "-n", 300, "-o", "frames", says="has frames already")

    def test_frames_have_the_size_that_is_asked_for(self):
        self.cadt("render", "--generate", "uniform", "-n", 99, "-o", "odd/", "--size", "65x49", "--fps", 1, "--seconds", 1, "-q")
        self.assertEqual(png_size(self.path("odd") / "0001.png"), (65, 49))

    def interrupted(self, folder):
        """Begins ten minutes of frames, and ends it when there are some."""
        with self.started("render", "--generate", "uniform", "-n", 300, "-o", folder, "--size", "64x48", "--fps", 10,
                          "--seconds", 600) as process:
            end = time.monotonic() + SECONDS
            while not self.path(folder).is_dir() or not any(f.suffix == ".png" for f in self.path(folder).iterdir()):
                self.assertLess(time.monotonic(), end, "no frame came")
                self.assertIsNone(process.poll(), "it ended")
                time.sleep(0.01)
            process.terminate()
            err = process.communicate(timeout=SECONDS)[1]
        self.assertEqual((process.returncode, err), (130, b"cadt: interrupted\n"))

    def test_interrupted_frames_leave_nothing(self):
        for folder in ("frames/", "new", "one/in/another/"):
            if not folder.endswith("/"):
                self.path(folder).mkdir()
                self.write(f"{folder}/note.txt", "stays")
            self.interrupted(folder)
        self.assertEqual(self.names(), ["new"], "the folder was there before")
        self.assertEqual([f.name for f in self.path("new").iterdir()], ["note.txt"])
        self.cadt("render", "--generate", "uniform", "-n", 300, "-o", "new", "--size", "64x48", "--fps", 5, "--seconds", 1, "-q")

    def test_a_failed_run_makes_no_folder(self):
        self.fails(3, "render", "missing.xy", "-o", "frames/", says="missing.xy")
        self.write("line.xy", "0 0\n1 1\n2 2\n")
        self.fails(4, "render", "line.xy", "-o", "deep/frames/", says="on one line")
        self.fails(3, "render", "--generate", "uniform", "-n", 300, "-o", "line.xy/", says="line.xy")
        self.assertEqual(self.names(), ["line.xy"])

    def test_films(self):
        if shutil.which("ffmpeg") is None:
            self.fail("ffmpeg is not installed: scripts/setup --tests installs it")
        for suffix, mark in ((".mp4", b"ftyp"), (".webm", b"webm"), (".gif", b"GIF89a")):
            name = "film" + suffix
            self.cadt("render", "--generate", "uniform", "-n", 300, "-o", name, "--size", "65x49", "--fps", 5, "--seconds", 1, "-q")
            self.assertIn(mark, self.path(name).read_bytes()[:64])
        self.assertEqual(self.names(), ["film.gif", "film.mp4", "film.webm"])

    def stand_in(self, text):
        """A program called ffmpeg, before all others."""
        folder = pathlib.Path(self.path("bin"))
        folder.mkdir(exist_ok=True)
        (folder / "ffmpeg").write_text("#!/bin/sh\n" + text + "\n")
        (folder / "ffmpeg").chmod(0o755)
        before = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", before)
        os.environ["PATH"] = f"{folder}:{before}"

    def test_what_ffmpeg_says_is_said(self):
        self.stand_in("cat > /dev/null; echo 'Unknown encoder' >&2; exit 8")
        self.fails(3, "render", "--generate", "uniform", "-n", 300, "-o", "a.mp4", "--size", 64, "--seconds", 1,
                   says=("a.mp4", "ffmpeg ended with exit code 8: Unknown encoder"))
        self.assertEqual(self.names(), ["bin"])

    def test_without_ffmpeg_it_says_what_to_do(self):
        before = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", before)
        os.environ["PATH"] = str(self.folder)
        self.fails(3, "render", "--generate", "uniform", "-n", 300, "-o", "a.mp4", says=("ffmpeg", "-o frames/"))
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
