// SPDX-License-Identifier: Apache-2.0
// What a DeviceTriangulation holds, and the state of a triangulator that it shares.
#pragma once

#include <cadt/triangulator.hpp>

#include <memory>
#include <vector>

#include "common/driver/context.hpp"
#include "common/driver/device.hpp"
#include "common/driver/early_arrays.hpp"
#include "common/driver/memory.hpp"
#include "common/driver/memory_plan.hpp"
#include "common/driver/triangulation_data.hpp"

namespace cadt {

struct SegmentJob;

struct Triangulator::State {
  State(const Options& o, std::unique_ptr<Device> d, bool cache)
      : options(o), device(std::move(d)), memory(*device, cache) {}
  Options options;
  std::unique_ptr<Device> device;
  Memory memory;
  KnownSizes known;
  Device::Copied copied_before;  ///< what the device had copied when the call began
};

struct DeviceTriangulation::Data {
  std::shared_ptr<Triangulator::State> state;  // first member: destroyed last, after the memory
  std::size_t points = 0, distinct = 0, triangle_count = 0, duplicate_count = 0;
  Allocation triangles, neighbors;   ///< 3 words a triangle each
  Allocation edge_flags;             ///< a word a triangle; null without segments
  Allocation chain_offsets, chains;  ///< vertices along each of `segments` segments; null without segments
  std::size_t segments = 0, chain_length = 0;
  Allocation regions, inside;                   ///< a word a triangle; null without a domain, as the rest of it
  Allocation region_values, region_attributes;  ///< a word, a double a region
  std::size_t region_count = 0;
  Allocation triangles_inside, neighbors_inside;
  std::size_t number_inside = 0;
  /// Of all points, where they are not those of the input: crossings are added, or a grid has moved them.
  Allocation places;
  Allocation added_parents;  ///< of the last `added` points, crossings
  std::size_t added = 0;
  bool moved = false, rounded_valid = true;
  Allocation duplicate_points, representatives;  ///< null if there are none
  int dimension = -1;
  Statistics statistics;

  [[nodiscard]] std::size_t hull_size() const noexcept {
    return dimension == 2 ? 2 * distinct - 2 - triangle_count : 0;
  }
};

/// Triangulates points on the device of `state` (Triangulator::triangulate).
[[nodiscard]] std::unique_ptr<DeviceTriangulation::Data> triangulate_on_device(
    const std::shared_ptr<Triangulator::State>& state, const DevicePoints& points, SegmentJob* job = nullptr);
/// Copies the hull to the host, and the arrays that it has not, to `arrays` where there are some.
void read_mesh(Context& ctx, const DeviceTriangulation::Data& from, Triangulation::Data& to, EarlyArrays& arrays);
/// Reads lists of `count` words; they may be null if that is 0.
[[nodiscard]] std::vector<Duplicate> read_duplicates(Device& device, const Allocation& points,
                                                     const Allocation& representatives, std::size_t count);
[[nodiscard]] inline std::vector<Duplicate> read_duplicates(const DeviceTriangulation::Data& from) {
  return read_duplicates(*from.state->device, from.duplicate_points, from.representatives, from.duplicate_count);
}

}  // namespace cadt
