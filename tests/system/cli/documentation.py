# SPDX-License-Identifier: Apache-2.0
"""Commands and outputs of a document: a test runs them, and compares."""
import os
import pathlib
import re
import subprocess

from harness import PROGRAM, SECONDS, CliTest, default_signals


def commands(text):
    """Commands of the blocks ```console, each with the output that is shown."""
    for block in re.findall(r"(?ms)^```console\n(.*?)^```", text):
        yield from re.findall(r"(?m)^\$ (.*)\n((?:(?!\$ ).*\n)*)", block)


class DocumentationTest(CliTest):
    def same_words(self, shown, found):
        """Numbers may differ in their last digits: compilers differ in what they do to divisions."""
        split = lambda text: re.findall(r"-?\d[\d.e+-]*|[^-\d]+|-", text)
        self.assertEqual(len(split(shown)), len(split(found)), found)
        for a, b in zip(split(shown), split(found)):
            if "." in a:
                self.assertAlmostEqual(float(a), float(b), places=9)
            else:
                self.assertEqual(a, b)

    def shell(self, command):
        """What a command of a document prints; `cadt` is the program under test."""
        environment = {**os.environ, "PATH": f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=self.folder, env=environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, preexec_fn=default_signals,
                              timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout

    def run_commands(self, text):
        """Runs the commands of a document, and returns how many they are."""
        count = 0
        for command, shown in commands(text):
            count += 1
            self.same_words(shown, self.shell(command))
        return count
