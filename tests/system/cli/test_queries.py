# SPDX-License-Identifier: Apache-2.0
"""locate, interpolate, raster, voronoi: against brute force on small sets."""
import ast
import json
import math
import random
import re
import signal
import struct
import unittest
import zipfile

from harness import SOURCE, CliTest, integer_points, read_off, twice_area, xy_text


def plane(x, y):
    return 2 * x - 3 * y + 5


def xyz_text(points, height=plane):
    return "".join(f"{x} {y} {height(x, y)}\n" for x, y in points)


def read_npy(data):
    """Shape and flat list of an array."""
    assert data[:6] == b"\x93NUMPY", data[:6]
    length = struct.unpack("<H", data[8:10])[0]
    header = ast.literal_eval(data[10:10 + length].decode())
    assert not header["fortran_order"]
    kind = {"<f8": "d", "<i4": "i", "<u4": "I"}[header["descr"]]
    body = data[10 + length:]
    return header["shape"], list(struct.unpack(f"<{len(body) // struct.calcsize(kind)}{kind}", body))


def npy_bytes(descr, shape, kind, numbers):
    header = repr({"descr": descr, "fortran_order": False, "shape": shape}).encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + struct.pack(f"<{len(numbers)}{kind}", *numbers)


def read_npz(path):
    with zipfile.ZipFile(path) as archive:
        return {name[:-4]: read_npy(archive.read(name)) for name in archive.namelist()}


def read_asc(text):
    """Header and rows."""
    lines = text.splitlines()
    header = {key.lower(): float(value) for key, value in (line.split() for line in lines[:6])}
    return header, [[float(word) for word in line.split()] for line in lines[6:]]


def clipped(polygon, p, q):
    """The part of a convex polygon that is nearer to p than to q."""
    a, b = 2 * (q[0] - p[0]), 2 * (q[1] - p[1])
    c = q[0] ** 2 + q[1] ** 2 - p[0] ** 2 - p[1] ** 2
    side = [a * x + b * y - c for x, y in polygon]
    result = []
    for i, (point, s) in enumerate(zip(polygon, side)):
        other, t = polygon[i - 1], side[i - 1]
        if (s <= 0) != (t <= 0):
            f = t / (t - s)
            result.append((other[0] + f * (point[0] - other[0]), other[1] + f * (point[1] - other[1])))
        if s <= 0:
            result.append(point)
    return result


def area(polygon):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, polygon[1:] + polygon[:1])) / 2


def cell(points, p, box):
    """Voronoi cell of p within the box."""
    x0, y0, x1, y1 = box
    polygon = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    for q in points:
        if q != p:
            polygon = clipped(polygon, p, q)
    return polygon


def sibson(points, values, q, box):
    """Natural neighbours: shares of the cell that q would take from each point."""
    own = cell(points, q, box)
    shares = [area(clipped_all(own, p, points)) for p in points]
    return sum(s * v for s, v in zip(shares, values)) / sum(shares)


def clipped_all(polygon, p, points):
    for other in points:
        if other != p and polygon:
            polygon = clipped(polygon, p, other)
    return polygon


class LocateCommand(CliTest):
    def sets(self):
        yield integer_points(60, 30), integer_points(300, 40, seed=9)
        yield [(x, y) for x in range(6) for y in range(6)], [(x, y) for x in range(-1, 8) for y in range(-1, 8)]

    def triangles(self):
        self.cadt("triangulate", "p.xy", "-o", "m.off", "-q")
        return read_off(self.path("m.off").read_text())[1]

    def test_triangles_are_those_of_triangulate_the_lowest_one(self):
        for points, queries in self.sets():
            self.write("p.xy", xy_text(points))
            self.write("q.xy", xy_text(queries))
            triangles = self.triangles()

            def brute(q):
                for i, (a, b, c) in enumerate(tuple(points[v] for v in t) for t in triangles):
                    if min(twice_area(a, b, q), twice_area(b, c, q), twice_area(c, a, q)) >= 0:
                        return i
                return -1

            expected = [brute(q) for q in queries]
            self.assertIn(-1, expected)
            result = self.cadt("locate", "p.xy", "q.xy")
            self.assertEqual([int(line) for line in result.out.splitlines()], expected)
            self.assertEqual(result.err, "")
            summary = self.cadt("locate", "p.xy", "q.xy", "-o", "t.npy")
            self.assertEqual(summary.out, "")
            inside = len(queries) - expected.count(-1)
            self.assertRegex(summary.err, rf"(?m)^inside      {inside} of {len(queries)}$")
            self.assertEqual(read_npy(self.path("t.npy").read_bytes()), ((len(queries),), expected))

    def test_barycentric(self):
        points, queries = next(self.sets())
        self.write("p.xy", xy_text(points))
        self.write("q.xy", xy_text(queries))
        triangles = self.triangles()
        self.cadt("locate", "p.xy", "q.xy", "--barycentric", "-o", "b.csv", "-q")
        lines = self.path("b.csv").read_text().splitlines()
        self.assertEqual(lines[0], "triangle,barycentric0,barycentric1,barycentric2")
        self.assertEqual(len(lines), len(queries) + 1)
        for q, line in zip(queries, lines[1:]):
            t, *weights = line.split(",")
            if t == "-1":
                self.assertEqual(weights, ["nan"] * 3)
                continue
            weights = [float(w) for w in weights]
            self.assertGreaterEqual(min(weights), 0)
            for axis in (0, 1):
                back = sum(w * points[v][axis] for w, v in zip(weights, triangles[int(t)]))
                self.assertAlmostEqual(back, q[axis], places=9)
        self.cadt("locate", "p.xy", "q.xy", "--barycentric", "-o", "b.npz", "-q")
        arrays = read_npz(self.path("b.npz"))
        self.assertEqual(arrays["triangle"][0], (len(queries),))
        self.assertEqual(arrays["barycentric"][0], (len(queries), 3))
        self.assertEqual(arrays["triangle"][1], [int(line.split(",")[0]) for line in lines[1:]])

    def test_nearest(self):
        for points, queries in self.sets():
            points = list(dict.fromkeys(points))
            self.write("p.xy", xy_text(points))
            self.write("q.xy", xy_text(queries))
            distance = lambda q, v: (points[v][0] - q[0]) ** 2 + (points[v][1] - q[1]) ** 2
            brute = [min(range(len(points)), key=lambda v: distance(q, v)) for q in queries]
            out = self.cadt("locate", "p.xy", "q.xy", "--nearest").out
            self.assertEqual([int(line) for line in out.splitlines()], brute)
            self.cadt("locate", "p.xy", "q.xy", "--nearest", "-k", "4", "-o", "n.csv", "-q")
            header, *rows = self.path("n.csv").read_text().splitlines()
            self.assertEqual(header, "point0,point1,point2,point3")
            for q, first, row in zip(queries, brute, rows):
                row = [int(v) for v in row.split(",")]
                self.assertEqual(row[0], first)
                self.assertEqual(len(set(row)), 4)
                self.assertEqual([distance(q, v) for v in row], sorted(distance(q, v) for v in range(len(points)))[:4])
        self.write("few.xy", xy_text([(0, 0), (1, 0), (0, 1)]))
        self.assertEqual(self.cadt("locate", "few.xy", "-", "--nearest", "-k", "5", stdin="2 0.5\n").out, "1 0 2 -1 -1\n")

    def test_queries_from_a_pipe_and_by_columns(self):
        self.write("p.xy", xy_text([(0, 0), (4, 0), (0, 4), (4, 4)]))
        self.assertEqual(self.cadt("locate", "p.xy", "-", stdin="9 9\n").out, "-1\n")
        self.assertEqual(self.cadt("locate", "p.xy", "-", stdin="x,y\n9,9\n", ).out, "-1\n")
        self.write("q.csv", "name,north,east\na,4,0\nb,9,9\n")
        out = self.cadt("locate", "p.xy", "q.csv", "--query-columns", "east,north", "--nearest").out
        self.assertEqual(out.split(), ["2", "3"])
        self.assertEqual(self.cadt("locate", "-", "-f", "xy", "q.csv", "--query-columns", "2,3", "--nearest",
                                   stdin=xy_text([(0, 0), (4, 0), (0, 4)])).out.split(), ["1", "1"])

    def test_without_triangles(self):
        self.write("p.xy", xy_text([(0, 0), (1, 1), (2, 2)]))
        result = self.cadt("locate", "p.xy", "-", stdin="1 1\n")
        self.assertEqual(result.out, "-1\n")
        self.assertRegex(result.err, r"^cadt: warning: p.xy: no triangles")
        self.assertEqual(self.cadt("locate", "p.xy", "-", "-q", stdin="1 1\n").err, "")


class InterpolateCommand(CliTest):
    def test_a_plane_is_reproduced(self):
        points = integer_points(200, 100)
        self.write("p.xyz", xyz_text(points))
        source = random.Random(5)
        queries = [(source.uniform(25, 75), source.uniform(25, 75)) for _ in range(200)]
        self.write("q.xy", xy_text(queries))
        for method in ("linear", "natural"):
            out = self.cadt("interpolate", "p.xyz", "q.xy", "--method", method).out.split()
            self.assertEqual(len(out), len(queries))
            for q, value in zip(queries, out):
                self.assertAlmostEqual(float(value), plane(*q), places=9)
        nearest = self.cadt("interpolate", "p.xyz", "q.xy", "--method", "nearest").out.split()
        for q, value in zip(queries, nearest):
            self.assertEqual(float(value), plane(*min(points, key=lambda p: math.dist(p, q))))

    def test_natural_neighbours_are_sibsons(self):
        points = list(dict.fromkeys(integer_points(40, 100)))
        values = [math.sin(x / 20) + (y / 30) ** 2 for x, y in points]
        self.write("p.xyz", "".join(f"{x} {y} {v!r}\n" for (x, y), v in zip(points, values)))
        source = random.Random(6)
        queries = [(source.uniform(35, 65), source.uniform(35, 65)) for _ in range(30)]
        self.write("q.xy", xy_text(queries))
        out = self.cadt("interpolate", "p.xyz", "q.xy", "--method", "natural").out.split()
        for q, value in zip(queries, out):
            self.assertAlmostEqual(float(value), sibson(points, values, q, (-900, -900, 1000, 1000)), places=9)

    def test_values_from_files(self):
        points = [(0, 0), (10, 0), (0, 10), (10, 10)]
        self.write("p.xy", xy_text(points))
        self.write("v.txt", "0\n10\n20\n30\n")
        self.write("v.csv", "a,b\n0,1\n10,1\n20,1\n30,1\n")
        self.path("f.npy").write_bytes(npy_bytes("<f8", (4,), "d", [0, 10, 20, 30]))
        self.path("h.npy").write_bytes(npy_bytes("<i2", (4, 2), "h", [0, 1, 10, 1, 20, 1, 30, 1]))
        for values, expected in [("v.txt", "13"), ("v.csv", "13 1"), ("f.npy", "13"), ("h.npy", "13 1")]:
            out = self.cadt("interpolate", "p.xy", "-", "--values", values, stdin="3 5\n").out
            self.assertEqual(out, expected + "\n", values)
        self.cadt("interpolate", "p.xy", "-", "--values", "v.csv", "-o", "o.csv", stdin="3 5\n")
        self.assertEqual(self.path("o.csv").read_text(), "value0,value1\n13,1\n")
        self.cadt("interpolate", "p.xy", "-", "--values", "v.csv", "-o", "o.npy", stdin="3 5\n")
        self.assertEqual(read_npy(self.path("o.npy").read_bytes()), ((1, 2), [13.0, 1.0]))
        self.write("t.csv", "lon,lat,depth,name\n0,0,1,a\n1,0,2,b\n0,1,3,c\n")
        out = self.cadt("interpolate", "t.csv", "-", "--columns", "lon,lat,depth", stdin="0.5 0.5\n").out
        self.assertEqual(out, "2.5\n")

    def test_of_equal_points_the_first_value_counts(self):
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n1 0 70\n0 0 80\n")
        for method in ("linear", "natural", "nearest"):
            self.assertEqual(self.cadt("interpolate", "p.xyz", "-", "--method", method, stdin="1 0\n0 0\n").out, "2\n1\n")

    def test_outside(self):
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n")
        self.assertEqual(self.cadt("interpolate", "p.xyz", "-", stdin="5 0.1\n").out, "nan\n")
        for method in ("linear", "natural", "nearest"):
            self.assertEqual(self.cadt("interpolate", "p.xyz", "-", "--method", method, "--outside", "nearest",
                                       stdin="5 0.1\n").out, "2\n")
        summary = self.cadt("interpolate", "p.xyz", "-", "-o", "o.xyz", stdin="5 0.1\n0 0.5\n")
        self.assertRegex(summary.err, r"(?m)^without     1 ")
        self.assertEqual(self.path("o.xyz").read_text(), "5 0.1 nan\n0 0.5 2\n")


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


class QueryErrors(CliTest):
    """Each says what to do, has its exit code, and leaves nothing."""

    def setUp(self):
        super().setUp()
        self.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n")
        self.write("p.xy", "0 0\n1 0\n0 1\n")
        self.write("q.xy", "0.2 0.2\n")
        self.before = self.names()

    def tearDown(self):
        self.assertEqual(self.names(), self.before)
        super().tearDown()

    def test_outputs(self):
        self.fails(2, "locate", "p.xy", "q.xy", "-o", "a.off", says=["unknown suffix '.off'", "csv, txt, npy, npz"])
        self.fails(2, "voronoi", "p.xy", "-o", "a.csv", says="npz, geojson, svg")
        self.fails(2, "raster", "p.xyz", "--res", "1", "-o", "a.tif", says="asc, npy, png")
        self.fails(2, "raster", "p.xyz", "--res", "1", says="--output")
        self.fails(2, "raster", "p.xyz", "--res", "1", "-o", "-", says="-t asc")
        self.fails(2, "voronoi", "p.xy", says="--output")
        self.fails(2, "locate", "p.xy", "q.xy", "-o", "q.xy", "-t", "txt", says="this is the input")
        self.fails(2, "interpolate", "p.xy", "q.xy", "--values", "p.xyz", "-o", "p.xyz", says="this is the input")
        self.fails(3, "locate", "p.xy", "q.xy", "-o", "none/a.csv", says="there is no folder")
        self.fails(2, "locate", "p.xy", "q.xy", "--barycentric", "-o", "a.npy", says="write an .npz or a .csv")

    def test_options(self):
        self.fails(2, "locate", "p.xy", says="QUERIES")
        self.fails(2, "locate", "-", "-", "-f", "xy", says="only one of POINTS and QUERIES")
        self.fails(2, "locate", "p.xy", "q.xy", "-k", "3", says="--nearest")
        self.fails(2, "locate", "p.xy", "q.xy", "--nearest", "-k", "0", says="-k")
        self.write("many.xy", "0.2 0.2\n" * 3000)
        self.before = sorted(self.before + ["many.xy"])
        self.fails(2, "locate", "p.xy", "many.xy", "--nearest", "-k", "1000000", says="3000000000 results")
        self.fails(2, "locate", "p.xy", "q.xy", "--nearest", "--barycentric", says="leave one of them out")
        self.fails(2, "interpolate", "p.xyz", "q.xy", "--method", "cubic", says="--method")
        self.fails(2, "interpolate", "p.xyz", "q.xy", "--values", "-", says="not standard input")
        self.fails(2, "raster", "p.xyz", "-o", "a.asc", says="--res")
        for wrong in ("0", "-1", "nan", "inf"):
            self.fails(2, "raster", "p.xyz", f"--res={wrong}", "-o", "a.asc", says="--res")
        self.fails(2, "raster", "p.xyz", "--res", "1", "--nodata", "0", "-o", "a.npy", says="--nodata belongs to .asc")
        self.fails(2, "raster", "p.xyz", "--res", "1", "--max-edge=-1", "-o", "a.npy", says="--max-edge")
        for wrong in ("1,2,3", "0,0,1,x", "0,0,1,1,", "0,0,1,inf", "0;0;1;1", "nan,0,1,1"):
            self.fails(2, "raster", "p.xyz", "--res", "1", "--bounds", wrong, "-o", "a.asc", says="four numbers")
            self.fails(2, "voronoi", "p.xyz", "--box", wrong, "-o", "a.svg", says="four numbers")
        self.fails(2, "voronoi", "p.xy", "--box", "1,0,0,1", "-o", "a.svg", says="x0 < x1")
        self.fails(5, "locate", "p.xy", "q.xy", "--backend", "host", "--device", "none", says="none")
        self.fails(6, "locate", "p.xy", "q.xy", "--max-memory", "10", says="--max-memory")

    def test_grids(self):
        self.write("line.xyz", "0 0 1\n0 1 2\n0 2 3\n")
        self.before.append("line.xyz")
        self.before.sort()
        self.fails(2, "raster", "line.xyz", "--res", "1", "-o", "a.asc", says=["no cells", "--bounds"])
        self.fails(2, "raster", "p.xyz", "--res", "1e-6", "-o", "a.asc", says=["1000000 x 1000000 cells", "larger --res"])
        self.fails(2, "raster", "p.xyz", "--res", "1e-320", "-o", "a.asc", says="larger --res")
        self.fails(2, "voronoi", "p.xyz", "--box=-1.7e308,-1.7e308,1.7e308,1.7e308", "-o", "a.geojson",
                   says="--box: the box is so large")
        self.fails(3, "raster", "p.xyz", "--res", "1e-5", "--bounds", "0,0,1,1e-5", "-o", "a.png", says="too many for a picture")

    def test_values(self):
        self.fails(3, "interpolate", "p.xy", "q.xy", says=["p.xy: no values", "--values FILE"])
        self.fails(3, "raster", "p.xy", "--res", "1", "-o", "a.asc", says="no values")
        files = {"two.txt": ("1\n2\n", "two.txt: 2 rows of values for the 3 points of p.xy"),
                 "word.txt": ("1\nx\n3\n", "word.txt:2: column 1"),
                 "nan.txt": ("1\nnan\n3\n", "nan.txt:2: column 1"),
                 "ragged.csv": ("1,2\n1\n1,2\n", "ragged.csv:2: the line has 1 fields"),
                 "head.csv": ("a,b\n", "only a header"),
                 "none.txt": ("", "none.txt: is empty")}
        for name, (text, says) in files.items():
            self.write(name, text)
            self.fails(3, "interpolate", "p.xy", "q.xy", "--values", name, says=says)
        arrays = {"nan.npy": (npy_bytes("<f8", (3,), "d", [1, math.nan, 3]), "nan.npy: byte "),
                  "bool.npy": (npy_bytes("|b1", (3,), "B", [1, 0, 1]), "float32, float64 or integers"),
                  "cube.npy": (npy_bytes("<f8", (3, 1, 1), "d", [1, 2, 3]), "(n,) or (n, m)")}
        for name, (data, says) in arrays.items():
            self.path(name).write_bytes(data)
            self.fails(3, "interpolate", "p.xy", "q.xy", "--values", name, says=says)
        self.write("pair.csv", "1,2\n3,4\n5,6\n")
        self.fails(3, "raster", "p.xy", "--values", "pair.csv", "--res", "1", "-o", "a.asc", says="2 values a point")
        self.fails(2, "interpolate", "p.xy", "q.xy", "--values", "pair.csv", "-o", "a.xyz", says="room for one")
        self.fails(3, "interpolate", "p.xy", "q.xy", "--values", "absent.txt", says="absent.txt")
        self.before = sorted(self.before + list(files) + list(arrays) + ["pair.csv"])

    def test_queries(self):
        self.write("bad.xy", "0 0\n1 nan\n")
        self.before = sorted(self.before + ["bad.xy"])
        self.fails(3, "locate", "p.xy", "bad.xy", says="bad.xy:2: ")
        self.fails(3, "locate", "p.xy", "absent.xy", says="absent.xy")

    def test_coordinates_that_natural_neighbours_do_not_take(self):
        self.write("w.xyz", "0 0 1\n1e300 0 2\n0 1e-300 3\n")
        self.before = sorted(self.before + ["w.xyz"])
        self.fails(3, "interpolate", "w.xyz", "q.xy", "--method", "natural", says="w.xyz: natural neighbours need")
        self.fails(3, "raster", "w.xyz", "--res", "1e299", "--bounds", "0,0,1e300,1e300", "--method", "natural",
                   "-o", "a.asc", says="w.xyz: natural neighbours need")

    def test_a_failure_while_writing_keeps_the_old_file(self):
        self.write("a.asc", "old")
        self.before = sorted(self.before + ["a.asc"])
        self.fails(3, "raster", "p.xyz", "--res", "0.25", "--method", "nearest", "--nodata", "3", "-o", "a.asc",
                   says=["a.asc: a cell has the value 3", "--nodata"])
        self.assertEqual(self.path("a.asc").read_text(), "old")


class QueryProgress(CliTest):
    def test_line_on_a_terminal_none_in_a_pipe(self):
        self.scattered("p.f64", 1000000)
        self.write("q.xy", "1.5 1.5\n")
        arguments = ["p.f64", "q.xy", "-o", "t.txt", "--backend", "host", "--threads", "1"]
        with self.on_terminal("locate", *arguments) as (process, terminal):
            text = terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 0)
        self.assertRegex(text, r"\r[a-z]+ +\d+ %  [\d.]+[Mk]? points/s")
        self.assertRegex(text, r"\r +\rpoints      1000000\r\n")
        self.assertNotIn("\r", self.cadt("locate", *arguments).err)
        self.assertEqual(self.cadt("locate", *arguments, "-q").err, "")


class QueryInterruption(CliTest):
    def test_leaves_nothing(self):
        self.scattered("p.f64", 1000000)
        self.path("v.npy").write_bytes(npy_bytes("<f8", (1000000,), "d", [1.0] * 1000000))
        with self.on_terminal("raster", "p.f64", "--values", "v.npy", "--method", "natural", "--res", "0.0002", "-o",
                              "d.npy", "--backend", "host") as (process, terminal):
            terminal.wait_for("filling the cells")
            process.send_signal(signal.SIGINT)
            terminal.wait_for()
            self.assertEqual(process.wait(timeout=60), 130, terminal.text)
        self.assertEqual(self.names(), ["p.f64", "v.npy"])


class QueryDocumentation(CliTest):
    """docs/queries.md shows what is."""

    def setUp(self):
        super().setUp()
        self.text = (SOURCE / "docs" / "queries.md").read_text()

    def same_words(self, shown, found):
        """Numbers may differ in their last digits: compilers differ in what they do to divisions."""
        split = lambda text: re.findall(r"-?\d[\d.e+-]*|[^-\d]+|-", text)
        self.assertEqual(len(split(shown)), len(split(found)), found)
        for a, b in zip(split(shown), split(found)):
            if "." in a:
                self.assertAlmostEqual(float(a), float(b), places=9)
            else:
                self.assertEqual(a, b)

    def test_commands_have_the_output_that_is_shown(self):
        commands = 0
        for block in re.findall(r"```console\n(.*?)```", self.text, re.S):
            for command, shown in re.findall(r"(?m)^\$ (.*)\n((?:(?!\$ ).*\n)*)", block):
                commands += 1
                if command.startswith("printf"):
                    text, name = re.fullmatch(r"printf '(.*)' > (\S+)", command).groups()
                    self.write(name, text.replace("\\n", "\n"))
                else:
                    self.same_words(shown, self.cadt(*command.split()[1:]).out)
        self.assertEqual(commands, 9)

    def test_programs_are_the_examples(self):
        shown = re.findall(r"```cpp\n(.*?)```", self.text, re.S)
        files = [(SOURCE / "examples" / name).read_text() for name in ("queries.cpp", "device_queries.cpp")]
        self.assertEqual(shown, [text[text.index("#include"):] for text in files])


if __name__ == "__main__":
    unittest.main()
