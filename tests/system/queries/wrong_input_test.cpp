// SPDX-License-Identifier: Apache-2.0
#include "tests/system/queries/brute_force.hpp"
#include "tests/system/resident/resident.hpp"

#include <cmath>
#include <limits>

namespace cadt::test {
namespace {

class WrongInput : public BackendTest {
 protected:
  Points xy = uniform_points(120, 2);
  Triangulation mesh = triangulate(std::span<const double>(xy), on_host_options());
  static Options on_host_options() {
    Options options;
    options.backend = Backend::host;
    return options;
  }
};

TEST_P(WrongInput, QueriesThatAreNotFiniteHaveAnIndex) {
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  for (const double bad :
       {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()})
    for (const std::size_t at : {0u, 3u, 9u}) {
      Points where(20, 0.5);
      where[2 * at + 1] = bad;
      where[19] = std::nan("");
      const std::vector<double> values(120, 1.0);
      const auto check = [&](const auto& call) {
        const auto error = thrown<InputError>(call);
        ASSERT_NE(error, nullptr);
        EXPECT_EQ(error->index(), at);
        EXPECT_EQ(std::string(error->what()).substr(0, 6), "query ");
      };
      check([&] { (void)queries.locate(where); });
      check([&] { (void)queries.nearest_vertices(where, 3); });
      check([&] { (void)queries.interpolate(values, where); });
    }
  EXPECT_EQ(queries.locate(Points{0.5, 0.5}).size(), 1u);
}

TEST_P(WrongInput, SizesThatDoNotFit) {
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const Points where = {0.5, 0.5};
  EXPECT_THROW((void)queries.interpolate(std::vector<double>(119), where), InputError);
  EXPECT_THROW((void)queries.interpolate(std::vector<double>(), where), InputError);
  EXPECT_EQ(queries.interpolate(std::vector<double>(360, 2.0), where).size(), 3u);
  EXPECT_THROW((void)queries.rasterize({0, 0, 1, 1, 2, 2}, std::vector<double>(240)), InputError);
  try {
    (void)queries.nearest_vertices(where, 0);
    ADD_FAILURE() << "no error";
  } catch (const OptionError& error) {
    EXPECT_STREQ(error.what(), "k: must be at least 1");
  }
  EXPECT_THROW((void)queries.nearest_vertices(where, std::size_t{1} << 31), LimitError);
  EXPECT_THROW(MeshQueries(std::span<const double>(xy).subspan(2), mesh, GetParam().options()), InputError);
}

TEST_P(WrongInput, Grids) {
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const std::vector<double> values(120, 1.0);
  const double inf = std::numeric_limits<double>::infinity();
  for (const Grid& grid :
       {Grid{inf, 0, 1, 1, 2, 2}, Grid{0, std::nan(""), 1, 1, 2, 2}, Grid{0, 0, 0, 1, 2, 2}, Grid{0, 0, 1, 0, 2, 2},
        Grid{0, 0, 1e308, 1, 5, 2}, Grid{0, 0, 1, 1, 2, 2, 0, std::size_t{0} - 1}})
    EXPECT_THROW((void)queries.rasterize(grid, values), InputError);
  EXPECT_THROW((void)queries.rasterize({0, 0, 1, 1, 1u << 16, 1u << 16}, values), LimitError);
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW((void)queries.rasterize({0, 0, 1, 1, most, 1}, values), LimitError);
  EXPECT_TRUE(queries.rasterize({0, 0, 1, 1, 0, most}, values).empty());
  EXPECT_TRUE(queries.rasterize({0, 0, 1, 1, most, 0}, values).empty());
  EXPECT_THROW((void)queries.rasterize({0, 0, 1, 1, 2, 2}, values, Interpolation::linear, std::nan("")), OptionError);
  EXPECT_THROW((void)queries.rasterize({0, 0, 1, 1, 2, 2}, values, Interpolation::linear, -1), OptionError);
  EXPECT_TRUE(queries.rasterize({0, 0, 1, 1, 0, 2}, values).empty());
  EXPECT_THROW((void)queries.voronoi_polygons({0, 0, 0, 1}), InputError);
  EXPECT_THROW((void)queries.voronoi_polygons({0, 0, inf, 1}), InputError);
  EXPECT_THROW((void)queries.outline(std::nan("")), OptionError);
  EXPECT_THROW((void)queries.outline(1, -1), OptionError);
}

TEST_P(WrongInput, ArraysThatAreNoMesh) {
  std::vector<std::int32_t> triangles(mesh.triangles().begin(), mesh.triangles().end()),
      neighbors(mesh.neighbors().begin(), mesh.neighbors().end());
  const auto open = [&] {
    MeshQueries(std::span<const double>(xy), MeshView{triangles, neighbors, {}, {}}, GetParam().options());
  };
  open();
  const auto refused_at = [&](std::int32_t& word, std::int32_t wrong, std::size_t triangle) {
    const std::int32_t right = std::exchange(word, wrong);
    const auto error = thrown<InputError>(open);
    ASSERT_NE(error, nullptr);
    EXPECT_LE(error->index(), triangle);
    word = right;
  };
  refused_at(triangles[3 * 50], 120, 50);
  refused_at(triangles[3 * 50 + 1], -1, 50);
  refused_at(triangles[3 * 50 + 2], triangles[3 * 50], 50);
  refused_at(triangles[3 * 50 + 2], triangles[3 * 51], 50);
  refused_at(neighbors[3 * 60], static_cast<std::int32_t>(triangles.size() / 3), 60);
  refused_at(neighbors[3 * 60 + 1], 60, 60);
  refused_at(neighbors[3 * 60 + 2], neighbors[3 * 60 + 2] == 7 ? 8 : 7, 60);
  refused_at(neighbors[0], std::numeric_limits<std::int32_t>::min(), 0);
  neighbors.pop_back();
  EXPECT_THROW(open(), InputError);
  neighbors.clear();
  EXPECT_THROW(open(), InputError);
}

/// A mesh of other points of the same number: whatever the answers, the calls end.
TEST_P(WrongInput, PointsOfAnotherMeshEndTheWalk) {
  const Points others = uniform_points(120, 99);
  MeshQueries queries(std::span<const double>(others), mesh, GetParam().options());
  const std::vector<double> values(120, 1.0);
  const Asked set("", xy);
  const auto ends = [&](const auto& call) {
    try {
      call();
    } catch (const InputError&) {
    }
  };
  ends([&] { (void)queries.locate(set.queries); });
  ends([&] { (void)queries.nearest_vertices(set.queries, 3); });
  ends([&] { (void)queries.interpolate(values, set.queries, Interpolation::natural); });
  ends([&] { (void)queries.rasterize({0, 0, 0.1, 0.1, 10, 10}, values); });
  ends([&] { (void)queries.voronoi_polygons({-1, -1, 2, 2}); });
}

TEST_P(WrongInput, StopEndsACall) {
  cadt::stop_source source;
  Options options = GetParam().options();
  options.stop = source.get_token();
  std::vector<std::string> phases;
  options.progress = [&](const Progress& p) { phases.emplace_back(p.phase); };
  MeshQueries queries(std::span<const double>(xy), mesh, options);
  EXPECT_EQ(queries.locate(Points{0.5, 0.5}).size(), 1u);
  EXPECT_FALSE(phases.empty());
  source.request_stop();
  EXPECT_THROW((void)queries.locate(Points{0.5, 0.5}), Cancelled);
}

TEST_P(WrongInput, LittleMemoryIsRefused) {
  Options options = GetParam().options();
  options.max_memory = 4 * xy.size() / 2 - 1;  // a word of each point is needed at once
  EXPECT_THROW(MeshQueries(std::span<const double>(xy), mesh, options), OutOfMemory);
  options.max_memory = 1000;  // the first queries need more
  EXPECT_THROW((void)MeshQueries(std::span<const double>(xy), mesh, options).locate(std::span<const double>(xy)),
               OutOfMemory);
}

CADT_ON_MAIN_BACKENDS(WrongInput);

}  // namespace
}  // namespace cadt::test
