// SPDX-License-Identifier: Apache-2.0
// Triangulation as a value: single elements, copies, points that are kept.
#include "tests/unit/api/meshes.hpp"

#include <algorithm>
#include <optional>

namespace cadt::test {
namespace {

template <class Call>
std::optional<std::size_t> refused_index(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.index();
  }
  return std::nullopt;
}

TEST(Values, ElementsAreThoseOfTheArrays) {
  for_each_mesh([](const Points&, const Triangulation& mesh) {
    for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
      const auto v = mesh.triangle(t);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(v[k], mesh.triangles()[3 * t + k]);
        EXPECT_EQ(mesh.neighbor(t, k), mesh.neighbors()[3 * t + k]);
      }
    }
    std::vector<std::int32_t> representative(mesh.number_of_points(), -1);
    for (const Duplicate& d : mesh.duplicates()) representative[static_cast<std::size_t>(d.point)] = d.representative;
    for (std::size_t p = 0; p < representative.size(); ++p) EXPECT_EQ(mesh.duplicate_of(p), representative[p]) << p;
    const std::size_t t = mesh.number_of_triangles(), n = mesh.number_of_points();
    EXPECT_EQ(refused_index([&] { (void)mesh.triangle(t); }), t);
    EXPECT_EQ(refused_index([&] { (void)mesh.neighbor(t, 0); }), t);
    EXPECT_EQ(refused_index([&] { (void)mesh.duplicate_of(n); }), n);
    if (t != 0) {
      EXPECT_EQ(refused_index([&] { (void)mesh.neighbor(t - 1, 3); }), 3u);
    }
  });
}

TEST(Values, CopiesShareTheArraysAndOutliveEachOther) {
  auto mesh = std::make_unique<Triangulation>(triangulate(uniform_points(1000), one_thread()));
  Triangulation copy = *mesh, assigned;
  assigned = copy;
  const auto hash = mesh->hash();
  const auto triangles = copy.triangles();
  EXPECT_EQ(triangles.data(), mesh->triangles().data());
  mesh.reset();
  EXPECT_EQ(copy.hash(), hash);
  const Triangulation moved = std::move(copy);
  copy = assigned;  // what was moved from can be assigned to
  EXPECT_EQ(copy.hash(), hash);
  EXPECT_EQ(moved.triangles().data(), triangles.data());
}

TEST(Values, PointsAreKeptWhereThatIsAskedFor) {
  Options options = one_thread();
  std::vector<float> xy = {0, 0, 1, 0, 0, 1, 1, 0};
  EXPECT_EQ(triangulate(xy, options).points().size(), 0u);
  options.keep_points = KeepPoints::view;
  const Triangulation viewed = triangulate(xy, options);
  EXPECT_EQ(viewed.points().x_data(), xy.data());
  options.keep_points = KeepPoints::copy;
  const Triangulation kept = triangulate(xy, options);
  EXPECT_TRUE(verify(viewed.points(), viewed).ok);
  xy.assign(8, 7);
  EXPECT_EQ(viewed.points().x(1), 7);
  ASSERT_EQ(kept.points().size(), 4u);
  EXPECT_NE(kept.points().interleaved_doubles(), nullptr);
  EXPECT_EQ(kept.points().y(2), 1);
  EXPECT_TRUE(verify(kept.points(), kept).ok);
  const Triangulation copy = kept;
  EXPECT_EQ(copy.points().x_data(), kept.points().x_data());
  EXPECT_EQ(triangulate(PointsView(), options).points().size(), 0u);
}

}  // namespace
}  // namespace cadt::test
