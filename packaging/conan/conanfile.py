# SPDX-License-Identifier: Apache-2.0
import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get, rmdir

required_conan_version = ">=2.0"


class CadtConan(ConanFile):
    name = "cadt"
    version = "@version@"
    description = "Exact parallel Delaunay triangulation of points of the plane, on threads, OpenCL and NVIDIA's graphics cards"
    license = "Apache-2.0"
    topics = ("delaunay", "triangulation", "computational-geometry", "cuda", "opencl")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    # No option fPIC: the code is always position-independent.
    options = {"shared": [True, False], "opencl": [True, False], "cuda": [True, False]}
    default_options = {"shared": False, "opencl": True, "cuda": False}

    def validate(self):
        check_min_cppstd(self, 20)
        if self.settings.os != "Linux":
            raise ConanInvalidConfiguration("this recipe is tried on Linux alone")
        if self.options.cuda and not self.options.shared:
            raise ConanInvalidConfiguration("with CUDA a static cadt needs the toolkit's libraries, which conan does not know: "
                                            "use -o cadt/*:shared=True")

    def requirements(self):
        if self.options.opencl:  # to build with; the loader is looked for at run time
            self.requires("opencl-clhpp-headers/2023.04.17", visible=False)

    def layout(self):
        cmake_layout(self, src_folder="src")

    def source(self):
        get(self, **self.conan_data["sources"][self.version], strip_root=True)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in ("APPS", "BENCH", "EXAMPLES", "TESTS"):
            toolchain.cache_variables[f"CADT_BUILD_{part}"] = False
        toolchain.cache_variables["CADT_OPENCL"] = bool(self.options.opencl)
        toolchain.cache_variables["CADT_CUDA"] = bool(self.options.cuda)
        if self.options.cuda:
            toolchain.cache_variables["CADT_CUDA_ARCHITECTURES"] = "all"
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        for folder in ("cmake", "pkgconfig"):  # conan makes both from package_info()
            rmdir(self, os.path.join(self.package_folder, "lib", folder))

    def package_info(self):
        self.cpp_info.libs = ["cadt"]
        self.cpp_info.system_libs = ["pthread", "dl", "m"]
        self.cpp_info.set_property("cmake_file_name", "cadt")
        self.cpp_info.set_property("cmake_target_name", "cadt::cadt")
        self.cpp_info.set_property("pkg_config_name", "cadt")
