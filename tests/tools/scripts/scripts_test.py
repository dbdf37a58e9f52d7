# SPDX-License-Identifier: Apache-2.0
"""What scripts/test, setup, python_env and others say and do when something goes wrong, with stand-ins for the programs that they
call.

CADT_SOURCE: the source tree."""
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

SOURCE = Path(os.environ["CADT_SOURCE"])
SLEEPS = "echo $$ > {file}\nexec sleep 60"


class Scripts(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.tree = Path(scratch.name).resolve() / "tree"
        shutil.copytree(SOURCE / "scripts", self.tree / "scripts")
        (self.tree / "build").mkdir()

    def write(self, name, text):
        file = self.tree / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)

    def start(self, *command, folder="."):
        environment = {**os.environ, "PATH": f"{self.tree}/bin:{os.environ['PATH']}"}
        return subprocess.Popen(command, cwd=self.tree / folder, env=environment, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)

    def run_it(self, *command, folder="."):
        process = self.start(*command, folder=folder)
        said = process.communicate(timeout=60)[0]
        return process.returncode, said

    # ---- scripts/test

    def prepare_test(self, cmake="exit 0", ctest="echo '100% tests passed, 0 tests failed out of 1'"):
        self.write("scripts/setup", "exit 0")
        self.write("scripts/python_env", "exit 0")
        self.write("bin/cmake", cmake)
        self.write("bin/ctest", ctest)

    def test_passed_and_failed(self):
        self.prepare_test()
        code, said = self.run_it("scripts/test")
        self.assertEqual(code, 0, said)
        self.assertIn("scripts/test: all passed", said)
        for what in ({"ctest": "exit 8"}, {"cmake": "exit 1"}):
            self.prepare_test(**what)
            code, said = self.run_it("scripts/test")
            self.assertEqual(code, 1, said)
            self.assertIn("scripts/test: FAILED (release)", said)
            self.assertNotIn("all passed", said)

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            files = [self.tree / f"pid-{number}-{what}" for what in ("cmake", "pip")]
            self.prepare_test(SLEEPS.format(file=files[0]))
            self.write("bin/pip", SLEEPS.format(file=files[1]))
            self.write("scripts/python_env", "if [ $# -gt 0 ]; then pip; fi")
            process = self.start("scripts/test")
            deadline = time.monotonic() + 30
            while not all(file.exists() and sleeps(file.read_text()) for file in files):
                self.assertLess(time.monotonic(), deadline, f"{files} are not there")
                time.sleep(0.02)
            os.killpg(process.pid, number)
            said = process.communicate(timeout=30)[0]  # which ends when no process has the pipe
            self.assertEqual(process.returncode, -number, said)
            self.assertIn("scripts/test: interrupted (release)", said)
            self.assertNotIn("all passed", said)
            deadline = time.monotonic() + 10
            while is_alive(int(files[1].read_text())):
                self.assertLess(time.monotonic(), deadline, "pip still runs")
                time.sleep(0.02)

    # ---- scripts/setup

    def prepare_setup(self, states, update="exit 0"):
        # What dpkg-query does: the format once for each architecture, no line of its own.
        self.write("bin/dpkg-query", f"""format=${{2#-f=}}
for state in {states}; do printf "$(printf %s "$format" | sed "s/[$]{{db:Status-Status}}/$state/")"; done""")
        self.write("bin/apt-get", f"[ $1 = update ] || exec echo apt-get: $1\n{update}")
        self.write("bin/sudo", 'exec "$@"')

    def test_a_package_of_two_architectures(self):
        for states in ("installed", "installed installed", "not-installed installed"):
            self.prepare_setup(states)
            code, said = self.run_it("scripts/setup", "--check")
            self.assertEqual(code, 0, said)
        for states in ("not-installed", "config-files half-installed"):
            self.prepare_setup(states)
            self.assertEqual(self.run_it("scripts/setup", "--check")[0], 1, states)

    def test_lists_of_another_repository(self):
        self.prepare_setup("not-installed", update="exit 100")
        code, said = self.run_it("scripts/setup")
        self.assertEqual(code, 0, said)
        self.assertIn("apt-get update failed", said)
        self.assertIn("apt-get: install", said)

    # ---- scripts/python_env

    def test_an_environment_without_pip(self):
        (self.tree / "python" / "requirements").mkdir(parents=True)
        (self.tree / "python" / "requirements" / "test.txt").touch()
        self.write("bin/python3", """for folder; do :; done
echo "$@" >> made
mkdir -p $folder/bin
printf '#!/bin/sh\\n' > $folder/bin/python
chmod +x $folder/bin/python""")
        self.write("build/venv/bin/python", "exit 1")
        for _ in range(2):  # the second time it is there
            code, said = self.run_it("scripts/python_env")
            self.assertEqual(code, 0, said)
        self.assertEqual((self.tree / "made").read_text(), "-m venv --clear build/venv\n")

    # ---- usage

    def test_usage_from_any_folder(self):
        for name in ("build_wheel", "check_portability", "fuzz", "package", "quickstart", "setup", "site", "test"):
            for folder, script in ((".", f"scripts/{name}"), ("scripts", f"./{name}")):
                code, said = self.run_it(script, "--nothing", folder=folder)
                self.assertEqual(code, 2, f"{script}: {said}")
                self.assertIn(f"usage: scripts/{name}", said)
        self.assertIn("usage: scripts/evaluate", self.run_it("./evaluate", "--help", folder="scripts")[1])

    def test_points_of_the_quick_start(self):
        self.prepare_test(cmake="echo cmake: $*; exit 9")
        for points in ("0", "abc", "-3", "-h", "--help"):
            self.assertEqual(self.run_it("scripts/quickstart", points)[0], 2, points)
        for points in ([], ["1000"], ["2M"], ["1e6"]):
            code, said = self.run_it("scripts/quickstart", *points)
            self.assertEqual(code, 9, said)


def sleeps(process):  # and is no shell any more, which may put a signal off until its program has ended
    try:
        return Path(f"/proc/{process.strip()}/comm").read_text() == "sleep\n"
    except OSError:
        return False


def is_alive(process):
    try:
        state = Path(f"/proc/{process}/stat").read_text().rsplit(") ")[-1][0]
    except OSError:
        return False
    return state != "Z"  # one that has ended, and that nobody has waited for


if __name__ == "__main__":
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)  # nohup and background jobs ignore some, and so would all that starts here
    unittest.main()
