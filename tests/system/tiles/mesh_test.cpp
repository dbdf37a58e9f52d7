// SPDX-License-Identifier: Apache-2.0
// The mesh in tiles is that of one call, array by array, whatever the tiles.
#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"
#include "tests/system/tiles/tile_runs.hpp"

#include <cadt/io/generate.hpp>

#include <algorithm>
#include <array>
#include <exception>
#include <mutex>
#include <vector>

namespace cadt::test {
namespace {

class TilesTest : public BackendTest {
 protected:
  /// A device takes milliseconds for a node of three points, and a few of them show what many do.
  [[nodiscard]] std::vector<std::uint64_t> small_tiles() const {
    return GetParam().backend == Backend::host ? std::vector<std::uint64_t>{3, 20, 150}
                                               : std::vector<std::uint64_t>{90};
  }
};
CADT_ON_MAIN_BACKENDS(TilesTest);

TEST_P(TilesTest, GeneratedSets) {
  for (const io::Distribution& about : io::distributions()) {
    SCOPED_TRACE(about.name);
    io::GenerateOptions options;
    options.n = 700;
    EXPECT_TRUE(same_in_tiles(io::generate(about.name, options).xy, small_tiles(), GetParam().options()));
  }
}

TEST_P(TilesTest, LargerGeneratedSets) {
  for (const char* name : {"uniform", "grid", "clusters", "ring", "duplicates", "concentric", "parabola"}) {
    SCOPED_TRACE(name);
    io::GenerateOptions options;
    options.n = 20'000;
    constexpr std::array<std::uint64_t, 2> sizes{700, 5'000};
    EXPECT_TRUE(same_in_tiles(io::generate(name, options).xy, sizes, GetParam().options()));
  }
}

TEST_P(TilesTest, Families) {
  for (const FamilyGroup& group : family_groups()) {
    int n = 0;
    for (const Family& family : group.families()) {
      const Points xy = family.make();
      if (xy.size() > 6'000 || ++n > (GetParam().backend == Backend::host ? 12 : 4)) continue;
      SCOPED_TRACE(family.name);
      EXPECT_TRUE(same_in_tiles(xy, small_tiles(), GetParam().options()));
    }
  }
}

TEST_P(TilesTest, RealSets) {
  if (!data_folder()) GTEST_SKIP() << "CADT_DATA_DIR is not set";
  for (const RealSet& set : real_sets()) {
    if (set.points > (GetParam().backend == Backend::host ? 60'000U : 20'000U)) continue;
    SCOPED_TRACE(set.name);
    Points xy = read(set);
    for (double& v : xy) v += 0.0;
    const std::array<std::uint64_t, 2> sizes{xy.size() / 2 / 30 + 3, 5'000};
    EXPECT_TRUE(same_in_tiles(xy, sizes, GetParam().options()));
  }
}

TEST_P(TilesTest, HardSets) {
  if (!data_folder()) GTEST_SKIP() << "CADT_DATA_DIR is not set";
  const bool host = GetParam().backend == Backend::host;
  const auto compare = [&](const ExactCounts& set, Points xy) {
    SCOPED_TRACE(set.name);
    for (double& v : xy) v += 0.0;
    const std::array<std::uint64_t, 2> sizes{xy.size() / 2 / 12 + 3, xy.size() / 2 / 3 + 3};
    EXPECT_TRUE(same_in_tiles(xy, sizes, GetParam().options()));
  };
  int n = 0;
  for (const ExactCounts& set : expected_of_files())
    if (!set.not_finite && (host || ++n <= 10)) compare(set, hard_file(set.name));
  n = 0;
  for (const ExactCounts& set : expected_of_catalogue())
    if (!set.not_finite && set.points <= 2'000 && (host || ++n <= 10)) compare(set, catalogue_set(set.name));
}

TEST_P(TilesTest, FewPoints) {
  EXPECT_TRUE(same_in_tiles({}, small_tiles(), GetParam().options()));
  EXPECT_TRUE(same_in_tiles({1, 2}, small_tiles(), GetParam().options()));
  EXPECT_TRUE(same_in_tiles(Points(60, 0.5), small_tiles(), GetParam().options()));
  EXPECT_TRUE(same_in_tiles({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, small_tiles(), GetParam().options()));
}

TEST_P(TilesTest, OrderOfInputIsThatOfIds) {
  const Points xy = uniform_points(3'000, 5);
  const std::vector<std::size_t> order = random_order(xy.size() / 2, 3);
  EXPECT_TRUE(same_in_tiles(reordered(xy, order), small_tiles(), GetParam().options()));
}

TEST_P(TilesTest, IdsAbove32Bits) {
  const Points xy = uniform_points(2'000, 7);
  tiles::RunOptions options = in_tiles(150, GetParam().options());
  options.first_id = (std::uint64_t{1} << 33) + 12345;
  const tiles::CollectedMesh nodes = run_in_memory(*tiles::in_memory(xy), options);
  EXPECT_GT(nodes.node(0).ids.front(), std::uint64_t{1} << 33);
  EXPECT_TRUE(same_arrays(tiles::merge(nodes), xy, triangulate(PointsView(std::span<const double>(xy)))));
  EXPECT_TRUE(tiles::verify(nodes).ok);
}

TEST_P(TilesTest, SeveralDevices) {
  const Points xy = uniform_points(10'000, 9);
  tiles::RunOptions options = in_tiles(200, GetParam().options());
  options.devices.assign(3, GetParam().options());
  tiles::RunResult result;
  const tiles::CollectedMesh nodes = run_in_memory(*tiles::in_memory(xy), options, &result);
  const Triangulation mesh = triangulate(PointsView(std::span<const double>(xy)));
  EXPECT_TRUE(same_arrays(tiles::merge(nodes), xy, mesh));
  EXPECT_EQ(result.hash, mesh.hash());
}

TEST_P(TilesTest, ConsumerSeesEachNodeOnce) {
  const Points xy = uniform_points(3'000, 11);
  tiles::RunOptions options = in_tiles(300, GetParam().options());
  options.devices.assign(2, GetParam().options());
  std::mutex lock;
  std::vector<std::uint32_t> seen;
  std::uint64_t triangles = 0, points = 0;
  options.consumer = [&](const tiles::NodeView& view) {
    const Part part = view.finished.part.download();
    const std::scoped_lock guard(lock);
    seen.push_back(view.node);
    triangles += part.triangles.size() / 3;
    EXPECT_EQ(part.triangles.size() / 3, view.finished.sums.triangles);
    EXPECT_EQ(view.xy.size(), 2 * view.ids.size());
    if (view.leaf) points += view.ids.size();
    for (const std::int32_t v : part.triangles) EXPECT_LT(static_cast<std::size_t>(v), view.ids.size());
  };
  const tiles::RunResult result = tiles::run(*tiles::in_memory(xy), options);
  std::sort(seen.begin(), seen.end());
  for (std::uint32_t i = 0; i < result.plan.tree.size(); ++i) EXPECT_EQ(seen.at(i), i);
  EXPECT_EQ(seen.size(), result.plan.tree.size());
  EXPECT_EQ(triangles, result.whole.triangles);
  EXPECT_EQ(points, xy.size() / 2);
}

TEST_P(TilesTest, ErrorsOfCallbacksEndTheRun) {
  const Points xy = uniform_points(3'000, 11);
  const auto source = tiles::in_memory(xy);
  struct Mine : std::exception {};
  for (const std::uint32_t at : {0U, 5U, 30U}) {
    tiles::RunOptions options = in_tiles(200, GetParam().options());
    options.devices.assign(2, GetParam().options());
    options.consumer = [at](const tiles::NodeView& view) {
      if (view.node == at) throw Mine();
    };
    EXPECT_THROW(tiles::run(*source, options), Mine);
    options.consumer = nullptr;
    options.collect = [at](tiles::NodeData&& node) {
      if (node.node == at) throw Mine();
    };
    EXPECT_THROW(tiles::run(*source, options), Mine);
    stop_source stop;
    options.stop = stop.get_token();
    options.collect = [&stop, at](tiles::NodeData&& node) {
      if (node.node == at) stop.request_stop();
    };
    if (at == 0) {
      EXPECT_THROW(tiles::run(*source, options), Cancelled);
    }
  }
}

TEST_P(TilesTest, DeviceBudgetOfOneTile) {
  const Points xy = uniform_points(400'000, 13);
  Options budget = GetParam().options();
  budget.max_memory = std::size_t{12} << 20;
  const PointsView points{std::span<const double>(xy)};
  EXPECT_THROW((void)triangulate(points, budget), OutOfMemory);
  const tiles::RunResult result = tiles::run(*tiles::in_memory(xy), in_tiles(20'000, budget));
  EXPECT_EQ(result.hash, triangulate(points, GetParam().options()).hash());
}

}  // namespace
}  // namespace cadt::test
