// SPDX-License-Identifier: Apache-2.0
// A back end that is asked for by name is the one that runs, and where its devices are gone nothing runs instead.
#include "tests/support/backends.hpp"
#include "tests/support/device_choice.hpp"
#include "tests/support/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace cadt::test {
namespace {

class Forced : public BackendTest {};

TEST_P(Forced, BackendIsTheOneThatRan) {
  const Points xy = uniform_points(5000);
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  const Statistics& s = mesh.statistics();
  EXPECT_EQ(s.backend, to_string(GetParam().backend));
  EXPECT_GT(s.launches, 0u);
  EXPECT_GT(s.bytes_device_peak, 0u);
  // The device is one of that back end, and the one that the tests were told to use.
  const std::vector<DeviceInfo> devices = list_devices();
  const auto ran = std::ranges::find_if(devices, [&](const DeviceInfo& device) {
    return device.backend == GetParam().backend && device.usable && device.name == s.device && is_chosen(device);
  });
  ASSERT_TRUE(ran != devices.end()) << "'" << s.device << "' is no usable device of " << s.backend;
  if (GetParam().backend == Backend::cuda) {
    EXPECT_TRUE(ran->gpu);
  }
  RecordProperty("device", s.device);
  RecordProperty("launches", std::to_string(s.launches));
}
CADT_ON_EVERY_BACKEND(Forced);

// CUDA and the OpenCL loader read their variables once, so this runs in a process of its own that has not asked yet.
class ForcedBackend : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override { testing::GTEST_FLAG(death_test_style) = "threadsafe"; }

  [[noreturn]] static void triangulate_without_devices() {
    setenv("CUDA_VISIBLE_DEVICES", "", 1);
    setenv("OCL_ICD_VENDORS", "/nonexistent", 1);
    unsetenv("OCL_ICD_FILENAMES");
    const Points xy = uniform_points(100);
    Options options;
    options.backend = GetParam();
    try {
      const Triangulation mesh = triangulate(std::span<const double>(xy), options);
      std::fprintf(stderr, "ran on %s: %s\n", mesh.statistics().backend.c_str(), mesh.statistics().device.c_str());
    } catch (const BackendUnavailable& error) {
      std::fprintf(stderr, "thrown: %s\n", error.what());
      std::exit(error.backend() == to_string(GetParam()) && !error.reason().empty() ? 0 : 2);
    }
    std::exit(1);
  }
};

TEST_P(ForcedBackend, IsNotReplacedWhenItHasNoDevice) {
  const std::string name(to_string(GetParam()));
  EXPECT_EXIT(triangulate_without_devices(), testing::ExitedWithCode(0),
              "thrown: back end '" + name + "' is not available: .");
}
std::string backend_name(const testing::TestParamInfo<Backend>& info) { return std::string(to_string(info.param)); }
INSTANTIATE_TEST_SUITE_P(Devices, ForcedBackend, testing::Values(Backend::opencl, Backend::cuda), backend_name);

}  // namespace
}  // namespace cadt::test
