// SPDX-License-Identifier: Apache-2.0
// What a device without double precision says of itself, takes and refuses, through every way into the library.
#include "backends/opencl/open.hpp"
#include "tests/support/device_choice.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/system/floats/floats.hpp"
#include "tests/system/resident/device_memory.hpp"

#include <algorithm>
#include <limits>

namespace cadt::opencl {
/// tests/unit/predicates/signs_only.cl: the predicates and the self-test.
[[nodiscard]] std::string signs_source();
}  // namespace cadt::opencl

namespace cadt::test {
namespace {

class FloatInterface : public FloatTest {
 protected:
  void SetUp() override {
    FloatTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    for (const DeviceInfo& device : list_devices())
      if (device.backend == Backend::opencl && device.usable && is_chosen(device)) {
        info = device;
        return;
      }
  }
  template <class Work>
  void expect_refused(const Work& work) const {
    try {
      work();
      FAIL() << "doubles were taken";
    } catch (const BackendUnavailable& error) {
      EXPECT_EQ(error.backend(), "opencl");
      for (const char* word : {"no double precision", "float", "another device"})
        EXPECT_NE(error.reason().find(word), std::string::npos) << error.what();
      EXPECT_NE(error.reason().find(info.name), std::string::npos) << error.what();
    }
  }
  DeviceInfo info;
};

TEST_F(FloatInterface, DeviceIsUsableAndSaysThatItHasNoDoubles) {
  EXPECT_TRUE(info.usable) << info.reason;
  EXPECT_EQ(info.reason, "");
  EXPECT_FALSE(info.fp64);
}

TEST_F(FloatInterface, IsNeverChosenByItself) {
  Options options;
  const Triangulator triangulator(options);
  EXPECT_TRUE(triangulator.device().fp64);
  EXPECT_NE(triangulator.device().backend, Backend::opencl);
}

TEST_F(FloatInterface, DoublesAreRefused) {
  const Points xy = grid_points(3, 3), x(9, 0.5), y(9, 0.25);
  using Doubles = std::span<const double>;
  const std::vector<std::size_t> offsets = {0, 4, 9};
  expect_refused([&] { static_cast<void>(triangulate(Doubles(xy), float_options())); });
  expect_refused([&] { static_cast<void>(triangulate(PointsView(Doubles(x), Doubles(y)), float_options())); });
  expect_refused([&] { static_cast<void>(triangulate_batch(Doubles(xy), offsets, float_options())); });
  Triangulator triangulator(float_options());
  expect_refused([&] { static_cast<void>(triangulator.triangulate(Doubles(xy))); });
  // and then floats are taken
  EXPECT_EQ(triangulator.triangulate(FloatSpan(floats_of(xy))).number_of_triangles(), 8u);
}

TEST_F(FloatInterface, ArraysOfEachAxis) {
  const Points xy = uniform_points(2000, 2);
  Floats x, y;
  for (std::size_t i = 0; i < xy.size(); i += 2)
    x.push_back(static_cast<float>(xy[i])), y.push_back(static_cast<float>(xy[i + 1]));
  const Triangulation mesh = triangulate(PointsView(FloatSpan(x), FloatSpan(y)), float_options());
  EXPECT_EQ(mesh.hash(), triangulate(FloatSpan(floats_of(xy)), host_options()).hash());
}

TEST_F(FloatInterface, NoNumbersAreNamed) {
  for (const float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    Floats xy = floats_of(uniform_points(1000, 2));
    xy[2 * 700 + 1] = xy[2 * 900] = bad;
    try {
      static_cast<void>(triangulate(FloatSpan(xy), float_options()));
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(error.index(), 700u);
    }
  }
}

TEST_F(FloatInterface, StarsAreAnOptionErrorAndAutomaticTakesLocks) {
  Options options = float_options();
  options.tuning.strategy = Strategy::stars;
  const Floats xy = floats_of(uniform_points(1000, 2));
  try {
    static_cast<void>(triangulate(FloatSpan(xy), options));
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("locks"), std::string::npos) << error.what();
  }
  const Triangulation mesh = triangulate(FloatSpan(xy), float_options());
  EXPECT_EQ(mesh.statistics().proven_stars, 0u);
  EXPECT_GE(mesh.statistics().splits, 990u);
  EXPECT_FALSE(mesh.statistics().wide_arithmetic);
}

TEST_F(FloatInterface, SetsOneAfterAnother) {
  Floats xy;
  std::vector<std::size_t> offsets = {0};
  for (const std::size_t n : {5u, 0u, 400u, 1u, 3u, 2500u}) {
    const Floats set = floats_of(uniform_points(n, n + 1));
    xy.insert(xy.end(), set.begin(), set.end());
    offsets.push_back(xy.size() / 2);
  }
  const TriangulationBatch batch = triangulate_batch(FloatSpan(xy), offsets, float_options());
  const TriangulationBatch host = triangulate_batch(FloatSpan(xy), offsets, host_options());
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    EXPECT_TRUE(std::ranges::equal(batch.triangles(s), host.triangles(s))) << s;
    EXPECT_TRUE(std::ranges::equal(batch.neighbors(s), host.neighbors(s))) << s;
  }
}

TEST_F(FloatInterface, Stabilize) {
  const Floats xy = floats_of(cluster_points(4000));
  Options options = float_options();
  const Hash128 hash = triangulate(FloatSpan(xy), host_options()).hash();
  options.tuning.stabilize = Stabilize::defer;
  options.tuning.flip_threshold = 1;
  EXPECT_EQ(triangulate(FloatSpan(xy), options).hash(), hash);
  options.tuning.stabilize = Stabilize::paper;
  const Triangulation mesh = triangulate(FloatSpan(xy), options);
  EXPECT_EQ(mesh.number_of_triangles(), triangulate(FloatSpan(xy), host_options()).number_of_triangles());
}

TEST_F(FloatInterface, StatisticsAndWatch) {
  const Floats xy = floats_of(uniform_points(3000, 2));
  Options options = float_options();
  std::size_t shown = 0;
  options.tuning.watch = [&](const Snapshot&) { ++shown; };
  EXPECT_EQ(triangulate(FloatSpan(xy), options).hash(), triangulate(FloatSpan(xy), host_options()).hash());
  EXPECT_GT(shown, 3u);
  options.tuning.watch = nullptr;
  options.statistics = StatisticsDetail::timing;
  options.tuning.kernel_times = true;
  EXPECT_FALSE(triangulate(FloatSpan(xy), options).statistics().kernels.empty());
}

// Forbidden in the source itself, on devices that have doubles as well; literals without a suffix are floats.
TEST_F(FloatInterface, ADoubleInTheKernelsIsAnErrorOfTheCompiler) {
  opencl::OpenRequest request;
  request.index = info.index;
  request.fresh = true;
  const std::string literals = "typedef char cadt_literals_are_floats[sizeof(0.5 * 1e10) == 4 ? 1 : -1];\n";
  request.source = opencl::signs_source() + literals;
  EXPECT_NE(opencl::open_device(request), nullptr);
  for (const char* use : {"static float cadt_test(float x) { return (float)((double)x * x); }\n",
                          "__kernel void cadt_test(__global double2* p) { p[0].x = 0.5f; }\n"}) {
    request.source = opencl::signs_source() + use;
    try {
      static_cast<void>(opencl::open_device(request));
      FAIL() << "compiled: " << use;
    } catch (const KernelBuildError& error) {
      EXPECT_NE(error.log().find("cadt_there_are_no_doubles_on_this_device"), std::string::npos) << error.log();
    }
  }
}

// Each probe of the self-test for floats notices what it is for.
TEST_F(FloatInterface, EachWrongOperationIsNamed) {
  struct Fault {
    const char *from, *to, *probe;
  };
  const Fault faults[] = {
      {"out[0] = in[0] * in[0] + in[1]", "out[0] = fma(in[0], in[0], in[1])", "contraction of a*a+b"},
      {"(in[2] - (s - t)) + (in[3] - t)", "(in[2] + in[3]) - s", "rounding error of a sum"},
      {"out[2] = in[4];", "out[2] = in[4] + in[5];", "a copy of a subnormal number"},
      {"cadt_less(in[6], in[7])", "(in[6] < in[7])", "a choice of subnormal numbers"},
      {"out[4] = in[8] + in[9]", "out[4] = in[8]", "rounding of a sum"},
      {"out[5] = in[10] * in[11]", "out[5] = nextafter(in[10] * in[11], 2.0f)", "rounding of a product"},
      {"out[6] = in[12] / in[13]", "out[6] = in[12]", "division without a remainder"},
      {"p.high)", "(p.high ^ (1l << 40)))", "64 x 64 bit product"},
      {"(cadt_u32, p.low);", "(cadt_u32, p.low + 1ul);", "64 x 64 bit product, low word"},
  };
  for (const Fault& fault : faults) {
    opencl::OpenRequest request;
    request.index = info.index;
    request.fresh = true;
    request.source = opencl::signs_source();
    const std::size_t at = request.source.find(fault.from);
    ASSERT_NE(at, std::string::npos) << "the source has changed: " << fault.from;
    request.source.replace(at, std::string(fault.from).size(), fault.to);
    try {
      static_cast<void>(opencl::open_device(request));
      // another device may not flush, whatever its compiler is told
      if (info.platform == "Portable Computing Language") ADD_FAILURE() << "accepted: " << fault.to;
    } catch (const BackendUnavailable& error) {
      EXPECT_NE(error.reason().find("fails the self-test '" + std::string(fault.probe) + "'"), std::string::npos)
          << error.what();
    }
  }
}

// Verification runs on the host: the device's verifier needs doubles.
TEST_F(FloatInterface, Verification) {
  const Floats xy = floats_of(grid_points(30, 30));
  const Triangulation mesh = triangulate(FloatSpan(xy), float_options());
  EXPECT_TRUE(verify_on_device(FloatSpan(xy), mesh, float_options()).ok);
  Floats other = xy;
  other[100] += 0.3F;
  EXPECT_FALSE(verify_on_device(FloatSpan(other), mesh, float_options()).ok);
}

TEST_F(FloatInterface, PointsInDeviceMemory) {
  const auto memory = opencl_memory(info.index);
  ASSERT_NE(memory, nullptr);
  Options options = float_options();
  options.queue = memory->queue();
  Triangulator triangulator(options);
  const Floats xy = floats_of(uniform_points(3000, 2)), line = {0, 0, 1, 1, 2, 2, 1, 1};
  for (const Floats& set : {xy, line}) {
    const DevicePoints points{.x = memory->upload(FloatSpan(set)), .size = set.size() / 2, .scalar = Scalar::float32};
    const DeviceTriangulation mesh = triangulator.triangulate(points);
    const Triangulation host = triangulate(FloatSpan(set), host_options());
    ASSERT_EQ(mesh.number_of_triangles(), host.number_of_triangles());
    const auto triangles = memory->download<std::int32_t>(mesh.triangles(), 3 * mesh.number_of_triangles());
    EXPECT_TRUE(std::ranges::equal(triangles, host.triangles()));
    EXPECT_TRUE(triangulator.verify(points, mesh).ok);
    DevicePoints later = points;  // and not those of the mesh
    later.skip = 1;
    later.size -= 1;
    const DeviceTriangulation rest = triangulator.triangulate(later);
    const Triangulation host_rest = triangulate(FloatSpan(set).subspan(2), host_options());
    EXPECT_EQ(rest.number_of_triangles(), host_rest.number_of_triangles());
  }
  const Points doubles = uniform_points(100, 2);
  const DevicePoints points{.x = memory->upload(std::span<const double>(doubles)), .size = 100};
  expect_refused([&] { static_cast<void>(triangulator.triangulate(points)); });
}

}  // namespace
}  // namespace cadt::test
