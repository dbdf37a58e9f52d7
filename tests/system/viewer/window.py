# SPDX-License-Identifier: Apache-2.0
"""A window on a display of its own, and what a user does there. Standard library only."""
import os
import pathlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "docs" / "site" / "tools"))
import pictures

PROGRAM = os.environ.get("CADT_PROGRAM", "cadt")
SECONDS = 240  # for one answer: llvmpipe compiles, and machines are shared
PANEL = 340  # pixels


def missing():
    """Why there can be no window here, or None."""
    for program, package in (("Xvfb", "xvfb"), ("xdotool", "xdotool")):
        if shutil.which(program) is None:
            return f"no {program}: install {package}"
    return None


def blocks(path, side=20):
    """Mean colour of each square of a picture."""
    width, height, channels, image = pictures.pixels(pathlib.Path(path))
    assert channels == 3, channels
    means = []
    for top in range(0, height - side + 1, side):
        for left in range(0, width - side + 1, side):
            cut = b"".join(image[3 * (y * width + left):3 * (y * width + left + side)] for y in range(top, top + side))
            means.append(tuple(sum(cut[k::3]) / (side * side) for k in range(3)))
    return means


def difference(first, second):
    """Mean difference of the squares of two pictures, in levels of 256."""
    a, b = blocks(first), blocks(second)
    assert len(a) == len(b), (len(a), len(b))
    return sum(abs(x - y) for p, q in zip(a, b) for x, y in zip(p, q)) / (3 * len(a))


class WindowTest(unittest.TestCase):
    """Each test has a display and a folder of its own."""

    def setUp(self):
        if why := missing():
            if os.environ.get("CADT_REQUIRE_DISPLAY"):
                self.fail(why)
            self.skipTest(why)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cadt-window-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        reader, writer = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1400x900x24", "-nolisten", "tcp"],
                                       pass_fds=[writer], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop, self.server)
        os.close(writer)
        with os.fdopen(reader) as display:
            self.environment = {**os.environ, "DISPLAY": ":" + display.readline().strip(), "CADT_GL_DEBUG": "1"}
        self.process, self.lines, self.seen = None, queue.Queue(), []

    @staticmethod
    def stop(process):
        if process.poll() is None:
            process.terminate()
        process.wait()

    def environment_of_view(self):
        more = dict(setting.split("=", 1) for setting in os.environ.get("CADT_VIEW_ENVIRONMENT", "").split(";") if setting)
        return {**self.environment, **more}

    def view(self, *arguments):
        """Opens the window and gives it the keyboard."""
        self.process = subprocess.Popen([PROGRAM, "view", "--log", "--backend", "host", *map(str, arguments)], cwd=self.folder,
                                        env=self.environment_of_view(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.process.communicate)
        self.addCleanup(self.stop, self.process)
        threading.Thread(target=self.read, args=[self.process.stdout], daemon=True).start()
        self.wait("window")
        self.focus()

    def read(self, stream):
        for line in stream:
            self.lines.put(line.rstrip("\n"))
        self.lines.put(None)

    def focus(self):
        # Without a window manager nobody else does that.
        self.xdotool("search", "--sync", "--onlyvisible", "--name", "^cadt", "windowfocus", "--sync", "%@")

    def xdotool(self, *arguments):
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 0, f"xdotool {arguments}: {done.stderr}")
        return done.stdout

    def wait(self, beginning):
        """The next line that begins so."""
        end = time.monotonic() + SECONDS
        while True:
            try:
                line = self.lines.get(timeout=max(0.0, end - time.monotonic()))
            except queue.Empty:
                self.fail(f"'{beginning}' was not said in {SECONDS} s; before: {self.seen}")
            if line is None:
                self.fail(f"the window is gone before '{beginning}': {self.process.stderr.read()} {self.seen}")
            self.seen.append(line)
            if line.startswith(beginning):
                return line

    def key(self, *keys):
        for key in keys:
            self.xdotool("key", "--delay", 20, key)

    def click(self, x, y, button=1):
        self.xdotool("mousemove", x, y, "sleep", 0.1, "click", button)

    def drag(self, points, button=1):
        """Press at the first place, along the others, release at the last."""
        x, y = points[0]
        self.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", button)
        for x, y in points[1:]:
            self.xdotool("mousemove", x, y, "sleep", 0.05)
        self.xdotool("mouseup", button)

    def screenshot(self, key="s"):
        self.key(key)
        return self.folder / self.wait("saved ").split()[1]

    def quit(self):
        """Ends the program, which must have met no OpenGL error."""
        self.key("q")
        self.assertEqual(self.process.wait(SECONDS), 0, self.process.stderr.read())
        self.assertEqual(self.process.stderr.read(), "", "errors belong into the window")

    def cadt(self, *arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout
