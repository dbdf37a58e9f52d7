# SPDX-License-Identifier: Apache-2.0
"""What can be said of the recipes in packaging/ without their tools, and of scripts/package: they parse, they give options
that cadt has, and version, place and hash of the tarball are filled in everywhere. scripts/check_packages builds them.

CADT_SOURCE: the source tree."""
import ast
import hashlib
import importlib.util
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import types
import unittest
import unittest.mock
from pathlib import Path

SOURCE = Path(os.environ["CADT_SOURCE"])
RECIPES = {name: SOURCE / "packaging" / name for name in ("vcpkg", "conan", "spack")}
SPACK_PACKAGE = Path("spack_repo", "cadt", "packages", "cadt", "package.py")
URL = "https://example.org/of-a-test/cadt.tar.gz"


def files(folder):
    return [path for path in sorted(folder.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]


def load_spack(path):
    """The class of the package, with what it said to Spack, in a stand-in for Spack's modules."""
    said = []

    class When:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            return False

    def say(name):
        def directive(*arguments, **named):
            said.append((name, arguments, named))
            return When()
        return directive

    names = {"spack.package": ("version", "variant", "depends_on", "conflicts", "license", "when"),
             "spack_repo.builtin.build_systems.cmake": ("generator",), "spack_repo.builtin.build_systems.cuda": ()}
    modules = {name: types.ModuleType(name) for name in names}
    for name, module in modules.items():
        for directive in names[name]:
            setattr(module, directive, say(directive))
    modules["spack_repo.builtin.build_systems.cmake"].CMakePackage = type("CMakePackage", (), {})
    modules["spack_repo.builtin.build_systems.cuda"].CudaPackage = type("CudaPackage", (), {})
    with unittest.mock.patch.dict(sys.modules, modules):
        specification = importlib.util.spec_from_file_location("package", path)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
    return module.Cadt, said


class Recipes(unittest.TestCase):
    def test_nothing_is_fixed(self):
        version = re.search(r'CADT_VERSION "(.*)"', (SOURCE / "include" / "cadt" / "version.hpp").read_text())[1]
        for folder in RECIPES.values():
            text = {path: path.read_text() for path in files(folder)}
            for path, content in text.items():
                self.assertNotIn(version, content, path)
                self.assertIsNone(re.search(r"[0-9a-f]{64}|file://|/(home|root|tmp|usr|opt)/", content), path)
            everything = "".join(text.values())
            for place in ("@version@", "@url@"):
                self.assertIn(place, everything, folder)
            self.assertRegex(everything, "@sha(256|512)@", folder)

    def test_files_parse(self):
        port = json.loads((RECIPES["vcpkg"] / "cadt" / "vcpkg.json").read_text())
        self.assertEqual((port["name"], port["version-semver"], port["license"]), ("cadt", "@version@", "Apache-2.0"))
        self.assertEqual(set(port["features"]), {"cuda", "opencl"})
        self.assertLessEqual(set(port["default-features"]), set(port["features"]))
        scripts = [path for folder in RECIPES.values() for path in files(folder) if path.suffix == ".py"]
        self.assertEqual(len(scripts), 3)
        for path in scripts:
            ast.parse(path.read_text(), path)

    def test_options_are_those_of_cadt(self):
        known = set(re.findall(r"^(?:option|set)\((\w+)", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE))
        self.assertIn("CADT_OPENCL", known)
        for name, folder in RECIPES.items():
            named = set(re.findall(r"CADT_[A-Z_]*[A-Z]\b", "".join(path.read_text() for path in files(folder)))) - {"CADT_VERSION"}
            if name == "conan":
                named |= {f"CADT_BUILD_{part}" for part in ("APPS", "BENCH", "EXAMPLES", "TESTS")}
            self.assertLessEqual({"CADT_OPENCL", "CADT_CUDA", "CADT_BUILD_TESTS"}, named, name)
            self.assertLessEqual(named - {"CADT_BUILD"}, known, name)

    def test_spack_package(self):
        package, said = load_spack(RECIPES["spack"] / SPACK_PACKAGE)
        self.assertIn(("version", ("@version@",), {"sha256": "@sha256@", "url": "@url@"}), said)
        cairo, = [arguments[0] for name, arguments, _ in said if name == "depends_on" and arguments[0].startswith("cairo")]
        self.assertLessEqual({"pdf", "png", "svg"}, set(cairo.split("+")))  # Spack's has them off
        variants = [arguments[0] for name, arguments, _ in said if name == "variant"]
        cuda = types.SimpleNamespace(value="80,90")
        given = package()
        given.define = lambda name, value: f"-D{name}={value}"
        given.define_from_variant = lambda name, variant: f"-D{name}={variant in (*variants, 'cuda')}"
        given.spec = types.SimpleNamespace(satisfies=lambda what: what == "+cuda", variants={"cuda_arch": cuda})
        arguments = given.cmake_args()
        self.assertIn("-DCADT_CUDA_ARCHITECTURES=80,90", arguments)
        for option in ("BUILD_SHARED_LIBS", "CADT_OPENCL", "CADT_CUDA", "CADT_BUILD_APPS"):
            self.assertIn(f"-D{option}=True", arguments)


class Package(unittest.TestCase):
    def test_tarball_and_recipes_of_a_clone(self):
        if not (SOURCE / ".git").exists():
            self.skipTest("these sources are no clone")
        with tempfile.TemporaryDirectory() as scratch:
            clone = Path(scratch) / "clone"
            subprocess.run(["git", "clone", "-q", "--shared", SOURCE, clone], check=True)
            subprocess.run([clone / "scripts" / "package", "--source", "--url", URL], check=True, stdout=subprocess.PIPE)
            made = clone / "build" / "package"
            tarball, = made.glob("*.tar.gz")
            version = re.fullmatch(r"cadt-(\d+\.\d+\.\d+)\.tar\.gz", tarball.name)[1]
            with tarfile.open(tarball) as archive:
                header = archive.extractfile(f"cadt-{version}/include/cadt/version.hpp").read().decode()
                self.assertNotIn(f"cadt-{version}/.git", archive.getnames())
            self.assertIn(f'CADT_VERSION "{version}"', header)
            for name, algorithm in {"vcpkg": "sha512", "conan": "sha256", "spack": "sha256"}.items():
                text = "".join(path.read_text() for path in files(made / name))
                self.assertNotRegex(text, r"@\w+@", name)
                for filled_in in (version, URL, hashlib.new(algorithm, tarball.read_bytes()).hexdigest()):
                    self.assertIn(filled_in, text, name)
            self.assertEqual(json.loads((made / "vcpkg" / "cadt" / "vcpkg.json").read_text())["version-semver"], version)


if __name__ == "__main__":
    unittest.main()
