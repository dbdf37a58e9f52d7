// SPDX-License-Identifier: Apache-2.0
// Segments between points of a device without doubles, from the host and in device memory.
#include "tests/system/constrained/resident_check.hpp"
#include "tests/system/floats/floats.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <algorithm>

namespace cadt::test {
namespace {

ConstraintOptions with(Crossing crossing, Domain domain) {
  ConstraintOptions constraints;
  constraints.crossing = crossing;
  constraints.domain = domain;
  constraints.grid = 0.25;
  if (domain == Domain::seeds) constraints.holes = {{0.5, 0.5}};
  return constraints;
}

/// Sets with whole numbers, and random ones.
std::vector<SegmentSet> sets() {
  std::vector<SegmentSet> list;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    list.push_back(lattice_segments(seed, 7, 12, 1, 1));
    list.push_back(random_segments(seed, 60, 0.3));
    list.push_back(random_segments(seed, 40, 0.01));  // few of which cross
    const Floats rounded = floats_of(list.back().xy);
    list.back().xy = doubles_of(rounded);
    list[list.size() - 2].xy = doubles_of(floats_of(list[list.size() - 2].xy));
  }
  return list;
}

class FloatSegments : public FloatTest {};

TEST_F(FloatSegments, MeshesAreThoseOfTheHost) {
  int made = 0;
  for (const SegmentSet& set : sets()) {
    SCOPED_TRACE(set.name);
    const Floats xy = floats_of(set.xy);
    for (const Crossing crossing : {Crossing::error, Crossing::exact}) {
      const ConstraintOptions constraints = with(crossing, Domain::layers);
      ConstrainedTriangulation mesh, expected;
      std::string refused, expected_refusal;
      try {
        expected = triangulate_constrained(FloatSpan(xy), set.segments, constraints, host_options());
      } catch (const CrossingError& error) {
        expected_refusal = error.what();
      }
      try {
        mesh = triangulate_constrained(FloatSpan(xy), set.segments, constraints, float_options());
      } catch (const CrossingError& error) {
        refused = error.what();
      }
      EXPECT_EQ(refused, expected_refusal);
      if (!refused.empty()) continue;
      ++made;
      EXPECT_EQ(mesh.hash(), expected.hash());
      EXPECT_TRUE(std::ranges::equal(mesh.region_value(), expected.region_value()));
      EXPECT_TRUE(std::ranges::equal(mesh.added_points(), expected.added_points()));
    }
  }
  EXPECT_GT(made, 9);
}

TEST_F(FloatSegments, SameInDeviceMemory) {
  for (const SegmentSet& set : sets())
    for (const Crossing crossing : {Crossing::error, Crossing::exact})
      for (const Domain domain : {Domain::hull, Domain::layers, Domain::seeds})
        expect_same_in_device_memory(float_options(), set.xy, set.segments, with(crossing, domain));
}

TEST_F(FloatSegments, GridsAreRefused) {
  const SegmentSet set = sets().front();
  const ConstraintOptions constraints = with(Crossing::grid, Domain::hull);
  expect_same_in_device_memory(float_options(), set.xy, set.segments, constraints);
  try {
    static_cast<void>(
        triangulate_constrained(FloatSpan(floats_of(set.xy)), set.segments, constraints, float_options()));
    ADD_FAILURE() << "no error";
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("takes no doubles"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace cadt::test
