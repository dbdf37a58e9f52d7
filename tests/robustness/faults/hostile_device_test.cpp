// SPDX-License-Identifier: Apache-2.0
// Devices slower, smaller or less reliable than any real one: locks that are never released, lists that are too short,
// buffers that are too small, and the most that a launch may cost.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using namespace device_text;
using Reals = std::span<const double>;

constexpr std::size_t mesh_parameters = 12;  // CADT_LOCKED_MESH_PARAMETERS (common/mesh/locked_mesh.dev.h)

template <class T>
T value_of(const Arg& arg) {
  T value;
  EXPECT_EQ(arg.size(), sizeof value);
  std::memcpy(&value, arg.value(), sizeof value);
  return value;
}

class HostileDevice : public ResidentTest {
 protected:
  [[nodiscard]] Options insertion() const {
    Options with = options();
    with.tuning.strategy = Strategy::locks;
    return with;
  }
  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

/// A triangle that is locked and never released, as after a work-item that was killed: no call waits for it for ever.
TEST_P(HostileDevice, LockThatIsNeverReleased) {
  const Points xy = uniform_points(3000);
  Triangulator triangulator(insertion());
  for (const std::size_t which : {0U, 1U, 2U, 3U}) {
    bool poked = false;
    std::uint32_t launches = 0;
    faults->after_launch = [&](KernelId kernel, std::span<const Arg> args, Device& device, double) {
      ++launches;
      if (kernel != KernelId::cadt_seed_mesh) return;
      // the first triangle and its ghosts: triangles 2 first, 2 first + 1, 2 second, 2 second + 1
      const auto first = value_of<std::uint32_t>(args[6]), second = value_of<std::uint32_t>(args[7]);
      const std::size_t record = 2 * std::size_t{which < 2 ? first : second} + which % 2;
      const std::uint32_t locked = 1;
      device.write(*args[0].buffer(), record * sizeof(cadt_locked_triangle) + CADT_WORD_LOCK * sizeof locked, &locked,
                   sizeof locked);
      poked = true;
    };
    const auto error = thrown<InternalError>([&] { (void)triangulator.triangulate(Reals(xy)); });
    EXPECT_TRUE(poked);
    ASSERT_NE(error, nullptr);
    EXPECT_NE(std::string(error->what()).find("no progress"), std::string::npos) << error->what();
    EXPECT_LT(launches, 2000U);
    faults->after_launch = nullptr;
    triangulator.release_memory();
    EXPECT_EQ(faults->live_bytes(), 0U);
    EXPECT_EQ(triangulator.triangulate(Reals(xy)).hash(), on_host(Reals(xy)).hash());
  }
}

/// The list of edges deferred to the next launch has room for few: the legality sweep finds those that were dropped. To
/// make sure that edges are deferred, every seventh triangle is locked in the middle of the insertion and unlocked two
/// launches later. On GPUs the legality sweep itself needs the list: without any room it stops with an error.
TEST_P(HostileDevice, ListOfEdgesThatIsTooShort) {
  const Points uniform = uniform_points(6000, 4), lattice = grid_points(60, 70);
  std::uint64_t dropped = 0;
  for (const Points& xy : {uniform, lattice}) {
    const Hash128 expected = on_host(Reals(xy)).hash();
    const std::size_t n = xy.size() / 2;
    for (const std::uint32_t capacity : {0U, 1U, 2U, 7U, 64U}) {
      Triangulator triangulator(insertion());
      if (triangulator.device().gpu && (capacity == 1 || capacity == 2)) continue;  // one or two edges a sweep
      SCOPED_TRACE(capacity);
      std::set<const Buffer*> counts;
      // The capacity stands before the last argument, the counts before it.
      faults->change_launch = [&](KernelId kernel, std::vector<Arg>& args) {
        if (kernel != KernelId::cadt_insert && kernel != KernelId::cadt_legalize_edges &&
            kernel != KernelId::cadt_legality_sweep && kernel != KernelId::cadt_border_sweep)
          return;
        const std::size_t last = args.size() - 1;
        EXPECT_GE(value_of<std::uint32_t>(args[last - 1]), n / 8);
        args[last - 1] = Arg(capacity);
        counts.insert(args[last - 2].buffer());
      };
      faults->change_read = [&](const Buffer& from, std::size_t offset, void* to, std::size_t bytes) {
        // Another buffer may have the address of one that is gone: the counts are few words, results are many.
        if (!counts.contains(&from) || offset != 0 || bytes < 8 || bytes > 64) return;
        std::uint32_t edges = 0;
        std::memcpy(&edges, static_cast<std::byte*>(to) + sizeof edges, sizeof edges);
        dropped += edges - std::min(edges, capacity);
        edges = std::min(edges, capacity);
        std::memcpy(static_cast<std::byte*>(to) + sizeof edges, &edges, sizeof edges);
      };
      std::vector<cadt_locked_triangle> triangles(2 * n);
      std::vector<std::size_t> locked;
      std::size_t launches = 0;
      faults->after_launch = [&](KernelId kernel, std::span<const Arg> args, Device& device, double) {
        if (kernel != KernelId::cadt_insert && kernel != KernelId::cadt_legalize_edges) return;
        ++launches;
        // On GPUs before the last level: what an earlier one drops, later flips have on their lists again.
        const std::size_t lock_at = triangulator.device().gpu ? 12 : 9, give_back_at = lock_at + 2;
        Buffer& buffer = *args[0].buffer();
        const auto set_locks = [&](std::uint32_t more) {
          for (const std::size_t r : locked) {
            const std::uint32_t lock = triangles[r].word[CADT_WORD_LOCK] + more;
            device.write(buffer, r * sizeof(cadt_locked_triangle) + CADT_WORD_LOCK * sizeof lock, &lock, sizeof lock);
          }
        };
        if (launches == lock_at) {
          device.read(buffer, 0, triangles.data(), triangles.size() * sizeof triangles[0]);
          for (std::size_t r = 0; r < triangles.size(); r += 7)
            if (triangles[r].word[CADT_WORD_LOCK] != 0) locked.push_back(r);
          set_locks(1);
        } else if (launches == give_back_at) {
          set_locks(2);
        }
      };
      if (triangulator.device().gpu && capacity == 0) {
        const auto error = thrown<InternalError>([&] { (void)triangulator.triangulate(Reals(xy)); });
        ASSERT_NE(error, nullptr);
        EXPECT_NE(std::string(error->what()).find("illegal edges"), std::string::npos) << error->what();
      } else {
        const Triangulation mesh = triangulator.triangulate(Reals(xy));
        EXPECT_EQ(mesh.hash(), expected);
        EXPECT_TRUE(mesh.statistics().certified);
        EXPECT_GT(mesh.statistics().deferred_edges, 0U);
      }
      EXPECT_FALSE(counts.empty());
      EXPECT_GT(locked.size(), n / 500);
      faults->change_launch = nullptr;
      faults->change_read = nullptr;
      faults->after_launch = nullptr;
    }
  }
  EXPECT_GT(dropped, 100U);
  RecordProperty("dropped", std::to_string(dropped));
}

/// The locked triangles of all points are one buffer. Where it cannot be so large, the call is refused before any work.
TEST_P(HostileDevice, LargestBufferIsTooSmall) {
  const Points xy = uniform_points(20000);
  faults->largest_buffer_bytes = 2 * 20000 * sizeof(cadt_locked_triangle) - 1;
  Triangulator triangulator(insertion());
  const std::size_t launched = faults->count(Step::launch);
  const auto error = thrown<OutOfMemory>([&] { (void)triangulator.triangulate(Reals(xy)); });
  ASSERT_NE(error, nullptr);
  EXPECT_EQ(error->needed(), 2 * 20000 * sizeof(cadt_locked_triangle));
  EXPECT_EQ(error->available(), faults->largest_buffer_bytes);
  (void)thrown<OutOfMemory>([&] { (void)triangulator.triangulate(upload(xy)); });
  EXPECT_EQ(faults->count(Step::launch), launched);
  EXPECT_EQ(faults->live_bytes(), 0U);
  const Points fewer(xy.begin(), xy.end() - 2);
  EXPECT_EQ(triangulator.triangulate(Reals(fewer)).hash(), on_host(Reals(fewer)).hash());
}

/// A variant of the kernels that is built when it is first launched, in the middle of a call, and does not compile.
TEST_P(HostileDevice, KernelsThatDoNotBuildInTheMiddle) {
  const Points xy = uniform_points(2000);
  Triangulator triangulator(insertion());
  std::size_t all = 0;  // launches; how many are needed for what is left over differs a little
  faults->change_launch = [&](KernelId, std::vector<Arg>&) { ++all; };
  (void)triangulator.triangulate(Reals(xy));
  ASSERT_GT(all, 20U);
  for (const std::size_t at : {std::size_t{0}, std::size_t{3}, all / 2, 3 * all / 4}) {
    std::size_t launches = 0;
    faults->change_launch = [&](KernelId, std::vector<Arg>&) {
      if (launches++ == at) throw KernelBuildError(triangulator.device().name, "-DCADT_WIDE=1", "line 7: no such word");
    };
    const auto error = thrown<KernelBuildError>([&] { (void)triangulator.triangulate(Reals(xy)); });
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->log(), "line 7: no such word");
    EXPECT_NE(std::string(error->what()).find(error->log()), std::string::npos);
    faults->change_launch = nullptr;
    triangulator.release_memory();
    EXPECT_EQ(faults->live_bytes(), 0U);
    EXPECT_EQ(triangulator.triangulate(Reals(xy)).hash(), on_host(Reals(xy)).hash());
  }
}

/// Batched sets are split into as many groups as memory needs.
TEST_P(HostileDevice, SetsInSmallerGroups) {
  constexpr std::size_t sets = 160, size = 1000;
  const Points xy = uniform_points(sets * size);
  std::vector<std::size_t> offsets;
  for (std::size_t s = 0; s <= sets; ++s) offsets.push_back(s * size);
  faults->largest_buffer_bytes = sets * size / 2 * 2 * sizeof(cadt_locked_triangle) - 1;
  Triangulator triangulator(options());
  const TriangulationBatch batch = triangulator.triangulate_batch(Reals(xy), offsets);
  for (const std::size_t s : {std::size_t{0}, sets / 2, sets - 1}) {
    const auto set = Reals(xy).subspan(2 * s * size, 2 * size);
    EXPECT_EQ(batch.triangulation(s).hash(), on_host(set).hash());
  }
}

/// No launch goes on for ever, whatever the points: so many points at most are inserted in it, and for each so many
/// flips are made (docs/reliability.md, F05). Stars of many edges and rows of many flips are what breaks such a bound.
TEST_P(HostileDevice, WorkOfALaunchIsBounded) {
  Options with = insertion();
  with.statistics = StatisticsDetail::counters;
  Triangulator triangulator(with);
  const bool contiguous = !triangulator.device().gpu;
  const std::uint64_t most_points = contiguous ? std::uint64_t{1} << 19 : std::uint64_t{1} << 25;
  // CADT_FLIP_LIMIT and CADT_EDGE_FLIP_LIMIT of common/insertion/insert.dev.h, and what is on the worklist then
  constexpr std::uint64_t worklist = 64;
  const std::uint64_t flips_of_a_point = (contiguous ? std::uint64_t{1} << 14 : 64) + worklist;
  const std::uint64_t flips_of_an_edge = (contiguous ? std::uint64_t{1} << 14 : 16) + worklist;
  std::map<std::string, double> longest;
  std::uint64_t flips_before = 0, most_of_a_point = 0, most_of_an_edge = 0, inserts = 0;
  const Buffer* of = nullptr;
  faults->after_launch = [&](KernelId kernel, std::span<const Arg> args, Device& device, double took) {
    double& known = longest[kernel_names[static_cast<std::size_t>(kernel)]];
    known = std::max(known, took);
    const bool insert = kernel == KernelId::cadt_insert;
    if (!insert && kernel != KernelId::cadt_legalize_edges) return;
    ++inserts;
    const auto work = value_of<std::uint32_t>(args[mesh_parameters + (insert ? 3 : 1)]);
    EXPECT_LE(work, most_points + most_points / 4 + 64);  // and those that other launches left over
    const Buffer* counters = args.back().buffer();
    std::vector<std::uint32_t> words(static_cast<std::size_t>(CADT_COUNTER_ROWS) * CADT_COUNTER_STRIDE);
    device.read(*counters, 0, words.data(), words.size() * sizeof words[0]);
    std::uint64_t flips = 0;
    for (std::size_t row = 0; row < CADT_COUNTER_ROWS; ++row)
      flips += words[row * CADT_COUNTER_STRIDE + CADT_COUNT_FLIPS];
    if (of != counters) flips_before = 0;
    of = counters;
    EXPECT_LE(flips - flips_before, (insert ? flips_of_a_point : flips_of_an_edge) * work);
    std::uint64_t& most = insert ? most_of_a_point : most_of_an_edge;
    if (work != 0) most = std::max(most, (flips - flips_before) / work);
    flips_before = flips;
  };
  Points hub = hub_points(contiguous ? 3000 : 100000), cross = axis_cross(contiguous ? 250 : 2000);
  // inside out: each point sees all edges that were there before it
  std::ranges::reverse(cross);
  for (const Points& xy : {hub, cross, uniform_points(contiguous ? 20000 : 2000000), skewed_points(20000)}) {
    const Triangulation mesh = triangulator.triangulate(Reals(xy));
    EXPECT_TRUE(mesh.statistics().certified);
    of = nullptr;
  }
  EXPECT_GT(inserts, 20U);
  RecordProperty("flips_of_a_point", std::to_string(most_of_a_point));
  RecordProperty("flips_of_an_edge", std::to_string(most_of_an_edge));
  for (const auto& [name, took] : longest) RecordProperty(name, std::to_string(took) + " ms");
  faults->after_launch = nullptr;
}

/// A card that draws a screen gets launches of a thirtieth: 2^20 points take 3 ms on an H200 (docs/reliability.md,
/// F05).
TEST_P(HostileDevice, WatchdogMakesLaunchesSmall) {
  faults->watchdog = true;
  Triangulator triangulator(insertion());
  if (!triangulator.device().gpu) GTEST_SKIP() << "a processor has no watchdog";
  EXPECT_TRUE(triangulator.device().watchdog);
  constexpr std::uint64_t most = std::uint64_t{1} << 20;
  std::uint64_t points = 0, slots = 0;
  faults->after_launch = [&](KernelId kernel, std::span<const Arg> args, Device&, double) {
    if (kernel == KernelId::cadt_insert)
      points = std::max<std::uint64_t>(points, value_of<std::uint32_t>(args[mesh_parameters + 3]));
    if (kernel == KernelId::cadt_legality_sweep)
      slots = std::max<std::uint64_t>(slots, value_of<std::uint32_t>(args[mesh_parameters + 1]));
  };
  const Points xy = uniform_points(2500000);
  EXPECT_TRUE(triangulator.triangulate(Reals(xy)).statistics().certified);
  faults->after_launch = nullptr;
  EXPECT_GT(points, most / 2);  // the last level has 1.25 million
  EXPECT_LE(points, most + most / 4 + 64);
  EXPECT_GT(slots, most);
  EXPECT_LE(slots, 4 * most);
}

CADT_ON_MAIN_BACKENDS(HostileDevice);

}  // namespace
}  // namespace cadt::test
