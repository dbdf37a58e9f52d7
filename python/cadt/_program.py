# SPDX-License-Identifier: Apache-2.0
"""Starts the program ``cadt`` that lies in this package: what ``cadt`` and ``python -m cadt`` do."""

from __future__ import annotations

import os
import sys

from cadt import __path__ as folders


def main() -> int:
    """Becomes the program, with the words of the command line; on Windows returns its exit code."""
    windows = os.name == "nt"
    # An editable installation has a folder of Python files and one of what is compiled.
    for folder in folders:
        program = os.path.join(folder, "bin", "cadt.exe" if windows else "cadt")
        if os.path.exists(program):
            break
    else:
        print("cadt: the program is not in this build of the package (CADT_BUILD_APPS is OFF)", file=sys.stderr)
        return 2
    try:
        if not windows:
            # The name that it was called by: the program looks for cadt-terrain beside it.
            os.execv(program, [sys.argv[0], *sys.argv[1:]])
        import subprocess

        # The libraries of a repaired wheel lie beside the package.
        libraries = os.path.join(os.path.dirname(folder), "cadt.libs")
        path = os.pathsep.join((libraries, os.environ.get("PATH", "")))
        return subprocess.run([program, *sys.argv[1:]], env={**os.environ, "PATH": path}, check=False).returncode
    except OSError as error:  # a wheel that was unpacked by something else than pip, without the right to execute
        print(f"cadt: {program} cannot be started: {error.strerror}; install the wheel with pip", file=sys.stderr)
        return 2
