// SPDX-License-Identifier: Apache-2.0
// The catalogue of hard inputs in every order, at its size, at ten times its size and at as many points as work-groups
// have items, one fewer and one more. Each mesh equals that of CGAL (without it: that of the serial host, verified).
//
// CADT_CATALOGUE=all: ten times the size, and all sizes of groups, on all configurations; some minutes for a back end.
#include "tests/support/orders.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::test {
namespace {

bool whole_catalogue() {
  const char* text = std::getenv("CADT_CATALOGUE");
  return text != nullptr && std::string_view(text) == "all";
}

class InEveryOrder : public BackendTest {
 protected:
  void SetUp() override {
    BackendTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
    for (const BackendCase& c : cases_of(GetParam().backend)) {
      if (whole_catalogue() || c.name == GetParam().name) triangulators_.emplace_back(c.options());
    }
    ASSERT_FALSE(triangulators_.empty());
  }

  void TearDown() override { RecordProperty("meshes", std::to_string(meshes_)); }

  void check(const Points& xy, const std::string& what) {
    check_orders(xy, what);
    if (const Points inside = inside_first_triangle(xy); !inside.empty()) {
      const ExpectedMesh expected = expected_mesh(inside);
      for (Triangulator& triangulator : triangulators_) {
        EXPECT_TRUE(same_mesh(triangulator.triangulate(std::span<const double>(inside)), expected))
            << what << " in one triangle";
        ++meshes_;
      }
    }
  }

  static std::vector<std::string> names() {
    std::vector<std::string> result;
    for (const ExactCounts& counts : expected_of_catalogue())
      if (!counts.not_finite) result.push_back(counts.name);
    EXPECT_GT(result.size(), 70U);
    return result;
  }

 private:
  void check_orders(const Points& xy, const std::string& what) {
    const ExpectedMesh expected = expected_mesh(xy);
    for (const PointOrder& order : point_orders()) {
      const std::vector<std::size_t> indices = order.of(xy);
      ASSERT_EQ(indices.size(), xy.size() / 2);
      const Points points = reordered(xy, indices);
      for (Triangulator& triangulator : triangulators_) {
        EXPECT_TRUE(same_but_for_order(triangulator.triangulate(std::span<const double>(points)), expected, indices))
            << what << ", order: " << order.name;
        ++meshes_;
      }
    }
  }

  std::vector<Triangulator> triangulators_;
  std::size_t meshes_ = 0;
};

TEST_P(InEveryOrder, Catalogue) {
  for (const std::string& name : names()) check(catalogue_set(name), name);
}

TEST_P(InEveryOrder, TenTimesTheCatalogue) {
  if (!whole_catalogue()) GTEST_SKIP() << "takes minutes; CADT_CATALOGUE=all runs it";
  for (const std::string& name : names()) check(catalogue_set(name, 10), name + " x 10");
}

// Points of each set, chosen at random: the first ones would be on a line in many.
TEST_P(InEveryOrder, SizesOfWorkGroups) {
  std::vector<std::size_t> groups = {64, 256};
  if (whole_catalogue()) groups = {8, 16, 32, 64, 128, 256, 512, 1024};
  for (const std::string& name : names()) {
    const Points all = shuffled(catalogue_set(name), 5);
    for (const std::size_t items : groups) {
      for (const std::size_t n : {items - 1, items, items + 1}) {
        if (2 * n > all.size()) continue;
        const Points xy(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(2 * n));
        check(xy, std::to_string(n) + " points of " + name);
      }
    }
  }
}
CADT_ON_MAIN_BACKENDS(InEveryOrder);

// The orders would test nothing if they were none, or all the same.
TEST(OrdersOfPoints, ArePermutationsAndDiffer) {
  const Points xy = uniform_points(300, 4);
  std::vector<std::vector<std::size_t>> orders;
  for (const PointOrder& order : point_orders()) {
    orders.push_back(order.of(xy));
    std::vector<std::size_t> indices = orders.back();
    std::sort(indices.begin(), indices.end());
    for (std::size_t i = 0; i < indices.size(); ++i) ASSERT_EQ(indices[i], i) << order.name;
  }
  for (std::size_t i = 0; i < orders.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(orders[i], orders[j]);
}

// A curve goes from cell to neighbouring cell.
TEST(OrdersOfPoints, HilbertNeverJumps) {
  const Points xy = grid_points(32, 32);
  for (const PointOrder& order : point_orders()) {
    if (order.name != "hilbert") continue;
    const Points along = reordered(xy, order.of(xy));
    for (std::size_t i = 2; i < along.size(); i += 2)
      ASSERT_EQ(std::abs(along[i] - along[i - 2]) + std::abs(along[i + 1] - along[i - 1]), 1.0) << i / 2;
  }
}

TEST(OrdersOfPoints, FirstTriangleHasAllPointsInside) {
  for (const Points& xy : {uniform_points(50, 3), scaled(uniform_points(50, 3), -1070),
                           moved(uniform_points(50), 1e15, -1e15), Points{0, 0}, Points{1e300, 1e300, 1e300, -1e300}}) {
    const Points all = inside_first_triangle(xy);
    ASSERT_EQ(all.size(), xy.size() + 6);
    const ExpectedMesh mesh = expected_mesh(all);
    EXPECT_EQ(mesh.hull, (std::vector<std::int32_t>{0, 1, 2}));
  }
  EXPECT_TRUE(inside_first_triangle({1e308, 0, -1e308, 0}).empty());
  EXPECT_TRUE(inside_first_triangle({}).empty());
}

}  // namespace
}  // namespace cadt::test
