// SPDX-License-Identifier: Apache-2.0
// A mesh by tiles equals that of one call, triangle by triangle with its neighbours.
#include <cadt/cadt.hpp>
#include <cadt/finalization.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"
#include "tests/support/families.hpp"
#include "tests/system/finalization/tile_mesh.hpp"

namespace cadt::test {
namespace {

class Finalization : public BackendTest {};

void expect_equal(const TiledMesh& tiled, const Triangulation& mesh, std::uint64_t first_id = 0) {
  ASSERT_EQ(tiled.triangles.size(), mesh.number_of_triangles());
  ASSERT_TRUE(tiled.triangles == linked_triangles(mesh, first_id));
  std::vector<DuplicateId> duplicates;
  for (const Duplicate& d : mesh.duplicates())
    duplicates.push_back(
        {first_id + static_cast<std::uint64_t>(d.point), first_id + static_cast<std::uint64_t>(d.representative)});
  EXPECT_EQ(tiled.duplicates, duplicates);
  EXPECT_EQ(tiled.sums.points, mesh.number_of_points());
  EXPECT_EQ(tiled.sums.dimension, mesh.dimension());
  EXPECT_EQ(tiled.sums.hull_edges, mesh.dimension() == 2 ? mesh.hull().size() : 0);
  require_complete(tiled.sums);
  if (first_id == 0) {
    EXPECT_EQ(hash_of(tiled.sums), mesh.hash());
  }
}

/// Tiles and one call give the same for these points, by a tree and by one join of all leaves.
void compare(Triangulator& triangulator, const Points& xy, std::size_t tile_points) {
  SCOPED_TRACE("tiles of " + std::to_string(tile_points));
  const Triangulation mesh = triangulator.triangulate(std::span<const double>(xy));
  for (bool flat : {false, true}) {
    SCOPED_TRACE(flat ? "one join" : "a tree");
    TileOptions options;
    options.tile_points = tile_points;
    options.flat = flat;
    expect_equal(triangulate_by_tiles(triangulator, xy, options), mesh);
    if (testing::Test::HasFailure()) return;
  }
}

TEST_P(Finalization, EqualsOneCallForEveryFamily) {
  Triangulator triangulator(GetParam().options());
  std::size_t sets = 0;
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families()) {
      const Points xy = family.make();
      const std::size_t n = xy.size() / 2;
      if (n > 1500 || (group.name == "sizes" && n % 7 != 0)) continue;
      SCOPED_TRACE(family.name);
      compare(triangulator, xy, n < 40 ? 3 : n / 9);
      ASSERT_FALSE(HasFailure());
      ++sets;
    }
  }
  EXPECT_GT(sets, 100u);
}

TEST_P(Finalization, EqualsOneCallForEverySizeOfTiles) {
  Triangulator triangulator(GetParam().options());
  const bool slow = GetParam().backend != Backend::host;
  for (const Points& xy : {uniform_points(2000, 3), grid_points(41, 37), cluster_points(1500), parabola_points(600)}) {
    for (std::size_t tile_points : {3u, 4u, 7u, 20u, 100u, 333u, 1000u, 5000u}) {
      if (slow && tile_points < 20) continue;
      compare(triangulator, xy, tile_points);
      ASSERT_FALSE(HasFailure());
    }
  }
}

TEST_P(Finalization, IdsAboveTwoToThe32) {
  Triangulator triangulator(GetParam().options());
  const Points xy = uniform_points(3000, 9);
  TileOptions options;
  options.tile_points = 400;
  options.first_id = (std::uint64_t{1} << 33) - 1500;  // in the middle the low words begin anew
  expect_equal(triangulate_by_tiles(triangulator, xy, options), triangulator.triangulate(std::span<const double>(xy)),
               options.first_id);
}

TEST_P(Finalization, FewVerticesStayOpen) {
  Triangulator triangulator(GetParam().options());
  TileOptions options;
  options.tile_points = 20000;
  const Points xy = uniform_points(150000, 4);
  const TiledMesh mesh = triangulate_by_tiles(triangulator, xy, options);
  expect_equal(mesh, triangulator.triangulate(std::span<const double>(xy)));
  EXPECT_GE(mesh.open_of_root_n.size(), 8u);
  EXPECT_LT(*std::ranges::max_element(mesh.open_of_root_n), 7.0);
  EXPECT_GT(*std::ranges::min_element(mesh.open_of_root_n), 2.0);
}

TEST_P(Finalization, RefusesWhatCannotBe) {
  Triangulator triangulator(GetParam().options());
  const Points xy = {0, 0, 1, 0, 0, 1};
  const TileBox box{0, 0, 2, 2};
  const std::vector<std::uint64_t> ids = {1, 2, 3}, equal = {1, 2, 2}, few = {1, 2};
  const auto leaf = [&](const Points& points, const std::vector<std::uint64_t>& of, const TileBox& in) {
    return finish_leaf(triangulator, std::span<const double>(points), of, in, 0);
  };
  EXPECT_THROW((void)leaf(xy, few, box), InputError);
  try {
    (void)leaf(xy, equal, box);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 2u);
  }
  EXPECT_THROW((void)leaf(xy, ids, {0, 0, 1, 2}), InputError) << "boxes are half-open";
  try {
    (void)leaf(xy, ids, {1e-9, 0, 1, 2});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("e-09 to below 1 and y from 0 to below 2"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW((void)leaf(xy, ids, {0, 0, 1.5, 1.5}));
  const Points bad = {0, 0, 1, std::numeric_limits<double>::quiet_NaN(), 0, 1};
  try {
    (void)leaf(bad, ids, box);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 1u);
  }
  EXPECT_THROW((void)finish_leaf(triangulator, std::span<const double>(xy), ids, box, 1u << 24), LimitError);
  const std::vector<std::int32_t> part = {0, 1};
  EXPECT_THROW((void)hash_of(ids, part, {}), std::invalid_argument);
  for (const std::int32_t wrong : {3, -1, std::numeric_limits<std::int32_t>::max()})
    EXPECT_THROW((void)hash_of(ids, std::vector<std::int32_t>{0, 1, wrong}, {}), std::invalid_argument) << wrong;
}

/// Whatever the device's arithmetic is: sides are examined on the host.
TEST_P(Finalization, RefusesOtherArithmetic) {
  Triangulator triangulator(GetParam().options());
  const Points xy = {0, 0, 1, 0, 0, 1};
  const std::vector<std::uint64_t> ids = {1, 2, 3};
  const int before = std::fegetround();
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  EXPECT_THROW((void)finish_leaf(triangulator, std::span<const double>(xy), ids, TileBox{0, 0, 2, 2}, 0), Error);
  EXPECT_THROW((void)finish_join(triangulator, {}, TileBox{}, 0), Error);
  std::fesetround(before);
}

TEST_P(Finalization, ProgressNeverFalls) {
  Triangulator triangulator(GetParam().options());
  std::vector<double> told;
  triangulator.options().progress = [&](const Progress& progress) { told.push_back(progress.fraction); };
  const auto expect_progress = [&](std::size_t fewest) {
    ASSERT_GE(told.size(), fewest);
    EXPECT_TRUE(std::ranges::is_sorted(told)) << testing::PrintToString(told);
    EXPECT_GE(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    told.clear();
  };
  const Points all = uniform_points(6000, 5);
  Points halves[2];
  std::vector<std::uint64_t> ids[2];
  double middle = 0;
  for (std::size_t i = 0; i < all.size(); i += 2) middle += 2 * all[i] / static_cast<double>(all.size());
  for (std::size_t i = 0; i < all.size(); i += 2) {
    const int side = all[i] < middle ? 0 : 1;
    halves[side].insert(halves[side].end(), {all[i], all[i + 1]});
    ids[side].push_back(i / 2);
  }
  TileBox boxes[2];
  boxes[0].max_x = boxes[1].min_x = middle;
  std::vector<Open> open;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto number = static_cast<std::uint32_t>(side);
    open.push_back(
        finish_leaf(triangulator, std::span<const double>(halves[side]), ids[side], boxes[side], number).open);
    expect_progress(5);
  }
  (void)finish_join(triangulator, open, TileBox{}, 2);
  expect_progress(5);
  (void)finish_leaf(triangulator, PointsView(), {}, boxes[0], 3);
  expect_progress(1);
  EXPECT_TRUE(triangulator.options().progress) << "it is the caller's again";
  (void)triangulator.triangulate(std::span<const double>(all));
  expect_progress(5);
}

/// A join that is told something wrong finds it.
TEST_P(Finalization, JoinsFindWhatChildrenGetWrong) {
  Triangulator triangulator(GetParam().options());
  const Points xy = uniform_points(900, 12);
  const Triangulation mesh = triangulator.triangulate(std::span<const double>(xy));
  const auto found = [&](const std::function<void(FinishedNode&)>& tamper) {
    std::size_t calls = 0;
    TileOptions options;
    options.tile_points = 100;
    options.tamper = [&](FinishedNode& node) {
      if (++calls == 2) tamper(node);
    };
    try {
      const TiledMesh tiled = triangulate_by_tiles(triangulator, xy, options);
      require_complete(tiled.sums);
      return tiled.triangles != linked_triangles(mesh);
    } catch (const Error&) {
      return true;
    } catch (const std::logic_error&) {
      return true;
    }
  };
  EXPECT_FALSE(found([](FinishedNode&) {}));
  EXPECT_TRUE(found([](FinishedNode& node) { node.open.sides.pop_back(); })) << "a side dropped";
  EXPECT_TRUE(found([](FinishedNode& node) { std::swap(node.open.sides[0].from, node.open.sides[0].to); }));
  EXPECT_TRUE(found([](FinishedNode& node) {
    OpenSide& side = node.open.sides[3];
    side.apex_x = node.open.xy[2 * std::size_t{side.from}];
    side.apex_y = node.open.xy[2 * std::size_t{side.from} + 1];
  })) << "an apex that is no triangle's";
  EXPECT_TRUE(found([](FinishedNode& node) {
    std::swap(node.open.sides[0].row, node.open.sides[1].row);
    std::swap(node.open.sides[0].triangle, node.open.sides[1].triangle);
  })) << "links swapped";
  EXPECT_TRUE(found([](FinishedNode& node) { node.open.sides.push_back(node.open.sides[0]); })) << "a side twice";
  EXPECT_TRUE(found([](FinishedNode& node) {
    // a vertex dropped that no side ends in, or else the last
    std::set<std::uint32_t> ends;
    for (const OpenSide& side : node.open.sides) ends.insert({side.from, side.to});
    std::uint32_t drop = static_cast<std::uint32_t>(node.open.ids.size()) - 1;
    while (drop > 0 && ends.contains(drop)) --drop;
    node.open.ids.erase(node.open.ids.begin() + drop);
    node.open.xy.erase(node.open.xy.begin() + 2 * drop, node.open.xy.begin() + 2 * drop + 2);
    for (OpenSide& side : node.open.sides) {
      if (side.from > drop) --side.from;
      if (side.to > drop) --side.to;
    }
  })) << "a vertex dropped";
  EXPECT_TRUE(found([](FinishedNode& node) { std::swap(node.open.ids[0], node.open.ids[1]); }));
  EXPECT_TRUE(found([](FinishedNode& node) { node.sums.certified_edges -= 1; }));
}

/// A side whose triangle is not Delaunay: the join that closes its edge says so.
TEST_P(Finalization, JoinsExamineEdges) {
  Triangulator triangulator(GetParam().options());
  const Points xy = uniform_points(900, 12);
  for (const bool wrong : {false, true}) {
    std::size_t calls = 0;
    TileOptions options;
    options.tile_points = 450;
    options.tamper = [&](FinishedNode& node) {
      if (++calls != 1) return;
      // The apex comes near the edge: the disc of the triangle grows over the vertex across.
      OpenSide& side = node.open.sides[node.open.sides.size() / 2];
      const double* a = &node.open.xy[2 * std::size_t{side.from}];
      const double* b = &node.open.xy[2 * std::size_t{side.to}];
      const double x = (a[0] + b[0]) / 2, y = (a[1] + b[1]) / 2, part = wrong ? 1e-3 : 1;
      side.apex_x = x + part * (side.apex_x - x);
      side.apex_y = y + part * (side.apex_y - y);
    };
    if (wrong) {
      EXPECT_THROW((void)triangulate_by_tiles(triangulator, xy, options), InternalError);
    } else {
      EXPECT_NO_THROW((void)triangulate_by_tiles(triangulator, xy, options));
    }
  }
}

TEST(FinalizationOfPoints, SumsThatAreWrong) {
  NodeSums square{
      .points = 4, .distinct = 4, .triangles = 2, .hull_edges = 4, .certified_edges = 1, .dimension = 2, .hash = {}};
  EXPECT_NO_THROW(require_complete(square));
  NodeSums more = square, unexamined = square;
  more.triangles = 3;
  unexamined.certified_edges = 0;
  EXPECT_THROW(require_complete(more), InternalError);
  EXPECT_THROW(require_complete(unexamined), InternalError);
  NodeSums nothing;
  EXPECT_NO_THROW(require_complete(nothing));
}

TEST(FinalizationOfPoints, FloatsAndSeparateArrays) {
  Options options;
  options.backend = Backend::host;
  Triangulator triangulator(options);
  const Points xy = uniform_points(500, 2);
  std::vector<float> narrow(xy.begin(), xy.end());
  std::vector<std::uint64_t> ids(500);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 2 * i;
  const FinishedNode node = finish_leaf(triangulator, std::span<const float>(narrow), ids, {}, 0);
  const Triangulation mesh = triangulator.triangulate(std::span<const float>(narrow));
  EXPECT_EQ(node.part.number_of_triangles(), mesh.number_of_triangles());
  EXPECT_TRUE(std::ranges::equal(node.part.download().triangles, mesh.triangles()));
  EXPECT_TRUE(std::ranges::equal(node.part.download().neighbors, mesh.neighbors()));
  std::vector<std::int32_t> triangles(3 * mesh.number_of_triangles(), 77), neighbors(triangles),
      few(triangles.size() - 1);
  node.part.download(triangles, neighbors);
  EXPECT_TRUE(std::ranges::equal(triangles, mesh.triangles()));
  EXPECT_TRUE(std::ranges::equal(neighbors, mesh.neighbors()));
  EXPECT_THROW(node.part.download(triangles, few), std::invalid_argument);
  EXPECT_THROW(node.part.download(few, neighbors), std::invalid_argument);
  EXPECT_TRUE(node.open.ids.empty());
}

TEST(FinalizationOfPoints, NothingAndOnePoint) {
  Options options;
  options.backend = Backend::host;
  Triangulator triangulator(options);
  const FinishedNode nothing = finish_leaf(triangulator, PointsView(), {}, {}, 0);
  EXPECT_EQ(nothing.sums.dimension, -1);
  require_complete(nothing.sums);
  EXPECT_EQ(hash_of(nothing.sums), triangulator.triangulate(PointsView()).hash());
  const Points one = {4, 5};
  const std::vector<std::uint64_t> id = {7};
  const FinishedNode leaf = finish_leaf(triangulator, std::span<const double>(one), id, {0, 0, 9, 9}, 0);
  EXPECT_EQ(leaf.open.ids, id);
  EXPECT_EQ(leaf.open.xy, one);
}

CADT_ON_MAIN_BACKENDS(Finalization);

}  // namespace
}  // namespace cadt::test
