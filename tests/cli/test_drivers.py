# SPDX-License-Identifier: Apache-2.0
"""The program where drivers are missing or broken: it starts, says what is missing, and the host computes."""
import json
import os
import unittest
from unittest import mock

from harness import CliTest, integer_points, xy_text

NO_DRIVERS = os.environ.get("CADT_NO_DRIVERS", "")


class DriverTest:
    """What all cases have in common. Each sets `environment`, in which OpenCL cannot be used."""

    def setUp(self):
        super().setUp()
        self.write("in.xy", xy_text(integer_points(200)))
        self.hash = self.cadt("triangulate", "in.xy", "--backend", "host").fields()["hash"]
        self.compiled_in = {d["backend"] for d in self.devices() if not d["reason"].startswith("not compiled in")}

    def devices(self):
        return json.loads(self.cadt("devices", "--json").out)["devices"]

    def expect_host_only(self, environment, opencl_says):
        """Everything but OpenCL works, and `opencl_says` is its reason wherever there is one."""
        with mock.patch.dict(os.environ, environment):
            devices = {d["backend"]: d for d in self.devices()}
            self.assertEqual(devices["host"]["usable"], True)
            opencl = devices["opencl"]
            self.assertEqual((opencl["usable"], opencl["index"]), (False, -1))
            if "opencl" in self.compiled_in:
                for text in opencl_says:
                    self.assertIn(text, opencl["reason"])
            self.assertIn(f"\nopencl: {opencl['reason']}\n", self.cadt("devices").out)
            for backend in ("host", "auto"):
                if backend == "auto" and devices["cuda"]["usable"]:
                    continue
                result = self.cadt("triangulate", "in.xy", "--backend", backend, "--verify")
                self.assertEqual((result.err, result.fields()["hash"]), ("", self.hash))
                self.assertIn("host", result.fields()["back end"])
            self.fails(5, "triangulate", "in.xy", "--backend", "opencl", "-o", "m.off",
                       says=["back end 'opencl' is not available", opencl["reason"]])
            self.assertFalse(self.path("m.off").exists())
            return devices

    def with_loader(self, target):
        """An environment in which both names of the loader stand for the file `target`."""
        for name in ("libOpenCL.so.1", "libOpenCL.so"):
            self.path(name).symlink_to(target)
        return {"LD_LIBRARY_PATH": str(self.folder)}


@unittest.skipIf(os.environ.get("CADT_SANITIZE"), "the sanitizers' library has to be the first one")
class WithoutDrivers(DriverTest, CliTest):
    def test_is_a_reason_and_a_typed_error(self):
        devices = self.expect_host_only({"LD_PRELOAD": NO_DRIVERS},
                                        ["the OpenCL loader cannot be loaded: ", "libOpenCL.so.1: ", "install"])
        self.assertEqual((devices["cuda"]["usable"], devices["cuda"]["index"]), (False, -1))
        if "cuda" in self.compiled_in:
            self.assertIn("driver", devices["cuda"]["reason"])
        with mock.patch.dict(os.environ, {"LD_PRELOAD": NO_DRIVERS}):
            self.fails(5, "triangulate", "in.xy", "--backend", "cuda", says=devices["cuda"]["reason"])


class WithoutVendor(DriverTest, CliTest):
    def test_is_a_reason_and_a_typed_error(self):
        if any("loader cannot be loaded" in d["reason"] for d in self.devices()):
            self.skipTest("needs the OpenCL loader")
        self.expect_host_only({"OCL_ICD_VENDORS": "/nonexistent"}, ["no OpenCL platform", "/nonexistent", "install"])


class BrokenLoader(DriverTest, CliTest):
    def test_file_that_is_no_library(self):
        self.write("text", "not a library\n")
        self.expect_host_only(self.with_loader(self.path("text")),
                              ["the OpenCL loader cannot be loaded: ", "libOpenCL.so.1: "])

    def test_library_without_opencl(self):
        self.expect_host_only(self.with_loader(NO_DRIVERS), ["is no OpenCL loader: ", "clGetPlatformIDs"])

    def test_loader_without_most_functions(self):
        self.expect_host_only(self.with_loader(os.environ["CADT_HOLLOW_LOADER"]),
                              ["no OpenCL device", "clGetDeviceIDs: CL_INVALID_OPERATION"])


if __name__ == "__main__":
    unittest.main()
