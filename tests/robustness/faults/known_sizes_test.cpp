// SPDX-License-Identifier: Apache-2.0
// What a triangulator knows of earlier calls: sizes that had their memory, whether the plan was compact, what is
// reserved and what is cached. It must not know more than happened, and must forget what was freed.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <array>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

constexpr std::size_t fixed_bytes = 65536;

class KnownSizes : public ResidentTest {
 protected:
  [[nodiscard]] Options options(Strategy strategy) const {
    Options with = ResidentTest::options();
    with.tuning.strategy = strategy;
    return with;
  }
  /// CUDA has a pool of its own, which knows what is free.
  [[nodiscard]] bool keeps() const { return GetParam().backend != Backend::cuda; }

  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

/// In the compact plan the vertices of the mesh are written in several launches. Buffers are pooled here, so that a
/// call caches little more than it needs.
class KnownSavings : public KnownSizes {
 protected:
  void SetUp() override {
    KnownSizes::SetUp();
    faults->makes_parts = true;
    faults->change_launch = [this](KernelId kernel, std::vector<Arg>&) {
      if (kernel == KernelId::cadt_star_vertices) ++launches;
    };
  }
  std::size_t launches_of(Triangulator& triangulator, const Known& known) {
    launches = 0;
    EXPECT_EQ(triangulator.triangulate(Reals(known.xy)).hash(), known.mesh.hash());
    return launches;
  }
  static std::size_t quick(std::size_t n) { return 2 * fixed_bytes + 101 * n; }  ///< bytes of a call that does not save

  std::size_t launches = 0;
};

/// A call with floats has the compact plan whatever memory there is, and says nothing about calls without it.
TEST_P(KnownSavings, AreNotThoseOfOtherCalls) {
  const Known known(uniform_points(70'000));
  const std::vector<float> single(known.xy.begin(), known.xy.end());
  Triangulator triangulator(options(Strategy::stars));
  for (const auto& [bytes, wanted] : {std::pair{quick(known.size()) - 1, 4U}, std::pair{quick(known.size()), 1U}}) {
    triangulator.options().max_memory = bytes;
    EXPECT_EQ(launches_of(triangulator, known), wanted) << bytes;
    triangulator.release_memory();
  }
  triangulator.options().max_memory = 0;
  (void)triangulator.triangulate(PointsView(single));
  if (!keeps()) return;
  faults->device_bytes = quick(known.size()) - 1;
  ASSERT_LE(faults->live_bytes(), faults->device_bytes);
  for (int call = 0; call < 2; ++call) EXPECT_EQ(launches_of(triangulator, known), 4U) << call;
}

/// After release_memory() it is asked anew whether there is enough, before any work.
TEST_P(KnownSizes, ReleasedMemoryIsForgotten) {
  const Points xy = uniform_points(20000);
  const std::vector<std::size_t> offsets = {0, 2000, 4000, 6000, 20000};
  const DevicePoints points = upload(xy);
  const std::vector<std::pair<const char*, std::function<void(Triangulator&)>>> calls = {
      {"host", [&](Triangulator& t) { (void)t.triangulate(Reals(xy)); }},
      {"device", [&](Triangulator& t) { (void)t.triangulate(points); }},
      {"sets", [&](Triangulator& t) { (void)t.triangulate_batch(Reals(xy), offsets); }},
      {"sets on the device", [&](Triangulator& t) { (void)t.triangulate_batch(points, offsets); }}};
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    for (const auto& [name, call] : calls) {
      for (const bool reserved : {false, true}) {
        SCOPED_TRACE(std::string(name) + ", " + std::string(cadt::to_string(strategy)) +
                     (reserved ? ", reserved" : ""));
        Triangulator triangulator(options(strategy));
        if (reserved) triangulator.reserve(xy.size() / 2);
        call(triangulator);
        triangulator.release_memory();
        faults->clear();
        faults->device_bytes = 20 * xy.size();
        const auto error = thrown<OutOfMemory>([&, &call = call] { call(triangulator); });
        ASSERT_NE(error, nullptr);
        EXPECT_GT(error->needed(), faults->device_bytes);
        EXPECT_EQ(error->available(), faults->device_bytes - faults->live_bytes());
        EXPECT_EQ(faults->count(Step::launch), 0U);
        EXPECT_EQ(faults->count(Step::allocation), 0U);
        faults->device_bytes = 0;
        call(triangulator);
      }
    }
  }
}

/// Any allocation of reserve() fails: what was not reserved is reserved by the next one.
TEST_P(KnownSizes, FailedReserveIsNotDone) {
  if (!keeps()) GTEST_SKIP() << "the pool of CUDA is one allocation";
  const Known known(uniform_points(10000));
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    const auto allocations = [&](const auto& work) {
      const std::size_t before = faults->count(Step::allocation);
      work();
      return faults->count(Step::allocation) - before;
    };
    std::size_t all = 0, usual = 0;
    {
      Triangulator triangulator(options(strategy));
      all = allocations([&] { triangulator.reserve(known.size()); });
      usual = allocations([&] { (void)triangulator.triangulate(Reals(known.xy)); });
    }
    EXPECT_GE(all, 7U);
    for (std::size_t k = 0; k < all; ++k) {
      SCOPED_TRACE("allocation " + std::to_string(k) + ", " + std::string(cadt::to_string(strategy)));
      Triangulator triangulator(options(strategy));
      faults->fail(Step::allocation, k);
      (void)thrown<OutOfMemory>([&] { triangulator.reserve(known.size()); });
      faults->clear();
      EXPECT_EQ(allocations([&] { triangulator.reserve(known.size()); }), all);
      const std::size_t more =
          allocations([&] { EXPECT_EQ(triangulator.triangulate(Reals(known.xy)).hash(), known.mesh.hash()); });
      EXPECT_LE(more, usual + 2);  // what threads leave over differs a little
    }
  }
}

/// Memory cached by earlier calls counts: a lower bound frees it.
TEST_P(KnownSizes, CachedMemoryIsBoundedToo) {
  const Known many(uniform_points(100'000)), few(uniform_points(1000, 2));
  constexpr std::size_t bound = 4'000'000;
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    for (const bool reserved : {false, true}) {
      Triangulator triangulator(options(strategy));
      if (reserved) triangulator.reserve(many.size());
      EXPECT_EQ(triangulator.triangulate(Reals(many.xy)).hash(), many.mesh.hash());
      if (keeps()) {
        EXPECT_GT(faults->live_bytes(), bound);
      }
      triangulator.options().max_memory = bound;
      const Triangulation mesh = triangulator.triangulate(Reals(few.xy));
      EXPECT_EQ(mesh.hash(), few.mesh.hash());
      EXPECT_LE(mesh.statistics().bytes_device_peak, bound);
      EXPECT_LE(faults->live_bytes(), bound);
    }
  }
}

CADT_ON_MAIN_BACKENDS(KnownSizes);
CADT_ON_MAIN_BACKENDS(KnownSavings);

}  // namespace
}  // namespace cadt::test
