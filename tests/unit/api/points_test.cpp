// SPDX-License-Identifier: Apache-2.0
// Views of points in whatever arrays a caller has: the same coordinates, and the same mesh.
#include "tests/unit/api/meshes.hpp"

#include <deque>
#include <limits>
#include <list>
#include <string>

namespace cadt::test {
namespace {

struct Site {
  double x, y;
};
struct Station {
  std::string name;
  float y, x;  // the other way round
  int code;
};
struct Survey {
  double lon, lat, depth;
};
struct Deep : Survey {
  char quality;
};
#pragma pack(push, 1)
struct Record {
  char kind;
  double x, y;
};
#pragma pack(pop)

const Points some_points = {0.5, 1.5, -2, 4, 7, 8, 1e300, -0.0};

/// The view has the points of `xy`.
void expect_points(const PointsView& view, const Points& xy) {
  ASSERT_EQ(view.size(), xy.size() / 2);
  for (std::size_t i = 0; i < view.size(); ++i) {
    EXPECT_EQ(view.x(i), xy[2 * i]) << i;
    EXPECT_EQ(view.y(i), xy[2 * i + 1]) << i;
  }
}

template <class P>
std::vector<P> points_as(const Points& xy) {
  std::vector<P> points(xy.size() / 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].x = static_cast<decltype(P::x)>(xy[2 * i]);
    points[i].y = static_cast<decltype(P::y)>(xy[2 * i + 1]);
  }
  return points;
}

TEST(PointsView, OfRangesOfPoints) {
  expect_points(points_as<Site>(some_points), some_points);
  expect_points(std::span<const Site>(points_as<Site>(some_points)).subspan(1), {-2, 4, 7, 8, 1e300, -0.0});
  const Points small = {0.5, 1.5, -2, 4, 7, 8};
  expect_points(points_as<Station>(small), small);
  expect_points(points_as<Record>(some_points), some_points);  // unaligned
  expect_points(std::vector<std::array<double, 2>>{{0.5, 1.5}, {-2, 4}, {7, 8}}, small);
  expect_points(std::vector<std::array<float, 3>>{{0.5F, 1.5F, 9}, {-2, 4, 9}, {7, 8, 9}}, small);
  expect_points(std::vector<std::pair<float, float>>{{0.5F, 1.5F}, {-2.0F, 4.0F}, {7.0F, 8.0F}}, small);
  const double rows[][2] = {{0.5, 1.5}, {-2, 4}, {7, 8}}, flat[] = {0.5, 1.5, -2, 4, 7, 8};
  expect_points(rows, small);
  expect_points(flat, small);
  const std::vector<Survey> survey = {{0.5, 1.5, 3}, {-2, 4, 3}, {7, 8, 3}};
  expect_points(PointsView(survey, &Survey::lon, &Survey::lat), small);
  expect_points({survey, &Survey::depth, &Survey::lon}, {3, 0.5, 3, -2, 3, 7});
  std::vector<Deep> deep(2);
  deep[1].lon = 5, deep[1].lat = 6;
  expect_points(PointsView(deep, &Survey::lon, &Survey::lat), {0, 0, 5, 6});
}

TEST(PointsView, OfListsAndSeparateArrays) {
  expect_points({0.5, 1.5, -2.0, 4.0}, {0.5, 1.5, -2, 4});
  expect_points({{0.5, 1.5}, {-2, 4}}, {0.5, 1.5, -2, 4});
  expect_points({}, {});
  const double x[] = {0.5, -2}, y[] = {1.5, 4};
  expect_points({x, y}, {0.5, 1.5, -2, 4});
  const std::vector<float> fx = {0.5F, -2}, fy = {1.5F, 4};
  expect_points({fx, fy}, {0.5, 1.5, -2, 4});
  EXPECT_THROW(PointsView({1.0, 2.0, 3.0}), InputError);
}

TEST(PointsView, SaysHowItsPointsLie) {
  const auto sites = points_as<Site>(some_points);
  const PointsView view(sites);
  EXPECT_TRUE(view.interleaved());
  EXPECT_EQ(view.interleaved_doubles(), &sites[0].x);
  EXPECT_EQ(view.stride(), sizeof(Site));
  const auto records = points_as<Record>(some_points);
  const PointsView packed(records);
  EXPECT_FALSE(packed.interleaved());
  EXPECT_FALSE(packed.separate());
  EXPECT_EQ(packed.interleaved_doubles(), nullptr);
  EXPECT_EQ(packed.stride(), sizeof(Record));
  const double swapped[][2] = {{1, 2}, {3, 4}};
  EXPECT_FALSE(PointsView::strided(&swapped[0][1], &swapped[0][0], 2, 16).interleaved());
  expect_points(PointsView::strided(&swapped[0][1], &swapped[0][0], 2, 16), {2, 1, 4, 3});
  expect_points(PointsView(records).subview(1, 2), {-2, 4, 7, 8});
  EXPECT_TRUE(PointsView(std::vector<double>()).interleaved());
  EXPECT_EQ(PointsView(std::vector<Site>()).size(), 0u);
}

TEST(PointsView, NothingElseBecomesOne) {
  static_assert(!std::convertible_to<std::vector<int>, PointsView>);
  static_assert(!std::convertible_to<std::vector<double*>, PointsView>);
  static_assert(!std::convertible_to<std::vector<std::vector<double>>, PointsView>);
  static_assert(!std::convertible_to<std::vector<std::pair<double, float>>, PointsView>);
  static_assert(!std::convertible_to<std::vector<Survey>, PointsView>);
  static_assert(!std::convertible_to<std::list<Site>, PointsView>);
  static_assert(!std::convertible_to<std::deque<double>, PointsView>);
}

TEST(CopyPoints, FromIteratorsAndGetters) {
  struct Hidden {
    [[nodiscard]] double easting() const { return x; }
    double x = 0;
    int y = 0;
  };
  const std::list<Hidden> list = {{0.5, 1}, {-2, 4}};
  const std::vector<double> xy =
      copy_points(list.begin(), list.end(), &Hidden::easting, [](const Hidden& p) { return 2 * p.y; });
  expect_points(xy, {0.5, 2, -2, 8});
}

/// Every way to give the points leads to the same mesh, alone, in batches, and verified.
template <class P>
void expect_same_meshes(const Points& xy) {
  const std::vector<P> points = points_as<P>(xy);
  Points exact;
  for (const P& p : points) exact.insert(exact.end(), {static_cast<double>(p.x), static_cast<double>(p.y)});
  Triangulator triangulator(one_thread());
  const Triangulation expected = triangulator.triangulate(PointsView(exact));
  const Triangulation mesh = triangulator.triangulate(PointsView(points));
  EXPECT_TRUE(std::ranges::equal(mesh.triangles(), expected.triangles()));
  EXPECT_TRUE(verify(points, mesh).ok);
  EXPECT_TRUE(verify_on_device(points, mesh, one_thread()).ok);
  const std::size_t n = points.size(), offsets[] = {0, n / 3, n / 2, n};
  const auto batch = triangulator.triangulate_batch(points, offsets);
  for (std::size_t s = 0; s < 3; ++s) {
    const Points set(exact.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s]),
                     exact.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s + 1]));
    EXPECT_TRUE(std::ranges::equal(batch.triangles(s), triangulator.triangulate(PointsView(set)).triangles())) << s;
  }
  EXPECT_EQ(triangulator.triangulate_async(PointsView(points)).get().hash(), expected.hash());
}

TEST(PointsView, LeadsToTheSameMesh) {
  for (const Points& xy : {Points(), Points{1, 2}, grid_points(20, 30), uniform_points(5000)}) {
    SCOPED_TRACE(xy.size() / 2);
    expect_same_meshes<Site>(xy);
    expect_same_meshes<Station>(xy);
    expect_same_meshes<Record>(xy);
  }
  expect_same_meshes<Record>(uniform_points(600'000));  // more than are packed in one piece
}

TEST(PointsView, FindsThePointThatIsNoNumber) {
  auto records = points_as<Record>(uniform_points(100));
  records[57].y = std::numeric_limits<double>::quiet_NaN();
  for (const auto& call : {std::function<void()>([&] { (void)triangulate(records, one_thread()); }),
                           std::function<void()>([&] { (void)verify(records, MeshView()); })}) {
    try {
      call();
      ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.index(), 57u);
    }
  }
}

}  // namespace
}  // namespace cadt::test
