// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mesh_checks.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace cadt::test {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

constexpr std::size_t permuted_up_to = 5000;

std::uint64_t edge_key(std::int32_t from, std::int32_t to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
}

// Boundary edges of the triangles, chained counterclockwise from the smallest index.
std::vector<std::int32_t> hull_of(std::span<const std::int32_t> triangles, std::span<const std::int32_t> neighbors) {
  std::unordered_map<std::int32_t, std::int32_t> next;
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    if (neighbors[k] >= 0) continue;
    const std::size_t first = k - k % 3;
    next[triangles[first + (k + 1) % 3]] = triangles[first + (k + 2) % 3];
  }
  std::vector<std::int32_t> loop;
  if (next.empty()) return loop;
  const std::int32_t start =
      std::min_element(next.begin(), next.end(), [](const auto& a, const auto& b) { return a.first < b.first; })->first;
  for (std::int32_t v = start; loop.empty() || v != start; v = next.at(v)) loop.push_back(v);
  return loop;
}

template <class T, class Print>
AssertionResult same_array(const char* name, std::span<const T> have, const std::vector<T>& want, Print print) {
  const auto size = std::min(have.size(), want.size());
  for (std::size_t i = 0; i < size; ++i) {
    if (!(have[i] == want[i])) {
      return AssertionFailure() << name << "[" << i << "] is " << print(have[i]) << ", expected " << print(want[i])
                                << " (sizes " << have.size() << ", " << want.size() << ")";
    }
  }
  if (have.size() != want.size()) {
    return AssertionFailure() << name << " has " << have.size() << " entries, expected " << want.size();
  }
  return AssertionSuccess();
}

AssertionResult same_indices(const char* name, std::span<const std::int32_t> have,
                             const std::vector<std::int32_t>& want) {
  return same_array(name, have, want, [](std::int32_t value) { return value; });
}

// Without CGAL: the mesh of the serial host, if the verifier, whose predicates are its own, accepts it with every tie.
// What CGAL found is then compared through the table of tests/system/golden alone.
OracleMesh oracle_of(const Points& xy) {
#if CADT_TEST_CGAL
  return cgal_delaunay(xy);
#else
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  const Triangulation mesh = triangulate(std::span<const double>(xy), options);
  if (const auto accepted = verified(xy, mesh); !accepted) throw std::runtime_error(accepted.message());
  OracleMesh oracle{mesh.dimension(), representatives(xy), {}};
  for (std::size_t k = 0; k < mesh.triangles().size(); k += 3) {
    const auto t = mesh.triangles().subspan(k, 3);
    oracle.triangles.push_back({t[0], t[1], t[2]});
  }
  make_canonical(oracle.triangles);
  return oracle;
#endif
}

}  // namespace

std::vector<std::int32_t> neighbors_of(std::span<const std::int32_t> triangles) {
  std::unordered_map<std::uint64_t, std::int32_t> owner;
  owner.reserve(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::size_t first = k - k % 3;
    owner[edge_key(triangles[first + (k + 1) % 3], triangles[first + (k + 2) % 3])] = static_cast<std::int32_t>(k / 3);
  }
  std::vector<std::int32_t> neighbors(triangles.size(), -1);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::size_t first = k - k % 3;
    const auto other = owner.find(edge_key(triangles[first + (k + 2) % 3], triangles[first + (k + 1) % 3]));
    if (other != owner.end()) neighbors[k] = other->second;
  }
  return neighbors;
}

ExpectedMesh expected_mesh(const Points& xy) {
  OracleMesh oracle = oracle_of(xy);
  ExpectedMesh mesh;
  mesh.dimension = oracle.dimension;
  mesh.representative = std::move(oracle.representative);
  for (const Triangle& t : oracle.triangles) mesh.triangles.insert(mesh.triangles.end(), t.begin(), t.end());
  mesh.neighbors = neighbors_of(mesh.triangles);
  mesh.hull = hull_of(mesh.triangles, mesh.neighbors);
  mesh.vertex_triangle.assign(mesh.representative.size(), -1);
  for (std::size_t k = mesh.triangles.size(); k > 0; --k) {
    mesh.vertex_triangle[static_cast<std::size_t>(mesh.triangles[k - 1])] = static_cast<std::int32_t>((k - 1) / 3);
  }
  for (std::size_t i = 0; i < mesh.representative.size(); ++i) {
    const std::int32_t r = mesh.representative[i];
    if (r == static_cast<std::int32_t>(i)) continue;
    mesh.duplicates.push_back({static_cast<std::int32_t>(i), r});
    mesh.vertex_triangle[i] = mesh.vertex_triangle[static_cast<std::size_t>(r)];
  }
  return mesh;
}

AssertionResult same_mesh(const Triangulation& mesh, const ExpectedMesh& expected) {
  if (mesh.dimension() != expected.dimension) {
    return AssertionFailure() << "dimension() is " << mesh.dimension() << ", expected " << expected.dimension;
  }
  if (mesh.number_of_points() != expected.representative.size()) {
    return AssertionFailure() << "number_of_points() is " << mesh.number_of_points();
  }
  if (3 * mesh.number_of_triangles() != mesh.triangles().size()) {
    return AssertionFailure() << "number_of_triangles() is " << mesh.number_of_triangles() << " for "
                              << mesh.triangles().size() << " indices";
  }
  AssertionResult result = same_array("duplicates", mesh.duplicates(), expected.duplicates, [](const Duplicate& d) {
    return std::to_string(d.point) + " = " + std::to_string(d.representative);
  });
  if (result) result = same_indices("triangles", mesh.triangles(), expected.triangles);
  if (result) result = same_indices("neighbors", mesh.neighbors(), expected.neighbors);
  if (result) result = same_indices("hull", mesh.hull(), expected.hull);
  if (result) result = same_indices("vertex_triangle", mesh.vertex_triangle(), expected.vertex_triangle);
  return result;
}

AssertionResult same_but_for_order(const Triangulation& mesh, const ExpectedMesh& expected,
                                   std::span<const std::size_t> order) {
  std::vector<std::int32_t> back;
  for (const std::size_t i : order) back.push_back(expected.representative[i]);
  if (mesh.dimension() != expected.dimension) return AssertionFailure() << "dimension() depends on the order";
  if (mesh.duplicates().size() != expected.duplicates.size()) {
    return AssertionFailure() << "the number of duplicates depends on the order";
  }
  return same_indices("triangles in another order", canonical_set(mesh.triangles(), back), expected.triangles);
}

std::vector<std::int32_t> canonical_set(std::span<const std::int32_t> triangles, std::span<const std::int32_t> index) {
  std::vector<Triangle> set(triangles.size() / 3);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::int32_t v = triangles[k];
    set[k / 3][k % 3] = index.empty() ? v : index[static_cast<std::size_t>(v)];
  }
  make_canonical(set);
  std::vector<std::int32_t> flat;
  flat.reserve(triangles.size());
  for (const Triangle& t : set) flat.insert(flat.end(), t.begin(), t.end());
  return flat;
}

AssertionResult verified(const Points& xy, const Triangulation& mesh) {
  const VerifyReport report = verify(std::span<const double>(xy), mesh);
  if (!report.ok) return AssertionFailure() << "verify(): " << report.summary();
  if (report.points != mesh.number_of_points() || report.triangles_examined != mesh.number_of_triangles()) {
    return AssertionFailure() << "verify() examined " << report.points << " points and " << report.triangles_examined
                              << " triangles";
  }
  return AssertionSuccess();
}

AssertionResult triangulates_as_cgal(const Points& xy, const Options& options) {
  const ExpectedMesh expected = expected_mesh(xy);
  const Triangulation mesh = triangulate(std::span<const double>(xy), options);
  AssertionResult result = same_mesh(mesh, expected);
  if (result) result = verified(xy, mesh);
  if (!result || xy.size() / 2 > permuted_up_to) return result;
  const std::vector<std::size_t> order = random_order(xy.size() / 2, xy.size());
  return same_but_for_order(triangulate(std::span<const double>(reordered(xy, order)), options), expected, order);
}

}  // namespace cadt::test
