// SPDX-License-Identifier: Apache-2.0
// The kill matrix: each mutation at many places of one mesh with everything in it (cocircular points, points on hull
// edges, duplicates), on the host's verifier and on every device's. Rows: mutations, with the check that is made for
// them; columns: how many of the mutated meshes each check rejects. docs/reliability.md has the table.
#include "rejection.hpp"
#include "truth.hpp"

#include "common/driver/triangulation_data.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <set>

namespace {

using Index = std::int32_t;
constexpr std::array<const char*, 10> columns{"counts",   "range", "neighbors", "orientation", "vertices",
                                              "boundary", "euler", "hull",      "delaunay",    "ties"};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The mesh that is mutated, by the library, with every array.
TestMesh subject() {
  TestMesh m;
  m.xy = lattice(7, 6).xy;
  for (double v : random_points(60, 11)) m.xy.push_back(8 + 5 * v);
  for (const std::size_t i : {3U, 50U, 3U, 60U, 0U}) m.xy.insert(m.xy.end(), {m.xy[2 * i], m.xy[2 * i + 1]});
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  const cadt::Triangulation mesh = cadt::triangulate(m.points(), options);
  m.triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
  m.neighbors.assign(mesh.neighbors().begin(), mesh.neighbors().end());
  m.hull.assign(mesh.hull().begin(), mesh.hull().end());
  m.duplicates.assign(mesh.duplicates().begin(), mesh.duplicates().end());
  return m;
}

/// Changes the mesh at place `i`; false if there is nothing to change there.
using Change = std::function<bool(TestMesh&, std::size_t i)>;
/// With all arrays as in a result of the library; or with triangles alone, as from another program.
enum class Form { full, bare };

struct Mutation {
  const char* name;
  const char* check;  ///< the one that must reject it
  Form form;
  Change change;
};

cadt::verifier::Point point(const TestMesh& m, Index v) { return {m.xy[2 * at(v)], m.xy[2 * at(v) + 1]}; }

Index apex_across(const TestMesh& m, std::size_t edge) {
  const std::size_t t = edge - edge % 3, s = 3 * at(m.neighbors[edge]);
  for (std::size_t j = 0; j < 3; ++j) {
    const Index v = m.triangles[s + j];
    if (v != m.triangles[t + (edge + 1) % 3] && v != m.triangles[t + (edge + 2) % 3]) return v;
  }
  return -1;
}

/// Flips edge `e` if it is the diagonal of a convex quadrilateral, and tied or not as wanted.
bool flip(TestMesh& m, std::size_t e, bool tied) {
  if (m.neighbors[e] < 0) return false;
  const std::size_t t = e - e % 3, s = 3 * at(m.neighbors[e]);
  const Index a = m.triangles[e], b = m.triangles[t + (e + 1) % 3], c = m.triangles[t + (e + 2) % 3];
  const Index d = apex_across(m, e);
  if (truth::orientation(point(m, a), point(m, b), point(m, d)) <= 0 ||
      truth::orientation(point(m, a), point(m, d), point(m, c)) <= 0)
    return false;
  if ((truth::incircle(point(m, a), point(m, b), point(m, c), point(m, d)) == 0) != tied) return false;
  std::ranges::copy(std::array{a, b, d}, m.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  std::ranges::copy(std::array{a, d, c}, m.triangles.begin() + static_cast<std::ptrdiff_t>(s));
  m.complete();
  return true;
}

std::ptrdiff_t outer_edges(const TestMesh& m, std::size_t t) {
  const auto first = m.neighbors.begin() + static_cast<std::ptrdiff_t>(3 * t);
  return std::count(first, first + 3, -1);
}

/// Takes triangle t out if it has `sides` edges on the boundary.
bool drop(TestMesh& m, std::size_t t, int sides) {
  if (t >= m.size() || outer_edges(m, t) != sides) return false;
  const auto first = m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
  m.triangles.erase(first, first + 3);
  return true;
}

/// A tube between two holes where triangles were: genus 1, and every edge still has its two triangles.
bool add_handle(TestMesh& m, std::size_t t) {
  const std::size_t u = (t + m.size() / 2) % m.size();
  std::set<Index> vertices;
  for (std::size_t k = 0; k < 3; ++k) vertices.insert({m.triangles[3 * t + k], m.triangles[3 * u + k]});
  if (vertices.size() != 6 || outer_edges(m, t) != 0 || outer_edges(m, u) != 0) return false;
  std::array<Index, 3> a{}, b{};
  for (std::size_t k = 0; k < 3; ++k) a[k] = m.triangles[3 * t + k], b[2 - k] = m.triangles[3 * u + k];
  std::vector<Index> rest;
  for (std::size_t i = 0; i < m.triangles.size(); ++i)
    if (i / 3 != t && i / 3 != u) rest.push_back(m.triangles[i]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    rest.insert(rest.end(), {a[k], a[n], b[k], a[n], b[n], b[k]});
  }
  m.triangles = rest;
  return true;
}

/// Once more beside itself, as a second piece with points of its own.
bool add_component(TestMesh& m, std::size_t i) {
  if (i > 0) return false;
  const auto n = static_cast<Index>(m.xy.size() / 2);
  const std::vector<double> xy = m.xy;
  for (std::size_t k = 0; k < xy.size(); ++k) m.xy.push_back(xy[k] + (k % 2 == 0 ? 100 : 0));
  const std::vector<Index> triangles = m.triangles;
  for (const Index v : triangles) m.triangles.push_back(v + n);
  return true;
}

bool slit(TestMesh& m, std::size_t e) {
  const Index s = m.neighbors[e];
  if (s < 0) return false;
  for (std::size_t j = 0; j < 3; ++j)
    if (m.neighbors[3 * at(s) + j] == static_cast<Index>(e / 3)) m.neighbors[3 * at(s) + j] = -1;
  m.neighbors[e] = -1;
  return true;
}

bool set(Index& word, Index value) {
  if (word == value) return false;
  word = value;
  return true;
}

template <class List>
bool within(const List& list, std::size_t i) {
  return i < list.size();
}

std::vector<Mutation> mutations() {
  const auto on_triangle = [](auto change) {
    return Change([change](TestMesh& m, std::size_t i) { return i < m.size() && change(m, i); });
  };
  const auto on_edge = [](auto change) {
    return Change([change](TestMesh& m, std::size_t i) { return i < m.triangles.size() && change(m, i); });
  };
  const auto count = [](const TestMesh& m) { return static_cast<Index>(m.size()); };
  const auto points = [](const TestMesh& m) { return static_cast<Index>(m.xy.size() / 2); };
  return {
      {"an index of a triangle missing", "counts", Form::bare,
       [](TestMesh& m, std::size_t i) { return i < 2 && (m.triangles.pop_back(), true); }},
      {"a neighbour missing at the end", "counts", Form::full,
       [](TestMesh& m, std::size_t i) { return i < 2 && (m.neighbors.pop_back(), true); }},
      {"vertex -1", "range", Form::full, on_edge([](TestMesh& m, std::size_t e) { return set(m.triangles[e], -1); })},
      {"vertex n", "range", Form::bare,
       on_edge([=](TestMesh& m, std::size_t e) { return set(m.triangles[e], points(m)); })},
      {"vertex 2^31 - 1", "range", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return set(m.triangles[e], INT_MAX); })},
      {"a vertex twice in a triangle", "range", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return set(m.triangles[e], m.triangles[e - e % 3 + (e + 1) % 3]); })},
      {"neighbour -2", "range", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return set(m.neighbors[e], -2); })},
      {"neighbour T", "range", Form::full,
       on_edge([=](TestMesh& m, std::size_t e) { return set(m.neighbors[e], count(m)); })},
      {"neighbour aliased", "neighbors", Form::full,
       on_edge([=](TestMesh& m, std::size_t e) { return set(m.neighbors[e], (m.neighbors[e] + 3) % count(m)); })},
      {"a triangle its own neighbour", "neighbors", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return set(m.neighbors[e], static_cast<Index>(e / 3)); })},
      {"neighbour missing on one side", "neighbors", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return set(m.neighbors[e], -1); })},
      {"triple rotated, neighbours not", "neighbors", Form::full, on_triangle([](TestMesh& m, std::size_t t) {
         const auto first = m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
         std::rotate(first, first + 1, first + 3);
         return true;
       })},
      {"triangle twice", "neighbors", Form::bare, on_triangle([](TestMesh& m, std::size_t t) {
         for (std::size_t k = 0; k < 3; ++k) m.triangles.push_back(m.triangles[3 * t + k]);
         return true;
       })},
      {"two vertices swapped (inverted)", "orientation", Form::full, on_triangle([](TestMesh& m, std::size_t t) {
         std::swap(m.triangles[3 * t + 1], m.triangles[3 * t + 2]);
         std::swap(m.neighbors[3 * t + 1], m.neighbors[3 * t + 2]);
         return true;
       })},
      {"vertices of two triangles swapped", "orientation", Form::bare, on_triangle([](TestMesh& m, std::size_t t) {
         const Index v = m.triangles[3 * t], w = m.triangles[(3 * t + m.triangles.size() / 2) % m.triangles.size()];
         for (Index& u : m.triangles) u = u == v ? w : u == w ? v : u;
         return v != w;
       })},
      {"point moved out of its star", "orientation", Form::full,
       [](TestMesh& m, std::size_t i) {
         const std::size_t v = 42 + i;
         const auto p = static_cast<Index>(v);
         if (i >= 60 || std::ranges::count(m.hull, p) != 0) return false;
         for (const cadt::Duplicate& d : m.duplicates)
           if (d.representative == p) return false;
         m.xy[2 * v] += 1.25;
         return true;
       }},
      {"a point that is no vertex", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) {
         m.xy.insert(m.xy.end(), {0.5 + static_cast<double>(i % 5), 0.25});
         return true;
       }},
      {"a point that is no vertex, no lists", "vertices", Form::bare,
       [](TestMesh& m, std::size_t i) {
         m.xy.insert(m.xy.end(), {0.5 + static_cast<double>(i % 5), 0.25});
         return true;
       }},
      {"corner cut off", "vertices", Form::bare, [](TestMesh& m, std::size_t i) { return drop(m, i, 2); }},
      {"duplicate not recorded", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) {
         if (!within(m.duplicates, i)) return false;
         m.duplicates.erase(m.duplicates.begin() + static_cast<std::ptrdiff_t>(i));
         return true;
       }},
      {"duplicate of another point", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) { return within(m.duplicates, i) && set(m.duplicates[i].representative, 9); }},
      {"duplicate of itself", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) {
         return within(m.duplicates, i) && set(m.duplicates[i].representative, m.duplicates[i].point);
       }},
      {"duplicate recorded twice", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) {
         if (!within(m.duplicates, i)) return false;
         m.duplicates.insert(m.duplicates.begin() + static_cast<std::ptrdiff_t>(i), m.duplicates[i]);
         return true;
       }},
      {"a vertex recorded as a duplicate", "vertices", Form::full,
       [](TestMesh& m, std::size_t i) {
         if (i > 40) return false;
         m.duplicates.insert(m.duplicates.begin(), {static_cast<Index>(i + 1), 0});
         return true;
       }},
      {"inner triangle dropped", "boundary", Form::bare, [](TestMesh& m, std::size_t i) { return drop(m, i, 0); }},
      {"slit", "boundary", Form::full, on_edge(slit)},
      {"two components", "boundary", Form::bare, add_component},
      {"two components", "euler", Form::bare, add_component},
      {"handle (genus 1)", "euler", Form::bare, on_triangle(add_handle)},
      {"hull cut", "hull", Form::bare,
       [](TestMesh& m, std::size_t i) {
         // only where the vertex behind is within the hull: else a corner goes, or the mesh falls apart
         if (i >= m.size() || outer_edges(m, i) != 1) return false;
         for (std::size_t k = 0; k < 3; ++k)
           if (m.neighbors[3 * i + k] < 0 && std::ranges::count(m.hull, m.triangles[3 * i + k]) != 0) return false;
         return drop(m, i, 1);
       }},
      {"hull one too short", "hull", Form::full,
       [](TestMesh& m, std::size_t i) {
         return within(m.hull, i) && (m.hull.erase(m.hull.begin() + static_cast<std::ptrdiff_t>(i)), true);
       }},
      {"hull one too long", "hull", Form::full,
       [](TestMesh& m, std::size_t i) {
         return within(m.hull, i) && (m.hull.insert(m.hull.begin() + static_cast<std::ptrdiff_t>(i), m.hull[i]), true);
       }},
      {"hull in another order", "hull", Form::full,
       [](TestMesh& m, std::size_t i) {
         if (i + 1 >= m.hull.size()) return false;
         std::swap(m.hull[i], m.hull[i + 1]);
         return true;
       }},
      {"hull rotated", "hull", Form::full,
       [](TestMesh& m, std::size_t i) {
         if (i == 0 || !within(m.hull, i)) return false;
         std::ranges::rotate(m.hull, m.hull.begin() + static_cast<std::ptrdiff_t>(i));
         return true;
       }},
      {"legal edge flipped", "delaunay", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return flip(m, e, false); })},
      {"tied edge flipped the other way", "ties", Form::full,
       on_edge([](TestMesh& m, std::size_t e) { return flip(m, e, true); })},
  };
}

/// Every mutation at up to so many places, as evenly as they come.
constexpr std::size_t most_places = 12;

TEST(KillMatrix, EveryMutationIsRejectedByItsCheck) {
  const TestMesh whole = subject();
  ASSERT_TRUE(verify_full(whole).ok) << verify_full(whole).summary();
  ASSERT_TRUE(verify_bare(whole).ok) << verify_bare(whole).summary();
  ASSERT_GT(verify_full(whole).ties, 20U);
  std::set<std::string> alone;  // checks that some mutation is rejected by and by no other
  for (const OpenDevice& d : open_devices()) std::printf("verified on the host and on: %s\n", d.name.c_str());
  std::printf("%-36s %-12s places", "mutation", "check");
  for (const char* column : columns) std::printf(" %11s", column);
  std::printf("\n");
  for (const Mutation& mutation : mutations()) {
    SCOPED_TRACE(mutation.name);
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < whole.triangles.size(); ++i)
      if (TestMesh m = whole; mutation.change(m, i)) possible.push_back(i);
    ASSERT_FALSE(possible.empty());
    std::map<std::string, int> rejected;
    int places = 0;
    const std::size_t step = (possible.size() + most_places - 1) / most_places;
    for (std::size_t p = 0; p < possible.size(); p += step) {
      TestMesh m = whole;
      ASSERT_TRUE(mutation.change(m, possible[p]));
      const VerifyReport report = mutation.form == Form::full ? verify_full(m) : verify_bare(m);
      expect_killed_by(report, mutation.check);
      const Names names = failed(report);
      for (const std::string& name : names) ++rejected[name];
      if (names.size() == 1) alone.insert(names.front());
      ++places;
      if (HasFailure()) {
        ADD_FAILURE() << "at place " << possible[p] << ": " << report.summary();
        return;
      }
    }
    std::printf("%-36s %-12s %6d", mutation.name, mutation.check, places);
    for (const char* column : columns)
      std::printf(" %11s", rejected.contains(column) ? std::to_string(rejected[column]).c_str() : "");
    std::printf("\n");
  }
  // No other check would notice if one of these were gone. What spoils the boundary or the genus spoils Euler's formula
  // or an orientation as well.
  for (const char* name : {"counts", "range", "neighbors", "orientation", "vertices", "hull", "delaunay", "ties"})
    EXPECT_TRUE(alone.contains(name)) << name;
}

cadt::Hash128 hash_of(const TestMesh& m, int dimension = 2) {
  auto data = std::make_unique<cadt::Triangulation::Data>();
  data->points = m.xy.size() / 2;
  data->triangle_count = m.size();
  data->triangles = cadt::make_words(m.triangles.size());
  data->neighbors = cadt::make_words(m.neighbors.size());
  std::ranges::copy(m.triangles, data->triangles.get());
  std::ranges::copy(m.neighbors, data->neighbors.get());
  data->hull = m.hull;
  data->duplicates = m.duplicates;
  data->dimension = dimension;
  return cadt::Triangulation(std::move(data)).hash();
}

/// The hash changes with every triangle, each duplicate, and the numbers of points, triangles and hull vertices; not
/// with the order of triangles, nor with the vertex at which a triangle begins.
TEST(KillMatrix, HashTellsEveryMutationOfTheSetApart) {
  const TestMesh whole = subject();
  const cadt::Hash128 hash = hash_of(whole);
  TestMesh same = whole;
  for (std::size_t t = 0; t < same.size(); ++t) {
    const auto first = same.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
    std::rotate(first, first + static_cast<std::ptrdiff_t>(t % 3), first + 3);
  }
  EXPECT_EQ(hash_of(same), hash);
  for (std::size_t t = 0; t + 1 < same.size(); t += 2)
    std::swap_ranges(same.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t),
                     same.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t + 3),
                     same.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
  EXPECT_EQ(hash_of(same), hash);
  std::set<std::string> seen{hash.to_string()};
  const auto expect_new = [&](const TestMesh& m, const std::string& what) {
    EXPECT_TRUE(seen.insert(hash_of(m).to_string()).second) << what;
  };
  for (std::size_t t = 0; t < whole.size(); ++t) {
    TestMesh m = whole;
    std::swap(m.triangles[3 * t], m.triangles[3 * t + 1]);
    expect_new(m, "inverted " + std::to_string(t));
    m = whole;
    m.triangles.erase(m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t),
                      m.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
    expect_new(m, "without " + std::to_string(t));
    m = whole;
    for (std::size_t k = 0; k < 3; ++k) m.triangles.push_back(m.triangles[3 * t + k]);
    expect_new(m, "twice " + std::to_string(t));
  }
  for (std::size_t e = 0; e < whole.triangles.size(); e += 3) {
    TestMesh m = whole;
    m.triangles[e] ^= 1;
    expect_new(m, "vertex " + std::to_string(e));
  }
  for (std::size_t i = 0; i < whole.duplicates.size(); ++i) {
    TestMesh m = whole;
    m.duplicates.erase(m.duplicates.begin() + static_cast<std::ptrdiff_t>(i));
    expect_new(m, "without duplicate " + std::to_string(i));
    m = whole;
    ++m.duplicates[i].representative;
    expect_new(m, "duplicate " + std::to_string(i));
  }
  TestMesh m = whole;
  m.hull.pop_back();
  expect_new(m, "hull");
  m = whole;
  m.xy.insert(m.xy.end(), {0, 0});
  expect_new(m, "points");
  EXPECT_NE(hash_of(whole, 1), hash);
}

}  // namespace
