# SPDX-License-Identifier: Apache-2.0
"""All ranks stop together, with one message, and nothing that was finished is lost."""
import contextlib
import os
import pathlib
import resource
import shutil
import signal
import struct
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from ranks import ANYWHERE, MPI_PROGRAM, MPIRUN, RankTest, digest, stop_at  # noqa: E402


class FaultTest(RankTest):
    def setUp(self):
        super().setUp()
        self.name = self.generate("uniform", 20000)
        self.options = ["-o", "mesh.cadt", "--tile-points", 400, "--backend", "host", "--threads", 1]

    undisturbed = {}

    def whole(self):
        """sha256 of the mesh that nothing has disturbed."""
        key = (self.name, self.path(self.name).stat().st_size, *self.options)
        if key not in self.undisturbed:
            self.tiles(1, self.name, *self.options, "-q")
            self.undisturbed[key] = digest(self.path("mesh.cadt"))
            shutil.rmtree(self.path("mesh.cadt"))
        return self.undisturbed[key]

    def resumed(self, ranks=3, more=()):
        self.tiles(ranks, self.name, *self.options, "--resume", "-q", *more)
        return digest(self.path("mesh.cadt"))


class WrongInput(FaultTest):
    def test_smallest_index_of_all_ranks(self):
        """NaN on two ranks: the same message for any number of them."""
        data = bytearray(self.path(self.generate("uniform", 200000, "large.f64")).read_bytes())
        for index in (190000, 70000):
            data[16 * index:16 * index + 8] = struct.pack("<d", float("nan"))
        self.path("nan.f64").write_bytes(data)
        for ranks in (1, 4):
            self.fails(3, ranks, "nan.f64", *self.options, "-q", says=["point 70000", "nan.f64", "NaN"])
        self.assertNotIn("mesh.cadt", self.names())

    def test_command_line(self):
        self.fails(2, 2, self.name, "--tile-point", 5, says=["no option --tile-point; did you mean --tile-points?",
                                                             "cadt-mpi tiles --help"])
        self.fails(2, 2, command=[MPIRUN, *ANYWHERE, "-n", "2", MPI_PROGRAM, "tils"],
                   says="there is no command 'tils'; did you mean tiles?")
        self.fails(2, 2, "-o", "mesh.cadt", says="name files")
        self.fails(2, 3, self.name, "--tile-points", 2, says="at least 3")
        self.fails(2, 1, command=[MPI_PROGRAM, "tiles", self.name, *map(str, self.options)],
                   environment={"SLURM_STEP_NUM_TASKS": "4"}, says=["4 tasks", "srun --mpi=pmix"])
        self.fails(3, 2, "missing.f64", *self.options, says="missing.f64")
        text = " ".join(self.tiles(1, "--help")[0].split())
        self.assertIn("0: the cores that it may use, divided among the ranks there", text)
        for other in ("0 takes all cores", "--strict", "--verify", "Triangle"):
            self.assertNotIn(other, text)

    def test_directory_is_there(self):
        self.tiles(2, self.name, *self.options, "-q")
        before = digest(self.path("mesh.cadt"))
        self.fails(3, 2, self.name, *self.options, "-q", says=["mesh.cadt", "--resume"])
        self.assertEqual(self.resumed(), before)  # which is complete
        self.fails(3, 2, self.name, "-o", "mesh.cadt", "--tile-points", 500, "--resume", "-q",
                   says=["--tile-points 400", "500"])

    def test_points_do_not_fit_into_memory(self):
        self.fails(6, 3, self.name, *self.options, "--host-memory", "1K", "-q", says=["--scratch", "--host-memory"])


class RanksThatDiffer(FaultTest):
    def together(self, first, second):
        tail = ["tiles", self.name, *map(str, self.options), "-q"]
        return [MPIRUN, *ANYWHERE, "-n", "1", *first, *tail, ":", "-n", "1", *second, *tail]

    def test_another_build(self):
        other = self.path("other")
        shutil.copy(MPI_PROGRAM, other)
        with open(other, "ab") as file:
            file.write(b"\0")
        self.fails(2, 2, command=self.together([MPI_PROGRAM], [str(other)]), says=["rank 1", "another build"])
        self.assertNotIn("mesh.cadt", self.names())

    def test_other_arguments(self):
        command = self.together([MPI_PROGRAM], [MPI_PROGRAM]) + ["--resume"]
        self.fails(2, 2, command=command, says=["rank 1", "--resume than rank 0"])

    def in_folders(self, *more):
        """Rank 0 in the folder a, rank 1 in b."""
        tail = [MPI_PROGRAM, "tiles", "points.f64", *map(str, self.options), "-q", *more]
        folders = [["-wdir", str(self.path(name)), "-n", "1"] for name in ("a", "b")]
        return [MPIRUN, *ANYWHERE, *folders[0], *tail, ":", *folders[1], *tail]

    def copies(self):
        """Of the input in both folders."""
        self.name = self.generate("uniform", 300000, "points.f64")
        self.options[3] = 30000
        for name in ("a", "b"):
            self.path(name).mkdir()
            shutil.copy(self.path(self.name), self.path(f"{name}/points.f64"))

    def test_another_mesh_of_the_same_name(self):
        self.copies()
        self.generate("uniform", 3000, "old.f64")
        self.cadt("tiles", "old.f64", "-o", "b/mesh.cadt", "--tile-points", 400, "-q")
        before = digest(self.path("b/mesh.cadt"))
        self.fails(3, 2, command=self.in_folders(), says=["rank 1", "mesh.cadt: this process sees another mesh there"])
        self.assertEqual(digest(self.path("b/mesh.cadt")), before)
        shutil.rmtree(self.path("a/mesh.cadt"))
        shutil.rmtree(self.path("b/mesh.cadt"))
        self.fails(3, 2, command=self.in_folders(), says=["rank 1", "mesh.cadt: this process does not see"])

    def test_input_of_another_size(self):
        self.copies()
        with open(self.path("b/points.f64"), "ab") as file:
            file.write(struct.pack("<dd", 0.5, 0.5))
        self.fails(2, 2, command=self.in_folders(), says=["rank 1", "reads 300001 points, and rank 0 300000"])
        self.assertFalse(self.path("a/mesh.cadt").exists())

    def test_input_with_another_point(self):
        """The last one, which rank 1 looks at and rank 0 distributes."""
        self.copies()
        with open(self.path("b/points.f64"), "r+b") as file:
            file.seek(-16, os.SEEK_END)
            file.write(struct.pack("<d", 0.5))
        self.path("b/mesh.cadt").symlink_to(self.path("a/mesh.cadt"))
        self.fails(3, 2, command=self.in_folders(), says="changed while it was read")
        self.assertEqual([path.name for path in self.path("a/mesh.cadt").glob("node-*")], [])

    def test_own_devices(self):
        """What is a rank's own may differ: here its threads and memory, on clusters its device."""
        tail = ["tiles", self.name, *map(str, self.options[:-2]), "-q"]
        command = [MPIRUN, *ANYWHERE, "-n", "1", MPI_PROGRAM, *tail, "--threads", "2", ":", "-n", "2", MPI_PROGRAM, *tail,
                   "--threads", "1", "--host-memory", "1G"]
        self.tiles(3, command=command)
        found = digest(self.path("mesh.cadt"))
        shutil.rmtree(self.path("mesh.cadt"))
        self.assertEqual(found, self.whole())

    def test_full_disk_on_one_rank(self):
        self.name = self.generate("uniform", 300000, "large.f64")
        self.options[3] = 50000
        before = self.whole()
        with self.running(3, self.name, *self.options, environment=stop_at("mkdir mesh.cadt")) as run:
            stopped = run.stopped()  # MPI has made files of its own by then
            resource.prlimit(run.rank(2), resource.RLIMIT_FSIZE, (4096, 4096))
            os.kill(stopped, signal.SIGCONT)
            code, text = run.end()
        self.assertEqual(code, 3, text)
        self.assertEqual(text.count("cadt: error:"), 1, text)
        self.assertRegex(text, r"mesh\.cadt/node-.*\.npy: cannot be written")
        self.assertIn("rank 2 of 3", text)
        self.assertEqual([path for path in self.path("mesh.cadt").rglob("*.tmp")], [])
        self.assertEqual(self.resumed(), before)


def node_written(number):
    return f"rename unfinished/node-{number:06}"


class KillTest(FaultTest):
    # Whatever the others do when a rank is killed, what was finished is there, and --resume makes the rest.
    def kill(self, rank, marker=None, node=None):
        """Where the progress says `marker`, or where the rank that has written `node` waits."""
        with self.running(3, self.name, *self.options, environment=stop_at(node_written(node)) if node else None) as run:
            if node:
                stopped = run.stopped()
            else:
                run.wait_for(marker)
            os.kill(run.rank(rank), signal.SIGKILL)
            if node:
                with contextlib.suppress(ProcessLookupError):  # mpirun may have ended it by now
                    os.kill(stopped, signal.SIGCONT)
            code, text = run.end()
        self.assertNotEqual(code, 0, text)
        complete = self.path("mesh.cadt/manifest.json")
        self.assertFalse(complete.exists() and '"complete": true' in complete.read_text(), "it was over before")


class Killed(KillTest):
    def finished(self):
        """Files of nodes that are there as a whole, and which file it is."""
        nodes = [path.parent.name for path in self.path("mesh.cadt/unfinished").glob("node-*/node.json")]
        names = [f"mesh.cadt/{node}/triangles.npy" for node in nodes if not node.endswith(".tmp")]
        return {name: self.path(name).stat().st_ino for name in names}

    def test_then_resume(self):
        before = self.whole()
        for node, rank in ((3, 1), (30, 0)):  # of 127
            with self.subTest(node=node):
                self.kill(rank, node=node)
                left = self.finished()
                self.assertGreater(len(left), 0)
                _, text = self.tiles(4, self.name, *self.options, "--resume")
                self.assertRegex(text, r"resumed +[1-9]", "all was made again")
                self.assertEqual(digest(self.path("mesh.cadt")), before)
                kept = {name: self.path(name).stat().st_ino for name in left}
                self.assertEqual(kept, left, "what was finished was made again")
                shutil.rmtree(self.path("mesh.cadt"))

    def test_interrupted(self):
        self.name = self.generate("uniform", 400000, "large.f64")  # so many that work is left when the signal is heard
        before = self.whole()
        with self.running(3, self.name, *self.options, environment=stop_at(node_written(12))) as run:
            stopped = run.stopped()
            os.kill(run.rank(1), signal.SIGTERM)
            os.kill(stopped, signal.SIGCONT)
            code, text = run.end()
        self.assertEqual(code, 130, text)
        self.assertIn("mesh.cadt can be continued with --resume\ncadt: interrupted", text)
        self.assertEqual(self.resumed(), before)


class KilledThorough(KillTest):
    def test_each_phase(self):
        self.name = self.generate("uniform", 2000000, "large.f64")
        self.options[3] = 20000
        before = self.whole()
        for marker in ("sample", "shuffle", "tiles 0 %", "tiles 50 %", "links"):
            for rank in (0, 2):
                with self.subTest(marker=marker, rank=rank):
                    self.kill(rank if marker != "links" else 0, marker=marker)
                    self.assertEqual(self.resumed(), before)
                    shutil.rmtree(self.path("mesh.cadt"))


class Slow(FaultTest):
    def test_a_rank_that_sleeps(self):
        before = self.whole()
        with self.running(3, self.name, *self.options, environment=stop_at(node_written(12))) as run:
            sleeping = run.stopped()
            time.sleep(2)
            self.assertIsNone(run.process.poll())
            os.kill(sleeping, signal.SIGCONT)
            code, text = run.end()
        self.assertEqual(code, 0, text)
        self.assertEqual(digest(self.path("mesh.cadt")), before)


if __name__ == "__main__":
    unittest.main()
