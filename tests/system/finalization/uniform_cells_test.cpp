// SPDX-License-Identifier: Apache-2.0
// Points by counter: each range of indices is a part of the plane, on every device the same.
#include <cadt/uniform_cells.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "tests/support/backends.hpp"
#include "tests/system/resident/resident.hpp"

namespace cadt::test {
namespace {

class Cells : public ResidentTest {};

TEST_P(Cells, AreTheSameOnTheDevice) {
  Triangulator triangulator(options());
  const UniformCells cells((std::uint64_t{1} << 33) + 77, 5);
  const std::uint64_t first = (std::uint64_t{1} << 32) - 500;
  const std::size_t count = 1000;
  std::vector<double> expected(2 * count);
  cells.generate(first, count, expected.data());
  const DeviceArray xy{memory->upload(std::span<const double>(std::vector<double>(2 * count))), 2 * count};
  cells.generate(triangulator, first, count, xy);
  EXPECT_EQ(memory->download<double>(xy.memory, 2 * count), expected);
  EXPECT_THROW(cells.generate(triangulator, first, count + 1, xy), InputError);
  // Twice as many are no size.
  EXPECT_THROW(cells.generate(triangulator, first, std::size_t{1} << 63, xy), InputError);
  EXPECT_THROW(cells.generate(triangulator, first, (std::size_t{1} << 63) + 1, xy), InputError);

  // A leaf of points and ids in device memory is the one of the same points on the host.
  std::vector<std::uint64_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) ids[i] = first + 7 * i;
  const DevicePoints points{.x = xy.memory, .size = count};
  const TileBox box{0, 0, 1, 1};
  const FinishedNode there =
      finish_leaf(triangulator, points, {.memory = memory->upload(std::span<const std::uint64_t>(ids))}, box, 4);
  const FinishedNode here = finish_leaf(triangulator, std::span<const double>(expected), ids, box, 4);
  const FinishedNode counted = finish_leaf(triangulator, points, {.first = first}, box, 4);
  EXPECT_EQ(there.open.ids, here.open.ids);
  EXPECT_EQ(there.open.xy, here.open.xy);
  EXPECT_EQ(there.open.sides, here.open.sides);
  EXPECT_EQ(there.part.hash(), here.part.hash());
  EXPECT_NE(counted.part.hash(), here.part.hash());
  EXPECT_EQ(counted.open.ids[0] - first, (here.open.ids[0] - first) / 7);
  EXPECT_EQ(counted.open.sides, here.open.sides);
}

CADT_ON_MAIN_BACKENDS(Cells);

TEST(UniformCellsOnHost, PartsHaveTheirPoints) {
  for (std::uint64_t n : {1u, 63u, 64u, 1000u, 100003u}) {
    const UniformCells cells(n, 9);
    std::vector<double> xy(2 * n);
    cells.generate(0, n, xy.data());
    for (unsigned depth = 0; depth <= 2 * cells.level(); ++depth) {
      std::uint64_t next = 0;
      for (std::uint64_t p = 0; p < std::uint64_t{1} << depth; ++p) {
        const UniformCells::Part part = cells.part(depth, p);
        ASSERT_EQ(part.first, next);
        next += part.count;
        for (std::uint64_t i = part.first; i < next; ++i) ASSERT_TRUE(part.box.contains(xy[2 * i], xy[2 * i + 1])) << i;
      }
      ASSERT_EQ(next, n);
    }
    for (const double v : xy) ASSERT_TRUE(v >= 0 && v < 1);
  }
}

/// Of the largest set, and one point less: the last part ends with the set.
TEST(UniformCellsOnHost, LargestSetsHaveParts) {
  for (const std::uint64_t n : {(std::uint64_t{1} << 40) - 1, std::uint64_t{1} << 40}) {
    const UniformCells cells(n);
    const unsigned depth = 2 * cells.level();
    EXPECT_EQ(depth, 24U);
    const UniformCells::Part last = cells.part(depth, (std::uint64_t{1} << depth) - 1);
    EXPECT_EQ(last.count, n >> depth);
    EXPECT_EQ(last.first + last.count, n);
  }
  EXPECT_THROW(UniformCells((std::uint64_t{1} << 40) + 1), LimitError);
}

TEST(UniformCellsOnHost, DepthIsTheLeast) {
  const UniformCells cells(1'000'000);
  for (std::uint64_t most : {1'000'000u, 999'999u, 300'000u, 1000u}) {
    const auto depth = cells.depth_for(most);
    ASSERT_TRUE(depth);
    const auto largest = [&](unsigned d) {
      std::uint64_t count = 0;
      for (std::uint64_t p = 0; p < std::uint64_t{1} << d; ++p) count = std::max(count, cells.part(d, p).count);
      return count;
    };
    EXPECT_LE(largest(*depth), most);
    if (*depth > 0) {
      EXPECT_GT(largest(*depth - 1) + 1, most);
    }
  }
  EXPECT_FALSE(cells.depth_for(3));
  EXPECT_THROW(UniformCells((std::uint64_t{1} << 40) + 1), LimitError);
}

/// Joins of many sides divide them among threads: nothing depends on how many there are, and what stays open is what a
/// tree of small joins leaves open.
TEST(UniformCellsOnHost, JoinsOfManySidesOnThreads) {
  const UniformCells cells(300'000);
  constexpr unsigned depth = 11;  // of 2,048 leaves, those of the left half
  constexpr std::uint64_t first_id = (std::uint64_t{1} << 33) - 70'000;
  const auto triangulator = [](unsigned threads) {
    Options options;
    options.backend = Backend::host;
    options.threads = threads;
    return Triangulator(options);
  };
  Triangulator one = triangulator(1);
  std::vector<Open> leaves, level;
  for (std::uint64_t p = 0; p < std::uint64_t{1} << (depth - 1); ++p) {
    const UniformCells::Part part = cells.part(depth, p);
    std::vector<double> xy(2 * part.count);
    cells.generate(part.first, part.count, xy.data());
    std::vector<std::uint64_t> ids(part.count);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = first_id + part.first + i;
    leaves.push_back(finish_leaf(one, std::span<const double>(xy), ids, part.box, static_cast<std::uint32_t>(p)).open);
  }
  const TileBox half = cells.part(1, 0).box;
  const auto children = std::span(leaves);
  const FinishedNode expected = finish_join(one, children, half, 4000);
  EXPECT_GT(expected.messages.size(), 35'000u);
  // What is told to a side of a child leads back to it.
  std::vector<TriangleId> told, linked;
  for (const Link& message : expected.messages) told.push_back(message.triangle);
  for (const TriangleId across : expected.links)
    if (across != pending_triangle) linked.push_back(across);
  std::ranges::sort(told);
  std::ranges::sort(linked);
  EXPECT_TRUE(told == linked);
  for (const unsigned threads : {2u, 3u, 7u}) {
    Triangulator several = triangulator(threads);
    const FinishedNode node = finish_join(several, children, half, 4000);
    EXPECT_EQ(node.messages, expected.messages);
    EXPECT_EQ(node.open.ids, expected.open.ids);
    EXPECT_EQ(node.open.xy, expected.open.xy);
    EXPECT_EQ(node.open.sides, expected.open.sides);
    EXPECT_EQ(node.links, expected.links);
    EXPECT_EQ(node.sums, expected.sums);
    EXPECT_EQ(node.part.hash(), expected.part.hash());
  }
  // One child with the sides of all.
  Open whole;
  for (const Open& leaf : leaves) {
    const auto first = static_cast<std::uint32_t>(whole.ids.size());
    whole.ids.insert(whole.ids.end(), leaf.ids.begin(), leaf.ids.end());
    whole.xy.insert(whole.xy.end(), leaf.xy.begin(), leaf.xy.end());
    for (OpenSide side : leaf.sides) {
      side.from += first, side.to += first;
      whole.sides.push_back(side);
    }
  }
  const FinishedNode alone = finish_join(one, std::span(&whole, 1), half, 4000);
  EXPECT_EQ(alone.messages, expected.messages);
  EXPECT_EQ(alone.open.sides, expected.open.sides);
  EXPECT_EQ(alone.links, expected.links);
  EXPECT_EQ(alone.sums, expected.sums);
  std::uint64_t certified = 0;
  Hash128 hash;
  level = leaves;
  for (unsigned d = depth - 1; d > 0; --d) {
    std::vector<Open> parents;
    for (std::uint64_t p = 0; p < std::uint64_t{1} << (d - 1); ++p) {
      FinishedNode node = finish_join(one, std::span(level).subspan(2 * p, 2), cells.part(d, p).box, 5000);
      certified += node.sums.certified_edges;
      const Hash128 part = node.part.hash();
      hash.high += part.high, hash.low += part.low;
      parents.push_back(std::move(node.open));
    }
    level = std::move(parents);
  }
  ASSERT_EQ(level.size(), 1u);
  EXPECT_EQ(level[0].ids, expected.open.ids);
  EXPECT_EQ(level[0].xy, expected.open.xy);
  EXPECT_EQ(level[0].sides.size(), expected.open.sides.size());
  EXPECT_EQ(certified, expected.sums.certified_edges);
  EXPECT_EQ(hash, expected.part.hash());
}

TEST(UniformCellsOnHost, LookUniform) {
  const std::size_t n = 1 << 18;
  std::vector<double> xy(2 * n);
  UniformCells(std::uint64_t{1} << 34, 3).generate(0, n, xy.data());  // 256 cells of 1,024 points
  double low_x = 2, high_x = -1;
  for (std::size_t i = 0; i < n; ++i) low_x = std::min(low_x, xy[2 * i]), high_x = std::max(high_x, xy[2 * i]);
  EXPECT_GT(high_x, low_x);
  std::vector<int> bins(64);
  const UniformCells one(n, 3);
  one.generate(0, n, xy.data());
  for (std::size_t i = 0; i < n; ++i)
    ++bins[static_cast<std::size_t>(std::fmod(xy[2 * i] * 4096, 1.0) * 8) * 8 +
           static_cast<std::size_t>(std::fmod(xy[2 * i + 1] * 4096, 1.0) * 8)];
  for (int count : bins) EXPECT_NEAR(count, static_cast<double>(n) / 64, 5 * std::sqrt(n / 64.0));
}

}  // namespace
}  // namespace cadt::test
