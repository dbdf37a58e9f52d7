// SPDX-License-Identifier: Apache-2.0
#include "tiles/tree.hpp"

#include "tests/unit/tiles/tiles_support.hpp"
#include "tiles/manifest.hpp"

#include <cadt/io/generate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace cadt::tiles {
namespace {

/// Each leaf has the points that the tree says, no more than a tile takes unless they are all equal.
void expect_tree_of(const TileTree& tree, const std::vector<double>& xy, std::uint64_t tile_points) {
  std::vector<std::uint64_t> counts(tree.size());
  std::vector<std::set<std::pair<double, double>>> places(tree.size());
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    const std::uint32_t leaf = tree.leaf_of(xy[i], xy[i + 1]);
    ASSERT_TRUE(tree.node(leaf).box.contains(xy[i], xy[i + 1]));
    ++counts[leaf];
    if (places[leaf].size() < 2) places[leaf].insert({xy[i], xy[i + 1]});
  }
  for (const std::uint32_t leaf : tree.leaves()) {
    EXPECT_EQ(tree.node(leaf).points, counts[leaf]);
    EXPECT_TRUE(counts[leaf] <= tile_points || places[leaf].size() == 1) << counts[leaf];
    EXPECT_GT(counts[leaf], 0U);
  }
  EXPECT_EQ(tree.number_of_points(), xy.size() / 2);
  EXPECT_EQ(TileTree({tree.nodes().begin(), tree.nodes().end()}), tree);  // checks its form
}

TEST(TileTree, OneLeafIsThePlane) {
  const TileTree tree = tree_of(points_of("uniform", 100), 100);
  ASSERT_EQ(tree.size(), 1U);
  EXPECT_TRUE(tree.node(0).box.is_plane());
  EXPECT_EQ(tree.number_of_points(), 100U);
  EXPECT_EQ(tree_of({}, 3).size(), 1U);
}

TEST(TileTree, EverySetAndSize) {
  for (const io::Distribution& about : io::distributions()) {
    for (const std::uint64_t size : {3, 7, 100, 600}) {
      SCOPED_TRACE(std::string(about.name) + " " + std::to_string(size));
      const std::vector<double> xy = points_of(about.name, 1000);
      expect_tree_of(tree_of(xy, size), xy, size);
    }
  }
}

TEST(TileTree, SplitsAtCoordinatesOfTheInput) {
  const std::vector<double> xy = points_of("grid", 400);
  const std::set<double> values(xy.begin(), xy.end());
  const TileTree tree = tree_of(xy, 10);
  for (const TreeNode& node : tree.nodes()) {
    for (const double side : {node.box.min_x, node.box.min_y, node.box.max_x, node.box.max_y})
      EXPECT_TRUE(std::isinf(side) || values.contains(side));
  }
}

TEST(TileTree, HalvesTheLongerSide) {
  const TileTree tree = tree_of({0, 0, 1, 0.1, 2, 0.2, 3, 0.3}, 3);
  ASSERT_EQ(tree.size(), 3U);
  EXPECT_EQ(tree.node(0).box.max_x, 2);
  EXPECT_EQ(tree.node(0).points, 2U);
  EXPECT_EQ(tree.node(1).box.min_x, 2);  // half-open: the point at 2 is right of it
}

TEST(TileTree, EqualPointsAreOneLeafWhateverItsSize) {
  std::vector<double> xy(2 * 50, 1.5);
  EXPECT_EQ(tree_of(xy, 3).size(), 1U);
  xy.insert(xy.end(), {1.5, 2, 1, 2, 1.5, -3, 1, 7});
  const TileTree tree = tree_of(xy, 3);
  expect_tree_of(tree, xy, 3);
  EXPECT_EQ(tree.node(tree.leaf_of(1.5, 1.5)).points, 50U);
}

TEST(TileTree, DoesNotDependOnHowPassesAreDivided) {
  const std::vector<double> xy = points_of("gaussian", 5000);
  const TileTree whole = tree_of(xy, 60);
  for (const std::size_t parts : {2, 7, 100}) EXPECT_EQ(tree_of(xy, 60, parts), whole);
}

TEST(TileTree, SampledSets) {
  for (const char* name : {"uniform", "clusters", "two-clusters", "line"}) {
    SCOPED_TRACE(name);
    const std::vector<double> xy = points_of(name, 2'500'000);
    const TileTree tree = tree_of(xy, 100'000, 3);
    expect_tree_of(tree, xy, 100'000);
    EXPECT_LT(tree.leaves().size(), 64U);
  }
}

TEST(TileTree, SampleAtOnePlaceHidesNothing) {
  // All points of the sample are equal, and the few that are not are on all sides of them.
  std::vector<double> xy(2 * 1'500'000, 3.0);
  const std::vector<double> others{2, 2, 3, 2, 4, 2, 2, 3, 4, 3, 2, 4, 3, 4, 4, 4};
  for (std::size_t i = 0; i < others.size(); ++i) xy[2 * 77'777 * (i / 2 + 1) + i % 2] = others[i];
  const TileTree tree = tree_of(xy, 5);
  expect_tree_of(tree, xy, 5);
  EXPECT_EQ(tree.node(tree.leaf_of(3, 3)).points, 1'500'000U - 8);
}

TEST(TileTree, TooManyNodesAreALimit) {
  const std::vector<double> xy = points_of("uniform", 1000);
  TreeBuilder builder(1000, 3, 100);
  TreePass pass = builder.new_pass();
  builder.look_at(pass, 0, xy);
  try {
    builder.finish_pass(std::move(pass));
    FAIL() << "no limit";
  } catch (const LimitError& e) {
    EXPECT_EQ(e.limit(), 100U);
    EXPECT_GT(e.count(), 100U);
    EXPECT_NE(std::string(e.what()).find("--tile-points"), std::string::npos);
  }
  EXPECT_THROW(TreeBuilder(10, 2), std::invalid_argument);
}

TEST(TileTree, WrongNodesAreRefused) {
  const TileTree tree = tree_of(points_of("uniform", 100), 20);
  const std::vector<TreeNode> nodes(tree.nodes().begin(), tree.nodes().end());
  const auto refused = [&](const auto& change) {
    std::vector<TreeNode> changed = nodes;
    change(changed);
    EXPECT_THROW(TileTree{changed}, Error);
  };
  refused([](auto& n) { n.clear(); });
  refused([](auto& n) { n.pop_back(); });
  refused([](auto& n) { std::swap(n[0], n[1]); });
  refused([](auto& n) { n.back().points += 1; });
  refused([](auto& n) { n[0].box.max_x = 0.999; });
  refused([](auto& n) { n.back().left = n.back().right; });
  refused([](auto& n) { n.back().box.min_x = 0; });
  refused([](auto& n) { n[0].parent = 1; });
}

TEST(Manifest, RoundTrip) {
  Manifest manifest;
  manifest.plan.tile_points = 20;
  manifest.plan.first_id = std::uint64_t{1} << 40;
  manifest.plan.content = {~std::uint64_t{0}, 5};
  manifest.plan.tree = tree_of(points_of("gaussian", 100), 20);
  const Manifest again = manifest_from_json(to_json(manifest), "m");
  EXPECT_EQ(again.plan, manifest.plan);
  EXPECT_FALSE(again.complete);
}

}  // namespace
}  // namespace cadt::tiles
