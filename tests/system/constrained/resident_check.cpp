// SPDX-License-Identifier: Apache-2.0
#include "tests/system/constrained/resident_check.hpp"

#include <cadt/triangulator.hpp>
#include <cadt/verify.hpp>

#include "tests/system/resident/device_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

void expect_same(const Triangulation& mesh, const Triangulation& expected) {
  EXPECT_EQ(mesh.number_of_points(), expected.number_of_points());
  EXPECT_EQ(mesh.dimension(), expected.dimension());
  EXPECT_TRUE(std::ranges::equal(mesh.triangles(), expected.triangles()));
  EXPECT_TRUE(std::ranges::equal(mesh.neighbors(), expected.neighbors()));
  EXPECT_TRUE(std::ranges::equal(mesh.hull(), expected.hull()));
  EXPECT_TRUE(std::ranges::equal(mesh.duplicates(), expected.duplicates()));
}

void expect_same(const ConstrainedTriangulation& mesh, const ConstrainedTriangulation& expected) {
  expect_same(mesh.mesh(), expected.mesh());
  EXPECT_TRUE(std::ranges::equal(mesh.edge_flags(), expected.edge_flags()));
  EXPECT_TRUE(std::ranges::equal(mesh.chain_offsets(), expected.chain_offsets()));
  EXPECT_TRUE(std::ranges::equal(mesh.chain_vertices(), expected.chain_vertices()));
  EXPECT_TRUE(std::ranges::equal(mesh.constrained_edges(), expected.constrained_edges()));
  EXPECT_TRUE(std::ranges::equal(mesh.degenerate_segments(), expected.degenerate_segments()));
  EXPECT_TRUE(std::ranges::equal(mesh.region(), expected.region()));
  EXPECT_TRUE(std::ranges::equal(mesh.region_value(), expected.region_value()));
  EXPECT_TRUE(std::ranges::equal(mesh.region_attribute(), expected.region_attribute()));
  EXPECT_TRUE(std::ranges::equal(mesh.inside(), expected.inside()));
  EXPECT_EQ(mesh.number_inside(), expected.number_inside());
  EXPECT_EQ(mesh.triangles_inside(), expected.triangles_inside());
  EXPECT_TRUE(std::ranges::equal(mesh.added_points(), expected.added_points()));
  EXPECT_TRUE(std::ranges::equal(mesh.added_parents(), expected.added_parents()));
  EXPECT_TRUE(std::ranges::equal(mesh.moved_points(), expected.moved_points()));
  EXPECT_EQ(mesh.rounded_valid(), expected.rounded_valid());
}

/// What handles have, and what they have not.
void expect_handles(const DeviceTriangulation& mesh, DeviceMemory& memory, const ConstrainedTriangulation& expected,
                    const ConstraintOptions& constraints, const Points& xy) {
  const std::size_t count = mesh.number_of_triangles(), segments = expected.chain_offsets().size() - 1;
  const auto same = [&]<class T>(const void* handle, std::span<const T> values) {
    const std::vector<T> there = memory.download<T>(handle, values.size());
    return std::ranges::equal(there, values);
  };
  EXPECT_TRUE(same(mesh.edge_flags(), expected.edge_flags()));
  EXPECT_EQ(mesh.chain_offsets() == nullptr, segments == 0);
  EXPECT_EQ(mesh.chain_length(), expected.chain_vertices().size());
  EXPECT_TRUE(same(mesh.chain_vertices(), expected.chain_vertices()));
  const auto offsets = memory.download<std::uint32_t>(mesh.chain_offsets(), segments + 1);
  EXPECT_TRUE(std::ranges::equal(offsets, segments != 0 ? expected.chain_offsets() : std::span<const std::int64_t>()));
  if (constraints.domain == Domain::hull || count == 0) {
    EXPECT_EQ(mesh.regions(), nullptr);
    EXPECT_EQ(mesh.inside(), nullptr);
    EXPECT_EQ(mesh.region_values(), nullptr);
    EXPECT_EQ(mesh.region_attributes(), nullptr);
    EXPECT_EQ(mesh.number_of_regions(), 0U);
  } else {
    EXPECT_EQ(mesh.number_of_regions(), expected.number_of_regions());
    EXPECT_TRUE(same(mesh.regions(), expected.region()));
    EXPECT_TRUE(same(mesh.region_values(), expected.region_value()));
    EXPECT_TRUE(same(mesh.region_attributes(), expected.region_attribute()));
    EXPECT_TRUE(std::ranges::equal(memory.download<std::uint32_t>(mesh.inside(), count), expected.inside()));
    EXPECT_EQ(mesh.number_inside(), expected.number_inside());
    EXPECT_EQ(memory.download<std::int32_t>(mesh.triangles_inside(), 3 * mesh.number_inside()),
              expected.triangles_inside());
  }
  EXPECT_EQ(mesh.number_added(), expected.added_parents().size());
  EXPECT_TRUE(same(mesh.added_parents(), expected.added_parents()));
  const bool has_points = mesh.number_added() != 0 || (constraints.crossing == Crossing::grid && !xy.empty());
  EXPECT_EQ(mesh.all_points() != nullptr, has_points);
  if (!has_points) return;
  std::vector<double> all = constraints.crossing == Crossing::grid
                                ? std::vector<double>(expected.moved_points().begin(), expected.moved_points().end())
                                : xy;
  all.insert(all.end(), expected.added_points().begin(), expected.added_points().end());
  EXPECT_EQ(memory.download<double>(mesh.all_points(), 2 * mesh.number_of_points()), all);
}

/// An open device and memory on it: opening takes longer than most tests.
struct Resident {
  std::unique_ptr<DeviceMemory> memory;
  Triangulator triangulator;
};
Resident& resident(const Options& given) {
  using Key = std::pair<Backend, unsigned>;
  static auto* const open = new std::map<Key, Resident>;  // devices may be gone when static objects are destroyed
  const Key key = {given.backend, given.threads};
  if (const auto found = open->find(key); found != open->end()) return found->second;
  Options options = given;
  auto memory = device_memory(options.backend, Triangulator(options).device().index);
  if (memory->queue() != nullptr) options.queue = memory->queue();
  Triangulator triangulator(options);
  return open->emplace(key, Resident{std::move(memory), std::move(triangulator)}).first->second;
}

/// Data on the device; null if there is none.
struct Uploaded {
  Uploaded(DeviceMemory& m, std::span<const std::byte> data)
      : memory(m), handle(data.empty() ? nullptr : m.allocate(data.size())) {
    if (handle != nullptr) memory.write(handle, 0, data);
  }
  Uploaded(const Uploaded&) = delete;
  Uploaded& operator=(const Uploaded&) = delete;
  ~Uploaded() {
    if (handle != nullptr) memory.free(handle);
  }
  DeviceMemory& memory;
  void* handle;
};

/// The message of what is thrown; empty if nothing is.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

void expect_same_in_device_memory(const Options& given, const Points& xy, const std::vector<Segment>& segments,
                                  const ConstraintOptions& constraints) {
  SCOPED_TRACE("in device memory, domain " + std::to_string(static_cast<int>(constraints.domain)));
  Resident& device = resident(given);
  const bool doubles = device.triangulator.device().fp64;
  const std::vector<float> floats(xy.begin(), xy.end());
  const PointsView view = doubles ? PointsView(xy) : PointsView(floats);
  const Uploaded there(*device.memory, doubles ? std::as_bytes(std::span(xy)) : std::as_bytes(std::span(floats))),
      pairs_there(*device.memory, std::as_bytes(std::span(segments)));
  const DeviceArray pairs = {pairs_there.handle, 2 * segments.size()};
  const DevicePoints points = {
      .x = there.handle, .size = xy.size() / 2, .scalar = doubles ? Scalar::float64 : Scalar::float32};
  ConstrainedTriangulation expected;
  DeviceTriangulation mesh;
  const std::string refused = refusal([&] { expected = triangulate_constrained(view, segments, constraints, given); });
  EXPECT_EQ(refusal([&] { mesh = device.triangulator.triangulate_constrained(points, pairs, constraints); }), refused);
  if (!refused.empty()) return;
  expect_handles(mesh, *device.memory, expected, constraints, doubles ? xy : Points(floats.begin(), floats.end()));
  expect_same(mesh.download_constrained(), expected);
  const bool as_given = mesh.all_points() == nullptr;
  VerifyReport report;
  const std::string unverified = refusal([&] { report = device.triangulator.verify(points, mesh); });
  if (as_given) {
    EXPECT_EQ(unverified, "");
    EXPECT_TRUE(report.ok) << report.summary();
  } else {
    EXPECT_NE(unverified.find("verify download_constrained()"), std::string::npos) << unverified;
  }
}

}  // namespace cadt::test
