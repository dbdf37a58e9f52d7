// SPDX-License-Identifier: Apache-2.0
// Domains of Delaunay meshes some edges of which are taken for constrained. Outlines of triangles, each taken several
// times in either direction, are segments for which winding numbers are known; depths and regions are compared with
// searches triangle by triangle.
#include <limits>
#include <string>

#include "tests/unit/constraints/marked_mesh.hpp"

namespace cadt::test {
namespace {

void expect_consistent(const Marked& m, const Found& found) {
  const HostDomains& r = found.result;
  ASSERT_EQ(r.region.size(), m.size());
  ASSERT_EQ(r.inside.size(), m.size());
  ASSERT_EQ(r.region_attribute.size(), r.region_value.size());
  EXPECT_EQ(r.number_inside, static_cast<std::size_t>(std::ranges::count(r.inside, 1)));
  const Searched searched(m);
  EXPECT_EQ(r.region, searched.region);
  EXPECT_EQ(r.region_value.size(), static_cast<std::size_t>(searched.regions));
  // The triangles inside alone, in the same order.
  std::vector<std::int32_t> place(m.size(), -1), triangles, neighbors;
  std::vector<std::uint32_t> flags;
  for (std::size_t t = 0, next = 0; t < m.size(); ++t)
    if (r.inside[t] != 0) place[t] = static_cast<std::int32_t>(next++);
  for (std::size_t t = 0; t < m.size(); ++t) {
    if (r.inside[t] == 0) continue;
    flags.push_back(m.flags[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      triangles.push_back(m.vertex(t, k));
      neighbors.push_back(m.across(t, k) < 0 ? -1 : place[static_cast<std::size_t>(m.across(t, k))]);
    }
  }
  EXPECT_EQ(found.triangles, triangles);
  EXPECT_EQ(found.neighbors, neighbors);
  EXPECT_EQ(found.flags, flags);
}

ConstraintOptions with(Domain domain) {
  ConstraintOptions options;
  options.domain = domain;
  return options;
}

class Domains : public BackendTest {
 protected:
  [[nodiscard]] Found find(const Marked& marked, const ConstraintOptions& options) const {
    return Found(GetParam(), marked, options);
  }
  [[nodiscard]] std::int32_t vertex_of_error(const Marked& marked, Domain domain) const {
    try {
      (void)find(marked, with(domain));
    } catch (const DomainError& error) {
      EXPECT_NE(std::string(error.what()).find(std::to_string(error.vertex())), std::string::npos) << error.what();
      return error.vertex();
    }
    return -1;
  }
};

TEST_P(Domains, WindingNumbersAreThoseOfTheOutlines) {
  for (const bool lattice : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(std::to_string(seed) + (lattice ? " lattice" : ""));
      Marked m(random_points(500, seed, lattice));
      std::mt19937_64 random(seed);
      std::vector<std::int32_t> winding(m.size(), 0), times(m.size(), 0);
      for (std::size_t t = 0; t < m.size(); ++t)
        for (std::uint64_t i = random() % 8; i < 3; ++i) {
          const bool left = random() % 3 != 0;
          m.add_outline(t, left);
          winding[t] += left ? 1 : -1;
          ++times[t];
        }
      const Found nonzero = find(m, with(Domain::nonzero)), even_odd = find(m, with(Domain::even_odd));
      expect_consistent(m, nonzero);
      expect_consistent(m, even_odd);
      for (std::size_t t = 0; t < m.size(); ++t) {
        const auto region = static_cast<std::size_t>(nonzero.result.region[t]);
        ASSERT_EQ(nonzero.result.region_value[region], winding[t]) << t;
        ASSERT_EQ(nonzero.result.inside[t], winding[t] != 0 ? 1 : 0) << t;
        ASSERT_EQ(even_odd.result.region_value[region], times[t] % 2) << t;
        ASSERT_EQ(even_odd.result.inside[t], times[t] % 2) << t;
      }
    }
  }
}

TEST_P(Domains, LayersAreTheFewestSegmentsToTheOutside) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Marked m(random_points(400, seed, seed % 2 == 0));
    std::mt19937_64 random(seed);
    for (std::size_t t = 0; t < m.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (random() % 100 < 25 * seed) m.add(t, k, random() % 2 != 0);
    const Found layers = find(m, with(Domain::layers));
    expect_consistent(m, layers);
    const Searched searched(m);
    for (std::size_t t = 0; t < m.size(); ++t) {
      ASSERT_EQ(layers.result.region_value[static_cast<std::size_t>(layers.result.region[t])], searched.depth[t]) << t;
      ASSERT_EQ(layers.result.inside[t], searched.depth[t] % 2) << t;
    }
  }
}

TEST_P(Domains, NestedSquares) {
  const Marked m = nested_squares({true, true, false, false, false});
  // On the x axis, outside of the first, between it and the second, ...
  const double at[] = {2000, 500, 125, 30, 8, 0};
  const std::vector<std::int32_t> winding = {0, 1, 2, 1, 0, -1}, parity = {0, 1, 0, 1, 0, 1},
                                  depth = {0, 1, 2, 3, 4, 5}, outer = {0, 1, 1, 1, 1, 1}, all = {1, 1, 1, 1, 1, 1};
  const auto check = [&](Domain domain, const std::vector<std::int32_t>& value,
                         const std::vector<std::int32_t>& inside) {
    const Found found = find(m, with(domain));
    expect_consistent(m, found);
    EXPECT_EQ(found.result.region_value.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t t = triangle_at(m, at[i], 0.3);
      EXPECT_EQ(found.result.region_value[static_cast<std::size_t>(found.result.region[t])], value[i])
          << static_cast<int>(domain) << " at " << at[i];
      EXPECT_EQ(found.result.inside[t], inside[i]) << static_cast<int>(domain) << " at " << at[i];
    }
  };
  check(Domain::nonzero, winding, {0, 1, 1, 1, 0, 1});
  check(Domain::even_odd, parity, parity);
  check(Domain::layers, depth, parity);
  check(Domain::outer, outer, outer);
  check(Domain::hull, all, all);
  check(Domain::seeds, outer, outer);
}

TEST_P(Domains, NoTriangleOfTheOutside) {
  Marked m({0, 0, 4, 0, 4, 4, 0, 4, 1, 2});
  for (std::size_t t = 0; t < m.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (m.across(t, k) < 0) m.add(t, k);
  for (const Domain domain : {Domain::outer, Domain::even_odd, Domain::nonzero, Domain::layers, Domain::seeds}) {
    const Found found = find(m, with(domain));
    expect_consistent(m, found);
    EXPECT_EQ(found.result.number_inside, m.size());
    EXPECT_EQ(found.result.region_value, (std::vector<std::int32_t>{1}));
  }
}

TEST_P(Domains, NoSegments) {
  const Marked m(random_points(50, 9, false));
  for (const Domain domain : {Domain::outer, Domain::even_odd, Domain::nonzero, Domain::layers, Domain::seeds}) {
    const Found found = find(m, with(domain));
    expect_consistent(m, found);
    EXPECT_EQ(found.result.number_inside, 0U);
    EXPECT_EQ(found.result.region_value, (std::vector<std::int32_t>{0}));
  }
  EXPECT_EQ(find(m, with(Domain::hull)).result.number_inside, m.size());
}

TEST_P(Domains, NoTriangles) {
  const Marked m({0, 0, 1, 1, 2, 2});
  for (const Domain domain : {Domain::hull, Domain::even_odd, Domain::layers, Domain::seeds}) {
    const Found found = find(m, with(domain));
    EXPECT_TRUE(found.result.region.empty() && found.result.inside.empty() && found.result.region_value.empty());
  }
}

/// The lowest vertex at which segments do not close is named.
TEST_P(Domains, LooseEndIsNamed) {
  Marked m = nested_squares({true, true});
  const std::int32_t center = 4;
  EXPECT_EQ(vertex_of_error(m, Domain::even_odd), -1);
  m.add_edge(0, center);  // a bridge between the squares
  EXPECT_EQ(vertex_of_error(m, Domain::even_odd), 0);
  EXPECT_EQ(vertex_of_error(m, Domain::nonzero), 0);
  m.add_edge(0, center);
  EXPECT_EQ(vertex_of_error(m, Domain::even_odd), -1);  // given twice, it counts for nothing
  EXPECT_EQ(vertex_of_error(m, Domain::nonzero), 0);
  m.add_edge(center, 0);
  m.add_edge(center, 0);
  EXPECT_EQ(vertex_of_error(m, Domain::nonzero), -1);
  EXPECT_EQ(find(m, with(Domain::layers)).result.region_value.size(), 3U);
}

TEST_P(Domains, OutlinesGivenTwiceBoundNothing) {
  Marked m = nested_squares({true, true});
  for (std::int32_t k = 0; k < 8; ++k) m.add_edge(k, k % 4 == 3 ? k - 3 : k + 1);
  const Found even_odd = find(m, with(Domain::even_odd)), nonzero = find(m, with(Domain::nonzero));
  expect_consistent(m, even_odd);
  EXPECT_EQ(even_odd.result.region_value, (std::vector<std::int32_t>{0, 0, 0}));
  EXPECT_EQ(std::ranges::max(nonzero.result.region_value), 4);
}

TEST_P(Domains, OutlineOfTwoDirectionsHasNoWindingNumber) {
  Marked m({0, 0, 4, 0, 4, 4, 0, 4, -9, 2, 2, -9, 13, 2, 2, 13});
  m.add_edge(0, 1);
  m.add_edge(1, 2);
  m.add_edge(3, 2);  // against the others
  m.add_edge(3, 0);
  EXPECT_EQ(vertex_of_error(m, Domain::nonzero), 2);
  EXPECT_EQ(vertex_of_error(m, Domain::even_odd), -1);
}

TEST_P(Domains, HolesAndRegions) {
  const Marked m = nested_squares({true, true, true});
  ConstraintOptions options = with(Domain::seeds);
  options.holes = {{1, 2}, {50000, 0}};  // the second one is outside of the hull
  options.regions = {{10000, 10000, 7}, {125, 1, 3}, {-125, 1, 4}, {500, 0, 5}, {2000, 0, 6}};
  const Found found = find(m, options);
  expect_consistent(m, found);
  const auto region = [&](double x) { return static_cast<std::size_t>(found.result.region[triangle_at(m, x, 0.3)]); };
  EXPECT_EQ(found.result.region_value[region(2000)], 0);
  EXPECT_EQ(found.result.region_value[region(500)], 1);
  EXPECT_EQ(found.result.region_value[region(125)], 1);
  EXPECT_EQ(found.result.region_value[region(0)], 0);
  EXPECT_EQ(found.result.region_attribute[region(125)], 3);  // the first one there
  EXPECT_EQ(found.result.region_attribute[region(500)], 5);
  EXPECT_EQ(found.result.region_attribute[region(2000)], 6);
  EXPECT_EQ(found.result.region_attribute[region(0)], 0);
}

/// Beside the seed lie several triangles: the lowest of them counts, exactly.
TEST_P(Domains, SeedOnAnEdgeOrAVertex) {
  const double tiny = 0x1p-60;
  const Marked m({0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5});
  const auto at = [&](double x, double y) {
    ConstraintOptions options = with(Domain::seeds);
    options.holes = {{x, y}};
    return locate_seeds(m.mesh.triangles(), m.xy, {}, options).holes[0];
  };
  const auto below = static_cast<std::int32_t>(triangle_at(m, 0.5, 0.25)),
             left = static_cast<std::int32_t>(triangle_at(m, 0.25, 0.5));
  EXPECT_EQ(at(0.5, 0.5), 0);
  EXPECT_EQ(at(0.25, 0.25), std::min(below, left));
  EXPECT_EQ(at(0.25, std::nextafter(0.25, 0.0)), below);
  EXPECT_EQ(at(std::nextafter(0.25, 0.0), 0.25), left);
  EXPECT_EQ(at(0.5, 0), below);
  EXPECT_EQ(at(0.5, -tiny), -1);
  EXPECT_EQ(at(tiny, tiny / 2), below);
  EXPECT_EQ(at(0, 0), std::min(below, left));
  ConstraintOptions options = with(Domain::seeds);
  options.regions = {{0, std::numeric_limits<double>::quiet_NaN(), 0}};
  try {
    (void)find(m, options);
    ADD_FAILURE() << "no error";
  } catch (const OptionError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("ConstraintOptions::regions: ")) << error.what();
  }
}

/// A vertex from `added`, as crossings have.
TEST_P(Domains, SeedsAmongAddedPoints) {
  const std::vector<std::int32_t> triangles = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  const std::vector<double> xy = {0, 0, 1, 0, 1, 1, 0, 1}, added = {0.5, 0.5};
  ConstraintOptions options = with(Domain::seeds);
  options.holes = {{0.5, 0.75}, {0.75, 0.5}};
  EXPECT_EQ(locate_seeds(triangles, xy, {added, {}, {}}, options).holes, (std::vector<std::int32_t>{2, 1}));
}
CADT_ON_MAIN_BACKENDS(Domains);

}  // namespace
}  // namespace cadt::test
