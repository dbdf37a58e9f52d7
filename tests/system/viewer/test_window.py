#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cadt view with real keys and a real mouse: open, zoom, pick, grow, edit, screenshots; and all that can go wrong."""
import json
import re
import subprocess
import unittest

from window import PANEL, PROGRAM, WindowTest, blocks, difference

WIDTH, HEIGHT = 1000, 700
SIZE = f"{WIDTH}x{HEIGHT}"
MIDDLE = ((WIDTH - PANEL) // 2, HEIGHT // 2)


def numbers(line):
    return list(map(int, re.findall(r"\d+", line)))


class Session(WindowTest):
    """What one does in a sitting."""

    def test_open_zoom_pick_grow_edit(self):
        self.view("--generate", "uniform", "-n", 3000, "--size", SIZE, "--colour", "area")
        points, triangles = numbers(self.wait("loaded uniform"))[:2]
        self.assertEqual(points, 3000)
        with self.subTest("the picture is that of cadt render"):
            first = self.screenshot()
            self.cadt("render", "--generate", "uniform", "-n", 3000, "--colour", "area", "--size",
                      f"{WIDTH - PANEL}x{HEIGHT}", "-o", "render.png")
            self.assertLess(difference(first, self.folder / "render.png"), 3.0)
        with self.subTest("the place under the cursor stays"):
            x, y = MIDDLE[0] + 103, MIDDLE[1] - 57
            self.click(x, y)
            before = self.wait("picked")
            for _ in range(6):
                self.click(x, y, button=4)
            self.click(x, y)
            self.assertEqual(numbers(self.wait("picked"))[:4], numbers(before)[:4])
            self.assertGreater(difference(first, self.screenshot()), 3.0, "nothing was zoomed")
            self.key("Escape", "f")
            self.assertLess(difference(first, self.screenshot()), 0.5, "F shows everything again")
        with self.subTest("search"):
            self.key("slash")
            self.xdotool("type", "--delay", 20, "p 17")
            self.key("Return")
            self.wait("went to point 17")
            self.click(*MIDDLE)
            self.assertIn("point 17", self.wait("picked"), "it is in the middle now")
            self.key("Tab", "Tab")
            self.wait("picked")
            self.key("Escape", "f")
        with self.subTest("it grows"):
            self.key("g")
            snapshots = numbers(self.wait("recorded"))[0]
            self.assertGreater(snapshots, 5)
            for _ in range(4):
                self.key("greater")
            self.wait(f"snapshot {snapshots} of")  # played to its end
            self.key("comma")
            self.wait(f"snapshot {snapshots - 1} of")
            self.key("period")
            self.wait(f"snapshot {snapshots} of")
            self.key("g")
            self.wait("growth ended")
        with self.subTest("points are dragged, painted and erased"):
            self.key("e")
            self.wait("editing")
            self.drag([MIDDLE, (MIDDLE[0] + 30, MIDDLE[1]), (MIDDLE[0] + 60, MIDDLE[1] + 10)])
            self.wait("holds point")
            self.assertEqual(numbers(self.wait("edited"))[0], 3000)
            self.key("t")
            self.drag([MIDDLE, (MIDDLE[0] + 20, MIDDLE[1] + 20)])
            painted, mesh = numbers(self.wait("edited"))
            self.assertGreater(painted, 3000)
            self.assertGreater(mesh, triangles)
            self.key("t")
            self.drag([MIDDLE, (MIDDLE[0] + 20, MIDDLE[1] + 20), (MIDDLE[0] + 40, MIDDLE[1])])
            self.assertLess(numbers(self.wait("edited"))[0], painted)
            still = self.screenshot()
            self.key("m")
            for _ in range(20):  # by at most so much a frame
                self.xdotool("sleep", 2)
                if (moved := difference(still, self.screenshot())) > 0.5:
                    break
            self.key("m")
            self.assertGreater(moved, 0.5, "the points have not moved")
            self.key("e")
            self.wait("edited")
        with self.subTest("screenshots"):
            name = self.screenshot("S").name
            self.assertRegex(name, r"^uniform-3000-\d+\.png$")
            self.assertEqual(len(list(self.folder.glob("uniform-3000-*.png"))), numbers(name)[1], "each has a number of its own")
        self.quit()


class Changes(WindowTest):
    """Points that change, and what the window shows then."""

    def test_a_file_that_lies_elsewhere_now(self):
        lattice = [(x, y) for x in range(12) for y in range(12)]
        write = lambda at: (self.folder / "p.xy").write_text("".join(f"{x + at} {y + at}\n" for x, y in lattice))
        write(0)
        self.view("p.xy", "--size", SIZE)
        self.wait("loaded p.xy")
        first = self.screenshot()
        write(1000)
        self.key("r")
        self.wait("loaded p.xy")
        self.assertLess(difference(first, self.screenshot()), 2.0, "the same points elsewhere")
        self.quit()

    def test_loading_ends_editing(self):
        self.view("--generate", "uniform", "-n", 300, "--size", SIZE)
        self.wait("loaded")
        self.key("m")
        self.wait("editing")
        self.key("r")
        self.wait("edited")
        self.wait("loaded")
        self.quit()

    def test_a_point_outside_of_the_first_box(self):
        (self.folder / "p.xy").write_text("0 0\n1 0\n0 1\n1 1\n0.5 0.5\n")
        self.view("p.xy", "--size", SIZE)
        self.wait("loaded p.xy")
        self.key("minus", "minus", "minus", "e")
        self.wait("editing")
        self.drag([MIDDLE, (MIDDLE[0] + 150, MIDDLE[1]), (MIDDLE[0] + 300, MIDDLE[1])])
        self.wait("holds point 4")
        self.wait("edited")
        self.key("e")
        self.wait("edited")
        self.key("f")
        self.wait("ready")
        self.key("slash")
        self.xdotool("type", "--delay", 20, "p 4")
        self.key("Return")
        self.wait("went to point 4")
        self.click(MIDDLE[0] - 3, MIDDLE[1])
        self.assertIn("point 4", self.wait("picked"), "it is in the middle")
        self.quit()

    def test_a_second_button_does_not_end_a_drag(self):
        self.view("--generate", "uniform", "-n", 300, "--size", SIZE)
        self.wait("loaded")
        self.key("e")
        self.wait("editing")
        x, y = MIDDLE
        self.xdotool("mousemove", WIDTH - 20, y, "sleep", 0.2, "mousemove", x, y, "mousedown", 1)  # from the panel, at once
        self.wait("holds point")
        self.xdotool("click", 3, "sleep", 0.2)
        self.assertFalse([line for line in self.seen if line.startswith("edited")])
        self.xdotool("mousemove", x + 40, y, "sleep", 0.2, "mouseup", 1)
        self.wait("edited")
        self.assertEqual(sum(line.startswith("holds") for line in self.seen), 1)
        self.quit()

    def test_keys_of_the_keypad_zoom_once(self):
        self.view("--generate", "uniform", "-n", 200, "--size", SIZE)
        self.wait("loaded")
        for plain, keypad in (("plus", "KP_Add"), ("minus", "KP_Subtract")):
            self.key("f", plain)
            once = self.screenshot()
            self.key("f", keypad)
            self.assertEqual(difference(once, self.screenshot()), 0, keypad)
        self.quit()

    def test_keys_after_the_panel_is_hidden(self):
        for name in ("a.xy", "b.xy"):
            (self.folder / name).write_text("0 0\n1 0\n0 1\n")
        self.view("a.xy", "b.xy", "--size", SIZE)
        self.wait("loaded a.xy")
        self.key("F6", "p", "Next")
        self.wait("loaded b.xy")
        self.quit()

    def test_the_colour_after_editing_and_growth(self):
        (self.folder / "h.xyz").write_text("".join(f"{x} {y} {x * y}\n" for x in range(9) for y in range(9)))
        self.view("h.xyz", "--size", SIZE)
        self.wait("loaded")
        first = self.screenshot()
        self.key("e")
        self.wait("editing")
        self.key("e")
        self.wait("edited")
        self.assertEqual(difference(first, self.screenshot()), 0, "coloured by height")
        self.key("g")
        self.wait("recorded")
        self.key("r")
        self.wait("loaded")
        self.assertEqual(difference(first, self.screenshot()), 0, "coloured by height")
        self.quit()

    def test_a_place_beyond_the_largest_double(self):
        (self.folder / "huge.xy").write_text("0 0\n8e307 0\n0 8e307\n8e307 8e307\n4e307 4e307\n")
        self.view("huge.xy", "--size", SIZE)
        self.wait("loaded")
        self.key(*["minus"] * 8)
        self.key("e")
        self.wait("editing")
        self.drag([MIDDLE, (MIDDLE[0] + 170, MIDDLE[1]), (WIDTH - PANEL - 20, MIDDLE[1])])
        self.assertEqual(numbers(self.wait("edited"))[0], 5)
        self.key("e")
        self.assertGreater(numbers(self.wait("edited"))[1], 0)
        self.quit()

    def test_a_card_over_the_mesh_takes_clicks(self):
        self.view("--generate", "uniform", "-n", 300, "--size", SIZE)
        self.wait("loaded")
        self.key("F1")  # help
        self.screenshot("S")  # the help is drawn
        self.click(*MIDDLE)
        self.xdotool("sleep", 0.2)
        self.key("Escape", "e")
        self.wait("editing")
        self.assertFalse([line for line in self.seen if line.startswith("picked")])
        self.key("e")
        self.click(*MIDDLE)
        self.wait("picked")
        self.quit()

    def test_a_click_is_where_the_pointer_was(self):
        self.view("--generate", "uniform", "-n", 20000, "--size", SIZE)
        self.wait("loaded")
        self.click(*MIDDLE)
        here = self.wait("picked")
        for _ in range(5):
            # "d" makes a frame, which takes longer than the pointer needs.
            self.xdotool("mousemove", *MIDDLE, "sleep", 0.3, "key", "d", "click", 1, "mousemove", MIDDLE[0] + 90, MIDDLE[1])
            self.assertEqual(self.wait("picked"), here)
        self.quit()

    def test_what_does_not_grow_and_cannot_be_edited(self):
        (self.folder / "line.xy").write_text("0 0\n1 1\n2 2\n")
        (self.folder / "wide.xy").write_text("-1.7e308 0\n1.7e308 0\n0 1e308\n")
        self.view("line.xy", "wide.xy", "--size", SIZE)
        self.wait("loaded line.xy")
        self.key("g")
        self.assertIn("on one line", self.wait("message There is nothing that grows"))
        self.key("Escape", "Next")
        self.wait("loaded wide.xy")
        self.key("e")
        self.wait("message These points cannot be edited")
        self.quit()


class Look(WindowTest):
    """Dark and light, the panel, help, sizes of text."""

    def test_dark_help_and_panel(self):
        self.view("--generate", "uniform", "-n", 500, "--size", SIZE, "--scale", 1.5, "--dark")
        self.wait("loaded")
        dark = self.screenshot("S")
        self.assertLess(sum(map(sum, blocks(dark)[-30:])) / 90, 60, "the panel is dark")
        self.key("question")
        helped = self.screenshot("S")
        self.assertGreater(difference(dark, helped), 2.0, "help covers the mesh")
        self.key("Escape")
        self.assertLess(difference(dark, self.screenshot("S")), 1.0)
        self.key("d")
        self.assertGreater(sum(map(sum, blocks(self.screenshot("S"))[-30:])) / 90, 200, "the panel is light")
        self.key("p", "v", "2")
        self.wait("ready")
        self.xdotool("search", "--name", "^cadt", "windowsize", "--sync", "%@", 700, 500)
        self.xdotool("sleep", 1)
        small = self.screenshot()
        self.assertEqual(small.stat().st_size > 0 and len(blocks(small)), 35 * 25, "700 x 500 without a panel")
        self.quit()

    def test_lost_context(self):
        self.view("--generate", "uniform", "-n", 500, "--size", SIZE, "--lose-context")
        self.wait("loaded")
        self.wait("window")
        self.wait("loaded")
        self.focus()
        told = self.screenshot("S")
        self.key("Escape")
        self.assertGreater(difference(told, self.screenshot("S")), 1.0, "a message says what has happened")
        self.quit()


class Segments(WindowTest):
    """Meshes with segments: what is drawn of them, and what there is for points alone."""

    def test_a_polygon_with_a_hole(self):
        rings = [[[0, 0], [10, 0], [10, 10], [0, 10]], [[3, 3], [3, 7], [7, 7], [7, 3]]]
        (self.folder / "plate.json").write_text(json.dumps(rings))
        (self.folder / "bow.json").write_text("[[[0, 0], [4, 4], [4, 0], [0, 4]]]")
        self.view("plate.json", "bow.json", "--domain", "even_odd", "--size", SIZE)
        self.assertIn("8 points 8 triangles 8 constrained edges by copy", self.wait("loaded plate.json"))
        with self.subTest("the picture is that of cadt render"):
            shot = self.screenshot()
            self.cadt("render", "plate.json", "--domain", "even_odd", "--size", f"{WIDTH - PANEL}x{HEIGHT}", "-o", "render.png")
            self.assertLess(difference(shot, self.folder / "render.png"), 3.0)
        with self.subTest("the hole has no triangles"):
            self.click(*MIDDLE)
            self.click(MIDDLE[0], MIDDLE[1] + 260)
            self.wait("picked triangle")
            self.assertEqual(sum(line.startswith("picked") for line in self.seen), 1)
            self.key("Tab")
            self.key("Escape")
        with self.subTest("what there is for points alone"):
            for key in "vgemt":
                self.key(key)
                self.assertIn("This mesh has segments", self.wait("message"))
        with self.subTest("segments that cross"):
            self.key("Next")
            message = self.wait("message This file cannot be shown")
            self.assertIn("1 pair of segments crosses", message)
        self.quit()

    def test_interop_cannot_be_forced(self):
        (self.folder / "line.edg").write_text("1\n0 0 1 1\n")
        self.view("line.edg", "--size", SIZE, "--interop", "opencl")
        self.assertIn("leave --interop out", self.wait("message The display cannot show this"))
        self.quit()


class Troubles(WindowTest):
    """Files that are none, too many points, no display. The window stays."""

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def test_files_in_turn(self):
        files = [self.write("none.xy", "these are no numbers\n"), self.write("one.xy", "1 2\n"),
                 self.write("line.xy", "0 0\n1 1\n2 2\n"), self.write("square.xy", "0 0\n1 0\n1 1\n0 1\n"), "absent.xy"]
        self.view(*files, "--size", SIZE)
        self.assertIn("none.xy", self.wait("message This file cannot be shown"))
        self.key("Next")
        self.assertIn("1 points 0 triangles", self.wait("loaded one.xy"))
        self.key("Next")
        self.assertIn("3 points 0 triangles", self.wait("loaded line.xy"))
        self.key("Next")
        self.assertIn("4 points 2 triangles", self.wait("loaded square.xy"))
        self.click(MIDDLE[0] + 40, MIDDLE[1] + 5)
        self.wait("picked triangle")
        self.key("Next")
        self.wait("message This file cannot be shown")
        self.key("Escape")
        self.assertEqual(self.screenshot().name, "square-1.png", "what the picture shows")
        self.write("absent.xy", "0 0\n1 0\n0 1\n")
        self.key("r")
        self.assertIn("3 points 1 triangles", self.wait("loaded absent.xy"))
        self.quit()

    def test_a_thousand_million_points(self):
        self.view("--generate", "uniform", "-n", "1G", "--size", SIZE)
        self.assertIn("1,000,000,000 points, at most", self.wait("message Too many points"))
        self.quit()

    def test_cancel(self):
        self.view("--generate", "uniform", "-n", "10M", "--size", SIZE)
        self.key("Escape")
        self.wait("message Cancelled")
        self.quit()

    def fails(self, changes, *says):
        done = subprocess.run([PROGRAM, "view", "--generate", "uniform"], env={**self.environment_of_view(), **changes},
                              cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 5, done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)

    def test_no_display(self):
        del self.environment["DISPLAY"]
        self.fails({}, "no window can be opened", "cadt render", "ssh -X")

    def test_opengl_that_is_too_old(self):
        self.fails({"MESA_GL_VERSION_OVERRIDE": "3.3"}, "OpenGL", "4.5", "driver")


if __name__ == "__main__":
    unittest.main()
