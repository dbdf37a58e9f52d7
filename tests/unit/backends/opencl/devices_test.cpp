// SPDX-License-Identifier: Apache-2.0
// What the back end says about the machine, with and without drivers.
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

using OpenClDevices = OpenClTest;

TEST_F(OpenClDevices, AreNumberedAndDescribed) {
  const std::vector<DeviceInfo> devices = opencl_backend().devices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, static_cast<int>(i));
    EXPECT_EQ(devices[i].backend, Backend::opencl);
    EXPECT_EQ(devices[i].usable, devices[i].reason.empty()) << devices[i].reason;
  }
  EXPECT_FALSE(info.platform.empty());
  EXPECT_FALSE(info.name.empty());
  EXPECT_FALSE(info.driver.empty());
  EXPECT_FALSE(info.atomics.empty());
  EXPECT_TRUE(info.fp64);
  EXPECT_GT(info.compute_units, 0u);
  EXPECT_GT(info.largest_buffer_bytes, 0u);
  EXPECT_GE(info.memory_bytes, info.largest_buffer_bytes);
}

TEST_F(OpenClDevices, PoclIsACpuWithAcquireRelease) {
  if (info.platform != "Portable Computing Language") GTEST_SKIP() << "the first device is not PoCL's: " << info.name;
  EXPECT_FALSE(info.gpu);
  EXPECT_EQ(info.atomics, "CL3.0 acquire/release, device scope");
}

TEST_F(OpenClDevices, NumberOutOfRangeIsRefused) {
  for (const int number : {-1, 1000}) {
    const auto error = caught<BackendUnavailable>([&] { static_cast<void>(opencl_backend().open(number, Options{})); });
    EXPECT_NE(error.reason().find("there is no device " + std::to_string(number)), std::string::npos) << error.what();
    EXPECT_EQ(error.backend(), "opencl");
  }
}

// The loader reads its variables once, so each of these runs in a process of its own that has not asked it yet.
class OpenClWithoutDriver : public testing::Test {
 protected:
  void SetUp() override { testing::GTEST_FLAG(death_test_style) = "threadsafe"; }

  static constexpr int loader_ignores_variable = 77;

  [[noreturn]] static void report() {
    setenv("OCL_ICD_VENDORS", "/nonexistent", 1);
    const std::vector<DeviceInfo> devices = opencl_backend().devices();
    if (devices.size() != 1 || devices[0].index != -1 || devices[0].usable) {
      std::exit(devices[0].index >= 0 ? loader_ignores_variable : 1);
    }
    std::fprintf(stderr, "listed: %s\n", devices[0].reason.c_str());
    try {
      static_cast<void>(opencl_backend().open(0, Options{}));
    } catch (const BackendUnavailable& error) {
      std::fprintf(stderr, "thrown: %s\n", error.what());
      std::exit(error.reason() == devices[0].reason ? 0 : 2);
    }
    std::exit(3);
  }
};

TEST_F(OpenClWithoutDriver, IsAReasonAndATypedError) {
  int code = -1;
  const auto ended = [&](int status) {
    code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return code == 0 || code == loader_ignores_variable;
  };
  EXPECT_EXIT(report(), ended,
              "^$|listed: no OpenCL platform .*OCL_ICD_VENDORS=/nonexistent.*install.*\n"
              "thrown: back end 'opencl' is not available: no OpenCL platform");
  if (code == loader_ignores_variable) GTEST_SKIP() << "the loader does not follow OCL_ICD_VENDORS";
}

}  // namespace
}  // namespace cadt::test
