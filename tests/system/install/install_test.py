# SPDX-License-Identifier: Apache-2.0
"""What somebody else's project can do with an installed cadt, or with its sources.

CADT_SOURCE: the source tree; CADT_BUILD: a finished build of it."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import check_exports

SOURCE = Path(os.environ["CADT_SOURCE"])
BUILD = Path(os.environ["CADT_BUILD"])
CONSUMER = SOURCE / "tests" / "system" / "install" / "consumer"
C_TESTS = SOURCE / "tests" / "system" / "c"


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-3000:]}")
    return done.stdout


def installed(build, prefix):
    run("cmake", "--install", build, "--prefix", prefix)
    return prefix


def library_folder(prefix):
    return next(prefix.glob("lib*/**/cadt.pc")).parent.parent


class InstallTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = Path(self.scratch.name)

    def consume_with_cmake(self, *options, files):
        build = self.folder / "consumer"
        run("cmake", "-S", CONSUMER, "-B", build, "-G", "Ninja", *options)
        run("cmake", "--build", build)
        programs = {path.name: path for path in build.glob("**/*") if path.name in ("consumer", "uses-user", "files") and
                    path.is_file()}
        self.assertIn("two triangles", run(programs["consumer"]))
        run(programs["uses-user"])
        self.assertEqual("files" in programs, files)
        if files:
            run(programs["files"], self.folder / "mesh.ply")
            self.assertTrue((self.folder / "mesh.ply").stat().st_size > 1000)

    def consume_with_pkg_config(self, prefix, *more):
        environment = {**os.environ, "PKG_CONFIG_PATH": str(library_folder(prefix) / "pkgconfig")}
        flags = run("pkg-config", "--cflags", "--libs", *more, "cadt", env=environment).split()
        program = self.folder / "by-hand"
        run("g++", "-std=c++20", CONSUMER / "main.cpp", "-o", program, *flags)
        environment["LD_LIBRARY_PATH"] = str(library_folder(prefix))
        self.assertIn("two triangles", run(program, env=environment))
        return run("pkg-config", "--modversion", "cadt", env=environment).strip()


class Installed(InstallTest):
    def test_find_package_and_pkg_config(self):
        prefix = installed(BUILD, self.folder / "prefix")
        self.consume_with_cmake(f"-DCMAKE_PREFIX_PATH={prefix}", files=True)
        version = self.consume_with_pkg_config(prefix, "--static")
        header = (prefix / "include" / "cadt" / "version.hpp").read_text()
        self.assertIn(f'CADT_VERSION "{version}"', header)
        self.assertIn(version, run(prefix / "bin" / "cadt", "--version"))
        self.assertEqual([], [path for path in prefix.glob("include/**/*") if path.is_file() and path.suffix not in (".hpp", ".h")])

    def test_functions_of_c_are_those_that_are_exported(self):
        """check_exports.py compares the list with the library."""
        prefix, declared = installed(BUILD, self.folder / "prefix"), set()
        for header in prefix.glob("include/**/*.h"):
            text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.DOTALL)
            declared |= set(re.findall(r"\b(cadt_\w+)\(", text))
        self.assertEqual(sorted(declared), check_exports.listed(check_exports.C_SYMBOLS.read_text()))

    def test_a_prefix_that_was_moved(self):
        prefix = installed(BUILD, self.folder / "prefix").rename(self.folder / "elsewhere")
        self.consume_with_cmake(f"-DCMAKE_PREFIX_PATH={prefix}", files=True)
        self.consume_with_pkg_config(prefix, "--static")

    def ask_for(self, prefix, asked, *options, languages="CXX"):
        """What a project sees after a find_package() of cadt, and what CMake says where that ends it."""
        project = self.folder / "asks"
        project.mkdir(exist_ok=True)
        (project / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.25)\nproject(asks LANGUAGES {languages})\nset(CAIRO_FOUND mine)\n"
            f"find_package(cadt {asked})\n"
            'if(TARGET cadt::io)\n  set(io io)\nendif()\n'
            'message(STATUS "found ${cadt_FOUND} ${cadt_io_FOUND} ${io} ${CAIRO_FOUND}.${cadt_NOT_FOUND_MESSAGE}")\n')
        done = subprocess.run(["cmake", "-S", project, "-B", project / "build", "-G", "Ninja", "--fresh", f"-DCMAKE_PREFIX_PATH={prefix}",
                               *options], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return " ".join(done.stdout.split())

    def test_components_that_are_missing(self):
        prefix = installed(BUILD, self.folder / "prefix")
        self.assertIn("found 1 TRUE io mine.", self.ask_for(prefix, "REQUIRED COMPONENTS io"))
        missing = ("-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON")
        for quiet in ("", "QUIET "):
            self.assertIn("found 1 FALSE mine.", self.ask_for(prefix, f"{quiet}REQUIRED OPTIONAL_COMPONENTS io", *missing))
            self.assertIn("found 0 FALSE mine.", self.ask_for(prefix, f"{quiet}COMPONENTS io", *missing))
        self.assertIn("cadt::io needs: fmt PkgConfig cairo", self.ask_for(prefix, "REQUIRED COMPONENTS io", *missing))
        self.assertIn("cadt has no component files, only io", self.ask_for(prefix, "REQUIRED COMPONENTS files"))
        # Of what is found nothing is said.
        self.assertRegex(self.ask_for(prefix, "REQUIRED COMPONENTS io OPTIONAL_COMPONENTS files"), r"found 1 TRUE io mine\. --")
        next(prefix.glob("lib*/**/cadtIoTargets.cmake")).unlink()
        self.assertIn("cadt::io needs: the file formats, which this cadt was built without",
                      self.ask_for(prefix, "REQUIRED COMPONENTS io"))
        self.assertIn("found 1 FALSE mine.", self.ask_for(prefix, "REQUIRED OPTIONAL_COMPONENTS io"))

    def test_a_project_of_c_alone(self):
        prefix = installed(BUILD, self.folder / "prefix")
        self.assertIn("found 1 mine.", self.ask_for(prefix, "REQUIRED", languages="C CXX"))
        self.assertIn("found 0 mine.", self.ask_for(prefix, "", languages="C"))
        self.assertIn("needs the C++ linker: project(... LANGUAGES C CXX)", self.ask_for(prefix, "REQUIRED", languages="C"))


class Sources(InstallTest):
    def test_fetch_content(self):
        self.consume_with_cmake(f"-DCADT_SOURCE={SOURCE}", files=False)
        cache = (self.folder / "consumer" / "CMakeCache.txt").read_text()
        for variable in ("CMAKE_CUDA_ARCHITECTURES", "CMAKE_CUDA_COMPILER", "BUILD_TESTING"):
            self.assertIsNone(re.search(rf"^{variable}:", cache, re.MULTILINE), variable)
        self.assertIsNotNone(re.search(r"^CMAKE_BUILD_TYPE:STRING=$", cache, re.MULTILINE))
        targets = run("cmake", "--build", self.folder / "consumer", "--target", "help")
        for target in ("cadt_app", "cadt_io", "example", "test_"):
            self.assertNotIn(target, targets)


class SharedLibrary(InstallTest):
    def test_install_and_symbols(self):
        build, prefix = self.folder / "build", self.folder / "prefix"
        run("cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", "-DBUILD_SHARED_LIBS=ON", "-DCADT_CUDA=OFF",
            "-DCADT_BUILD_EXAMPLES=OFF")
        run("cmake", "--build", build)
        installed(build, prefix)
        libraries = library_folder(prefix)
        dynamic = run("readelf", "-d", libraries / "libcadt.so")
        self.assertIn("soname: [libcadt.so.0]", dynamic)
        self.assertEqual({"libcadt.so", "libcadt.so.0"} - {path.name for path in libraries.glob("libcadt.so*")}, set())
        run(sys.executable, SOURCE / "tests" / "system" / "install" / "check_exports.py", "nm", libraries / "libcadt.so")
        self.consume_with_cmake(f"-DCMAKE_PREFIX_PATH={prefix}", files=True)
        self.assertIn("cadt 0.", run(prefix / "bin" / "cadt", "--version"))  # finds its library
        self.consume_with_pkg_config(prefix)
        self.consume_from_c(prefix)
        self.consume_from_python(libraries)
        self.consume_from_rust(libraries)

    def consume_from_c(self, prefix):
        """The program of docs/c.md, without a compiler of C++."""
        source, program = self.folder / "mesh.c", self.folder / "mesh"
        source.write_text(re.search(r"```c\n(.*?)```", (SOURCE / "docs" / "c.md").read_text(), re.DOTALL).group(1))
        environment = {**os.environ, "PKG_CONFIG_PATH": str(library_folder(prefix) / "pkgconfig"),
                       "LD_LIBRARY_PATH": str(library_folder(prefix))}
        flags = run("pkg-config", "--cflags", "--libs", "cadt", env=environment).split()
        run("cc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", source, "-o", program, *flags)
        self.assertEqual(run(program, env=environment), "0 1 4\n0 4 3\n1 2 4\n2 3 4\n")

    def consume_from_python(self, libraries):
        self.assertIn("ctypes: ok", run(sys.executable, C_TESTS / "smoke.py", libraries / "libcadt.so.0"))

    def consume_from_rust(self, libraries):
        with self.subTest("Rust"):
            if shutil.which("rustc") is None:
                self.skipTest("there is no rustc")
            program = self.folder / "smoke"
            run("rustc", "--edition", "2021", "-D", "warnings", C_TESTS / "smoke.rs", "-L", libraries, "-o", program)
            self.assertIn("rust: ok", run(program, env={**os.environ, "LD_LIBRARY_PATH": str(libraries)}))


if __name__ == "__main__":
    unittest.main()
