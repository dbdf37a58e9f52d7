# SPDX-License-Identifier: Apache-2.0
"""scripts/wheel_licenses, with wheels that are made here.

CADT_SOURCE: the source tree."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

SOURCE = Path(os.environ["CADT_SOURCE"])
INFO = "cadt-9.dist-info"


class WheelLicenses(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.wheel = Path(scratch.name) / "cadt-9-py3-none-any.whl"

    def make(self, libraries, packages):
        with zipfile.ZipFile(self.wheel, "w") as archive:
            for name in ("cadt/__init__.py", *libraries):
                archive.writestr(name, name)
            program = zipfile.ZipInfo("cadt/bin/cadt")
            program.external_attr = 0o100755 << 16
            archive.writestr(program, "")
            components = [{"purl": f"pkg:pypi/cadt@9?file_name={self.wheel.name}"}, *({"purl": purl} for purl in packages)]
            archive.writestr(f"{INFO}/sboms/auditwheel.cdx.json", json.dumps({"components": components}))
            archive.writestr(f"{INFO}/RECORD", "cadt/__init__.py,,\n")

    def run_it(self, code):
        done = subprocess.run([sys.executable, SOURCE / "scripts" / "wheel_licenses", self.wheel], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, code, done.stdout)
        with zipfile.ZipFile(self.wheel) as archive:
            return done.stdout, {entry.filename: (entry, archive.read(entry)) for entry in archive.infolist()}

    def test_no_libraries(self):
        self.make([], [])
        self.assertIn("0 texts", self.run_it(0)[0])

    def test_a_package_of_debian(self):
        copyright = Path("/usr/share/doc/libstdc++6/copyright")
        if not copyright.is_file():
            self.skipTest(f"there is no {copyright}")
        self.make(["cadt.libs/libx.so"], ["pkg:deb/debian/libstdc%2B%2B6@12%2B1"])
        for _ in range(2):  # the second time it is there
            found = self.run_it(0)[1]
            name = f"{INFO}/licenses/libstdc++6.txt"
            self.assertEqual(found[name][1], copyright.read_bytes())
            record = found[f"{INFO}/RECORD"][1].decode().splitlines()
            self.assertEqual([line.split(",")[0] for line in record], ["cadt/__init__.py", name])
            self.assertEqual(found["cadt/bin/cadt"][0].external_attr >> 16, 0o100755)

    def test_what_is_missing(self):
        self.make(["cadt.libs/libx.so"], ["pkg:deb/debian/libof-nobody@1"])
        self.assertIn("no licence of the deb package libof-nobody", self.run_it(1)[0])
        self.make(["cadt.libs/libx.so", "cadt.libs/liby.so"], ["pkg:deb/debian/libstdc++6@1"])
        self.assertIn("2 libraries are in the wheel, and auditwheel knows the packages of 1", self.run_it(1)[0])


if __name__ == "__main__":
    unittest.main()
