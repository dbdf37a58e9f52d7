# SPDX-License-Identifier: Apache-2.0
"""Runs the program and looks at meshes. Standard library only."""
import contextlib
import hashlib
import os
import pathlib
import pty
import random
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ.get("CADT_PROGRAM", "cadt")
SOURCE = pathlib.Path(os.environ.get("CADT_SOURCE", pathlib.Path(__file__).parents[3]))
SECONDS = 120


def default_signals():
    """A shell in the background ignores SIGINT, and children inherit that."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


class Result:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    def fields(self):
        """The summary as a dictionary."""
        return {line[:12].strip(): line[12:].strip() for line in self.out.splitlines()}


def as_ordinary_user():
    """For `before`."""
    default_signals()
    if os.geteuid() == 0:  # root may do everything
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)


class CliTest(unittest.TestCase):
    """Each test has its own folder, in which the program runs."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cadt-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return self.folder / name

    def write(self, name, text):
        self.path(name).write_text(text)
        return name

    def names(self):
        return sorted(entry.name for entry in self.folder.iterdir())

    def cadt(self, *arguments, stdin="", expect=0, stdout=subprocess.PIPE, before=default_signals, program=PROGRAM,
             environment=None):
        """Runs the program to its end and checks the exit code."""
        done = subprocess.run([program, *map(str, arguments)], input=stdin.encode(), stdout=stdout,
                              stderr=subprocess.PIPE, cwd=self.folder, preexec_fn=before, timeout=SECONDS, env=environment)
        result = Result(done.returncode, (done.stdout or b"").decode(), done.stderr.decode())
        self.assertEqual(result.code, expect, f"cadt {' '.join(map(str, arguments))}\n{result.out}{result.err}")
        return result

    def fails(self, code, *arguments, says=(), **more):
        """Runs the program, which has to fail in the form that all errors have."""
        result = self.cadt(*arguments, expect=code, **more)
        self.assertRegex(result.err, r"(?m)^cadt: error: \S")
        self.assertEqual(result.out, "", "an error belongs on standard error")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, result.err)
        return result

    @contextlib.contextmanager
    def started(self, *arguments, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL):
        """The running program; killed at the end of the block if it is still there."""
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=stdin, stdout=subprocess.PIPE,
                                   stderr=stderr, cwd=self.folder, preexec_fn=default_signals)
        try:
            yield process
        finally:
            if process.poll() is None:
                process.kill()
            process.communicate()

    @contextlib.contextmanager
    def on_terminal(self, *arguments):
        """The running program with a terminal as standard error, and the terminal."""
        master, slave = pty.openpty()
        try:
            with self.started(*arguments, stderr=slave) as process:
                os.close(slave)
                slave = None
                yield process, Terminal(master)
        finally:
            if slave is not None:
                os.close(slave)
            os.close(master)

    def scattered(self, name, count, seed=1):
        """Random points as .f64, quickly."""
        data = bytearray(random.Random(seed).randbytes(16 * count))  # little-endian; from 1 to 2 by the exponent 0x3FF
        data[7::8] = b"\x3f" * (2 * count)
        data[6::8] = data[6::8].translate(bytes(0xF0 | low & 0x0F for low in range(256)))
        with open(self.path(name), "wb") as file:
            file.write(data)
        return name


def digest(directory):
    """sha256 of all that is the mesh: names and contents, without run.json."""
    total = hashlib.sha256()
    for path in sorted(p for p in directory.rglob("*") if p.is_file() and p.name != "run.json"):
        total.update(str(path.relative_to(directory)).encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


class Terminal:
    def __init__(self, descriptor):
        self.descriptor, self.text = descriptor, ""

    def wait_for(self, *words):
        """Reads until one of the words has appeared; without words until the program has closed it."""
        end = time.monotonic() + SECONDS
        while not any(word in self.text for word in words):
            if time.monotonic() > end:
                raise TimeoutError(f"{words} not in {self.text!r}")
            if not select.select([self.descriptor], [], [], 1)[0]:
                continue
            try:
                data = os.read(self.descriptor, 65536)
            except OSError:  # the other end is closed
                data = b""
            if not data:
                if words:
                    raise AssertionError(f"{words} never came: {self.text!r}")
                break
            self.text += data.decode(errors="replace")
        return self.text


def read_off(text):
    """Vertices (x, y, z as text) and triangles of an OFF file."""
    words = text.split()
    assert words[0] == "OFF", words[:1]
    points, faces = int(words[1]), int(words[2])
    at = 4
    vertices = [tuple(words[at + 3 * i:at + 3 * i + 3]) for i in range(points)]
    at += 3 * points
    triangles = []
    for i in range(faces):
        assert words[at + 4 * i] == "3"
        triangles.append(tuple(int(word) for word in words[at + 4 * i + 1:at + 4 * i + 4]))
    return vertices, triangles


def off_text(points, triangles):
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
    lines += [f"{x} {y} 0" for x, y in points]
    lines += ["3 {} {} {}".format(*triangle) for triangle in triangles]
    return "\n".join(lines) + "\n"


def xy_text(points):
    return "".join(" ".join(map(str, point)) + "\n" for point in points)


def twice_area(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def in_circle(a, b, c, d):
    """Positive when d is inside the circle of the counterclockwise triangle; exact for integers."""
    rows = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    aa, bb, cc = (x * x + y * y for x, y in rows)
    return ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx)


def hull_area(points):
    """Twice the area of the convex hull."""
    points = sorted(set(points))
    def half(order):
        chain = []
        for p in order:
            while len(chain) > 1 and twice_area(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        return chain[:-1]
    loop = half(points) + half(points[::-1])
    return sum(twice_area(loop[0], loop[i], loop[i + 1]) for i in range(1, len(loop) - 1))


def why_not_delaunay(points, triangles):
    """None if these are the triangles of a Delaunay triangulation of the integer points, else what is wrong."""
    area = 0
    for triangle in triangles:
        a, b, c = (points[i] for i in triangle)
        part = twice_area(a, b, c)
        if part <= 0:
            return f"{triangle} is not counterclockwise"
        area += part
        for p in points:
            if in_circle(a, b, c, p) > 0:
                return f"{p} is in the circle of {triangle}"
    if area != hull_area(points):
        return f"the triangles cover {area}, the hull {hull_area(points)}"
    used = {points[i] for triangle in triangles for i in triangle}
    return None if used == set(points) else f"without {set(points) - used}"


def integer_points(count, size=1000, seed=3):
    source = random.Random(seed)
    return [(source.randrange(size), source.randrange(size)) for _ in range(count)]
