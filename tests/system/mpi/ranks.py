# SPDX-License-Identifier: Apache-2.0
"""Runs cadt-mpi on several ranks. Standard library only."""
import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from harness import CliTest, PROGRAM, SECONDS, default_signals  # noqa: E402

MPI_PROGRAM = os.environ.get("CADT_MPI_PROGRAM", "cadt-mpi")
MPIRUN = os.environ.get("CADT_MPIRUN", "mpirun")
# Open MPI refuses root, more ranks than cores, and binds each rank to a core.
VERSION = subprocess.run([MPIRUN, "--version"], capture_output=True, text=True, check=False).stdout
OPEN_MPI = "Open MPI" in VERSION or "OpenRTE" in VERSION  # mpirun, mpiexec
ANYWHERE = ["--oversubscribe", "--allow-run-as-root", "--bind-to", "none"] if OPEN_MPI else []


def digest(folder):
    """sha256 of all files of a mesh directory and their names, but for run.json, which has times."""
    sums = hashlib.sha256()
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and name != "run.json":
            data = path.read_bytes()
            sums.update(f"{name} {len(data)}\n".encode() + data)
    return sums.hexdigest()


def ranks_of(launcher):
    """Process of each rank that mpirun has started so far."""
    found, todo = {}, [launcher]
    while todo:
        process = todo.pop()
        with contextlib.suppress(OSError):
            for task in pathlib.Path(f"/proc/{process}/task").iterdir():
                todo += [int(child) for child in (task / "children").read_text().split()]
            for variable in pathlib.Path(f"/proc/{process}/environ").read_bytes().split(b"\0"):
                if variable.startswith((b"OMPI_COMM_WORLD_RANK=", b"PMI_RANK=")):
                    if os.path.basename(os.readlink(f"/proc/{process}/exe")).startswith("cadt"):
                        found[int(variable.split(b"=")[1])] = process
    return found


class Run:
    """A running mpirun, whose lines on standard error are read as they come."""

    def __init__(self, process):
        self.process, self.lines = process, []
        self.changed = threading.Condition()
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        for line in self.process.stderr:
            with self.changed:
                self.lines.append(line.decode())
                self.changed.notify_all()
        with self.changed:
            self.lines.append("")
            self.changed.notify_all()

    def wait_for(self, text):
        with self.changed:
            there = self.changed.wait_for(lambda: any(text in line for line in self.lines) or self.lines[-1:] == [""], SECONDS)
            if not there or not any(text in line for line in self.lines):
                raise AssertionError(f"'{text}' never came:\n{''.join(self.lines)}")

    def rank(self, number):
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            found = ranks_of(self.process.pid)
            if number in found:
                return found[number]
            if self.process.poll() is not None:
                break
            time.sleep(0.01)
        raise AssertionError(f"rank {number} is not there:\n{''.join(self.lines)}")

    def stopped(self):
        """Process of the rank that has stopped (`stop_at`), as soon as one has."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end and self.process.poll() is None:
            for process in ranks_of(self.process.pid).values():
                with contextlib.suppress(OSError):
                    if pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(") ")[-1][0] == "T":
                        return process
            time.sleep(0.01)
        raise AssertionError(f"no rank has stopped:\n{''.join(self.lines)}")

    def end(self):
        self.process.wait(SECONDS)
        self.reader.join(SECONDS)
        return self.process.returncode, "".join(self.lines)


def stop_at(place):
    """Environment of a run whose rank stops where it comes to `place` first (tests/system/cli/signal_at.cpp)."""
    return {"LD_PRELOAD": os.environ["CADT_SIGNAL_AT"], "CADT_TEST_SIGNAL_AT": f"{place} 1 {signal.SIGSTOP.value}"}


def folder_in_memory():
    """Where waiting for the disk takes no time; none if there is little room. Nodes are synced one by one."""
    place = pathlib.Path("/dev/shm")
    with contextlib.suppress(OSError):
        if shutil.disk_usage(place).free > 1 << 30 and os.access(place, os.W_OK):
            return place
    return None


class RankTest(CliTest):
    """Each test has its own folder, in which the ranks run."""

    def setUp(self):
        place = pathlib.Path(tempfile.mkdtemp(prefix="cadt-mpi-", dir=folder_in_memory()))
        self.addCleanup(shutil.rmtree, place, ignore_errors=True)
        self.folder, self.shared_memory = place / "work", place / "shared"
        self.folder.mkdir()
        self.shared_memory.mkdir()

    def command(self, ranks, *arguments):
        return [MPIRUN, *ANYWHERE, "-n", str(ranks), MPI_PROGRAM, "tiles", *map(str, arguments)]

    def environment(self, more):
        # Open MPI leaves the memory that killed ranks have shared: it goes with the folder of the test.
        # When one rank has ended with an error it waits a second for the others, which end as well.
        return {**os.environ, "OMPI_MCA_btl_vader_backing_directory": str(self.shared_memory),
                "OMPI_MCA_odls_base_sigkill_timeout": "0", **more}

    def tiles(self, ranks, *arguments, expect=0, environment=None, command=None):
        """Runs cadt-mpi tiles to its end; `command`: a whole one instead."""
        done = subprocess.run(command or self.command(ranks, *arguments), capture_output=True, cwd=self.folder,
                              stdin=subprocess.DEVNULL, preexec_fn=default_signals, timeout=SECONDS,
                              env=self.environment(environment or {}), check=False)
        out, err = done.stdout.decode(), done.stderr.decode()
        self.assertEqual(done.returncode, expect, f"{ranks} ranks: {arguments}\n{out}{err}")
        return out, err

    def fails(self, code, ranks, *arguments, says=(), **more):
        """Ends with one message, however many ranks there are."""
        out, err = self.tiles(ranks, *arguments, expect=code, **more)
        self.assertEqual(err.count("cadt: error:"), 1, err)
        self.assertNotIn("cadt: interrupted", err)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, err)
        self.assertEqual(out, "")
        return err

    @contextlib.contextmanager
    def running(self, ranks, *arguments, environment=None):
        process = subprocess.Popen(self.command(ranks, *arguments), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   stdin=subprocess.DEVNULL, cwd=self.folder, preexec_fn=default_signals,
                                   env=self.environment(environment or {}))
        run = Run(process)
        try:
            yield run
        finally:
            if process.poll() is None:
                for rank in ranks_of(process.pid).values():
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(rank, signal.SIGKILL)
                process.kill()
            process.wait()
            run.reader.join(SECONDS)
            process.stderr.close()

    def mesh_hash(self, folder="mesh.cadt"):
        return json.loads(self.path(f"{folder}/manifest.json").read_text())["hash"]

    def single_hash(self, *inputs):
        """Of the mesh that one call makes of these points, in the order of the files."""
        return self.cadt("triangulate", *inputs, "--backend", "host").fields()["hash"]

    def points(self, name, points):
        self.path(name).write_bytes(b"".join(struct.pack("<dd", *point) for point in points))
        return name

    def generate(self, kind, count, name=None, seed=1):
        name = name or f"{kind}.f64"
        self.cadt("generate", kind, "-n", count, "--seed", seed, "-o", name)
        return name
