# SPDX-License-Identifier: Apache-2.0
"""Polygons and label images: cadt polygons, cadt labels."""
import json
import struct
import unittest
import zlib

from harness import CliTest, twice_area
from shapes import BOW_TIE, HOLE, SQUARE, ConstraintTest, area_of, geojson, polygon


def png(rows, kind=0, *chunks):
    """An image of 8 bits: grey (kind 0), colours (2), or places in a palette (3); `chunks` come before the pixels."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    width = len(rows[0]) // (3 if kind == 2 else 1)
    header = (b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, kind, 0, 0, 0))
    pixels = (b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in rows)))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*c) for c in (header, *chunks, pixels, (b"IEND", b"")))


class Polygons(CliTest):
    off = ConstraintTest.off

    def test_each_is_triangulated_inside(self):
        shifted = [[[x + 10, y] for x, y in ring] for ring in (SQUARE, HOLE)]
        self.write("a.geojson", geojson({"type": "Point", "coordinates": [1, 2]}, polygon(SQUARE, HOLE),
                                        {"type": "MultiPolygon", "coordinates": [[HOLE], shifted]}))
        err = self.cadt("polygons", "a.geojson", "-o", "m.off", "-o", "m.geojson", "-o", "m.svg", "-o", "m.png").err
        points, triangles = self.off("m.off")
        self.assertEqual(area_of(points, triangles) / 2, 15 + 1 + 15)
        for line in ("features    3", "polygons    3", "rings       5", "points      20", "triangles   18",
                     "left out    1 points and lines"):
            self.assertIn(line + "\n", err)
        features = json.loads(self.path("m.geojson").read_text())["features"]
        areas = {}
        for feature in features:
            a, b, c, _ = feature["geometry"]["coordinates"][0]
            number = feature["properties"]["feature"]
            areas[number] = areas.get(number, 0) + twice_area(a, b, c) / 2
        self.assertEqual(areas, {1: 15, 2: 16})

    def test_heights_and_the_reference_system_stay(self):
        crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
        high = [[[x, y, x + 10 * y] for x, y in ring] for ring in (SQUARE, BOW_TIE)]
        self.write("a.geojson", json.dumps(
            {"crs": crs, **json.loads(geojson(polygon(high[0]), polygon([[x + 9, y, x + 9 + 10 * y] for x, y, _ in high[1]])))}))
        for command in (["polygons", "a.geojson", "--crossing", "exact"],
                        ["triangulate", "a.geojson", "--crossing", "exact", "--domain", "even_odd"]):
            self.cadt(*command, "-o", "m.geojson")
            mesh = json.loads(self.path("m.geojson").read_text())
            self.assertEqual(mesh["crs"], crs)
            self.assertEqual(len(mesh["features"]), 4)
            for feature in mesh["features"]:
                for x, y, z in feature["geometry"]["coordinates"][0]:
                    self.assertAlmostEqual(z, x + 10 * y, 12)

    def test_summary_goes_to_stdout_without_output(self):
        self.write("a.json", json.dumps([SQUARE, HOLE]))
        self.assertEqual(self.cadt("polygons", "a.json").fields()["triangles"], "8")
        self.assertEqual(self.cadt("polygons", "a.json", "-o", "m.off", "-q").err, "")
        self.assertEqual(self.cadt("polygons", "-", "-f", "json", stdin=self.path("a.json").read_text()).fields()["rings"], "2")

    def test_those_that_cross_themselves_are_named(self):
        self.write("a.geojson", geojson(polygon(SQUARE), polygon(BOW_TIE), polygon(HOLE), polygon(BOW_TIE[::-1])))
        named = ["a.geojson: 2 of 4 polygons have no inside", "polygon 0 of feature 1: self-crossing, the edges from (",
                 "polygon 0 of feature 3: self-crossing"]
        self.fails(3, "polygons", "a.geojson", "-o", "m.off", "--strict", says=named + ["Nothing was written"])
        self.assertEqual(self.names(), ["a.geojson"])
        err = self.cadt("polygons", "a.geojson", "-o", "m.off").err
        for text in named + ["cadt: warning: ", "--crossing exact", "--strict", "no inside   2 polygons"]:
            self.assertIn(text, err)
        self.assertEqual(area_of(*self.off("m.off")) / 2, 16 + 1)
        self.assertEqual(self.cadt("polygons", "a.geojson", "-o", "m.off", "-q").err, "")

    def test_polygons_count_within_their_feature(self):
        parts = {"type": "MultiPolygon", "coordinates": [[SQUARE], [HOLE], [BOW_TIE]]}
        self.write("a.geojson", geojson(polygon(SQUARE), parts))
        err = self.cadt("polygons", "a.geojson", "-o", "m.off").err
        self.assertIn("polygon 2 of feature 1: self-crossing", err)
        self.assertIn("no inside   1 polygon\n", err)

    def test_crossings_can_become_vertices(self):
        self.write("a.geojson", geojson(polygon(SQUARE), polygon(BOW_TIE)))
        self.cadt("polygons", "a.geojson", "--crossing", "exact", "-o", "m.off")
        points, triangles = self.off("m.off")
        self.assertEqual(area_of(points, triangles) / 2, 16 + 8)
        self.assertEqual(points[12:], [(2, 2)])
        self.assertIn("mended      1 polygon, its points are in the output twice", self.cadt("polygons", "a.geojson", "--crossing", "exact").out)
        flat = [[0, 0], [1, 1], [2, 2], [0, 0]]
        self.write("b.geojson", geojson(polygon(SQUARE), polygon(BOW_TIE), polygon(flat), polygon(SQUARE, [[1, 1]])))
        err = self.cadt("polygons", "b.geojson", "--crossing", "exact", "-o", "m.off").err
        self.assertIn("polygon 0 of feature 2: zero area at (0, 0)", err)
        self.assertIn("They are left out; --strict makes this an error.", err)
        self.assertNotIn("polygon 3", err)
        self.assertEqual(area_of(*self.off("m.off")) / 2, 16 + 8 + 16)
        err = self.cadt("polygons", "b.geojson", "-o", "m.off").err
        self.assertIn("2 of 4 polygons have no inside", err)
        self.assertIn("They are left out; --crossing exact takes rings that cross; --strict", err)
        points, triangles = self.off("m.off")
        self.assertEqual(area_of(points, triangles) / 2, 16 + 16)
        self.assertIn((1, 1), [points[v] for t in triangles for v in t])

    def test_files_of_gdal_can_be_converted(self):
        for suffix in ("shp", "gpkg"):
            self.fails(2, "polygons", "a." + suffix, says=f"one of: geojson json; ogr2ogr OUT.geojson 'a.{suffix}' makes one of them")

    def test_a_grid_moves_those_that_cross_alone(self):
        dot = [[1, 1]]
        self.write("a.geojson", geojson(polygon(SQUARE, dot), polygon(BOW_TIE, dot)))
        self.assertEqual(self.cadt("polygons", "a.geojson", "--crossing", "grid=3", "-o", "m.off", "-q").err, "")
        points, triangles = self.off("m.off")
        square = [t for t in triangles if all(points[v][0] in (0, 1, 4) for v in t)]
        self.assertEqual(area_of(points, square) / 2, 16)
        others = [v for t in triangles if t not in square for v in t]
        self.assertTrue(others)
        for v in others:
            self.assertTrue(points[v][0] % 3 == 0 and points[v][1] % 3 == 0, points[v])

    def test_those_that_do_not_suit_the_grid_are_named(self):
        far = [[1e20 * x, 1e20 * y] for x, y in BOW_TIE]
        self.write("a.geojson", geojson(polygon(SQUARE), polygon(far), polygon(BOW_TIE)))
        err = self.cadt("polygons", "a.geojson", "--crossing", "grid=0.5", "-o", "m.off").err
        for text in ("1 of 3 polygons has no inside", "polygon 0 of feature 1: self-crossing", "; --crossing grid: coordinates are 2^52"):
            self.assertIn(text, err)
        self.assertEqual(area_of(*self.off("m.off")) / 2, 16 + 8)
        self.fails(3, "polygons", "a.geojson", "--crossing", "grid=0.5", "-o", "n.off", "--strict", says="coordinates are 2^52")
        err = self.cadt("polygons", "a.geojson", "--crossing", "grid=1e300", "-o", "m.off").err
        self.assertIn("; nothing is inside on the grid", err)

    def test_those_without_points_are_named(self):
        self.write("a.geojson", geojson(polygon(SQUARE), polygon(), polygon([]), polygon(SQUARE, []), polygon([], SQUARE)))
        named = ["a.geojson: 3 of 5 polygons have no inside"] + [
            f"polygon 0 of feature {p}: too few points, {who} has none" for p, who in ((1, "it"), (2, "it"), (4, "its first ring"))]
        self.fails(3, "polygons", "a.geojson", "-o", "m.off", "--strict", says=named)
        err = self.cadt("polygons", "a.geojson", "-o", "m.off").err
        for text in named:
            self.assertIn(text, err)
        self.assertEqual(area_of(*self.off("m.off")) / 2, 2 * 16)
        for name, text in (("b.json", "[]"), ("c.json", json.dumps(polygon(SQUARE, SQUARE)))):  # which that does not help
            self.write(name, text)
            err = self.cadt("polygons", name, "-o", "m.off").err
            self.assertIn("1 of 1 polygons has no inside", err)
            self.assertNotIn("--crossing", err)
        self.write("d.json", json.dumps(polygon(SQUARE[:2] * 3)))
        self.assertNotIn("--crossing", self.cadt("polygons", "d.json", "-o", "m.off").err)

    def test_heights_that_some_positions_lack_are_left_out_with_a_note(self):
        high = [[x, y, 1] for x, y in SQUARE]
        self.write("a.geojson", geojson(polygon(high), polygon(SQUARE)))
        self.assertIn("cadt: heights are left out: a.geojson has none at some points", self.cadt("polygons", "a.geojson").err)
        self.assertEqual(self.cadt("polygons", "a.geojson", "-q", "-o", "m.off").err, "")
        self.write("b.geojson", geojson(polygon([high[0], *SQUARE[1:]])))
        self.assertIn("b.geojson has none at some points", self.cadt("polygons", "b.geojson").err)
        dot = {"type": "Point", "coordinates": [0, 0]}  # of which nothing is read
        for shapes in ((polygon(high), dot), (polygon(SQUARE),)):
            self.write("c.geojson", geojson(*shapes))
            self.assertNotIn("heights", self.cadt("polygons", "c.geojson").err)

    def test_errors(self):
        self.fails(2, "polygons", "a.json", "--crossing", "round", says="--crossing round:")
        self.write("a.json", json.dumps({"type": "LineString", "coordinates": [[0, 0], [1, 1]]}))
        self.fails(3, "polygons", "a.json", says="has no polygons")
        self.fails(2, "polygons", "-", says="-f geojson")
        self.fails(2, "polygons", "a.json", "-o", "m.stl", says="unknown suffix")
        self.fails(2, "polygons", "a.json", "-o", "a.json", "-t", "geojson", says="this is the input")
        self.fails(2, "polygons", "a.shp", says="one of: geojson json")


class Labels(CliTest):
    off = ConstraintTest.off

    def setUp(self):
        super().setUp()
        self.rows = [[1, 1, 2, 2], [1, 3, 3, 2], [1, 1, 3, 0]]
        self.path("a.png").write_bytes(png(self.rows))

    def test_triangles_have_the_labels_of_their_pixels(self):
        err = self.cadt("labels", "a.png", "-o", "m.off", "-o", "m.geojson", "-o", "m.svg", "-o", "p.png", "-o", "m.vtu").err
        points, triangles = self.off("m.off")
        self.assertEqual(area_of(points, triangles) / 2, 12)
        areas = {}
        for feature in json.loads(self.path("m.geojson").read_text())["features"]:
            a, b, c, _ = feature["geometry"]["coordinates"][0]
            label = feature["properties"]["label"]
            areas[label] = areas.get(label, 0) + twice_area(a, b, c) / 2
            x, y = (int((p + q + r) / 3) for p, q, r in zip(a, b, c))
            self.assertEqual(label, self.rows[2 - y][x])
        self.assertEqual(areas, {1: 5, 2: 3, 3: 3, 0: 1})
        for line in ("pixels      4 x 3", "labels      4", "regions     4"):
            self.assertIn(line + "\n", err)
        self.assertIn("Name=\"label\"", self.path("m.vtu").read_bytes().decode(errors="replace"))

    def test_one_label_and_quiet(self):
        self.path("one.png").write_bytes(png([[7] * 5] * 4))
        self.assertEqual(self.cadt("labels", "one.png").fields()["triangles"], "2")
        self.assertEqual(self.cadt("labels", "one.png", "-o", "m.ply", "-q").err, "")

    def test_errors(self):
        self.write("no.png", "P5\n")
        self.fails(3, "labels", "no.png", says="no.png: is no PNG")
        self.path("cut.png").write_bytes(self.path("a.png").read_bytes()[:-20])
        self.fails(3, "labels", "cut.png", says="cut.png: is malformed")
        self.fails(2, "labels", "a.png", "-o", "a.png", says="this is the input")
        self.fails(2, "labels", "a.png", "-o", "m.npz", says="unknown suffix")
        self.fails(3, "labels", "absent.png", says="absent.png")

    def test_transparent_colours(self):
        grey, rgb = [[0, 1], [1, 0]], [[1, 2, 3, 4, 5, 6], [1, 2, 3, 7, 8, 9]]
        palette = (b"PLTE", bytes(range(9)))
        for name, data, right in (
                ("palette", png(grey, 3, palette, (b"tRNS", b"\xff\x80")), False),
                ("opaque palette", png(grey, 3, palette, (b"tRNS", b"\xff\xff\x00")), True),
                ("grey", png(grey, 0, (b"tRNS", struct.pack(">H", 1))), False),
                ("other grey", png(grey, 0, (b"tRNS", struct.pack(">H", 2))), True),
                ("colour", png(rgb, 2, (b"tRNS", struct.pack(">HHH", 4, 5, 6))), False),
                ("other colour", png(rgb, 2, (b"tRNS", struct.pack(">HHH", 4, 5, 7))), True)):
            with self.subTest(name):
                self.path("t.png").write_bytes(data)
                if right:
                    self.cadt("labels", "t.png")
                else:
                    self.fails(3, "labels", "t.png", says="is transparent")


if __name__ == "__main__":
    unittest.main()
