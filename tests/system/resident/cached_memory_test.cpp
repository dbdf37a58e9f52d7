// SPDX-License-Identifier: Apache-2.0
// What a triangulator keeps for its next call.
#include "tests/system/resident/resident_memory.hpp"

#include <algorithm>
#include <utility>

namespace cadt::test {
namespace {

/// On back ends whose memory the library caches; CUDA has a pool (CudaCalls.TakeNoMoreThanReserved).
using CachedMemory = ResidentMemory;

/// After reserve() the first call asks for small buffers only, those after it for a few of other sizes, and from the
/// second call of a size on for none.
TEST_P(CachedMemory, ReservedMemoryIsEnough) {
  std::vector<Known> sets;
  for (const std::size_t n : {60000, 59999, 40000, 30000, 14000, 5000}) sets.emplace_back(uniform_points(n, n));
  for (const Order order : {Order::canonical, Order::fast}) {
    for (const bool floats : {false, true}) {
      SCOPED_TRACE(floats ? "float" : "double");
      Options with = options();
      with.order = order;
      Triangulator triangulator(with);
      triangulator.reserve(60000);
      constexpr std::uint64_t most_small = 8;
      std::uint64_t last = kept_buffers(triangulator);  // reserve() asked for those
      for (int round = 0; round < 3; ++round) {
        for (const Known& known : sets) {
          const std::vector<float> single(known.xy.begin(), known.xy.end());
          const DevicePoints points = floats ? DevicePoints{.x = memory->upload(std::span<const float>(single)),
                                                            .size = known.size(),
                                                            .scalar = Scalar::float32}
                                             : upload(known.xy);
          const DeviceTriangulation mesh = triangulator.triangulate(points);
          const std::uint64_t now = requests(mesh), of_this = now - last;
          last = now;
          EXPECT_LE(mesh.statistics().bytes_device_peak, triangulator.memory_needed(60000));
          EXPECT_LE(of_this, round == 0 ? most_small : 0) << known.size() << " points, round " << round;
        }
      }
    }
  }
}

TEST_P(CachedMemory, SecondCallTakesNothingLarge) {
  for (const Points& xy : {set_of_all_kinds(), uniform_points(40000)}) {
    const DevicePoints points = upload(xy);
    Triangulator triangulator(options());
    std::uint64_t last = 0, first_call = 0, peak = 0;
    for (int call = 0; call < 4; ++call) {
      const DeviceTriangulation mesh = triangulator.triangulate(points);
      const std::uint64_t now = requests(mesh), of_this = now - last;
      last = now;
      if (call == 0) first_call = of_this;
      if (call == 0) continue;
      EXPECT_LT(of_this + 8, first_call) << call;
      if (call == 1) peak = mesh.statistics().bytes_device_peak;
      EXPECT_NEAR(static_cast<double>(mesh.statistics().bytes_device_peak), static_cast<double>(peak), 40000) << call;
    }
  }
}

/// Memory cached for the next call is pooled within a call: several calls take no more than one, 100 bytes a point with
/// input and result, and 80 if the input is floats. (Up to two more are in buffers that are too small to be pooled.)
TEST_P(CachedMemory, SeveralCallsTakeLittle) {
  const Points xy = uniform_points(300'000);
  const std::vector<float> single(xy.begin(), xy.end());
  for (const Order order : {Order::canonical, Order::fast}) {
    for (const bool floats : {false, true}) {
      SCOPED_TRACE(std::string(order == Order::fast ? "fast, " : "canonical, ") + (floats ? "float" : "double"));
      Options with = options();
      with.order = order;
      with.tuning.strategy = Strategy::automatic;
      Triangulator triangulator(with);
      if (!triangulator.device().gpu) GTEST_SKIP() << "processors keep more, of the memory of the process";
      const DevicePoints points = floats ? DevicePoints{.x = memory->upload(std::span<const float>(single)),
                                                        .size = single.size() / 2,
                                                        .scalar = Scalar::float32}
                                         : upload(xy);
      std::uint64_t last = 0;
      for (int call = 0; call < 4; ++call) {
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_GT(mesh.statistics().proven_stars, points.size * 9 / 10);
        EXPECT_LE(mesh.statistics().bytes_device_peak, (floats ? 74 : 86) * points.size) << call;
        const std::uint64_t now = requests(mesh), of_this = now - std::exchange(last, now);
        // the compact plan frees more of it
        if (call < 2 || !mesh.data().state->memory.caches()) continue;
        EXPECT_LE(of_this, floats ? 12U : 0U) << call;
      }
    }
  }
}

/// reserve() allocates fewer buffers where they are pooled, and they are enough.
TEST_P(CachedMemory, ReservedMemoryIsPooled) {
  constexpr std::size_t n = 70'000;
  const DevicePoints points = upload(uniform_points(n));
  for (const Strategy strategy : {Strategy::locks, Strategy::automatic}) {
    for (const Order order : {Order::canonical, Order::fast}) {
      SCOPED_TRACE(std::string(to_string(strategy)) + (order == Order::fast ? ", fast" : ", canonical"));
      Options with = options();
      with.order = order;
      with.tuning.strategy = strategy;
      Triangulator triangulator(with);
      if (!triangulator.device().gpu) GTEST_SKIP() << "CPUs pool nothing";
      triangulator.reserve(n);
      EXPECT_LE(triangulator.memory_needed(n), 170 * n);
      for (int call = 0; call < 3; ++call) {
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_LE(mesh.statistics().bytes_device_peak, triangulator.memory_needed(n)) << call;
      }
    }
  }
}

CADT_ON(host, CachedMemory, main_host_case);
CADT_ON(opencl, CachedMemory, main_opencl_case);

}  // namespace
}  // namespace cadt::test
