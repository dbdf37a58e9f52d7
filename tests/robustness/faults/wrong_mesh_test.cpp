// SPDX-License-Identifier: Apache-2.0
// Meshes that are wrong when they are certified: one of their words was changed on the device. Each count of the
// certification is sufficient for an InternalError, and the triangulator goes on.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <cadt/constrained.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using namespace device_text;
using Reals = std::span<const double>;
using Word = std::uint32_t;
using Face = std::array<Word, 3>;

constexpr Word ghost = CADT_GHOST;

constexpr Word link_of(Word triangle, Word edge) { return triangle << 2 | edge; }

/// The mesh as it is on the device.
struct Mesh {
  std::vector<Face> vertices, half_edges;
  std::vector<cadt_point> points;

  [[nodiscard]] bool real(Word t) const { return std::ranges::count(vertices[t], ghost) == 0; }
  /// The triangle across, and its edge.
  [[nodiscard]] std::pair<Word, Word> across(Word t, Word k) const {
    return {half_edges[t][k] >> 2, half_edges[t][k] & 3U};
  }

  /// An edge that is looked at from this triangle, which is not the first: its link may lead to an earlier one.
  [[nodiscard]] std::pair<Word, Word> edge_to_later() const {
    for (Word t = 1; t < vertices.size(); ++t)
      for (Word k = 0; k < 3; ++k)
        if (across(t, k).first > t && real(t)) return {t, k};
    ADD_FAILURE() << "no edge leads to a later triangle";
    return {0, 0};
  }

  [[nodiscard]] double area(Word a, Word b, Word c) const {
    const cadt_point p = points[a], q = points[b], r = points[c];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }
  /// Flips an edge between two triangles whose corners are a convex quadrilateral: what it becomes is illegal.
  void flip_an_edge() {
    for (Word t = 0; t < vertices.size(); ++t) {
      for (Word k = 0; k < 3; ++k) {
        const auto [u, j] = across(t, k);
        if (!real(t) || !real(u)) continue;
        const Word p = vertices[t][k], a = vertices[t][(k + 1) % 3], b = vertices[t][(k + 2) % 3], q = vertices[u][j];
        if (area(p, a, q) <= 1e-6 || area(p, q, b) <= 1e-6) continue;
        // a, b and q, p keep their slots where they can: {p, a, q} and {q, b, p}
        const Word beside_a = half_edges[u][(j + 1) % 3], beside_b = half_edges[t][(k + 1) % 3];
        vertices[t][(k + 2) % 3] = q;
        vertices[u][(j + 2) % 3] = p;
        const auto join = [&](Word triangle, Word edge, Word link) {
          half_edges[triangle][edge] = link;
          half_edges[link >> 2][link & 3U] = link_of(triangle, edge);
        };
        join(t, k, beside_a);
        join(u, j, beside_b);
        join(t, (k + 1) % 3, link_of(u, (j + 1) % 3));
        return;
      }
    }
    ADD_FAILURE() << "no edge can be flipped";
  }

  /// The position of a point of `row`. Points on the device are scaled by a power of two.
  [[nodiscard]] Word at(double x, double y) const {
    const double scale = std::ranges::max_element(points, {}, &cadt_point::y)->y / 5;
    for (Word v = 0; v < points.size(); ++v)
      if (points[v].x == scale * x && points[v].y == scale * y) return v;
    ADD_FAILURE() << "there is no such point";
    return 0;
  }
  /// Other triangles, as many, linked by their edges.
  void become(const std::vector<Face>& faces) {
    ASSERT_EQ(faces.size(), vertices.size());
    std::map<std::pair<Word, Word>, Word> sides;
    for (Word t = 0; t < faces.size(); ++t)
      for (Word k = 0; k < 3; ++k) sides[{faces[t][(k + 1) % 3], faces[t][(k + 2) % 3]}] = link_of(t, k);
    vertices = faces;
    for (Word t = 0; t < faces.size(); ++t)
      for (Word k = 0; k < 3; ++k) half_edges[t][k] = sides.at({faces[t][(k + 2) % 3], faces[t][(k + 1) % 3]});
  }
};

/// Four points on a line and one off it.
const Points row = {0, 0, 2, 0, 1, 5, 3, 0, 4, 0};

/// The boundary of the row goes from 0 to 3, back to 2 and on to 4, along a triangle without area: no edge is illegal.
void turn_back(Mesh& mesh) {
  const Word a = mesh.at(0, 0), b = mesh.at(2, 0), top = mesh.at(1, 5), c = mesh.at(3, 0), d = mesh.at(4, 0);
  mesh.become({{a, b, top},
               {a, c, b},
               {b, d, top},
               {ghost, c, a},
               {ghost, b, c},
               {ghost, d, b},
               {ghost, top, d},
               {ghost, a, top}});
}

void lose_an_edge(Mesh& mesh) {
  const auto [t, k] = mesh.edge_to_later();
  mesh.half_edges[t][k] = link_of(0, 0);  // neither side looks at it now
}
void unlink_an_edge(Mesh& mesh) {
  const auto [t, k] = mesh.edge_to_later();
  mesh.half_edges[t][k] = link_of(mesh.half_edges[t][k] >> 2, ((mesh.half_edges[t][k] & 3U) + 1) % 3);
}
void flip_an_edge(Mesh& mesh) { mesh.flip_an_edge(); }

using Change = void (*)(Mesh&);

class WrongMesh : public ResidentTest {
 protected:
  [[nodiscard]] Options options(Strategy strategy) const {
    Options with = ResidentTest::options();
    with.tuning.strategy = strategy;
    return with;
  }

  template <class T>
  static std::vector<T> read_all(Device& device, const Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    device.read(buffer, 0, values.data(), count * sizeof(T));
    return values;
  }

  /// The arrays before the first look at them.
  void change_arrays(Change change) {
    changed = 0;
    faults->before_launch = [this, change](KernelId kernel, std::span<const Arg> args, Device& device) {
      if (kernel != KernelId::cadt_certify || changed++ != 0) return;
      Word all = 0;
      std::memcpy(&all, args[5].value(), sizeof all);
      Mesh mesh{read_all<Face>(device, *args[1].buffer(), all), read_all<Face>(device, *args[2].buffer(), all),
                read_all<cadt_point>(device, *args[0].buffer(), all / 2 + 1)};
      change(mesh);
      device.write(*args[1].buffer(), 0, mesh.vertices.data(), all * sizeof(Face));
      device.write(*args[2].buffer(), 0, mesh.half_edges.data(), all * sizeof(Face));
    };
  }

  /// Changes the locked triangles before the first legality sweep: those in use, as a mesh numbered without gaps.
  void change_locked(std::size_t n, Change change) {
    changed = 0;
    faults->before_launch = [this, n, change](KernelId kernel, std::span<const Arg> args, Device& device) {
      if (kernel != KernelId::cadt_legality_sweep || changed++ != 0) return;
      std::vector<cadt_locked_triangle> triangles = read_all<cadt_locked_triangle>(device, *args[0].buffer(), 2 * n);
      std::vector<Word> used, number(triangles.size());
      for (Word r = 0; r < triangles.size(); ++r)
        if (triangles[r].word[CADT_WORD_LOCK] != 0) number[r] = static_cast<Word>(used.size()), used.push_back(r);
      Mesh mesh;
      mesh.points = read_all<cadt_point>(device, *args[1].buffer(), n);
      for (const Word r : used) {
        Face vertices{}, half_edges{};
        for (std::size_t k = 0; k < 3; ++k) {
          vertices[k] = triangles[r].word[k];
          const Word link = triangles[r].word[CADT_WORD_HALF_EDGE + k];
          half_edges[k] = link_of(number[link >> 2], link & 3U);
        }
        mesh.vertices.push_back(vertices);
        mesh.half_edges.push_back(half_edges);
      }
      change(mesh);
      for (std::size_t t = 0; t < used.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          triangles[used[t]].word[k] = mesh.vertices[t][k];
          triangles[used[t]].word[CADT_WORD_HALF_EDGE + k] =
              link_of(used[mesh.half_edges[t][k] >> 2], mesh.half_edges[t][k] & 3U);
        }
      }
      device.write(*args[0].buffer(), 0, triangles.data(), triangles.size() * sizeof triangles[0]);
    };
  }

  void expect_right(Triangulator& triangulator, const Points& xy) {
    faults->before_launch = nullptr;
    const Triangulation mesh = triangulator.triangulate(Reals(xy));
    EXPECT_EQ(mesh.hash(), on_host(Reals(xy)).hash());
    EXPECT_TRUE(mesh.statistics().certified);
  }

  /// What the error says.
  std::string refused(Triangulator& triangulator, const Points& xy) {
    const auto error = thrown<InternalError>([&] { (void)triangulator.triangulate(Reals(xy)); });
    EXPECT_GT(changed, 0U) << "there was no look at the mesh";
    return error == nullptr ? std::string() : error->what();
  }

  std::size_t changed = 0;  ///< looks at a mesh since a change was asked for
  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

/// The four counts of the certificate.
struct Counts {
  std::uint64_t edges, illegal, unfitting, back;
};

std::optional<Counts> counts_of(const std::string& text) {
  Counts c{};
  std::uint64_t wanted = 0;
  const int found = std::sscanf(text.c_str(),
                                "the mesh has %lu edges, and there should be %lu; %lu are illegal, %lu have sides that "
                                "do not fit, %lu turn back",
                                &c.edges, &wanted, &c.illegal, &c.unfitting, &c.back);
  EXPECT_EQ(found, 5) << text;
  return found == 5 ? std::optional(c) : std::nullopt;
}

TEST_P(WrongMesh, ArraysWithoutAnEdge) {
  Triangulator triangulator(options(Strategy::stars));
  for (const std::size_t n : {300U, 20000U}) {  // wrapped, or by stars and residual vertices
    const Points xy = uniform_points(n, 7);
    change_arrays(lose_an_edge);
    const auto found = counts_of(refused(triangulator, xy));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->edges, 3 * n - 4);
    EXPECT_EQ(found->illegal + found->unfitting + found->back, 0U);
    expect_right(triangulator, xy);
  }
}

TEST_P(WrongMesh, ArraysWithAnIllegalEdge) {
  Triangulator triangulator(options(Strategy::stars));
  for (const std::size_t n : {300U, 20000U}) {
    const Points xy = uniform_points(n, 7);
    change_arrays(flip_an_edge);
    const auto found = counts_of(refused(triangulator, xy));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->edges, 3 * n - 3);
    EXPECT_GE(found->illegal, 1U);
    EXPECT_LE(found->illegal, 5U);
    EXPECT_EQ(found->unfitting + found->back, 0U);
    expect_right(triangulator, xy);
  }
}

TEST_P(WrongMesh, ArraysWithSidesThatDoNotFit) {
  Triangulator triangulator(options(Strategy::stars));
  for (const std::size_t n : {300U, 20000U}) {
    const Points xy = uniform_points(n, 7);
    change_arrays(unlink_an_edge);
    const auto found = counts_of(refused(triangulator, xy));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->edges, 3 * n - 3);
    EXPECT_EQ(found->unfitting, 1U);
    EXPECT_EQ(found->illegal + found->back, 0U);
    expect_right(triangulator, xy);
  }
}

TEST_P(WrongMesh, ArraysWhoseBoundaryTurnsBack) {
  Triangulator triangulator(options(Strategy::stars));
  change_arrays(turn_back);
  const auto found = counts_of(refused(triangulator, row));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->edges, 12U);
  EXPECT_EQ(found->illegal + found->unfitting, 0U);
  EXPECT_EQ(found->back, 2U);
  expect_right(triangulator, row);
}

TEST_P(WrongMesh, LockedTrianglesWithoutAnEdge) {
  Triangulator triangulator(options(Strategy::locks));
  const Points xy = uniform_points(300, 7);
  change_locked(300, lose_an_edge);
  const std::string text = refused(triangulator, xy);
  EXPECT_NE(text.find("has 896 edges instead of 897"), std::string::npos) << text;
  expect_right(triangulator, xy);
}

/// The legality sweep repairs it: that is its purpose.
TEST_P(WrongMesh, LockedTrianglesWithAnIllegalEdge) {
  Triangulator triangulator(options(Strategy::locks));
  const Points xy = uniform_points(300, 7);
  change_locked(300, flip_an_edge);
  const Triangulation mesh = triangulator.triangulate(Reals(xy));
  EXPECT_GE(changed, 2U);
  EXPECT_EQ(mesh.hash(), on_host(Reals(xy)).hash());
  EXPECT_GE(mesh.statistics().legality_sweeps, 2U);
  EXPECT_GE(mesh.statistics().sweep_repairs, 1U);
  EXPECT_EQ(mesh.statistics().certified_edges, 897U);
  expect_right(triangulator, xy);
}

TEST_P(WrongMesh, LockedTrianglesWithAHalfEdgeThatIsNotMutual) {
  Triangulator triangulator(options(Strategy::locks));
  const Points xy = uniform_points(100, 7);
  change_locked(100, unlink_an_edge);
  const std::string text = refused(triangulator, xy);
  // The sweep cannot settle the edge, or it becomes illegal beside another one and gets no locks.
  EXPECT_TRUE(text.find("still finds illegal edges") != std::string::npos ||
              text.find("no progress") != std::string::npos)
      << text;
  expect_right(triangulator, xy);
}

TEST_P(WrongMesh, LockedTrianglesWhoseBoundaryTurnsBack) {
  Triangulator triangulator(options(Strategy::locks));
  change_locked(5, turn_back);
  const std::string text = refused(triangulator, row);
  EXPECT_NE(text.find("turns back at 2 points"), std::string::npos) << text;
  expect_right(triangulator, row);
}

/// With segments the mesh is certified when they are edges; what is constrained need not be legal, but fit.
TEST_P(WrongMesh, WithSegments) {
  const Points xy = uniform_points(300, 7);
  const std::vector<Segment> segments = {{0, 200}, {200, 100}};
  Triangulator triangulator(options(Strategy::stars));
  const auto call = [&] { return triangulator.triangulate_constrained(Reals(xy), segments); };
  const ConstrainedTriangulation expected = call();
  EXPECT_GT(expected.statistics().inserted_segments, 1U);
  for (const Change change : {lose_an_edge, flip_an_edge, unlink_an_edge}) {
    change_arrays(change);
    const auto error = thrown<InternalError>([&] { (void)call(); });
    ASSERT_NE(error, nullptr);
    const auto found = counts_of(error->what());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->edges, change == lose_an_edge ? 896U : 897U);
    EXPECT_EQ(found->unfitting, change == unlink_an_edge ? 1U : 0U);
    EXPECT_EQ(found->illegal != 0, change == flip_an_edge);
    faults->before_launch = nullptr;
    EXPECT_EQ(call().hash(), expected.hash());
  }
}

/// A segment is no edge when it is looked for in the mesh that has all.
TEST_P(WrongMesh, WithoutASegment) {
  const Points xy = uniform_points(300, 7);
  const std::vector<Segment> segments = {{0, 200}};
  Triangulator triangulator(options(Strategy::stars));
  const auto call = [&] { return triangulator.triangulate_constrained(Reals(xy), segments); };
  const ConstrainedTriangulation expected = call();
  int launch = 0;
  faults->before_launch = [&](KernelId kernel, std::span<const Arg> args, Device& device) {
    if (kernel != KernelId::cadt_flag_segments || ++launch != 2) return;
    std::array<Word, 2> ends{};  // of the segment
    device.read(*args[5].buffer(), 0, ends.data(), sizeof ends);
    ends[1] = (ends[1] + 1) % 300;
    device.write(*args[5].buffer(), 0, ends.data(), sizeof ends);
  };
  const auto error = thrown<InternalError>([&] { (void)call(); });
  ASSERT_NE(error, nullptr);
  EXPECT_NE(std::string(error->what()).find("the mesh is wrong at 1 segments"), std::string::npos) << error->what();
  faults->before_launch = nullptr;
  EXPECT_EQ(call().hash(), expected.hash());
}

CADT_ON_MAIN_BACKENDS(WrongMesh);

}  // namespace
}  // namespace cadt::test
