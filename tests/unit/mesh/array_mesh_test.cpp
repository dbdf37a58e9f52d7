// SPDX-License-Identifier: Apache-2.0
// The closing pass of a mesh in arrays: what it finds in meshes that are wrong in one place.
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/certify/certify.dev.h"
#pragma GCC diagnostic pop

constexpr std::uint32_t g = CADT_GHOST;

using Face = std::array<std::uint32_t, 3>;
using Found = std::array<std::uint32_t, 4>;  // examined, illegal, wrong, broken

struct Arrays {
  std::vector<std::uint32_t> vertices, half_edges;
  std::uint32_t real = 0;
  std::vector<std::uint32_t> edge_flags;

  explicit Arrays(const std::vector<Face>& faces) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> across;  // edge -> link
    for (std::uint32_t t = 0; t < faces.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        across[{faces[t][(k + 1) % 3], faces[t][(k + 2) % 3]}] = CADT_HALF_EDGE(t, k);
    for (const Face& face : faces) {
      vertices.insert(vertices.end(), face.begin(), face.end());
      for (std::uint32_t k = 0; k < 3; ++k) half_edges.push_back(across.at({face[(k + 2) % 3], face[(k + 1) % 3]}));
      if (face[0] != g && face[1] != g && face[2] != g) ++real;
    }
  }

  /// By so many work-items, in launches of so many triangles.
  [[nodiscard]] Found look(const std::vector<cadt_point>& points, std::uint32_t items = 1, std::uint32_t size = 1000,
                           bool real_in_words = false) const {
    const std::uint32_t known = real_in_words ? CADT_NONE : real;
    const auto all = static_cast<std::uint32_t>(vertices.size() / 3);
    std::vector<std::uint32_t> words((2 + CADT_COUNTER_ROWS) * CADT_COUNTER_STRIDE);
    constexpr std::uint32_t row = CADT_COUNTER_STRIDE;
    words[row + CADT_CERTIFY_REAL] = real;
    for (std::uint32_t begin = 0; begin < all; begin += size) {
      const std::uint32_t count = std::min(size, all - begin), grain = (count - 1) / items + 1;
      for (std::uint32_t item = 0; item < items; ++item)
        cadt_certify(item, items, points.data(), vertices.data(), half_edges.data(),
                     edge_flags.empty() ? nullptr : edge_flags.data(), known, all, 2, begin, count, grain, words.data(),
                     row, 1);
    }
    Found found{};
    std::copy_n(words.begin() + row, found.size(), found.begin());
    return found;
  }
};

/// A square with its centre, and a point to the right of it.
const std::vector<cadt_point> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, {7, 2}};
const std::vector<Face> mesh = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2},
                                {g, 1, 0}, {g, 5, 1}, {g, 2, 5}, {g, 3, 2}, {g, 0, 3}};

TEST(ArrayMesh, IsLookedAtOnce) {
  for (const std::uint32_t items : {1U, 3U, 16U})
    for (const std::uint32_t size : {1U, 4U, 1000U})
      EXPECT_EQ(Arrays(mesh).look(points, items, size), (Found{15, 0, 0, 0})) << items << " items, " << size;
}

TEST(ArrayMesh, NumberOfRealTrianglesInWords) {
  EXPECT_EQ(Arrays(mesh).look(points, 3, 4, true), (Found{15, 0, 0, 0}));
  Arrays none(mesh);
  none.real = 0;
  EXPECT_EQ(none.look(points, 3, 4, true), (Found{0, 0, 0, 0}));
}

TEST(ArrayMesh, IllegalEdge) {
  std::vector<Face> flipped = mesh;  // edge 1, 2 between 4 and 5 becomes 4, 5
  flipped[1] = {1, 5, 4};
  flipped[4] = {4, 5, 2};
  EXPECT_EQ(Arrays(flipped).look(points), (Found{15, 1, 0, 0}));
}

/// An illegal edge may stay if it is constrained; both of its triangles must say so.
TEST(ArrayMesh, ConstrainedEdge) {
  std::vector<Face> flipped = mesh;
  flipped[1] = {1, 5, 4};
  flipped[4] = {4, 5, 2};
  Arrays arrays(flipped);
  arrays.edge_flags.assign(mesh.size(), 0);
  EXPECT_EQ(arrays.look(points), (Found{15, 1, 0, 0}));
  arrays.edge_flags[1] = 1;  // the edge 5, 4
  EXPECT_EQ(arrays.look(points)[2], 1U);
  arrays.edge_flags[4] = 4;
  EXPECT_EQ(arrays.look(points), (Found{15, 0, 0, 0}));
  arrays.edge_flags[1] = 0;
  EXPECT_EQ(arrays.look(points)[2], 1U);
}

TEST(ArrayMesh, HullThatIsNotConvex) {
  // without the triangle 1, 5, 2 the hull is that of the square, and 5 is not in the mesh; move it out instead
  std::vector<cadt_point> moved = points;
  moved[1] = {4, 0};
  moved[5] = {7, -3};  // now 0, 1, 5 turns right
  EXPECT_EQ(Arrays(mesh).look(moved), (Found{15, 1, 0, 0}));
}

TEST(ArrayMesh, LinkThatIsNotMutual) {
  for (std::size_t i = 0; i < 3 * mesh.size(); ++i) {
    Arrays arrays(mesh);
    const std::uint32_t right = arrays.half_edges[i];
    for (const std::uint32_t link : {CADT_HALF_EDGE(9U, 3U), CADT_HALF_EDGE(10U, 0U), CADT_NONE, right ^ 1U}) {
      arrays.half_edges[i] = link;
      EXPECT_GT(arrays.look(points)[2], 0U) << i << ", " << link;
    }
  }
}

TEST(ArrayMesh, SidesWithOtherEnds) {
  // two triangles change places, their half_edges do not: each edge still has two sides that name each other
  Arrays arrays(mesh);
  for (std::size_t k = 0; k < 3; ++k) std::swap(arrays.vertices[k], arrays.vertices[6 + k]);
  EXPECT_GT(arrays.look(points)[2], 0U);
}

TEST(ArrayMesh, GhostAmongTheOthers) {
  Arrays arrays(mesh);
  arrays.real = 6;
  EXPECT_EQ(arrays.look(points), (Found{15, 0, 1, 0}));
  arrays.real = 3;
  EXPECT_EQ(arrays.look(points), (Found{15, 0, 2, 0}));
}

TEST(ArrayMesh, BoundaryThatTurnsBack) {
  const std::vector<cadt_point> row = {{0, 0}, {2, 0}, {1, 5}, {3, 0}, {4, 0}};
  EXPECT_EQ(Arrays({{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {g, 1, 0}, {g, 3, 1}, {g, 4, 3}, {g, 2, 4}, {g, 0, 2}}).look(row),
            (Found{12, 0, 0, 0}));
  EXPECT_EQ(Arrays({{0, 1, 2}, {0, 3, 1}, {1, 4, 2}, {g, 3, 0}, {g, 1, 3}, {g, 4, 1}, {g, 2, 4}, {g, 0, 2}}).look(row),
            (Found{12, 0, 0, 2}));
}

}  // namespace
