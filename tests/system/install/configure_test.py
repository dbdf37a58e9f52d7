# SPDX-License-Identifier: Apache-2.0
"""What a configuration says and writes, without a build of it.

CADT_SOURCE: the source tree."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["CADT_SOURCE"])
EMBEDDING = """cmake_minimum_required(VERSION 3.25)
project(embedding LANGUAGES NONE)
list(APPEND CMAKE_MODULE_PATH "{source}/cmake")
include(EmbedKernels)
cadt_embed_program(output "${{CMAKE_CURRENT_SOURCE_DIR}}/one.cl" "${{CMAKE_CURRENT_SOURCE_DIR}}" one)
add_custom_target(embed ALL DEPENDS "${{output}}")
"""


class ConfigureTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = Path(self.scratch.name)

    def cmake(self, *arguments, code=0):
        done = subprocess.run(["cmake", *map(str, arguments)], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, code, done.stdout[-3000:])
        return " ".join(done.stdout.split())

    def configure(self, *options, code=0):
        """What it says, in one line. Of the program there is nothing unless it is asked for."""
        parts = [f"-DCADT_BUILD_{part}=OFF" for part in ("APPS", "TESTS", "BENCH", "EXAMPLES")]
        return self.cmake("-S", SOURCE, "-B", self.folder, "-G", "Ninja", "-DCADT_CUDA=OFF", *parts, *options, code=code)


class Options(ConfigureTest):
    def test_values_of_on_off_and_auto(self):
        for value in ("no", "0", "False"):
            self.assertIn("opencl: out (CADT_OPENCL is OFF)", self.configure(f"-DCADT_OPENCL={value}"))
        self.assertIn("opencl: ", self.configure("-DCADT_OPENCL=auto"))
        self.assertIn("CADT_OPENCL is 'perhaps'; it can be AUTO, ON or OFF", self.configure("-DCADT_OPENCL=perhaps", code=1))
        self.assertIn("the viewer is left out: CADT_VIEWER is OFF",
                      self.configure("-DCADT_BUILD_APPS=ON", "-DCADT_OPENCL=OFF", "-DCADT_VIEWER=no"))

    def test_parts_of_programs_without_programs(self):
        self.assertIn("CADT_VIEWER is ON, but CADT_BUILD_APPS is OFF", self.configure("-DCADT_VIEWER=1", code=1))
        self.assertIn("CADT_MPI is ON, but CADT_BUILD_APPS is OFF", self.configure("-DCADT_VIEWER=OFF", "-DCADT_MPI=ON", code=1))

    def test_what_the_program_needs(self):
        for package in ("fmt", "nlohmann_json", "PkgConfig", "CLI11"):
            said = self.configure("-DCADT_BUILD_APPS=ON", "-DCADT_VIEWER=OFF", *(
                f"-DCMAKE_DISABLE_FIND_PACKAGE_{other}={other == package}" for other in ("fmt", "nlohmann_json", "PkgConfig", "CLI11")),
                code=1)
            self.assertRegex(said, rf"the program cadt needs what is not here: {package}\b.*libcli11-dev.*-DCADT_BUILD_APPS=OFF")


class Installation(ConfigureTest):
    def file_for_pkg_config(self, configuration, *options):
        self.configure("-DCADT_OPENCL=OFF", f"-DCMAKE_BUILD_TYPE={configuration}", "-DCMAKE_DEBUG_POSTFIX=_debug", *options)
        text = (self.folder / "pkgconfig" / configuration / "cadt.pc").read_text()
        include, = re.findall(r"^includedir=\$\{pcfiledir\}/(.*)$", text, re.MULTILINE)
        return include, re.findall(r"-l(cadt\w*)", text)

    def test_file_for_pkg_config(self):
        prefix = "-DCMAKE_INSTALL_PREFIX=/opt/cadt"
        for libraries, headers, include in (("lib", "include", "../../include"), ("lib/x", "/opt/h", "../../../../h"),
                                            ("/opt/l/lib", "include", "../../../cadt/include"), ("/opt/l/lib", "/opt/h", "../../../h")):
            found = self.file_for_pkg_config("Release", prefix, f"-DCMAKE_INSTALL_LIBDIR={libraries}",
                                             f"-DCMAKE_INSTALL_INCLUDEDIR={headers}")
            self.assertEqual(found, (include, ["cadt"]), (libraries, headers))
        self.assertEqual(self.file_for_pkg_config("Debug")[1], ["cadt_debug"])


class Embedding(ConfigureTest):
    def test_a_path_with_a_comma_and_a_space(self):
        source = self.folder / "one, two"
        source.mkdir()
        (source / "one.cl").write_text("kernel void one() {}\n")
        (source / "CMakeLists.txt").write_text(EMBEDDING.format(source=SOURCE))
        self.cmake("-S", source, "-B", source / "build", "-G", "Ninja")
        self.cmake("--build", source / "build")
        self.assertIn("kernel void one() {}", (source / "build" / "one.cpp").read_text())


if __name__ == "__main__":
    unittest.main()
