// SPDX-License-Identifier: Apache-2.0
// Steps of a call use parts of cached buffers (backends/opencl/buffer_pool.hpp): no two parts share a byte, the budget
// equals what the device has allocated, meshes are the same, and after any fault all memory can be freed. The device
// pools buffers here whether or not it does so elsewhere.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

constexpr std::size_t enough = 70'000;  // the smallest pooled buffers have a word for each of 65,536

class PooledMemory : public ResidentTest {
 protected:
  void SetUp() override {
    ResidentTest::SetUp();
    faults->makes_parts = true;
  }
  [[nodiscard]] Options with(Strategy strategy, Order order) const {
    Options chosen = options();
    chosen.tuning.strategy = strategy;
    chosen.order = order;
    return chosen;
  }
  /// CUDA has a pool of its own.
  [[nodiscard]] bool pools() const { return GetParam().backend != Backend::cuda; }

  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

Points with_equal_ones() {
  Points xy = uniform_points(enough, 4);
  const Points again(xy.begin(), xy.begin() + 2000);
  xy.insert(xy.end(), again.begin(), again.end());
  return xy;
}

/// Sets of several kinds and sizes in turn, so that buffers cached by one are pooled by another.
TEST_P(PooledMemory, MeshesAndBudgets) {
  std::vector<Known> sets;
  for (Points& xy : std::vector<Points>{with_equal_ones(), cluster_points(enough), grid_points(270, 260)})
    sets.emplace_back(std::move(xy));
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    for (const Order order : {Order::canonical, Order::fast}) {
      SCOPED_TRACE(std::string(cadt::to_string(strategy)) + (order == Order::fast ? ", fast" : ", canonical"));
      {
        Triangulator triangulator(with(strategy, order));
        for (int round = 0; round < 2; ++round) {
          for (const Known& known : sets) {
            SCOPED_TRACE(std::to_string(known.size()) + " points, round " + std::to_string(round));
            const DevicePoints points = upload(known.xy);
            faults->clear();
            const DeviceTriangulation mesh = triangulator.triangulate(points);
            EXPECT_EQ(mesh.statistics().bytes_device_peak, faults->most_bytes());
            EXPECT_GE(faults->parts(), round == 1 && pools() ? 4U : 0U);
            EXPECT_EQ(mesh.download().hash(), known.mesh.hash());
            if (round == 0) continue;
            // these save memory, in another way
            const std::size_t held = faults->live_bytes();
            const std::vector<float> single(known.xy.begin(), known.xy.end());
            const DevicePoints floats{
                .x = memory->upload(std::span<const float>(single)), .size = known.size(), .scalar = Scalar::float32};
            Triangulator saving(with(strategy, order));
            for (int call = 0; call < 2; ++call) {
              faults->clear();
              const DeviceTriangulation saved = saving.triangulate(floats);
              EXPECT_EQ(saved.statistics().bytes_device_peak, faults->most_bytes() - held) << call;
              EXPECT_EQ(saved.download().hash(), on_host(PointsView(std::span<const float>(single))).hash()) << call;
            }
            EXPECT_EQ(triangulator.triangulate(Reals(known.xy)).hash(), known.mesh.hash());
          }
        }
      }
      EXPECT_EQ(faults->live_bytes(), 0U);
    }
  }
}

/// Steps of each kind fail while parts of buffers are in use: with floats, whose plan is compact, each call allocates
/// some.
TEST_P(PooledMemory, AfterFaults) {
  const Points xy = cluster_points(enough);
  const std::vector<float> single(xy.begin(), xy.end());
  struct Case {
    const char* name;
    bool floats;
    Strategy strategy;
    Order order;
  };
  for (const auto& [name, floats, strategy, order] : {Case{"doubles, locks", false, Strategy::locks, Order::canonical},
                                                      Case{"doubles, stars", false, Strategy::stars, Order::canonical},
                                                      Case{"floats, stars", true, Strategy::stars, Order::fast}}) {
    SCOPED_TRACE(name);
    const PointsView points = floats ? PointsView(std::span<const float>(single)) : PointsView(Reals(xy));
    const auto expected = on_host(points).hash();
    Triangulator triangulator(with(strategy, order));
    const auto try_again = [&] {
      faults->clear();
      const Triangulation mesh = triangulator.triangulate(points);
      EXPECT_EQ(mesh.hash(), expected);
      EXPECT_EQ(mesh.statistics().bytes_device_peak, faults->most_bytes());
    };
    for (std::size_t s = 0; s < steps; ++s) {
      const auto step = static_cast<Step>(s);
      try_again();
      try_again();
      const std::size_t count = faults->count(step), stride = 1 + count / (step == Step::allocation ? 8 : 2);
      for (std::size_t k = 0; k < count && !HasFailure(); k += stride) {
        SCOPED_TRACE(std::string(to_string(step)) + " " + std::to_string(k) + " of " + std::to_string(count));
        faults->fail(step, k);
        try {
          EXPECT_EQ(triangulator.triangulate(points).hash(), expected);
        } catch (const Error&) {
          EXPECT_EQ(faults->failed(), 1U);
        }
        try_again();  // with what the failed call has left
      }
      triangulator.release_memory();
      EXPECT_EQ(faults->live_bytes(), 0U);
    }
  }
  EXPECT_EQ(faults->live_bytes(), 0U);
}

/// Pooled buffers are larger than requested, but not larger than the device's largest.
TEST_P(PooledMemory, LargestBufferJustFits) {
  const Points xy = uniform_points(enough);
  const auto expected = on_host(Reals(xy)).hash();
  faults->largest_buffer_bytes = 2 * enough * sizeof(device_text::cadt_locked_triangle);
  for (const bool reserved : {false, true}) {
    SCOPED_TRACE(reserved ? "reserved" : "not reserved");
    Triangulator triangulator(with(Strategy::locks, Order::canonical));
    if (reserved) triangulator.reserve(enough);
    for (int call = 0; call < 2; ++call) EXPECT_EQ(triangulator.triangulate(Reals(xy)).hash(), expected) << call;
  }
}

CADT_ON_MAIN_BACKENDS(PooledMemory);

}  // namespace
}  // namespace cadt::test
