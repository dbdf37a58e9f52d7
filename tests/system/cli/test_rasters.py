# SPDX-License-Identifier: Apache-2.0
"""raster and voronoi, against brute force on small sets."""
import json
import math
import re
import struct
import unittest

from answers import area, cell, plane, read_asc, read_npy, read_npz, xyz_text
from harness import CliTest, integer_points, read_off, xy_text


class RasterCommand(CliTest):
    def terrain(self):
        points = integer_points(80, 40)
        height = lambda x, y: math.sin(x / 5) * y
        self.write("p.xyz", "".join(f"{x} {y} {height(x, y)!r}\n" for x, y in points))
        return points

    def centres(self, header):
        rows, columns, size = int(header["nrows"]), int(header["ncols"]), header["cellsize"]
        return [(header["xllcorner"] + (i + 0.5) * size, header["yllcorner"] + (rows - 1 - j + 0.5) * size)
                for j in range(rows) for i in range(columns)]

    def test_cells_are_what_interpolate_finds_at_their_centres(self):
        points = self.terrain()
        for method in ("linear", "nearest", "natural"):
            self.cadt("raster", "p.xyz", "--res", "1.75", "--method", method, "-o", "d.asc", "-q")
            text = self.path("d.asc").read_text()
            self.assertRegex(text, r"^ncols \d+\nnrows \d+\nxllcorner \S+\nyllcorner \S+\ncellsize 1.75\n"
                                   r"NODATA_value -9999\n")
            header, rows = read_asc(text)
            self.assertEqual((header["xllcorner"], header["yllcorner"]),
                             (min(x for x, _ in points), min(y for _, y in points)))
            self.assertEqual(header["ncols"], math.ceil((max(x for x, _ in points) - header["xllcorner"]) / 1.75))
            self.assertEqual((len(rows), {len(row) for row in rows}), (header["nrows"], {header["ncols"]}))
            cells = [v for row in rows for v in row]
            self.write("q.xy", "".join(f"{x!r} {y!r}\n" for x, y in self.centres(header)))
            asked = [float(v) for v in self.cadt("interpolate", "p.xyz", "q.xy", "--method", method).out.split()]
            self.assertIn(-9999, cells)
            for a, b in zip(cells, asked):
                self.assertEqual(a == -9999, math.isnan(b))
                if a != -9999:
                    self.assertAlmostEqual(a, b, places=9)
            self.cadt("raster", "p.xyz", "--res", "1.75", "--method", method, "-o", "d.npy", "-q")
            shape, numbers = read_npy(self.path("d.npy").read_bytes())
            self.assertEqual(shape, (header["nrows"], header["ncols"]))
            self.assertEqual([-9999 if math.isnan(v) else v for v in numbers], cells)

    def test_a_plane_with_the_top_row_first(self):
        self.write("p.xyz", xyz_text([(0, 0), (2.1, 0), (0, 0.9), (2.1, 0.9)]))
        header, rows = read_asc(self.cadt("raster", "p.xyz", "--res", "0.3", "-o", "-", "-t", "asc").out)
        self.assertEqual((header["ncols"], header["nrows"]), (7, 3))  # 2.1 / 0.3 is more than 7 in doubles
        for j, row in enumerate(rows):
            for i, value in enumerate(row):
                self.assertAlmostEqual(value, plane(0.3 * (i + 0.5), 0.3 * (2 - j + 0.5)), places=9)

    def test_many_columns_cover_the_bounds(self):
        """A thousandth of a cell at most is rounding, however many there are."""
        self.write("p.xyz", xyz_text([(0, 0), (2000000.0015, 0), (0, 1), (2000000.0015, 1)]))
        self.cadt("raster", "p.xyz", "--res", "1", "-o", "d.npy", "-q")
        with self.path("d.npy").open("rb") as file:
            self.assertIn(b"(1, 2000001)", file.read(128))

    def test_bounds_nodata_and_long_edges(self):
        self.write("p.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n9 0 1\n9 1 1\n")
        asc = lambda *more: self.cadt("raster", "p.xyz", "--res", "1", "-o", "-", "-t", "asc", *more).out
        self.assertEqual(read_asc(asc())[1], [[1] * 9])
        self.assertEqual(read_asc(asc("--max-edge", "2"))[1], [[1] + [-9999] * 8])
        text = asc("--bounds=-2,-1,1,1.5", "--nodata=-1")
        self.assertTrue(text.startswith("ncols 3\nnrows 3\nxllcorner -2\nyllcorner -1\ncellsize 1\nNODATA_value -1\n"))
        self.assertEqual(read_asc(text)[1], [[-1, -1, -1], [-1, -1, 1], [-1, -1, -1]])

    def test_picture(self):
        self.terrain()
        result = self.cadt("raster", "p.xyz", "--res", "0.5", "-o", "d.png")
        columns, rows = map(int, re.search(r"(?m)^cells       (\d+) x (\d+)$", result.err).groups())
        data = self.path("d.png").read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", data[16:24]), (columns, rows))
        self.write("flat.xyz", "0 0 1\n1 0 1\n0 1 1\n")
        self.cadt("raster", "flat.xyz", "--res", "1", "-o", "one.png")


class VoronoiCommand(CliTest):
    box = (-10, -10, 60, 60)

    def points(self):
        points = list(dict.fromkeys(integer_points(70, 50)))
        self.write("p.xy", xy_text(points + points[:1]))
        return points

    def check(self, points, polygons):
        for p, polygon in enumerate(polygons):
            expected = cell(points, points[p], self.box)
            self.assertAlmostEqual(area(polygon), area(expected), places=8)  # positive: counterclockwise
            for x, y in polygon:
                near = min(math.dist((x, y), q) for q in points)
                self.assertAlmostEqual(math.dist((x, y), points[p]), near, places=8)

    def test_polygons(self):
        points = self.points()
        self.cadt("voronoi", "p.xy", "--box=-10,-10,60,60", "-o", "v.geojson")
        collection = json.loads(self.path("v.geojson").read_text())
        self.assertEqual(collection["type"], "FeatureCollection")
        features = collection["features"]
        self.assertEqual([f["properties"]["point"] for f in features], list(range(len(points))))
        rings = [f["geometry"]["coordinates"][0] for f in features]
        for ring in rings:
            self.assertEqual(ring[0], ring[-1])
        self.check(points, [[tuple(c) for c in ring[:-1]] for ring in rings])

    def test_arrays(self):
        points = self.points()
        self.cadt("triangulate", "p.xy", "-o", "m.off", "-q")
        triangles = read_off(self.path("m.off").read_text())[1]
        self.cadt("voronoi", "p.xy", "-o", "v.npz")
        arrays = read_npz(self.path("v.npz"))
        self.assertEqual(sorted(arrays), ["cell_begin", "cells", "points", "ridge_points", "ridge_vertices", "vertices"])
        self.assertEqual(arrays["vertices"][0], (len(triangles), 2))
        vertices = list(zip(arrays["vertices"][1][::2], arrays["vertices"][1][1::2]))
        for triangle, centre in zip(triangles, vertices):
            radii = [math.dist(centre, points[v]) for v in triangle]
            self.assertAlmostEqual(min(radii), max(radii), delta=1e-9 * max(radii))
        begin, cells = arrays["cell_begin"][1], arrays["cells"][1]
        self.assertEqual(arrays["cell_begin"][0], (len(points) + 2,))
        for p in range(len(points)):
            self.assertEqual(sorted(cells[begin[p]:begin[p + 1]]), [t for t in range(len(triangles)) if p in triangles[t]])
        self.assertEqual(begin[-1], begin[-2], "a duplicate has no cell")
        edges = arrays["ridge_points"][1]
        expected = {tuple(sorted((t[k], t[k - 1]))) for t in triangles for k in range(3)}
        self.assertEqual({tuple(sorted(e)) for e in zip(edges[::2], edges[1::2])}, expected)
        self.assertEqual(arrays["ridge_points"][0], arrays["ridge_vertices"][0])

        self.cadt("voronoi", "p.xy", "--box=-10,-10,60,60", "-o", "b.npz")
        arrays = read_npz(self.path("b.npz"))
        begin, xy = arrays["polygon_begin"][1], arrays["polygons"][1]
        corners = list(zip(xy[::2], xy[1::2]))
        self.check(points, [corners[begin[p]:begin[p + 1]] for p in range(len(points))])

    def test_a_box_along_the_sides_of_cells(self):
        """Cells that only touch the box are lines and points: no polygons."""
        self.write("g.xy", xy_text((x, y) for x in range(3) for y in range(2)))
        for box, inside in (("0.5,0,1.5,1", [2, 3]), ("0.5,0,1.5,0.5", [2]), ("0,0,2,1", range(6))):
            err = self.cadt("voronoi", "g.xy", "--box", box, "-o", "g.geojson").err
            self.assertRegex(err, rf"(?m)^cells       {len(inside)} within {box}$")
            features = json.loads(self.path("g.geojson").read_text())["features"]
            self.assertEqual([f["properties"]["point"] for f in features], list(inside))
            for feature in features:
                ring = [tuple(corner) for corner in feature["geometry"]["coordinates"][0]]
                self.assertEqual(len(set(ring)), len(ring) - 1, "the first corner closes the ring, no other is twice")
                self.assertGreater(area(ring[:-1]), 0)
            self.cadt("voronoi", "g.xy", "--box", box, "-o", "g.svg", "-q")
            self.assertIn(f"<title>{len(inside)} Voronoi cells</title>", self.path("g.svg").read_text())
            self.assertRegex(self.cadt("voronoi", "g.xy", "--box", box, "-o", "g.npz").err, f"cells       {len(inside)} ")

    def test_cells_of_any_size(self):
        """Products of coordinates near the ends of double are zero or infinite; these cells have an area."""
        for size in ("1e-200", "1e-300", "1e200", "8e307"):
            points = [(0, 0), (size, 0), (0, size), (size, size)]
            self.write("e.xy", xy_text(points))
            err = self.cadt("voronoi", "e.xy", "--box", f"-{size},-{size},{size},{size}", "-o", "e.geojson").err
            self.assertRegex(err, "(?m)^cells       4 within", size)

    def test_picture(self):
        points = self.points()
        result = self.cadt("voronoi", "p.xy", "-o", "v.svg")
        self.assertRegex(result.err, rf"(?m)^cells       {len(points)} within ")
        text = self.path("v.svg").read_text()
        self.assertIn(f"<title>{len(points)} Voronoi cells</title>", text)
        self.assertEqual(text.count("z") - text.count("size"), len(points))
        self.assertEqual(text.count("h0"), len(points) + 1)
        self.cadt("voronoi", "p.xy", "-o", "v.svg", "--box", "0,0,20,30", "-q")
        inside = [p for p in points + points[:1] if p[0] <= 20 and p[1] <= 30]
        self.assertEqual(self.path("v.svg").read_text().count("h0"), len(inside))


if __name__ == "__main__":
    unittest.main()
