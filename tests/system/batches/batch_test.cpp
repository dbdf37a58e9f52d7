// SPDX-License-Identifier: Apache-2.0
// Many sets of points in one call: each has the mesh that it has individually.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;
using Sets = std::vector<Points>;

struct Joined {
  explicit Joined(const Sets& sets) {
    for (const Points& set : sets) {
      xy.insert(xy.end(), set.begin(), set.end());
      offsets.push_back(xy.size() / 2);
    }
  }
  Points xy;
  std::vector<std::size_t> offsets = {0};
};

/// All that a set has in a batch, against the serial host's mesh of the individual set.
void expect_set(const TriangulationBatch& batch, std::size_t set, const Points& xy) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  const Triangulation expected = triangulate(Reals(xy), options);
  EXPECT_EQ(batch.number_of_points(set), expected.number_of_points());
  EXPECT_EQ(batch.dimension(set), expected.dimension());
  EXPECT_TRUE(std::ranges::equal(batch.triangles(set), expected.triangles()));
  EXPECT_TRUE(std::ranges::equal(batch.neighbors(set), expected.neighbors()));
  EXPECT_TRUE(std::ranges::equal(batch.duplicates(set), expected.duplicates()));
  const Triangulation copy = batch.triangulation(set);
  EXPECT_EQ(copy.hash(), expected.hash());
  EXPECT_TRUE(std::ranges::equal(copy.hull(), expected.hull()));
}

void expect_sets(const TriangulationBatch& batch, const Sets& sets) {
  ASSERT_EQ(batch.size(), sets.size());
  ASSERT_EQ(batch.triangle_offsets().size(), sets.size() + 1);
  EXPECT_EQ(batch.triangles().size(), 3 * batch.triangle_offsets().back());
  for (std::size_t s = 0; s < sets.size() && !testing::Test::HasFailure(); ++s) {
    SCOPED_TRACE("set " + std::to_string(s));
    expect_set(batch, s, sets[s]);
  }
}

class Batch : public BackendTest {
 protected:
  static Statistics check(const Sets& sets, Options options = GetParam().options()) {
    const Joined joined(sets);
    const TriangulationBatch batch = triangulate_batch(Reals(joined.xy), joined.offsets, options);
    expect_sets(batch, sets);
    const Statistics& s = batch.statistics();
    EXPECT_TRUE(s.certified);
    EXPECT_EQ(s.sets, sets.size());
    EXPECT_EQ(s.points, joined.xy.size() / 2);
    std::uint64_t edges = 0;
    for (std::size_t set = 0; set < batch.size(); ++set)
      if (batch.dimension(set) == 2) edges += 3 * (batch.number_of_points(set) - batch.duplicates(set).size()) - 3;
    EXPECT_EQ(s.certified_edges, edges);
    return s;
  }
  static Options stars() {
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::stars;
    return options;
  }
  /// Also a processor that does what a card does.
  static bool on_card() { return Triangulator(GetParam().options()).device().gpu; }
};

Sets uniform_sets(std::size_t count, std::size_t size) {
  Sets sets;
  for (std::size_t s = 0; s < count; ++s) sets.push_back(uniform_points(size, 1000 + s));
  return sets;
}

/// As uniform points, but one has more neighbours than a star can hold.
Points with_hub(std::size_t seed) {
  Points xy = moved(uniform_points(100, seed), 5, 5);
  const Points noise = uniform_points(60, seed + 1);
  xy.insert(xy.end(), {0, 0});
  for (std::size_t i = 0; i < 60; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / 60, r = 1 + 1e-6 * noise[i];
    xy.insert(xy.end(), {r * std::cos(angle), r * std::sin(angle)});
  }
  return xy;
}

TEST_P(Batch, EvenlySpread) {
  const Statistics s = check(uniform_sets(50, 1000));
  EXPECT_EQ(s.batched_sets, 50u);
  EXPECT_EQ(s.splits + s.edge_splits, on_card() ? 0u : 50u * 997u);
}
TEST_P(Batch, Stars) {
  const Statistics s = check(uniform_sets(50, 1000), stars());
  EXPECT_EQ(s.batched_sets, 50u);
  EXPECT_GT(s.proven_stars, 40000u);
  EXPECT_EQ(s.proven_stars + s.wrapped_stars, 50000u);
  EXPECT_EQ(s.sweep_repairs + s.splits, 0u);
}

TEST_P(Batch, OneSet) { check(uniform_sets(1, 1500)); }

// Of few points, with empty ones among them, at both ends too.
TEST_P(Batch, Smallest) {
  Sets sets = {{}, {}};
  for (std::size_t n = 1; n < 70; ++n) {
    sets.push_back(uniform_points(n, n));
    if (n % 3 == 0) sets.emplace_back();
  }
  sets.emplace_back();
  check(sets);
  check({{}, {}, {}});
  check({});
}

TEST_P(Batch, EveryFamily) {
  for (const FamilyGroup& group : family_groups()) {
    SCOPED_TRACE(group.name);
    Sets sets;
    for (const Family& family : group.families()) sets.push_back(family.make());
    check(sets);
    check(sets, stars());
  }
}

// Sets without triangles beside those with.
TEST_P(Batch, Flat) {
  Points line;
  for (int i = 0; i < 90; ++i) line.insert(line.end(), {0.1 * i, 0.1 * i});
  const Points same(200, 3.0);
  check({line, uniform_points(500, 3), same, {1, 2}, {1, 2, 1, 2}, {1, 2, 3, 4}, uniform_points(500, 4), line});
}

// Equal points are equal only within their set.
TEST_P(Batch, Duplicates) {
  Points twice = uniform_points(300, 8);
  const Points again = twice;
  twice.insert(twice.end(), again.begin(), again.end());
  const Points one = {5, 5}, many(100, 5.0);
  const Sets sets = {
      again, again, shuffled(twice, 3), again, one, one, many, shuffled(twice, 4), uniform_points(300, 9)};
  check(sets);
  check(sets, stars());
}

// Each set has its own exponents; those that span too many binades are triangulated individually.
TEST_P(Batch, Exponents) {
  Points wide = uniform_points(200, 5);
  for (std::size_t i = 0; i < 40; ++i) wide[i] = std::ldexp(wide[i], -280);
  const Points even = uniform_points(400, 6);
  const Statistics s = check({scaled(even, 900), even, wide, scaled(even, -1000), scaled(even, 1023), even, wide});
  EXPECT_TRUE(s.wide_arithmetic);
  EXPECT_EQ(s.batched_sets, 5u);
}

TEST_P(Batch, Hubs) {
  Sets sets = uniform_sets(8, 300);
  sets[2] = with_hub(3);
  sets[7] = with_hub(4);
  check(sets);
  const Statistics s = check(sets, stars());
  EXPECT_EQ(s.batched_sets, 6u);
  EXPECT_GT(s.splits, 200u);
}

// Sets that are too large to go with others, at the ends and between.
TEST_P(Batch, LargeSets) {
  const Sets small = uniform_sets(5, 200);
  check({uniform_points(40000, 1), small[0], small[1], uniform_points(3000, 2), small[2], grid_points(60, 50), small[3],
         small[4], uniform_points(40000, 3)});
}

// More sets than a batch may have.
TEST_P(Batch, ManySets) {
  const std::size_t count = (std::size_t{1} << 20) + 7;
  std::vector<std::size_t> offsets(count + 1);
  const Points set = uniform_points(5, 1);
  Points xy;
  for (std::size_t s = 0; s < count; ++s) {
    if (s % 1000 == 3 || s + 2 == count) xy.insert(xy.end(), set.begin(), set.end());
    offsets[s + 1] = xy.size() / 2;
  }
  const TriangulationBatch batch = triangulate_batch(Reals(xy), offsets, GetParam().options());
  ASSERT_EQ(batch.size(), count);
  expect_set(batch, 3, set);
  expect_set(batch, 4, {});
  expect_set(batch, 500'003, set);
  expect_set(batch, count - 2, set);
  EXPECT_EQ(batch.triangle_offsets().back(), 1050 * batch.triangles(3).size() / 3);
}

// The size of a batch follows the memory that there is.
TEST_P(Batch, LittleMemory) {
  const Sets sets = uniform_sets(200, 1000);
  Options options = GetParam().options();
  options.max_memory = 30'000'000;
  const Statistics s = check(sets, options);
  EXPECT_LE(s.bytes_device_peak, options.max_memory);
  options.max_memory = 5'000'000;
  try {
    check(sets, options);
    ADD_FAILURE() << "it has no memory";
  } catch (const OutOfMemory& error) {
    EXPECT_GT(error.needed(), options.max_memory);
    EXPECT_EQ(error.available(), options.max_memory);
  }
}

TEST_P(Batch, StrategiesAndStabilize) {
  const Sets sets = {uniform_points(300, 1), grid_points(20, 20), {}, uniform_points(2, 1), grid_points(1, 30)};
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    Options options = GetParam().options();
    options.tuning.strategy = strategy;
    const std::uint64_t together = check(sets, options).batched_sets;
    EXPECT_EQ(together, strategy == Strategy::locks && on_card() ? 0u : 2u);
  }
  Options options = GetParam().options();
  options.tuning.stabilize = Stabilize::defer;
  EXPECT_EQ(check(sets, options).batched_sets, 0u);
}

TEST_P(Batch, FastOrder) {
  const Sets sets = {uniform_points(300, 1), {}, uniform_points(3000, 2), grid_points(20, 20), uniform_points(40, 3)};
  const Joined joined(sets);
  Options options = GetParam().options();
  options.order = Order::fast;
  const TriangulationBatch batch = triangulate_batch(Reals(joined.xy), joined.offsets, options);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SCOPED_TRACE(s);
    const Triangulation expected = triangulate(Reals(sets[s]), GetParam().options());
    EXPECT_EQ(canonical_set(batch.triangles(s)), canonical_set(expected.triangles()));
    EXPECT_TRUE(std::ranges::equal(batch.neighbors(s), neighbors_of(batch.triangles(s))));
  }
}

TEST_P(Batch, EveryFormOfPoints) {
  const Sets sets = uniform_sets(6, 150);
  const Joined joined(sets);
  Triangulator triangulator(GetParam().options());
  std::vector<double> x, y;
  for (std::size_t i = 0; i < joined.xy.size(); i += 2) {
    x.push_back(joined.xy[i]);
    y.push_back(joined.xy[i + 1]);
  }
  expect_sets(triangulator.triangulate_batch(PointsView(x, y), joined.offsets), sets);
  const std::vector<float> floats(joined.xy.begin(), joined.xy.end());
  Sets rounded = sets;
  for (Points& set : rounded)
    for (double& value : set) value = static_cast<double>(static_cast<float>(value));
  expect_sets(triangulator.triangulate_batch(floats, joined.offsets), rounded);
  expect_sets(triangulator.triangulate_batch(joined.xy, joined.offsets), sets);
}

TEST_P(Batch, Errors) {
  Triangulator triangulator(GetParam().options());
  Joined joined(uniform_sets(3, 40));
  const auto refused = [&](const std::vector<std::size_t>& offsets) {
    try {
      (void)triangulator.triangulate_batch(joined.xy, offsets);
      return -1;
    } catch (const InputError& error) {
      return static_cast<int>(error.index());
    }
  };
  EXPECT_EQ(refused({}), 0);
  EXPECT_EQ(refused({1, 120}), 0);
  EXPECT_EQ(refused({0, 50, 40, 120}), 2);
  EXPECT_EQ(refused({0, 50, 119}), 2);
  EXPECT_EQ(refused({0, 50, 121}), 2);
  const TriangulationBatch batch = triangulator.triangulate_batch(joined.xy, joined.offsets);
  EXPECT_THROW((void)batch.triangles(3), InputError);
  EXPECT_THROW((void)batch.triangulation(3), InputError);
  joined.xy[2 * 95 + 1] = std::numeric_limits<double>::quiet_NaN();
  joined.xy[2 * 99] = std::numeric_limits<double>::infinity();
  try {
    (void)triangulator.triangulate_batch(joined.xy, joined.offsets);
    ADD_FAILURE() << "a point is no number";
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 95u);
    EXPECT_NE(std::string(error.what()).find("in set 2: point 15 "), std::string::npos) << error.what();
  }
  triangulator.options().tuning.watch = [](const Snapshot&) {};
  EXPECT_THROW((void)triangulator.triangulate_batch(joined.xy, joined.offsets), OptionError);
}

// In a set that is not together with others.
TEST_P(Batch, ErrorsInLargeSets) {
  Joined joined({uniform_points(10, 1), uniform_points(40000, 2)});
  joined.xy[2 * 1010] = std::numeric_limits<double>::infinity();
  try {
    (void)triangulate_batch(Reals(joined.xy), joined.offsets, GetParam().options());
    ADD_FAILURE() << "a point is no number";
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 1010u);
    EXPECT_NE(std::string(error.what()).find("in set 1: point 1000 "), std::string::npos) << error.what();
  }
}

TEST_P(Batch, ProgressAndCancel) {
  Sets sets = uniform_sets(30, 300);
  sets.insert(sets.begin() + 15, uniform_points(40000, 1));
  const Joined joined(sets);
  std::vector<double> told;
  Options options = GetParam().options();
  options.progress = [&](const Progress& p) { told.push_back(p.fraction); };
  (void)triangulate_batch(Reals(joined.xy), joined.offsets, options);
  ASSERT_GT(told.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1.0);
  cadt::stop_source source;
  options.stop = source.get_token();
  options.progress = [&](const Progress& p) {
    if (p.fraction > 0.5) source.request_stop();
  };
  EXPECT_THROW((void)triangulate_batch(Reals(joined.xy), joined.offsets, options), Cancelled);
}

CADT_ON_MAIN_BACKENDS(Batch);

}  // namespace
}  // namespace cadt::test
