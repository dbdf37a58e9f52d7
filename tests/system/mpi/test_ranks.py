# SPDX-License-Identifier: Apache-2.0
"""The mesh of several ranks is that of one call, and its directory does not tell how many there were."""
import lzma
import os
import pathlib
import random
import shutil
import struct
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from ranks import RankTest, digest  # noqa: E402

NUMBERS = (1, 2, 3, 4, 5, 7, 8, 16)
KINDS = ("uniform", "gaussian", "grid", "tilted", "hex", "circles", "concentric", "ngon", "kuzmin", "line", "collinear", "spiral",
         "parabola", "clusters", "skewed", "two-clusters", "duplicates", "ring", "contours")


class EqualTest(RankTest):
    def compare(self, inputs, tile, numbers=NUMBERS, more=(), environment=None, single=None):
        """The same directory for each number of ranks, with the hash of the mesh of one call."""
        found = {}
        for ranks in numbers:
            self.tiles(ranks, *inputs, "-o", "mesh.cadt", "--tile-points", tile, "--backend", "host",
                       "--threads", "1", "-q", *more, environment=environment)
            found[ranks] = (digest(self.path("mesh.cadt")), self.mesh_hash())
            shutil.rmtree(self.path("mesh.cadt"))
        self.assertEqual(len(set(found.values())), 1, found)
        [(directory, mesh)] = set(found.values())
        if single is not None:
            self.assertEqual(mesh, single)
        return directory


class NumbersOfRanks(EqualTest):
    def test_any_number_of_ranks(self):
        name = self.generate("uniform", 20000)
        whole = self.compare([name], 1000, single=self.single_hash(name))
        self.cadt("tiles", name, "-o", "one.cadt", "--tile-points", 1000, "--backend", "host")
        self.assertEqual(digest(self.path("one.cadt")), whole, "cadt tiles makes another directory")
        self.cadt("verify", "one.cadt")
        self.cadt("merge", "one.cadt", "-o", "merged.ele")
        self.cadt("triangulate", name, "-o", "single.ele")
        self.assertEqual(self.path("merged.ele").read_bytes(), self.path("single.ele").read_bytes())


class KindsOfPoints(EqualTest):
    def test_all_points_in_one_place_or_none(self):
        self.compare(["--generate", "uniform", "-n", 0], 3, numbers=(1, 4))
        for name, points in {"one": [(1, 2)], "two": [(1, 2), (0, 0)], "equal": [(3, 3)] * 40,
                             "line": [(i, 2 * i) for i in range(60)]}.items():
            with self.subTest(name):
                self.points(f"{name}.f64", points)
                self.compare([f"{name}.f64"], 3, numbers=(1, 4), single=self.single_hash(f"{name}.f64"))

    def test_copies_of_a_point_on_different_ranks(self):
        """The lowest index is the vertex: ids ascend in each leaf whatever rank has read them."""
        numbers = random.Random(1)
        self.points("copies.f64", [(numbers.random(), numbers.random()) for _ in range(500)] * 1000)
        # Four parts of the input: two rounds of the shuffle, and with small messages one rank at a time reads.
        whole = self.compare(["copies.f64"], 30000, numbers=(1, 3), single=self.single_hash("copies.f64"))
        small = {"CADT_MPI_MESSAGE_BYTES": "4096"}
        self.assertEqual(self.compare(["copies.f64"], 30000, numbers=(3,), environment=small), whole)

    def test_cells(self):
        """A set that each rank makes itself, tile by tile."""
        cells = ["--generate", "cells", "-n", "300000"]
        whole = self.compare(cells, 80000, numbers=(3,))
        self.cadt("tiles", *cells, "-o", "one.cadt", "--tile-points", 80000, "--backend", "host")
        self.assertEqual(digest(self.path("one.cadt")), whole)

    def test_lattice(self):
        self.points("lattice.f64", [(x, y) for x in range(40) for y in range(40)])
        self.compare(["lattice.f64"], 50, numbers=(1, 5), single=self.single_hash("lattice.f64"))

    def test_split_files(self):
        """Files one after the other are one input; another order of points is another mesh directory of equal triangles."""
        name = self.generate("uniform", 3000)
        data = self.path(name).read_bytes()
        whole = self.compare([name], 200, numbers=(2,))
        self.path("a.f64").write_bytes(data[:16 * 1234])
        self.path("b.f64").write_bytes(data[16 * 1234:])
        self.assertEqual(self.compare(["a.f64", "b.f64"], 200, numbers=(3,)), whole)
        self.path("swapped.f64").write_bytes(data[16 * 1234:] + data[:16 * 1234])
        self.compare(["b.f64", "a.f64"], 200, numbers=(2,), single=self.single_hash("swapped.f64"))


class Messages(EqualTest):
    def test_messages_in_pieces(self):
        """What is open in a node takes more than 256 bytes."""
        name = self.generate("uniform", 3000)
        whole = self.compare([name], 300, numbers=(1,), single=self.single_hash(name))
        self.assertEqual(self.compare([name], 300, numbers=(2, 5), environment={"CADT_MPI_MESSAGE_BYTES": "256"}), whole)

    def test_scratch(self):
        name = self.generate("uniform", 20000)
        self.path("scratch").mkdir()
        whole = self.compare([name], 1000, numbers=(2,))
        more = ("--scratch", "scratch", "--host-memory", "64K")
        self.assertEqual(self.compare([name], 1000, numbers=(3,), more=more), whole)
        self.assertEqual(list(self.path("scratch").iterdir()), [])

    def test_without_output(self):
        name = self.generate("uniform", 5000)
        out, _ = self.tiles(3, name, "--tile-points", 500, "--backend", "host", "-q")
        self.assertIn(self.single_hash(name), out)
        self.assertNotIn("mesh.cadt", self.names())


class GeneratedThorough(EqualTest):
    def test_every_kind(self):
        for kind in KINDS:
            for tile in (3, 37, 1000, 5000):
                with self.subTest(kind=kind, tile=tile):
                    name = self.generate(kind, 200 if tile == 3 else 6000)
                    self.compare([name], tile, numbers=(1, 3, 7), single=self.single_hash(name))


    def test_a_sample_of_one_place(self):
        """The sample has nothing of the two points elsewhere, so the tree needs the bounds that all ranks have found."""
        count, target = 4_000_000, 1 << 20

        def is_sampled(index):  # as tiles/tree.cpp chooses
            z, mask = index + 0x9E3779B97F4A7C15, (1 << 64) - 1
            z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
            z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
            return (z ^ (z >> 31)) < mask // count * target

        data = bytearray(struct.pack("<dd", 5, 5) * count)
        for start, x in ((count // 2, 4), (count - 1000, 6)):
            index = next(i for i in range(start, count) if not is_sampled(i))
            data[16 * index:16 * index + 8] = struct.pack("<d", x)
        self.path("place.f64").write_bytes(data)
        whole = self.compare(["place.f64"], 1000, numbers=(1, 3), single=self.single_hash("place.f64"))
        self.cadt("tiles", "place.f64", "-o", "one.cadt", "--tile-points", 1000, "--backend", "host")
        self.assertEqual(digest(self.path("one.cadt")), whole)


@unittest.skipUnless("CADT_DATA_DIR" in os.environ, "CADT_DATA_DIR is not set")
class DataThorough(EqualTest):
    SETS = ("geonames_cities.f64", "isprs_csite1_red1.f64", "autzen_trim.f64", "room_scan1.f64", "tsp_mona_lisa100k.xy",
            "gshhs_australia.xy", "stars_mag8.xy", "delaunator_issue44.xy")

    def test_sets(self):
        folder = pathlib.Path(os.environ["CADT_DATA_DIR"])
        for name in self.SETS:
            path = min([*folder.rglob(name), *folder.rglob(f"{name}.xz")])
            self.path(name).write_bytes((lzma.open if path.suffix == ".xz" else open)(path, "rb").read())
            for tile in (300, 5000):
                with self.subTest(name, tile=tile):
                    self.compare([name], tile, numbers=(1, 4), single=self.single_hash(name))


class OnOpenCL(EqualTest):
    def test_host_and_device(self):
        name = self.generate("uniform", 3000)
        whole = self.compare([name], 500, numbers=(2,))
        for ranks in (1, 2):
            self.tiles(ranks, name, "-o", f"{ranks}.cadt", "--tile-points", 500, "--backend", "opencl", "-q")
            self.assertEqual(digest(self.path(f"{ranks}.cadt")), whole)


if __name__ == "__main__":
    unittest.main()
