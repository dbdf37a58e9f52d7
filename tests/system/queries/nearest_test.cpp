// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <algorithm>

namespace cadt::test {
namespace {

class Nearest : public BackendTest {};

TEST_P(Nearest, OneEqualsBruteForceInExactArithmetic) {
  for_each_set(1500, [&](const Asked& set) {
    if (set.mesh.number_of_triangles() == 0) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    for (const Points& where : {set.queries, near_queries(set)}) {  // by the wide kernels, and most by the narrow ones
      const auto found = queries.nearest_vertex(where);
      ASSERT_EQ(found.size(), where.size() / 2);
      for (std::size_t q = 0; q < found.size(); ++q)
        ASSERT_EQ(std::vector{found[q]}, nearest(set, where[2 * q], where[2 * q + 1], 1))
            << "query " << q << ": " << where[2 * q] << " " << where[2 * q + 1];
    }
  });
}

TEST_P(Nearest, SeveralAreAsNearAsBruteForceFindsThem) {
  for_each_set(400, [&](const Asked& set) {
    if (set.mesh.number_of_triangles() == 0) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    constexpr std::size_t k = 7;
    const Points where = near_queries(set);
    const auto found = queries.nearest_vertices(where, k);
    ASSERT_EQ(found.size(), k * where.size() / 2);
    for (std::size_t q = 0; q < where.size() / 2; q += 3) {
      const double x = where[2 * q], y = where[2 * q + 1];
      const auto expected = nearest(set, x, y, k);
      std::vector<std::int32_t> row(found.begin() + static_cast<std::ptrdiff_t>(k * q),
                                    found.begin() + static_cast<std::ptrdiff_t>(k * q + k));
      for (std::size_t i = expected.size(); i < k; ++i) ASSERT_EQ(row[i], -1);
      row.resize(expected.size());
      for (std::size_t i = 0; i < row.size(); ++i) {
        ASSERT_GE(row[i], 0);
        ASSERT_EQ(compare_distances(set, x, y, row[i], expected[i]), 0) << "query " << q << ", place " << i;
      }
      // Equally near ones by index, but for those at the very smallest distance.
      std::size_t first = 1;
      while (first < row.size() && compare_distances(set, x, y, expected[0], expected[first]) == 0) ++first;
      for (std::size_t i = first; i < row.size(); ++i)
        ASSERT_EQ(row[i], expected[i]) << "query " << q << ", place " << i;
      std::ranges::sort(row);
      ASSERT_EQ(std::ranges::adjacent_find(row), row.end()) << "a vertex twice, query " << q;
    }
  });
}

TEST_P(Nearest, AllVerticesAndNoMore) {
  for_each_set(120, [&](const Asked& set) {
    if (set.mesh.number_of_triangles() == 0) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    const std::size_t vertices = set.xy.size() / 2 - set.mesh.duplicates().size(), k = 3 * vertices;
    const Points where = near_queries(set);
    for (std::size_t q = 0; q < 3; ++q) {
      auto row = queries.nearest_vertices(Points{where[2 * q], where[2 * q + 1]}, k);
      ASSERT_EQ(row.size(), k);
      ASSERT_TRUE(std::all_of(row.begin() + static_cast<std::ptrdiff_t>(vertices), row.end(),
                              [](std::int32_t v) { return v == -1; }));
      row.resize(vertices);
      for (std::size_t i = 1; i < vertices; ++i)
        ASSERT_LE(compare_distances(set, where[2 * q], where[2 * q + 1], row[i - 1], row[i]), 0) << "place " << i;
      std::ranges::sort(row);
      ASSERT_EQ(std::ranges::adjacent_find(row), row.end()) << "a vertex twice";
      ASSERT_GE(row.front(), 0);
    }
  });
}

/// A launch cannot be stopped, so many vertices of many queries take several.
TEST_P(Nearest, IsCancelledBetweenLaunches) {
  if (GetParam().backend != Backend::host) GTEST_SKIP() << "a GPU takes all of these at once";
  Points xy;
  for (int i = 0; i < 4000; ++i) xy.insert(xy.end(), {i % 61 + 1e-3 * (i % 7), i % 67 + 1e-3 * (i % 5)});
  Options options = GetParam().options();
  std::size_t told = 0;
  stop_source source;
  options.stop = source.get_token();
  options.progress = [&](const Progress& progress) {
    if (progress.phase == "nearest" && ++told == 3) source.request_stop();
  };
  MeshQueries queries(std::span<const double>(xy), triangulate(std::span<const double>(xy), GetParam().options()),
                      options);
  EXPECT_THROW((void)queries.nearest_vertices(xy, 1000), Cancelled);
  EXPECT_EQ(told, 3U);
}

TEST_P(Nearest, OfManyOnACircleAroundTheQueryTheLowest) {
  for (const int n : {3, 4, 5, 12, 64, 300}) {
    // integer points on circles with many: 5^2 13^2 17^2 = 1105^2
    Points xy;
    for (int x = -1105; x <= 1105 && static_cast<int>(xy.size()) < 2 * n; ++x)
      for (int y = -1105; y <= 1105; ++y)
        if (x * x + y * y == 1105 * 1105) xy.insert(xy.end(), {double(x), double(y)});
    std::reverse(xy.begin(), xy.end());
    for (std::size_t i = 0; i < xy.size(); i += 2) std::swap(xy[i], xy[i + 1]);
    for (int i = 0; i < 8; ++i) xy.insert(xy.end(), {2000.0 + i, 100.0 * i * i});
    std::rotate(xy.begin(), xy.begin() + 2 * (n % 5 + 1), xy.end());
    const Asked set("", xy);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    EXPECT_EQ(queries.nearest_vertex(Points{0, 0}), nearest(set, 0, 0, 1));
  }
}

CADT_ON_MAIN_BACKENDS(Nearest);

}  // namespace
}  // namespace cadt::test
