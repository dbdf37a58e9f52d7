// SPDX-License-Identifier: Apache-2.0
// The verifier of constrained meshes: whatever is changed in a correct one fails the check that is named for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/constraints/mesh_copy.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

namespace cadt::test {
namespace {

using Data = ConstrainedTriangulation::Data;

/// Two squares, one in the other, a bridge from the outer to the inner one, and points between.
SegmentSet squares() {
  SegmentSet set{"squares", {0, 0, 12, 0, 12, 12, 0, 12, 4, 4, 8, 4, 8, 8, 4, 8}, {}};
  const std::vector<double> others = {2, 1, 6, 0, 1, 6, 5, 6, 7, 5, 10, 3, 10, 9, 3, 10, 14, 6, -2, 5, 6, 14, 4, 0};
  set.xy.insert(set.xy.end(), others.begin(), others.end());
  set.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7},
                  {7, 4}, {0, 4}, {0, 4}, {4, 6}, {4, 6}, {4, 5}};
  return set;
}

/// A mesh as arrays, to be changed.
struct Parts {
  SegmentSet set = squares();
  ConstraintOptions options;
  std::vector<std::int32_t> triangles, neighbors;
  std::unique_ptr<Data> data;

  explicit Parts(Domain domain = Domain::even_odd) {
    options.domain = domain;
    if (domain == Domain::even_odd || domain == Domain::nonzero) set.segments.resize(8);  // closed
    if (domain == Domain::seeds) {
      options.holes = {{6.5, 6.5}};
      options.regions = {{1, 11, 7.5}, {-1, 5.5, 2.5}};
    }
    Options host;
    host.backend = Backend::host;
    host.threads = 1;
    const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, options, host);
    triangles.assign(mesh.mesh().triangles().begin(), mesh.mesh().triangles().end());
    neighbors.assign(mesh.mesh().neighbors().begin(), mesh.mesh().neighbors().end());
    data = copy_of(mesh);
  }

  [[nodiscard]] std::size_t across(std::size_t t, std::size_t k) const {
    return static_cast<std::size_t>(neighbors[3 * t + k]);
  }
  [[nodiscard]] bool constrained(std::size_t t, std::size_t k) const { return (data->edge_flags[t] >> k & 1U) != 0; }
  /// The edge of the neighbour that leads back.
  [[nodiscard]] std::size_t back(std::size_t t, std::size_t k) const {
    for (std::size_t j = 0; j < 3; ++j)
      if (neighbors[3 * across(t, k) + j] == static_cast<std::int32_t>(t)) return j;
    return 3;
  }
  /// Each interior edge, from its lower triangle.
  void each_edge(const std::function<void(std::size_t, std::size_t)>& use) const {
    for (std::size_t t = 0; t < triangles.size() / 3; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (neighbors[3 * t + k] > static_cast<std::int32_t>(t)) use(t, k);
  }

  /// Flips edge k of triangle t; whether it can be flipped. Flags go with their edges, and so does that of the flipped
  /// one.
  bool flip(std::size_t t, std::size_t k) {
    const std::size_t u = across(t, k), j = back(t, k);
    const auto place = [&](std::int32_t v) {
      const auto i = 2 * static_cast<std::size_t>(v);
      return std::array<double, 2>{set.xy[i], set.xy[i + 1]};
    };
    const std::int32_t x = triangles[3 * t + k], v = triangles[3 * t + (k + 1) % 3], w = triangles[3 * t + (k + 2) % 3],
                       y = triangles[3 * u + j];
    if (exact_orientation(place(x), place(v), place(y)) <= 0 || exact_orientation(place(x), place(y), place(w)) <= 0)
      return false;
    struct Side {
      std::int32_t across;
      std::uint32_t flag;
    };
    const auto side = [&](std::size_t of, std::size_t e) {
      return Side{neighbors[3 * of + e % 3], data->edge_flags[of] >> (e % 3) & 1U};
    };
    const Side wx = side(t, k + 1), xv = side(t, k + 2), vy = side(u, j + 1), yw = side(u, j + 2), own = side(t, k);
    const auto set_triangle = [&](std::size_t of, const std::array<std::int32_t, 3>& corners,
                                  const std::array<Side, 3>& sides) {
      data->edge_flags[of] = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        triangles[3 * of + e] = corners[e];
        neighbors[3 * of + e] = sides[e].across;
        data->edge_flags[of] |= sides[e].flag << e;
      }
    };
    const auto at_t = static_cast<std::int32_t>(t), at_u = static_cast<std::int32_t>(u);
    const auto moves = [&](std::int32_t n, std::int32_t from, std::int32_t to) {
      for (std::size_t e = 0; n >= 0 && e < 3; ++e)
        if (auto& value = neighbors[3 * static_cast<std::size_t>(n) + e]; value == from) value = to;
    };
    moves(vy.across, at_u, at_t);
    moves(wx.across, at_t, at_u);
    set_triangle(t, {x, v, y}, {vy, Side{at_u, own.flag}, xv});
    set_triangle(u, {x, y, w}, {yw, wx, Side{at_t, own.flag}});
    data->mesh = Triangulation::adopt(set.xy, triangles, neighbors, Trust::geometry);
    return true;
  }

  /// The names of the checks that fail.
  [[nodiscard]] std::string failures() {
    const VerifyReport report = verify(set.xy, set.segments, ConstrainedTriangulation(std::move(data)), options);
    std::string names;
    for (const Check& check : report.checks)
      if (!check.passed) names += (names.empty() ? "" : " ") + check.name;
    EXPECT_EQ(report.ok, names.empty());
    return names;
  }
};

const std::vector<Domain> all_domains = {Domain::hull,    Domain::outer,  Domain::even_odd,
                                         Domain::nonzero, Domain::layers, Domain::seeds};

TEST(VerifySegments, CorrectMeshes) {
  for (const Domain domain : all_domains) EXPECT_EQ(Parts(domain).failures(), "") << static_cast<int>(domain);
}

TEST(VerifySegments, BitDropped) {
  Parts().each_edge([](std::size_t t, std::size_t k) {
    Parts parts;
    if (!parts.constrained(t, k)) return;
    parts.data->edge_flags[parts.across(t, k)] ^= 1U << parts.back(t, k);
    parts.data->edge_flags[t] ^= 1U << k;
    const std::string failures = parts.failures();
    EXPECT_TRUE(failures == "constraints" || failures == "delaunay constraints") << failures;
  });
}

TEST(VerifySegments, BitAdded) {
  Parts().each_edge([](std::size_t t, std::size_t k) {
    Parts parts;
    if (parts.constrained(t, k)) return;
    parts.data->edge_flags[parts.across(t, k)] ^= 1U << parts.back(t, k);
    parts.data->edge_flags[t] ^= 1U << k;
    EXPECT_EQ(parts.failures(), "constraints");
  });
}

TEST(VerifySegments, BitOfOneSide) {
  Parts().each_edge([](std::size_t t, std::size_t k) {
    Parts parts, other;
    parts.data->edge_flags[t] ^= 1U << k;
    EXPECT_NE(parts.failures().find("neighbors"), std::string::npos);
    other.data->edge_flags[other.across(t, k)] ^= 1U << other.back(t, k);
    EXPECT_NE(other.failures().find("neighbors"), std::string::npos);
  });
}

TEST(VerifySegments, BitOfTheHull) {
  const Parts all;
  for (std::size_t i = 0; i < all.neighbors.size(); ++i) {
    if (all.neighbors[i] >= 0) continue;
    Parts parts;
    parts.data->edge_flags[i / 3] ^= 1U << i % 3;
    EXPECT_EQ(parts.failures(), "constraints");
  }
}

TEST(VerifySegments, LegalEdgeFlipped) {
  int flipped = 0;
  Parts().each_edge([&](std::size_t t, std::size_t k) {
    Parts parts;
    if (parts.constrained(t, k) || !parts.flip(t, k)) return;
    ++flipped;
    const std::string failures = parts.failures();  // cocircular edges: another mesh, not a wrong one, for "delaunay"
    EXPECT_TRUE(failures.starts_with("delaunay") || failures.starts_with("ties")) << failures;
  });
  EXPECT_GT(flipped, 5);
}

TEST(VerifySegments, ConstraintFlipped) {
  int flipped = 0;
  Parts().each_edge([&](std::size_t t, std::size_t k) {
    Parts parts;
    if (!parts.constrained(t, k) || !parts.flip(t, k)) return;
    ++flipped;
    EXPECT_NE(parts.failures().find("constraints"), std::string::npos);
  });
  EXPECT_GT(flipped, 2);
}

TEST(VerifySegments, Chains) {
  const Parts all;
  const std::size_t length = all.data->chain_vertices.size();
  ASSERT_GT(length, 16U);  // some have vertices on them
  for (std::size_t i = 0; i < length; ++i) {
    Parts parts;
    parts.data->chain_vertices[i] = 11;  // lies on no segment
    EXPECT_EQ(parts.failures(), "constraints") << i;
    Parts none;
    none.data->chain_vertices[i] = i % 2 == 0 ? -1 : 1000;
    EXPECT_EQ(none.failures(), "constraints") << i;
  }
  for (std::size_t s = 0; s < all.set.segments.size(); ++s) {
    Parts parts;
    const auto begin = parts.data->chain_vertices.begin();
    std::reverse(begin + parts.data->chain_offsets[s], begin + parts.data->chain_offsets[s + 1]);
    EXPECT_EQ(parts.failures(), "constraints") << s;
    Parts shorter;  // a vertex on the segment is left out, or, without one, an end
    shorter.data->chain_vertices.erase(shorter.data->chain_vertices.begin() + shorter.data->chain_offsets[s] + 1);
    for (std::size_t i = s + 1; i < shorter.data->chain_offsets.size(); ++i) --shorter.data->chain_offsets[i];
    EXPECT_EQ(shorter.failures(), "constraints") << s;
  }
  Parts fewer;
  fewer.data->chain_offsets.pop_back();
  EXPECT_EQ(fewer.failures(), "constraints");
}

/// From the right end to the right end along constrained edges, each of which is part of another segment as well.
TEST(VerifySegments, ChainOnAnotherWay) {
  const auto replace = [](Parts& parts, std::size_t s, const std::vector<std::int32_t>& chain) {
    auto& offsets = parts.data->chain_offsets;
    auto& vertices = parts.data->chain_vertices;
    const auto begin = vertices.begin() + offsets[s];
    vertices.erase(begin, vertices.begin() + offsets[s + 1]);
    vertices.insert(vertices.begin() + offsets[s], chain.begin(), chain.end());
    const std::int64_t more = static_cast<std::int64_t>(chain.size()) - (offsets[s + 1] - offsets[s]);
    for (std::size_t i = s + 1; i < offsets.size(); ++i) offsets[i] += more;
  };
  const auto chain_of = [](const Parts& parts, std::size_t s) {
    const auto begin = parts.data->chain_vertices.begin();
    return std::vector<std::int32_t>(begin + parts.data->chain_offsets[s], begin + parts.data->chain_offsets[s + 1]);
  };
  Parts around(Domain::layers);
  std::vector<std::int32_t> way;  // the other three sides of the inner square, for the segment that repeats the first
  for (const std::size_t s : {7U, 6U, 5U}) {
    std::vector<std::int32_t> side = chain_of(around, s);
    std::ranges::reverse(side);
    if (!way.empty()) side.erase(side.begin());
    way.insert(way.end(), side.begin(), side.end());
  }
  ASSERT_EQ(around.set.segments.back(), around.set.segments[4]);
  replace(around, around.set.segments.size() - 1, way);
  EXPECT_EQ(around.failures(), "constraints");

  Parts ascending(Domain::layers);  // by another corner, in the same direction: for the second of two diagonals
  std::vector<std::int32_t> corner = chain_of(ascending, 6);
  const std::vector<std::int32_t> side = chain_of(ascending, 7);
  std::ranges::reverse(corner);
  corner.insert(corner.begin(), side.rbegin(), side.rend() - 1);
  ASSERT_EQ(ascending.set.segments[11], ascending.set.segments[10]);
  replace(ascending, 11, corner);
  EXPECT_EQ(ascending.failures(), "constraints");

  Parts back(Domain::layers);
  std::vector<std::int32_t> steps = chain_of(back, 0);
  ASSERT_GT(steps.size(), 2U);
  steps.insert(steps.begin() + 2, {steps[0], steps[1]});  // back, and once more
  replace(back, 0, steps);
  EXPECT_EQ(back.failures(), "constraints");
}

TEST(VerifySegments, WrongRegion) {
  for (const Domain domain : all_domains) {
    const Parts all(domain);
    const std::size_t regions = all.data->region_value.size();
    ASSERT_GT(regions, 1U);
    for (std::size_t t = 0; t < all.data->region.size(); ++t) {
      Parts parts(domain);
      parts.data->region[t] = (parts.data->region[t] + 1) % static_cast<std::int32_t>(regions);
      EXPECT_EQ(parts.failures(), "regions") << t;
      Parts none(domain);
      none.data->region[t] = -1;
      EXPECT_EQ(none.failures(), "regions") << t;
    }
    Parts joined(domain);  // all in one
    std::ranges::fill(joined.data->region, 0);
    EXPECT_EQ(joined.failures(), "regions");
    Parts renumbered(domain);
    for (std::int32_t& region : renumbered.data->region) region = static_cast<std::int32_t>(regions) - 1 - region;
    std::ranges::reverse(renumbered.data->region_value);
    EXPECT_EQ(renumbered.failures(), "regions");
  }
}

TEST(VerifySegments, WrongInside) {
  for (const Domain domain : all_domains) {
    SCOPED_TRACE(static_cast<int>(domain));
    const Parts all(domain);
    for (std::size_t t = 0; t < all.data->inside.size(); ++t) {
      Parts parts(domain);
      parts.data->inside[t] ^= 1;
      EXPECT_EQ(parts.failures(), "regions") << t;
    }
    for (std::size_t r = 0; r < all.data->region_value.size(); ++r) {
      Parts parts(domain), attribute(domain);
      parts.data->region_value[r] += 2;  // the parity stays
      EXPECT_EQ(parts.failures(), "regions") << r;
      attribute.data->region_attribute[r] += 1;
      if (domain == Domain::seeds) {
        EXPECT_EQ(attribute.failures(), "regions") << r;
      }
    }
    Parts parts(domain), sizes(domain);
    ++parts.data->number_inside;
    EXPECT_EQ(parts.failures(), "regions");
    sizes.data->inside.pop_back();
    EXPECT_EQ(sizes.failures(), "regions");
  }
}

TEST(VerifySegments, AnotherRule) {
  for (const Domain made : {Domain::hull, Domain::outer, Domain::layers}) {
    for (const Domain asked : {Domain::hull, Domain::outer, Domain::layers}) {
      Parts parts(made);
      parts.options.domain = asked;
      EXPECT_EQ(parts.failures(), made == asked ? "" : "regions");
    }
  }
}

/// Crossings made vertices, rounded, and points on a grid.
TEST(VerifySegments, AddedAndMovedPoints) {
  const SegmentSet set = random_segments(4, 60, 0.4);
  for (const Crossing crossing : {Crossing::exact, Crossing::grid}) {
    ConstraintOptions options;
    options.crossing = crossing;
    options.grid = 1.0 / 256;
    options.domain = Domain::layers;
    const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, options);
    EXPECT_GT(mesh.added_points().size(), 20U);
    const VerifyReport report = verify(set.xy, set.segments, mesh, options);
    EXPECT_TRUE(report.ok) << report.summary();
    std::vector<Segment> others = set.segments;
    std::swap(others[3], others[4]);
    EXPECT_FALSE(verify(set.xy, others, mesh, options).ok);
  }
}

}  // namespace
}  // namespace cadt::test
