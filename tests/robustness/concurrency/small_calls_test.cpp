// SPDX-License-Identifier: Apache-2.0
// Small calls of the free function, for which each thread keeps a device and memory: what one call leaves behind must
// not be seen by the next, whatever its options, its end or its thread.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/portable.hpp"

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <array>
#include <cfenv>
#include <limits>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

Options on_host() {
  Options options;
  options.backend = Backend::host;
  return options;
}

/// Sets of several sizes, small and smaller, in turn: buffers of one call are too small or too large for the next.
const std::vector<Points>& sets() {
  static const std::vector<Points> all = {uniform_points(5, 1),         uniform_points(3000, 2),  Points(60, 1.5),
                                          grid_points(20, 30),          uniform_points(2, 3),     cluster_points(800),
                                          regular_polygon(90, 1, 2, 3), uniform_points(16383, 4), hub_points(200)};
  return all;
}
const std::vector<ExpectedMesh>& expected() {
  static const std::vector<ExpectedMesh> all = [] {
    std::vector<ExpectedMesh> meshes;
    for (const Points& xy : sets()) meshes.push_back(expected_mesh(xy));
    return meshes;
  }();
  return all;
}

void expect_right_meshes() {
  for (std::size_t s = 0; s < sets().size(); ++s)
    EXPECT_TRUE(same_mesh(triangulate(Reals(sets()[s]), on_host()), expected()[s])) << "set " << s;
}

TEST(SmallCalls, ResultsOutliveTheirThreads) {
  constexpr std::size_t threads = 6;
  (void)expected();
  std::vector<std::vector<Triangulation>> meshes(threads);
  {
    std::vector<JoinedThread> callers;
    for (std::size_t t = 0; t < threads; ++t)
      callers.emplace_back([&, t] {
        for (std::size_t call = 0; call < 2 * sets().size(); ++call) {
          Options options = on_host();
          options.threads = static_cast<unsigned>(t % 3);
          options.statistics = call % 2 != 0 ? StatisticsDetail::none : StatisticsDetail::counters;
          meshes[t].push_back(triangulate(Reals(sets()[(call + t) % sets().size()]), options));
        }
      });
  }
  for (std::size_t t = 0; t < threads; ++t)
    for (std::size_t call = 0; call < meshes[t].size(); ++call) {
      const std::size_t s = (call + t) % sets().size();
      EXPECT_TRUE(same_mesh(meshes[t][call], expected()[s])) << "thread " << t << ", set " << s;
      EXPECT_EQ(meshes[t][call].statistics().milliseconds.empty(), call % 2 != 0) << "the options of another call";
    }
}

TEST(SmallCalls, ErrorsInBetween) {
  Points bad = uniform_points(100, 5);
  bad[77] = std::numeric_limits<double>::quiet_NaN();
  Options wrong = on_host(), stopped = on_host();
  wrong.tuning.flip_threshold = 1001;
  for (int round = 0; round < 3; ++round) {
    EXPECT_THROW((void)triangulate(Reals(bad), on_host()), InputError);
    expect_right_meshes();
    EXPECT_THROW((void)triangulate(Reals(sets()[1]), wrong), OptionError);
    expect_right_meshes();
    for (const std::string_view phase : {"sort", "insert", "output"}) {
      cadt::stop_source stop;
      stopped.stop = stop.get_token();
      stopped.progress = [&](const Progress& progress) {
        if (progress.phase == phase) stop.request_stop();
      };
      EXPECT_THROW((void)triangulate(Reals(sets()[1]), stopped), Cancelled) << phase;
      expect_right_meshes();
    }
  }
}

TEST(SmallCalls, CallsWithinCalls) {
  Options options = on_host();
  std::size_t calls = 0;
  options.progress = [&](const Progress&) {
    const std::size_t s = ++calls % sets().size();
    EXPECT_TRUE(same_mesh(triangulate(Reals(sets()[s]), on_host()), expected()[s])) << "set " << s;
  };
  for (std::size_t s = 0; s < sets().size(); ++s)
    EXPECT_TRUE(same_mesh(triangulate(Reals(sets()[s]), options), expected()[s])) << "set " << s;
  EXPECT_GT(calls, sets().size());
}

TEST(SmallCalls, TheOrderIsThatOfTheCall) {
  Options fast = on_host();
  fast.order = Order::fast;
  const Points& xy = sets()[1];
  const Triangulation as_made = triangulate(Reals(xy), fast), sorted = triangulate(Reals(xy), on_host());
  EXPECT_EQ(as_made.hash(), sorted.hash());
  EXPECT_FALSE(std::ranges::equal(as_made.triangles(), sorted.triangles()));
  EXPECT_TRUE(same_mesh(sorted, expected()[1]));
}

/// Calls the library when its thread ends, after what was made later is destroyed: the library's own.
struct Last {
  std::optional<Hash128>* found = nullptr;
  ~Last() {
    if (found != nullptr) *found = triangulate(Reals(sets()[1]), on_host()).hash();
  }
};

TEST(SmallCalls, FromADestructorAtTheEndOfTheThread) {
  const Hash128 right = triangulate(Reals(sets()[1]), on_host()).hash();
  std::optional<Hash128> found, first;
  std::thread([&] {
    thread_local Last last;
    last.found = &found;
    first = triangulate(Reals(sets()[1]), on_host()).hash();
  }).join();
  EXPECT_EQ(first, right);
  EXPECT_EQ(found, right);
}

template <class Call>
bool is_refused(const Call& call) {
  try {
    call();
  } catch (const BackendUnavailable& error) {
    EXPECT_NE(error.reason().find("changed the arithmetic of this thread"), std::string::npos) << error.reason();
    return true;
  }
  return false;
}

class Arithmetic : public ::testing::Test {
 protected:
  /// Every call is refused in a thread with another arithmetic, and none before or after.
  template <class Change, class Restore>
  static void expect_refused(const Change& change, const Restore& restore) {
    const Points& xy = sets()[0];
    Triangulator triangulator(on_host());
    const Triangulation mesh = triangulate(Reals(xy), on_host());
    MeshQueries queries(Reals(xy), mesh, on_host());
    EXPECT_TRUE(same_mesh(mesh, expected()[0]));
    EXPECT_TRUE(same_mesh(triangulator.triangulate(Reals(xy)), expected()[0]));
    for (int round = 0; round < 2; ++round) {
      change();
      const std::array<bool, 4> refused = {is_refused([&] { (void)triangulate(Reals(xy), on_host()); }),
                                           is_refused([&] { (void)triangulator.triangulate(Reals(xy)); }),
                                           is_refused([&] { const Triangulator other(on_host()); }),
                                           is_refused([&] { (void)queries.locate(Reals(xy)); })};
      restore();
      EXPECT_EQ(refused, (std::array{true, true, true, true})) << "round " << round;
    }
    EXPECT_TRUE(same_mesh(triangulate(Reals(xy), on_host()), expected()[0]));
    EXPECT_TRUE(same_mesh(triangulator.triangulate(Reals(xy)), expected()[0]));
  }
};

TEST_F(Arithmetic, RoundsToNearest) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    expect_refused([=] { std::fesetround(mode); }, [] { std::fesetround(FE_TONEAREST); });
}

#if defined(__SSE2__)
TEST_F(Arithmetic, KeepsSubnormalNumbers) {
  const unsigned usual = _mm_getcsr();
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  for (const unsigned flag : {flush_to_zero, denormals_are_zero})
    expect_refused([=] { _mm_setcsr(usual | flag); }, [=] { _mm_setcsr(usual); });
}
#endif

}  // namespace
}  // namespace cadt::test
