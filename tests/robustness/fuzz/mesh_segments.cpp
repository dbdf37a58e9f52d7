// SPDX-License-Identifier: Apache-2.0
// Points and segments: a lattice, or any doubles near one another. A mesh must pass the verifier, have the triangles
// and constrained edges of CGAL, where that is installed, and be the same for several threads and other orders;
// segments that cross must be those that do, pair by pair, and make vertices on request, as CGAL's. Aborts otherwise.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <cadt/cadt.hpp>
#include <cadt/constrained.hpp>

#include "tests/robustness/fuzz/fuzz.hpp"
#include "tests/support/oracle_cdt.hpp"
#include "tests/support/oracle_constrained.hpp"

namespace {

using cadt::Segment;
using cadt::fuzz::fail;
using Pairs = std::vector<std::array<std::int32_t, 2>>;
using Place = std::array<double, 2>;

struct Input {
  std::vector<double> xy;
  std::vector<Segment> segments;
  [[nodiscard]] Place at(std::int32_t i) const {
    const auto k = 2 * static_cast<std::size_t>(i);
    return {xy[k], xy[k + 1]};
  }
  [[nodiscard]] bool crosses(const Segment& s, const Segment& t) const {
    const Place a = at(s[0]), b = at(s[1]), c = at(t[0]), d = at(t[1]);
    const auto sides = [](const Place& p, const Place& q, const Place& r, const Place& u) {
      return cadt::exact_orientation(p, q, r) * cadt::exact_orientation(p, q, u);
    };
    if (sides(a, b, c, d) >= 0 || sides(c, d, a, b) >= 0) return false;
    for (std::size_t i = 0; i < xy.size() / 2; ++i) {
      const Place p = at(static_cast<std::int32_t>(i));
      if (cadt::exact_orientation(a, b, p) == 0 && cadt::exact_orientation(c, d, p) == 0) return false;
    }
    return true;
  }
};

cadt::Triangulator& triangulator(unsigned threads) {
  const auto make = [](unsigned n) {
    cadt::Options options;
    options.backend = cadt::Backend::host;
    options.threads = n;
    options.tuning.grain = n == 1 ? 0 : 1;
    return new cadt::Triangulator(options);
  };
  static auto* const one = make(1);
  static auto* const three = make(3);
  return threads == 1 ? *one : *three;
}

void must_pass(const Input& input, const cadt::ConstrainedTriangulation& mesh,
               const cadt::ConstraintOptions& constraints) {
  cadt::VerifyOptions alone;
  alone.threads = 1;
  const cadt::VerifyReport report = cadt::verify(input.xy, input.segments, mesh, constraints, alone);
  if (!report.ok && mesh.rounded_valid()) fail(report.summary());
}

[[maybe_unused]] std::vector<cadt::test::Triangle> triangles(const cadt::ConstrainedTriangulation& mesh) {
  std::vector<cadt::test::Triangle> all;
  for (std::size_t t = 0; t < mesh.mesh().number_of_triangles(); ++t) all.push_back(mesh.mesh().triangle(t));
  cadt::test::make_canonical(all);
  return all;
}

void must_be_cgals([[maybe_unused]] const Input& input, [[maybe_unused]] const cadt::ConstrainedTriangulation& mesh) {
#if CADT_TEST_CGAL
  const cadt::test::ConstrainedOracleMesh expected = cadt::test::cgal_constrained(input.xy, input.segments);
  if (mesh.mesh().dimension() != expected.mesh.dimension) fail("CGAL's has another dimension");
  if (triangles(mesh) != expected.mesh.triangles) fail("CGAL has other triangles");
  if (!std::ranges::equal(mesh.constrained_edges(), expected.edges)) fail("CGAL has other constrained edges");
#endif
}

void must_be_cgals_with_crossings([[maybe_unused]] const Input& input,
                                  [[maybe_unused]] const cadt::ConstrainedTriangulation& mesh) {
#if CADT_TEST_CGAL
  const cadt::test::CrossedOracleMesh expected =
      cadt::test::cgal_constrained_plus(input.xy, input.segments, mesh.added_parents());
  if (expected.unknown != 0) fail("CGAL has other crossings");
  if (!std::ranges::equal(mesh.added_points(), expected.added_xy)) fail("CGAL has crossings at other places");
  if (triangles(mesh) != expected.triangles) fail("CGAL has other triangles with crossings");
  if (!std::ranges::equal(mesh.constrained_edges(), expected.constrained)) fail("CGAL has other pieces of segments");
#endif
}

void check(const Input& input, bool with_threads) {
  cadt::ConstraintOptions constraints;
  constraints.domain = cadt::Domain::layers;
  Pairs expected;
  for (std::size_t i = 0; i < input.segments.size(); ++i)
    for (std::size_t j = i + 1; j < input.segments.size(); ++j)
      if (input.crosses(input.segments[i], input.segments[j]))
        expected.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
  try {
    const auto mesh = triangulator(1).triangulate_constrained(input.xy, input.segments, constraints);
    if (!expected.empty()) fail("segments that cross are taken");
    must_pass(input, mesh, constraints);
    must_be_cgals(input, mesh);
    Input turned = input;
    std::reverse(turned.segments.begin(), turned.segments.end());
    for (std::size_t i = 0; i < turned.segments.size(); i += 2) std::swap(turned.segments[i][0], turned.segments[i][1]);
    const unsigned threads = with_threads ? 3 : 1;
    if (triangulator(threads).triangulate_constrained(turned.xy, turned.segments, constraints).hash() != mesh.hash())
      fail("the order of segments or threads change the mesh");
  } catch (const cadt::CrossingError& error) {
    if (error.pairs() != expected) fail("other pairs cross");
    constraints.crossing = cadt::Crossing::exact;
    const auto mesh = triangulator(1).triangulate_constrained(input.xy, input.segments, constraints);
    must_pass(input, mesh, constraints);
    must_be_cgals_with_crossings(input, mesh);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static cadt::fuzz::Counter meshes("meshes with segments");
  cadt::fuzz::Bytes bytes(data, size);
  const auto mode = bytes.take<std::uint8_t>();
  const int mask = mode & 1u ? 7 : 63;
  const double scale = mode & 2u ? 0.1 : 1.0;
  const std::size_t points = 1 + bytes.take<std::uint8_t>() % 64;
  Input input;
  for (std::size_t i = 0; i < 2 * points; ++i) {
    const int value = bytes.take<std::uint8_t>();
    double v = (value & mask) * scale;
    if (mode & 4u && value > 127) v = std::nextafter(v, 1e9);  // an ulp beside the lattice
    input.xy.push_back(v);
  }
  while (bytes.left() >= 2 && input.segments.size() < 96) {
    const auto from = bytes.take<std::uint8_t>() % points, to = bytes.take<std::uint8_t>() % points;
    const Segment segment = {static_cast<std::int32_t>(from), static_cast<std::int32_t>(to)};
    const bool crossed = std::any_of(input.segments.begin(), input.segments.end(),
                                     [&](const Segment& other) { return input.crosses(segment, other); });
    if (mode & 8u || !crossed) input.segments.push_back(segment);
  }
  meshes += 1;
  check(input, (mode & 16u) != 0);
  return 0;
}
