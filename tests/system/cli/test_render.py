# SPDX-License-Identifier: Apache-2.0
"""cadt render: pictures without a window."""
import json
import os
import re
import unittest

from harness import CliTest
from test_render_growth import png_rows, png_size

PAPER = bytes.fromhex("fbfaf6")


def colours(path):
    return {row[i:i + 3] for row in png_rows(path) for i in range(0, len(row), 3)}


class RenderTest(CliTest):
    def test_png_of_a_file_and_of_a_generated_set(self):
        self.cadt("generate", "terrain", "-n", 3000, "-o", "t.xyz")
        result = self.cadt("render", "t.xyz", "-o", "t.png", "--size", 300)
        self.assertIn("triangles of 3000 points drawn in", result.err)
        self.assertEqual(png_size(self.path("t.png"))[0], 300)
        result = self.cadt("render", "--generate", "uniform", "-n", 3000, "-o", "u.png", "--size", "200x100", "-q")
        self.assertEqual((result.out, result.err), ("", ""))
        self.assertEqual(png_size(self.path("u.png")), (200, 100))
        self.assertEqual(png_rows(self.path("u.png"))[0][:3], PAPER)
        self.assertGreater(len(colours(self.path("t.png"))), 500, "a relief")

    def test_each_colour_and_style_is_a_picture_of_its_own(self):
        seen = set()
        for more in (["--colour", "angle"], ["--colour", "area"], ["--colour", "order"], ["--colour", "degree"], ["--colour", "nothing"],
                     ["--style", "wireframe"], ["--style", "points"], [], ["--dark"], ["--camera", "0.5,0.5,4"], ["--samples", 4]):
            self.cadt("render", "--generate", "uniform", "-n", 200, "-o", "a.png", "--size", 120, "-q", "--backend", "host", *more)
            seen.add(self.path("a.png").read_bytes())
        self.assertEqual(len(seen), 10, "area is the default of points without heights")

    def test_camera_shows_the_place_in_the_middle(self):
        self.write("p.xy", "0 0\n100 0\n0 100\n50 50.5\n51 50\n50 51\n")
        self.cadt("render", "p.xy", "-o", "near.png", "--size", "101x101", "--camera", "90,90,30", "-q")
        self.assertEqual(colours(self.path("near.png")), {PAPER}, "outside of the hull")
        self.cadt("render", "p.xy", "-o", "near.png", "--size", "101x101", "--camera", "20,20,30", "-q", "--no-hull")
        self.assertNotIn(PAPER, colours(self.path("near.png")))

    def test_camera_shows_places_outside_of_the_points(self):
        self.write("p.xy", "0 0\n100 0\n0 100\n100 100\n")
        self.cadt("render", "p.xy", "-o", "a.png", "--size", "101x101", "--camera", "100,50,1", "-q")
        rows = png_rows(self.path("a.png"))
        self.assertNotEqual(rows[50][:3], PAPER)
        self.assertEqual(rows[50][3 * 70:3 * 71], PAPER)
        self.cadt("render", "p.xy", "-o", "a.png", "--size", "101x101", "--camera", "300,50,1", "-q")
        self.assertEqual(colours(self.path("a.png")), {PAPER})
        self.fails(2, "render", "p.xy", "-o", "b.png", "--camera", "50,50,1e40", says=("--camera", "e+"))
        for least in ("1e-3", "0", "-1", "nan"):  # whatever the points are
            self.fails(2, "render", "missing.xy", "-o", "b.png", "--camera", f"50,50,{least}", says=("--camera", "0.0625"))

    def test_svg_and_pdf(self):
        self.cadt("render", "--generate", "uniform", "-n", 300, "-o", "a.svg", "--size", 400)
        self.assertIn("viewBox=\"0 0 400", self.path("a.svg").read_text())
        self.cadt("render", "--generate", "uniform", "-n", 300, "-o", "a.pdf")
        self.assertTrue(self.path("a.pdf").read_bytes().startswith(b"%PDF-"))
        result = self.cadt("render", "--generate", "uniform", "-n", 300, "-o", "-", "-t", "svg", "-q")
        self.assertIn("</svg>", result.out)

    def svg_size(self, name):
        return [int(n) for n in re.search(r'viewBox="0 0 (\d+) (\d+)"', self.path(name).read_text()).groups()]

    def test_svg_and_pdf_have_the_size_that_is_asked_for(self):
        self.write("square.xy", "0 0\n1 0\n0 1\n1 1\n")
        for size in ("300x100", "100x300", "64x64"):
            width, height = map(int, size.split("x"))
            self.cadt("render", "square.xy", "-o", "a.svg", "--size", size)
            self.assertEqual(self.svg_size("a.svg"), [width, height])
            corners = re.findall(r"[ML] ([\d.]+) ([\d.]+)", self.path("a.svg").read_text())
            for k, side in ((0, width), (1, height)):
                along = [float(corner[k]) for corner in corners if float(corner[k]) not in (0, side)]
                self.assertAlmostEqual(min(along) + max(along), side, delta=1, msg="the mesh is in the middle")
                self.assertAlmostEqual(max(along) - min(along), min(width, height), delta=0.2 * min(width, height))
            self.cadt("render", "square.xy", "-o", "a.pdf", "--size", size)
            self.assertRegex(self.path("a.pdf").read_bytes(), rb"/MediaBox \[ 0 0 %d %d \]" % (width, height))

    def test_a_width_that_is_asked_for_is_had(self):
        self.write("square.xy", "0 0\n1 0\n0 1\n1 1\n")
        self.write("high.xy", "0 0\n1 0\n0 6\n1 6\n")
        for width in (4100, 16000):
            self.cadt("render", "square.xy", "-o", "a.svg", "--size", width)
            self.assertEqual(self.svg_size("a.svg"), [width, width])
            self.cadt("triangulate", "square.xy", "-o", "a.svg", "--width", 2 * width)
            self.assertEqual(self.svg_size("a.svg"), [2 * width, 2 * width])
        for command, option in (("render", "--size"), ("triangulate", "--width")):
            self.cadt(command, "high.xy", "-o", "a.svg")
            self.assertEqual(self.svg_size("a.svg")[1], 4000, "without a width")
            self.cadt(command, "high.xy", "-o", "a.svg", option, 1000)
            self.assertEqual(self.svg_size("a.svg")[0], 1000)
            self.assertGreater(self.svg_size("a.svg")[1], 5500)
        self.cadt("triangulate", "square.xy", "-o", "a.png", "--width", 4100)
        self.assertEqual(png_size(self.path("a.png")), (4100, 4100))
        self.cadt("render", "high.xy", "-o", "a.png", "--size", 800, "--samples", 1)
        width, height = png_size(self.path("a.png"))
        self.assertEqual(width, 800)
        self.assertGreater(height, 4500)
        self.fails(2, "triangulate", "square.xy", "-o", "a.svg", "--width", 32001, says="--width")

    def test_more_pixels_than_opengl_has_room_for(self):
        self.write("square.xy", "0 0\n1 0\n0 1\n1 1\n")
        for size, samples in (("11586x11586", 2), ("16384", 1), ("5793x5793", 4)):
            self.fails(5, "render", "square.xy", "-o", "a.png", "--size", size, "--samples", samples, says=("2 GiB", "samples"))
        self.assertEqual(self.names(), ["square.xy"])

    def test_no_triangles(self):
        for name, text in (("one", "3 4\n"), ("line", "0 0\n1 1\n2 2\n")):
            self.write(f"{name}.xy", text)
            self.cadt("render", f"{name}.xy", "-o", f"{name}.png", "--size", "80x60")
            self.assertNotEqual(colours(self.path(f"{name}.png")), {PAPER}, name)

    def test_large_meshes_of_triangulate_are_drawn_too(self):
        self.cadt("generate", "uniform", "-n", 120000, "-o", "p.f64")
        self.cadt("triangulate", "p.f64", "--backend", "host", "-o", "p.png", "--width", 200, "-q")
        self.assertEqual(png_size(self.path("p.png"))[0], 200)
        self.fails(3, "render", "p.f64", "--backend", "host", "-o", "p.svg", says="too many")
        self.assertEqual(self.names(), ["p.f64", "p.png"])


EDGE = bytes.fromhex("6b1f8a")
# A square of 10 with a square hole of 4.
PLATE = json.dumps({"type": "MultiPolygon", "coordinates": [[[[0, 0], [10, 0], [10, 10], [0, 10]], [[3, 3], [3, 7], [7, 7], [7, 3]]]]})


class RenderSegmentsTest(CliTest):
    def setUp(self):
        super().setUp()
        self.write("plate.geojson", PLATE)

    def picture(self, *arguments, name="p.png", size="101x101"):
        """The rows of the picture."""
        self.cadt("render", *arguments, "-o", name, "--size", size, "-q", "--backend", "host")
        return png_rows(self.path(name))

    def middle(self, *arguments):
        return self.picture(*arguments)[50][150:153]

    def near(self, colour, other):
        return all(abs(a - b) <= 2 for a, b in zip(colour, other))

    def test_what_is_outside_of_the_domain_is_not_drawn(self):
        result = self.cadt("render", "plate.geojson", "--domain", "even_odd", "-o", "p.png", "--size", 200)
        self.assertIn("8 triangles of 8 points drawn", result.err)
        self.picture("plate.geojson", "--domain", "even_odd", "--camera", "5,5,5")
        self.assertEqual(colours(self.path("p.png")), {PAPER}, "the hole")
        for domain in ([], ["--domain", "outer"]):
            self.picture("plate.geojson", *domain, "--camera", "5,5,5")
            self.assertNotIn(PAPER, colours(self.path("p.png")))
        self.picture("plate.geojson", "--domain", "even_odd", "--camera", "1.5,5,20")
        self.assertNotIn(PAPER, colours(self.path("p.png")), "the square around it")

    def test_constrained_edges_have_a_colour_of_their_own_at_each_magnification(self):
        for camera in ("10,5,0.25", "10,5,1", "10,5,1000", "3,5,1", "3,5,1e6"):
            self.assertTrue(self.near(self.middle("plate.geojson", "--domain", "even_odd", "--camera", camera), EDGE), camera)
        self.picture("plate.geojson", "--domain", "even_odd", "--camera", "1.5,5,20")
        self.assertFalse(any(self.near(colour, EDGE) for colour in colours(self.path("p.png"))), "edges inside are others")
        self.assertFalse(self.near(self.middle("plate.geojson", "--camera", "10,5,9", "--dark"), EDGE))

    def test_breaklines_over_points_with_heights(self):
        self.cadt("generate", "terrain", "-n", 20000, "-o", "t.xyz")
        self.write("lines.obj", "v 0.2 0.5 0\nv 0.8 0.5 0\nl 1 2\n")
        box = ["--camera", "0.43,0.5,1"]
        self.assertTrue(self.near(self.middle("t.xyz", "--segments", "lines.obj", *box), EDGE))
        self.assertGreater(len(colours(self.path("p.png"))), 200, "a relief")
        self.assertFalse(self.near(self.middle("t.xyz", *box), EDGE))

    def test_regions(self):
        usual = self.picture("plate.geojson")
        self.assertEqual(self.picture("plate.geojson", "--colour", "region"), usual, "there are two")
        self.assertNotEqual(self.picture("plate.geojson", "--colour", "area"), usual)
        hole, square = (self.middle("plate.geojson", "--camera", f"{x},5.5,30") for x in (4.2, 1.2))
        self.assertNotEqual(hole, square)
        one = self.picture("plate.geojson", "--domain", "even_odd")
        self.assertEqual(self.picture("plate.geojson", "--domain", "even_odd", "--colour", "area"), one, "one alone has no colour")

    def test_crossings(self):
        self.write("bow.json", "[[[0, 0], [4, 4], [4, 0], [0, 4]]]")
        self.fails(3, "render", "bow.json", "-o", "p.png", says=("(0, 0) - (4, 4)", "--crossing exact"))
        result = self.cadt("render", "bow.json", "-o", "p.png", "--size", 90, "--crossing", "exact", "--domain", "even_odd")
        self.assertIn("2 triangles of 5 points drawn", result.err)
        self.assertTrue(self.near(self.middle("bow.json", "--crossing", "exact", "--camera", "2,2,30"), EDGE))
        self.assertTrue(self.near(self.middle("bow.json", "--crossing", "grid=1", "--camera", "1,1,30"), EDGE))

    def test_files_of_shapes_are_those_of_triangulate(self):
        # The colours, too: they depend on the order of the triangles, which is not left to the device.
        square = lambda x, y: [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]]
        self.write("squares.json", json.dumps([square(3 * (7 * i % 20), 3 * i) for i in range(20)]))
        for file in ("plate.geojson", "squares.json"):
            for suffix in ("svg", "pdf"):
                self.cadt("render", file, "--domain", "even_odd", "-o", f"r.{suffix}", "--size", 300)
                self.cadt("triangulate", file, "--domain", "even_odd", "-o", f"t.{suffix}", "--width", 300)
                self.assertEqual(self.path(f"r.{suffix}").read_bytes(), self.path(f"t.{suffix}").read_bytes(), file)
        self.cadt("render", "plate.geojson", "-o", "r.svg", "--size", "300x100")
        self.assertIn('width="300" height="100"', self.path("r.svg").read_text())

    def test_what_does_not_fit(self):
        self.write("p.xy", "0 0\n1 0\n0 1\n")
        plate = ["render", "plate.geojson", "-o", "p.png"]
        self.fails(2, "render", "p.xy", "-o", "p.png", "--domain", "outer", says="--domain is about segments")
        self.fails(2, "render", "p.xy", "-o", "p.png", "--colour", "region", says="with segments only")
        self.fails(2, "render", "--generate", "uniform", "-o", "p.png", "--segments", "plate.geojson", says="--generate")
        self.fails(2, *plate, "--segments", "plate.geojson", says="segments of its own")
        self.fails(2, *plate, "--crossing", "grid=0", says="grid=0.001")
        self.fails(2, *plate, "--colour", "level", says="grows only")
        for option in ("-n", "--seed"):
            self.fails(2, *plate, option, "10", says=f"{option} requires --generate")
        self.fails(2, *plate, "--samples", "2.0", says="--samples: a whole number from 1 to 4")
        if " view " in self.cadt("--help").out:
            for option, value in (("--scale", "nan"), ("--seed", "-1"), ("--scale", "9")):
                self.fails(2, "view", "--generate", "uniform", option, value, says=f"{option}: a ")
            self.fails(2, "view", "p.xy", "-n", "10", says="-n requires --generate")
        self.fails(2, *plate, "--colour", "height", says="third column")
        self.fails(2, *plate, "--growth", 4, says="not shown as it grows")
        self.fails(2, "render", "plate.geojson", "-o", "film.mp4", says="not shown as it grows")
        self.fails(2, "render", "p.xy", "--segments", "lines.png", "-o", "lines.png", says="this is the input")
        self.assertEqual(self.names(), ["p.xy", "plate.geojson"])


class RenderErrorTest(CliTest):
    def test_what_cannot_be_meant(self):
        uniform = ["render", "--generate", "uniform", "-n", 100, "-o", "a.png"]
        self.fails(2, "render", "-o", "a.png", says="--generate")
        self.fails(2, "render", "in.xy", "--generate", "uniform", "-o", "a.png", says="not both")
        self.fails(2, "render", "--generate", "nosuch", "-o", "a.png", says="generate --list")
        for size in ("0", "99999", "20x", "x20", "1.5", "nan", "20x30x40"):
            self.fails(2, *uniform, "--size", size, says="--size")
        for camera in ("1,2", "1,2,0", "1,2,-3", "1,2,nan", "a,b,c", "1,2,3,4"):
            self.fails(2, *uniform, "--camera", camera, says="--camera")
        self.fails(2, *uniform, "--colour", "blue")
        self.fails(2, *uniform, "--colour", "height", says="third column")
        self.fails(2, *uniform, "--colour", "flips", says="grows")
        for options in (["--dark"], ["--no-hull"], ["--samples", 2]):
            self.fails(2, *uniform[:-1], "a.svg", *options, says=(options[0], ".svg"))
        self.fails(2, *uniform[:-1], "a.jpg", says="png, svg, pdf")
        self.assertEqual(self.names(), [])

    def test_a_point_that_is_none_and_a_file_that_is_none(self):
        self.write("nan.xy", "0 0\n1 nan\n2 1\n")
        self.fails(3, "render", "nan.xy", "-o", "a.png", says="nan.xy")
        self.write("text.xy", "hello world\n")
        self.fails(3, "render", "text.xy", "-o", "a.png", says="text.xy")
        self.fails(3, "render", "nosuch.xy", "-o", "a.png", says="nosuch.xy")
        self.fails(3, "render", "--generate", "uniform", "-n", 100, "-o", "nowhere/a.png", says="nowhere")

    def test_without_opengl(self):
        # No vendor's file, so that the loader finds no driver.
        environment = {**os.environ, "__EGL_VENDOR_LIBRARY_FILENAMES": "/dev/null"}
        self.fails(5, "render", "--generate", "uniform", "-n", 100, "-o", "a.png", environment=environment,
                   says=("no OpenGL without a window", "libegl-mesa0"))
        environment = {**os.environ, "MESA_GL_VERSION_OVERRIDE": "3.3"}
        self.fails(5, "render", "--generate", "uniform", "-n", 100, "-o", "a.png", environment=environment, says="OpenGL 4.5")
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
