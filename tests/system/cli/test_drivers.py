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


class OtherCudaDrivers(DriverTest, CliTest):
    """A driver older than the program, and one that lacks functions."""

    def expect_reason(self, version, says):
        self.path("libcuda.so.1").symlink_to(os.environ["CADT_HOLLOW_CUDA_DRIVER"])
        with mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": str(self.folder), "CADT_CUDA_DRIVER": version,
                                          "OCL_ICD_VENDORS": "/nonexistent"}):
            cuda = [d for d in self.devices() if d["backend"] == "cuda"]
            self.assertEqual([(d["usable"], d["index"]) for d in cuda], [(False, -1)])
            self.assertIn(says, cuda[0]["reason"])
            self.assertIn(f"\ncuda: {cuda[0]['reason']}\n", self.cadt("devices").out)
            self.fails(5, "triangulate", "in.xy", "--backend", "cuda", "-o", "m.off", says=cuda[0]["reason"])
            self.assertFalse(self.path("m.off").exists())
            self.assertEqual(self.cadt("triangulate", "in.xy", "--backend", "host").fields()["hash"], self.hash)

    def setUp(self):
        super().setUp()
        if "cuda" not in self.compiled_in:
            self.skipTest("needs the CUDA back end")

    def test_older_than_the_program(self):
        self.expect_reason("10020", "the driver knows CUDA 10.2 and the program needs ")

    def test_without_most_functions(self):
        self.expect_reason("990000", "not supported in the installed CUDA driver")


class FloatDevices(CliTest):
    """A device without double precision: what there is, taken for one."""

    def setUp(self):
        super().setUp()
        patch = mock.patch.dict(os.environ, {"CADT_OPENCL_NO_FP64": "1", "CADT_CACHE_DIR": ""})
        patch.start()
        self.addCleanup(patch.stop)
        devices = json.loads(self.cadt("devices", "--json").out)["devices"]
        self.device = next((d for d in devices if d["backend"] == "opencl" and d["usable"]), None)
        if self.device is None:
            self.skipTest("no usable OpenCL device")

    def test_it_is_listed_and_refuses_doubles_with_a_way_out(self):
        self.assertFalse(self.device["fp64"])
        self.assertRegex(self.cadt("devices").out,
                         rf"\nFloat coordinates only \(--floats\), when they are named:\nopencl {self.device['index']}: ")
        self.write("in.xy", "0 0\n1 0\n0.1 1\n")
        self.fails(5, "triangulate", "in.xy", "--backend", "opencl", says=["no double precision", "--floats"])

    def test_floats_have_the_mesh_of_the_host(self):
        self.scattered("in.f64", 3000)
        files = []
        for backend in ("opencl", "host"):
            files.append(f"{backend}.ply")
            result = self.cadt("triangulate", "in.f64", "--backend", backend, "--floats", "--verify", "-o", files[-1])
            self.assertIn("--floats moved 3000 of 3000 points", result.err)
            files[-1] = self.path(files[-1]).read_bytes()
        self.assertEqual(files[0], files[1])
        self.cadt("triangulate", "in.f64", "--backend", "opencl", "--floats", "-o", "mesh.off", "-q")
        self.cadt("verify", "in.f64", "mesh.off", "--floats", "-q")
        self.write("exact.xy", "0 0\n1 0\n0.5 1\n")
        quiet = self.cadt("triangulate", "exact.xy", "--floats")
        self.assertNotIn("moved", quiet.err)

    def test_beyond_the_largest_float(self):
        self.write("in.xy", "0 0\n1 0\n0.5 1e39\n")
        self.fails(3, "triangulate", "in.xy", "--floats", says=["point 2", "largest float"])


if __name__ == "__main__":
    unittest.main()
