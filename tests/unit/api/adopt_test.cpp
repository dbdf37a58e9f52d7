// SPDX-License-Identifier: Apache-2.0
// Meshes of other programs: right ones are adopted with all that a mesh of the library has, wrong ones are refused.
#include "tests/unit/api/meshes.hpp"

#include <algorithm>
#include <cfenv>
#include <limits>
#include <string>

namespace cadt::test {
namespace {

using Words = std::vector<std::int32_t>;

void expect_equal(const Triangulation& adopted, const Triangulation& mesh) {
  EXPECT_TRUE(std::ranges::equal(adopted.triangles(), mesh.triangles()));
  EXPECT_TRUE(std::ranges::equal(adopted.neighbors(), mesh.neighbors()));
  EXPECT_TRUE(std::ranges::equal(adopted.hull(), mesh.hull()));
  EXPECT_TRUE(std::ranges::equal(adopted.duplicates(), mesh.duplicates()));
  EXPECT_EQ(adopted.number_of_points(), mesh.number_of_points());
  EXPECT_EQ(adopted.dimension(), mesh.dimension());
  EXPECT_EQ(adopted.vertex_triangle(), mesh.vertex_triangle());
  EXPECT_EQ(adopted.hash(), mesh.hash());
  EXPECT_EQ(adopted.statistics().points, mesh.number_of_points());
}

TEST(Adopt, WhatTheLibraryMakes) {
  for_each_mesh([](const Points& xy, const Triangulation& mesh) {
    expect_equal(Triangulation::adopt(xy, mesh.triangles()), mesh);
    expect_equal(Triangulation::adopt(xy, mesh.triangles(), mesh.neighbors()), mesh);
    const Triangulation believed = Triangulation::adopt(xy, mesh.triangles(), {}, Trust::geometry);
    expect_equal(believed, mesh);
    EXPECT_TRUE(verify(xy, believed).ok);
  });
}

TEST(Adopt, NothingWithoutIeeeArithmetic) {
  const Points xy = {0, 0, 1, 0, 0, 1};
  const Words triangles = {0, 1, 2};
  const int before = std::fegetround();
  for (const Trust trust : {Trust::verify, Trust::geometry}) {
    ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
    EXPECT_THROW((void)Triangulation::adopt(xy, triangles, {}, trust), Error);
    std::fesetround(before);
  }
}

/// The check that refuses a mesh, and where; "none" if it is adopted.
struct Refusal {
  std::string check;
  std::int64_t first;
  friend bool operator==(const Refusal&, const Refusal&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Refusal& r) { return out << r.check << ' ' << r.first; }
};
Refusal refusal(const Points& xy, const Words& triangles, const Words& neighbors = {}, Trust trust = Trust::verify) {
  try {
    static_cast<void>(Triangulation::adopt(xy, triangles, neighbors, trust));
  } catch (const InvalidMesh& error) {
    EXPECT_NE(std::string(error.what()).find(error.check()), std::string::npos);
    return {error.check(), error.first()};
  }
  return {"none", -1};
}
Refusal refusal_on_trust(const Points& xy, const Words& triangles, const Words& neighbors = {}) {
  return refusal(xy, triangles, neighbors, Trust::geometry);
}

const Points square = {0, 0, 1, 0, 1, 1, 0, 1}, kite = {0, 0, 4, 0, 2, 1, 2, -1};

TEST(Adopt, TiesAsTheOtherProgramDecidedThem) {
  const Words one = {0, 1, 2, 0, 2, 3}, other = {0, 1, 3, 1, 2, 3};
  EXPECT_EQ(refusal(square, one), (Refusal{"none", -1}));
  EXPECT_EQ(refusal(square, other), (Refusal{"none", -1}));
}

TEST(Adopt, GeometryIsVerifiedOrBelieved) {
  const Words illegal = {0, 1, 2, 0, 3, 1};  // the long diagonal
  EXPECT_EQ(refusal(kite, illegal).check, "delaunay");
  EXPECT_EQ(refusal_on_trust(kite, illegal).check, "none");
  const Words clockwise = {0, 2, 1, 0, 1, 3};
  EXPECT_EQ(refusal(kite, clockwise), (Refusal{"orientation", 0}));
  EXPECT_EQ(refusal_on_trust(kite, clockwise).check, "none");
  EXPECT_EQ(refusal(square, {}).check, "vertices");  // not collinear
  EXPECT_EQ(refusal(square, {0, 1, 2}).check, "vertices");
}

TEST(Adopt, StructureIsNeverBelieved) {
  for (const Trust trust : {Trust::verify, Trust::geometry}) {
    EXPECT_EQ(refusal(square, {0, 1}, {}, trust), (Refusal{"counts", -1}));
    EXPECT_EQ(refusal(square, {0, 1, 2, 0, 2, 3}, {-1, -1, -1}, trust), (Refusal{"counts", -1}));
    EXPECT_EQ(refusal(square, {0, 1, 2, 0, 2, 4}, {}, trust), (Refusal{"range", 1}));
    EXPECT_EQ(refusal(square, {0, 1, 2, -1, 2, 3}, {}, trust), (Refusal{"range", 1}));
    EXPECT_EQ(refusal(square, {0, 1, 1, 0, 2, 3}, {}, trust), (Refusal{"range", 0}));
    EXPECT_EQ(refusal(square, {0, 1, 2, 0, 2, 3}, {-1, 2, -1, -1, -1, 0}, trust), (Refusal{"range", 0}));
    EXPECT_EQ(refusal(square, {0, 1, 2, 0, 2, 3}, {-1, 1, -1, -1, 0, -1}, trust).check, "neighbors");
    EXPECT_EQ(refusal(square, {0, 1, 2, 0, 1, 2}, {}, trust).check, "neighbors");
  }
  EXPECT_EQ(refusal_on_trust(square, {0, 1, 2}), (Refusal{"vertices", 3}));
  // Two triangles with one vertex in common: a boundary that meets itself.
  EXPECT_EQ(refusal_on_trust({0, 0, 1, 0, 0, 1, -1, 0, 0, -1}, {0, 1, 2, 0, 3, 4}).check, "boundary");
  EXPECT_EQ(refusal_on_trust({0, 0, 1, 0, 0, 1, 5, 5, 6, 5, 5, 6}, {0, 1, 2, 3, 4, 5}).check, "boundary");
  EXPECT_EQ(refusal_on_trust(square, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}).check, "boundary");  // a sphere
}

TEST(Adopt, TheVertexRepresentsItsDuplicates) {
  const Points xy = {0, 0, -0.0, 0, 1, 0, 0, 1, 1, 0};
  const Triangulation mesh = Triangulation::adopt(xy, Words{1, 4, 3});  // others take the last of equal points
  const std::vector<Duplicate> expected = {{0, 1}, {2, 4}};
  EXPECT_TRUE(std::ranges::equal(mesh.duplicates(), expected));
  EXPECT_EQ(mesh.duplicate_of(0), 1);
  EXPECT_EQ(mesh.duplicate_of(1), -1);
  EXPECT_EQ(mesh.vertex_triangle(), (Words{0, 0, 0, 0, 0}));
  EXPECT_EQ(mesh.hull().front(), 1);
}

TEST(Adopt, PointsThatAreNoNumbersAreRefused) {
  for (const Trust trust : {Trust::verify, Trust::geometry}) {
    Points xy = square;
    xy[5] = std::numeric_limits<double>::infinity();
    try {
      static_cast<void>(Triangulation::adopt(xy, Words{0, 1, 2, 0, 2, 3}, {}, trust));
      ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.index(), 2u);
    }
  }
}

TEST(Adopt, KeepsThePointsAndNotTheArrays) {
  Words triangles = {0, 1, 2, 0, 2, 3};
  const Triangulation mesh = Triangulation::adopt(square, triangles, {}, Trust::verify, KeepPoints::copy);
  triangles.assign(6, 0);
  EXPECT_EQ(mesh.triangle(1), (std::array<std::int32_t, 3>{0, 2, 3}));
  EXPECT_EQ(mesh.points().size(), 4u);
  EXPECT_NE(mesh.points().x_data(), square.data());
}

}  // namespace
}  // namespace cadt::test
