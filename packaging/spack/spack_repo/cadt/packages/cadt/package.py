# SPDX-License-Identifier: Apache-2.0
from spack.package import *

try:
    from spack_repo.builtin.build_systems.cmake import CMakePackage, generator
    from spack_repo.builtin.build_systems.cuda import CudaPackage
except ImportError:  # before Spack 1.0 they come with spack.package
    pass


class Cadt(CMakePackage, CudaPackage):
    """Exact parallel Delaunay triangulation of points of the plane, on threads, OpenCL devices and NVIDIA's graphics
    cards: the same mesh from every device and run."""

    license("Apache-2.0", checked_by="cadt")

    # scripts/package fills this in.
    version("@version@", sha256="@sha256@", url="@url@")

    variant("shared", default=True, description="Build the shared library, else the static one")
    variant("opencl", default=True, description="Back end for OpenCL devices; the loader is looked for at run time")
    variant("program", default=True, description="The program, and the file formats for programs (cadt::io)")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("opencl-c-headers", type="build", when="+opencl")
    depends_on("opencl-clhpp@2022.05.18:", type="build", when="+opencl")
    with when("+program"):
        depends_on("pkgconfig", type="build")
        depends_on("cli11", type="build")
        depends_on("nlohmann-json", type="build")
        depends_on("xxhash", type="build")
        depends_on("fast-float")
        depends_on("fmt")
        depends_on("cairo@1.16:+pdf+png+svg+ft+fc")  # from 1.18 on the recipe wants fonts with PDF
        depends_on("libpng")
        depends_on("zlib-api")

    conflicts("platform=darwin", msg="this recipe is tried on Linux alone")
    conflicts("platform=windows", msg="this recipe is tried on Linux alone")

    generator("ninja")

    def cmake_args(self):
        args = [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("CADT_OPENCL", "opencl"),
            self.define_from_variant("CADT_CUDA", "cuda"),
            self.define_from_variant("CADT_BUILD_APPS", "program"),
            self.define("CADT_BUILD_BENCH", False),
            self.define("CADT_BUILD_EXAMPLES", False),
            self.define("CADT_BUILD_TESTS", False),
            self.define("CADT_VIEWER", "OFF"),
        ]
        if self.spec.satisfies("+cuda") and not self.spec.satisfies("cuda_arch=none"):
            args.append(self.define("CADT_CUDA_ARCHITECTURES", self.spec.variants["cuda_arch"].value))
        return args
