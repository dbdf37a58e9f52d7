// SPDX-License-Identifier: Apache-2.0
// Calls with several groups: small sets are batched, a large set between them ends the group before it. What holds for
// the first group holds for the later ones, in every form of the points.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

/// Too large to go with others on any device.
constexpr std::size_t large = 33'000;

/// Points that float holds, so that all forms have the same meshes.
Points rounded(std::size_t n, std::uint64_t seed) {
  Points xy = uniform_points(n, seed);
  for (double& value : xy) value = static_cast<double>(static_cast<float>(value));
  return xy;
}

/// Small sets before, between and behind two large ones: three groups of several sets. Of equal numbers of points, a
/// wrong place would not show; equal points are equal within their set only.
struct Groups {
  std::vector<Points> sets;
  Points xy;
  std::vector<std::size_t> offsets = {0};
  Groups() {
    const auto add = [&](Points set) {
      xy.insert(xy.end(), set.begin(), set.end());
      offsets.push_back(xy.size() / 2);
      sets.push_back(std::move(set));
    };
    const auto add_small = [&](std::uint64_t seed) {
      add(rounded(310 + seed, seed));
      Points twice = rounded(100 + 7 * seed, seed + 1);
      twice.insert(twice.end(), twice.begin(), twice.begin() + 40);
      add(std::move(twice));
      add({});
      add(rounded(20 + seed, seed + 2));
    };
    add_small(10);
    add(rounded(large, 1));
    add_small(20);
    add(rounded(large + 1, 2));
    add_small(30);
  }
  [[nodiscard]] std::size_t points() const { return offsets.back(); }
};

/// The same points as the caller may have them.
struct Forms {
  explicit Forms(const Points& xy) : interleaved(xy), floats(xy.begin(), xy.end()) {
    for (std::size_t i = 0; i < xy.size(); i += 2) {
      x.push_back(xy[i]), y.push_back(xy[i + 1]);
      float_x.push_back(floats[i]), float_y.push_back(floats[i + 1]);
      records.push_back({i, xy[i + 1], xy[i]});
    }
  }
  [[nodiscard]] std::vector<std::pair<std::string, PointsView>> views() const {
    using Floats = std::span<const float>;
    return {{"interleaved doubles", Reals(interleaved)},
            {"separate doubles", PointsView(Reals(x), Reals(y))},
            {"interleaved floats", Floats(floats)},
            {"separate floats", PointsView(Floats(float_x), Floats(float_y))},
            {"doubles among other members", PointsView(records)}};
  }
  struct Record {
    std::size_t id;
    double y, x;
  };
  std::vector<Record> records;
  Points interleaved, x, y;
  std::vector<float> floats, float_x, float_y;
};

class BatchGroups : public BackendTest {
 protected:
  static Options options(Strategy strategy) {
    Options with = GetParam().options();
    with.tuning.strategy = strategy;
    return with;
  }
};

TEST_P(BatchGroups, EveryFormOfPoints) {
  const Groups groups;
  const Forms forms(groups.xy);
  std::vector<Triangulation> expected;
  Options serial;
  serial.backend = Backend::host;
  serial.threads = 1;
  for (const Points& set : groups.sets) expected.push_back(triangulate(Reals(set), serial));
  for (const Strategy strategy : {Strategy::automatic, Strategy::stars}) {
    Triangulator triangulator(options(strategy));
    for (const auto& [name, points] : forms.views()) {
      SCOPED_TRACE(name);
      const TriangulationBatch batch = triangulator.triangulate_batch(points, groups.offsets);
      ASSERT_EQ(batch.size(), groups.sets.size());
      EXPECT_EQ(batch.statistics().sets, groups.sets.size());
      EXPECT_EQ(batch.statistics().batched_sets, 9U);  // those with points
      EXPECT_EQ(batch.statistics().points, groups.points());
      std::uint64_t edges = 0, distinct = 0;
      for (std::size_t s = 0; s < groups.sets.size(); ++s) {
        SCOPED_TRACE("set " + std::to_string(s));
        EXPECT_EQ(batch.dimension(s), expected[s].dimension());
        EXPECT_TRUE(std::ranges::equal(batch.triangles(s), expected[s].triangles()));
        EXPECT_TRUE(std::ranges::equal(batch.neighbors(s), expected[s].neighbors()));
        EXPECT_TRUE(std::ranges::equal(batch.duplicates(s), expected[s].duplicates()));
        EXPECT_EQ(batch.triangulation(s).hash(), expected[s].hash());
        edges += expected[s].statistics().certified_edges;
        distinct += expected[s].statistics().distinct;
      }
      EXPECT_EQ(batch.statistics().certified_edges, edges);
      EXPECT_EQ(batch.statistics().distinct, distinct);
    }
  }
}

/// In a set of each group: the number of the point among all, the set, and the number in the set.
TEST_P(BatchGroups, FirstBadPoint) {
  const Groups groups;
  Triangulator triangulator(options(Strategy::automatic));
  struct Place {
    std::size_t set, point;
  };
  for (const auto& [set, at] : {Place{0, 0}, Place{4, large - 1}, Place{5, 0}, Place{8, 21}, Place{9, 1}, Place{10, 0},
                                Place{10, 339}, Place{13, 49}}) {
    SCOPED_TRACE("set " + std::to_string(set) + ", point " + std::to_string(at));
    Points xy = groups.xy;
    const std::size_t bad = groups.offsets[set] + at;
    ASSERT_LT(bad, groups.offsets[set + 1]);
    xy[2 * groups.points() - 1] = std::numeric_limits<double>::infinity();  // a later one is not the one that is named
    xy[2 * bad + at % 2] = std::numeric_limits<double>::quiet_NaN();
    const Forms forms(xy);
    for (const auto& [name, points] : forms.views()) {
      try {
        (void)triangulator.triangulate_batch(points, groups.offsets);
        ADD_FAILURE() << name << ": a point is no number";
      } catch (const InputError& error) {
        EXPECT_EQ(error.index(), bad) << name;
        const std::string where = "in set " + std::to_string(set) + ": point " + std::to_string(at) + " ";
        EXPECT_NE(std::string(error.what()).find(where), std::string::npos) << name << ": " << error.what();
      }
    }
  }
}

CADT_ON_MAIN_BACKENDS(BatchGroups);

}  // namespace
}  // namespace cadt::test
