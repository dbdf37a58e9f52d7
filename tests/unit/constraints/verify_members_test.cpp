// SPDX-License-Identifier: Apache-2.0
// The verifier of what a constrained mesh says beside its triangles: whatever is changed fails. And calls that would
// make meshes that no verifier accepts.
#include <gtest/gtest.h>
#include <cadt/polygons.hpp>

#include <array>
#include <cstdint>
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

struct Made {
  SegmentSet set;
  ConstraintOptions options;
  ConstrainedTriangulation mesh;

  Made(SegmentSet of, Crossing crossing) : set(std::move(of)) {
    options.crossing = crossing;
    options.grid = 1.0 / 256;
    Options host;
    host.backend = Backend::host;
    host.threads = 1;
    mesh = triangulate_constrained(set.xy, set.segments, options, host);
    EXPECT_EQ(after([](Data&) {}), "");
  }
  /// The first check that fails once the arrays are changed, and what it says, or "".
  [[nodiscard]] std::string after(const std::function<void(Data&)>& change) const {
    const std::shared_ptr<Data> data = copy_of(mesh);
    change(*data);
    const VerifyReport report = verify(set.xy, set.segments, ConstrainedTriangulation(data), options);
    for (const Check& check : report.checks)
      if (!check.passed) return check.name + ": " + check.what;
    EXPECT_TRUE(report.ok);
    return "";
  }
  void expect(const std::string& part, const std::function<void(Data&)>& change) const {
    const std::string what = after(change);
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }
};

const std::vector<Crossing> rules_of_crossings = {Crossing::exact, Crossing::grid};

/// Edges beside rounded crossings are exempt from the check of circles, from both sides whatever their flags.
TEST(VerifyMembers, BitsOfOneSideBesideCrossings) {
  const Made made(random_segments(4, 40, 0.4), Crossing::exact);
  const Triangulation& mesh = made.mesh.mesh();
  for (std::size_t e = 0; e < 3 * mesh.number_of_triangles(); ++e) {
    if (mesh.neighbors()[e] < 0) continue;
    const std::string what = made.after([&](Data& data) { data.edge_flags[e / 3] ^= 1U << e % 3; });
    EXPECT_TRUE(what.starts_with("neighbors") || what.find("on one side alone") != std::string::npos) << what;
  }
  // Two of them, so that their number is even.
  std::vector<std::size_t> exempt;
  for (std::size_t e = 0; e < 3 * mesh.number_of_triangles() && exempt.size() < 2; ++e)
    if ((made.mesh.edge_flags()[e / 3] >> e % 3 & 1U) != 0 && mesh.neighbors()[e] >= 0 &&
        mesh.triangles()[e - e % 3 + (e + 1) % 3] >= 80 && (exempt.empty() || e / 3 != exempt[0] / 3) &&
        (exempt.empty() || mesh.neighbors()[e] != static_cast<std::int32_t>(exempt[0] / 3)))
      exempt.push_back(e);
  ASSERT_EQ(exempt.size(), 2U);
  made.expect("on one side alone", [&](Data& data) {
    for (const std::size_t e : exempt) data.edge_flags[e / 3] ^= 1U << e % 3;
  });
  made.expect("more than three flags", [](Data& data) { data.edge_flags[2] |= 8U; });
}

TEST(VerifyMembers, ChainsOfPointsOnOneLine) {
  const Made made({"line", {0, 0, 3, 3, 1, 1, 1, 1, 2, 2, 9, 9}, {{0, 1}, {5, 2}, {3, 3}, {1, 4}}}, Crossing::error);
  ASSERT_EQ(made.mesh.mesh().number_of_triangles(), 0U);
  const std::vector<std::int32_t> along(made.mesh.chain_vertices().begin(), made.mesh.chain_vertices().end());
  ASSERT_EQ(along, (std::vector<std::int32_t>{0, 2, 4, 1, 5, 1, 4, 2, 1, 4}));
  const auto without = [&](std::size_t place, std::size_t segment) {
    return [=](Data& data) {
      data.chain_vertices.erase(data.chain_vertices.begin() + static_cast<std::ptrdiff_t>(place));
      for (std::size_t s = segment + 1; s < data.chain_offsets.size(); ++s) --data.chain_offsets[s];
    };
  };
  for (const std::size_t place : {1U, 2U}) made.expect("segment 0 leaves out a vertex on it", without(place, 0));
  for (const std::size_t place : {5U, 6U}) made.expect("segment 1 leaves out a vertex on it", without(place, 1));
  made.expect("segment 0 leaves out", [](Data& data) { data.chain_vertices[1] = 3; });  // equals point 2
  made.expect("segment 1 leaves out", [](Data& data) { data.chain_vertices[7] = 3; });
}

TEST(VerifyMembers, WhatIsSaidOfTheWhole) {
  for (const Crossing crossing : rules_of_crossings) {
    SegmentSet set = random_segments(4, 60, 0.4);
    set.segments.push_back({7, 7});
    const Made made(set, crossing);
    const auto last = static_cast<std::int32_t>(set.segments.size()) - 1;
    ASSERT_EQ(made.mesh.degenerate_segments().back(), last);
    made.expect("degenerate segments", [](Data& data) { data.degenerate.pop_back(); });
    made.expect("degenerate segments", [](Data& data) { data.degenerate.insert(data.degenerate.begin(), 0); });
    made.expect("rounded_valid", [](Data& data) { data.rounded_valid = false; });
    made.expect("attribute", [](Data& data) { data.region_attribute[0] = 1; });
  }
}

TEST(VerifyMembers, PairsOfCrossingsOnAGrid) {
  const Made made(random_segments(4, 60, 0.4), Crossing::grid);
  const std::size_t added = made.mesh.added_parents().size();
  ASSERT_GT(added, 20U);
  made.expect("pairs of segments for", [](Data& data) { data.parents.pop_back(); });
  for (std::size_t i = 0; i < added; ++i) {
    made.expect("no crossing", [&](Data& data) { std::swap(data.parents[i][0], data.parents[i][1]); });
    made.expect("no crossing", [&](Data& data) { std::swap(data.parents[i], data.parents[(i + 1) % added]); });
    made.expect("no crossing", [&](Data& data) { data.parents[i][1] = data.parents[i][1] == 59 ? 58 : 59; });
  }
}

TEST(VerifyMembers, StabilizingAsInThePaperIsRefused) {
  const SegmentSet set = random_segments(4, 6, 0.1);
  const std::array<std::int64_t, 2> offsets = {0, 4}, one = {0, 1};
  const std::vector<double> ring = {0, 0, 1, 0, 1, 1, 0, 1};
  Options options;
  options.backend = Backend::host;
  for (const Stabilize mode : {Stabilize::off, Stabilize::defer, Stabilize::paper}) {
    options.tuning.stabilize = mode;
    const auto refused = [&](const std::function<void()>& call) {
      try {
        call();
      } catch (const OptionError& e) {
        return e.option() == "tuning.stabilize";
      }
      return false;
    };
    EXPECT_EQ(refused([&] { (void)triangulate_constrained(set.xy, {}, {}, options); }), mode == Stabilize::paper);
    EXPECT_EQ(refused([&] { (void)triangulate_polygons(ring, offsets, one, options); }), mode == Stabilize::paper);
  }
}

/// A number of columns that times the points is that of the values, modulo 2^64.
TEST(ValuesAtCrossings, NumbersOfColumnsThatOverflow) {
  const SegmentSet set{"cross", {0, 0, 2, 2, 0, 2, 2, 0}, {{0, 1}, {2, 3}}};
  const Made made(set, Crossing::exact);
  const std::vector<double> values = {0, 1, 2, 3};
  EXPECT_EQ(values_at_crossings(set.xy, values, 1, made.mesh).size(), 5U);
  for (const std::size_t columns : {std::size_t{2}, std::size_t{0}, (std::size_t{1} << 62) + 1})
    EXPECT_THROW((void)values_at_crossings(set.xy, values, columns, made.mesh), InputError);
}

}  // namespace
}  // namespace cadt::test
