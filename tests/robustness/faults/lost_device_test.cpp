// SPDX-License-Identifier: Apache-2.0
// A real device that is lost: a kernel writes to an address that is none, which takes the context. In a process of its
// own, which has no device afterwards. CPUs end the process instead, so only GPUs can have this test.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "common/driver/device.hpp"
#include "common/driver/registry.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

namespace cadt::test {
namespace {

class LostDevice : public BackendTest {
 protected:
  void SetUp() override {
    testing::GTEST_FLAG(death_test_style) = "threadsafe";
    BackendTest::SetUp();
  }

  static int failures;
  static void expect(bool good, const char* what) {
    if (good) return;
    ++failures;
    std::fprintf(stderr, "failed: %s\n", what);
  }

  /// Whether it throws a typed error.
  template <class Work>
  static bool refused(const Work& work) {
    try {
      work();
    } catch (const DeviceError& error) {
      std::fprintf(stderr, "thrown: %s\n", error.what());
      return error.code() != 0 && !error.device().empty();
    } catch (const Error& error) {
      std::fprintf(stderr, "thrown: %s\n", error.what());
      return true;
    }
    return false;
  }

  [[noreturn]] static void lose(const Options& options) {
    const Points xy = uniform_points(2000);
    const std::span<const double> points(xy);
    {
      Triangulator triangulator(options);
      const DeviceTriangulation nothing;
      expect(triangulator.triangulate(points).number_of_triangles() > 0, "a call before");
      {
        const auto device = open_device(options);
        const auto buffer = device->allocate(1024);
        const std::unique_ptr<Buffer> null;
        const std::uint32_t count = 1 << 20;
        const std::array<Arg, 3> arguments = {Arg(null), Arg(count), Arg(1U)};
        expect(refused([&] {
                 device->launch(KernelId::cadt_identity, count, arguments, KernelVariant::narrow);
                 device->finish();
               }),
               "the kernel that writes to no address");
        std::uint32_t word = 0;
        expect(refused([&] { device->read(*buffer, 0, &word, sizeof word); }), "a copy");
        expect(refused([&] { device->fill(*buffer, 0, sizeof word, 0); }), "a fill");
        expect(refused([&] { device->finish(); }), "a wait");
        expect(refused([&] { (void)device->allocate(1 << 20); }), "an allocation");
      }
      expect(refused([&] { (void)triangulator.triangulate(points); }), "the triangulator of the same context");
      triangulator.release_memory();
    }
    // The host goes on.
    Options host;
    host.backend = Backend::host;
    expect(triangulate(points, host).number_of_triangles() > 0, "the host");
    std::fprintf(stderr, "all destroyed\n");
    std::exit(failures == 0 ? 0 : 1);
  }
};

int LostDevice::failures = 0;

TEST_P(LostDevice, EachCallIsATypedErrorAndNothingAborts) {
  bool card = false;
  for (const DeviceInfo& info : list_devices())
    card = card || (info.backend == GetParam().backend && info.usable && info.gpu && info.platform == "NVIDIA CUDA");
  if (!card) GTEST_SKIP() << "no card: a kernel of a processor would end the process";
  EXPECT_EXIT(lose(GetParam().options()), testing::ExitedWithCode(0), "all destroyed");
}
CADT_ON(opencl, LostDevice, main_opencl_case);
CADT_ON(cuda, LostDevice, main_cuda_case);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LostDevice);

}  // namespace
}  // namespace cadt::test
