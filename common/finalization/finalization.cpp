// SPDX-License-Identifier: Apache-2.0
// What the public types of finalization do beside the work.
#include <cadt/finalization.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/finalization/finish.hpp"

namespace cadt {

using namespace device_text;

bool TileBox::is_plane() const noexcept { return *this == TileBox{}; }

DevicePart::DevicePart() : data_(std::make_unique<Data>()) {}
DevicePart::DevicePart(std::unique_ptr<Data> data) : data_(std::move(data)) {}
DevicePart::~DevicePart() = default;
DevicePart::DevicePart(DevicePart&&) noexcept = default;
DevicePart& DevicePart::operator=(DevicePart&&) noexcept = default;

std::size_t DevicePart::number_of_points() const noexcept { return data_->point_count; }
std::size_t DevicePart::number_of_triangles() const noexcept { return data_->triangle_count; }

namespace {

void* handle_of(const DevicePart::Data& data, const Allocation& memory) noexcept {
  return memory ? data.state->device->handle(*memory) : nullptr;
}

}  // namespace

void* DevicePart::triangles() const noexcept { return handle_of(*data_, data_->triangles); }
void* DevicePart::neighbors() const noexcept { return handle_of(*data_, data_->neighbors); }
void* DevicePart::points() const noexcept { return handle_of(*data_, data_->points); }
void* DevicePart::ids() const noexcept { return handle_of(*data_, data_->ids); }

Hash128 DevicePart::hash() const {
  Hash128 sum;
  const std::size_t count = data_->triangle_count;
  if (count == 0) return sum;
  Statistics statistics;
  Context ctx(*data_->state->device, data_->state->memory, data_->state->options, statistics);
  const LaunchGrid parts = ctx.launcher.parts(count);
  Allocation rows = ctx.memory.allocate(parts.items * sizeof(cadt_hash));
  ctx.launcher.run<KernelId::cadt_hash_triangles>(data_->triangles, data_->ids, parts, parts.items, rows);
  constexpr std::uint32_t most_read = 1024;
  const std::uint32_t each = (parts.items - 1) / most_read + 1;
  const LaunchGrid few{(parts.items - 1) / each + 1, parts.items, each};
  if (each > 1) {
    Allocation merged = ctx.memory.allocate(few.items * sizeof(cadt_hash));
    ctx.launcher.run<KernelId::cadt_merge_hashes>(rows, few, few.items, merged);
    rows = std::move(merged);
  }
  for (const cadt_hash& row : ctx.device.read_values<cadt_hash>(*rows, few.items)) {
    sum.high += row.high;
    sum.low += row.low;
  }
  return sum;
}

Part DevicePart::download() const {
  Part part;
  part.triangles.resize(3 * data_->triangle_count);
  part.neighbors.resize(3 * data_->triangle_count);
  download(part.triangles, part.neighbors);
  return part;
}

void DevicePart::download(std::span<std::int32_t> triangles, std::span<std::int32_t> neighbors) const {
  const std::size_t count = 3 * data_->triangle_count;
  if (triangles.size() != count || neighbors.size() != count) {
    throw std::invalid_argument("a part of " + std::to_string(data_->triangle_count) +
                                " triangles needs two arrays of " + std::to_string(count) + " numbers");
  }
  if (count == 0) return;
  Device& device = *data_->state->device;
  device.read(*data_->triangles, 0, triangles.data(), triangles.size_bytes());
  device.read(*data_->neighbors, 0, neighbors.data(), neighbors.size_bytes());
}

NodeSums& NodeSums::operator+=(const NodeSums& other) noexcept {
  points += other.points;
  distinct += other.distinct;
  triangles += other.triangles;
  hull_edges += other.hull_edges;
  certified_edges += other.certified_edges;
  dimension = std::max(dimension, other.dimension);
  hash.high += other.hash.high;
  hash.low += other.hash.low;
  return *this;
}

void require_complete(const NodeSums& whole) {
  const std::uint64_t triangles = whole.dimension == 2 ? 2 * whole.distinct - 2 - whole.hull_edges : 0;
  if (whole.triangles != triangles)
    give_up("the nodes have ", whole.triangles, " triangles, and there should be ", triangles);
  const std::uint64_t edges = (3 * triangles - whole.hull_edges) / 2;
  if (whole.certified_edges != edges)
    give_up("the nodes have examined ", whole.certified_edges, " edges, and there are ", edges);
}

Hash128 hash_of(const NodeSums& whole) noexcept {
  cadt_hash hash = {whole.hash.high, whole.hash.low};
  cadt_hash_add(&hash, CADT_HASH_COUNTS, whole.points, whole.triangles, whole.hull_edges);
  cadt_hash_add(&hash, CADT_HASH_DIMENSION, static_cast<std::uint64_t>(whole.dimension + 1), 0, 0);
  return {hash.high, hash.low};
}

Hash128 hash_of(std::span<const std::uint64_t> ids, std::span<const std::int32_t> triangles,
                std::span<const DuplicateId> duplicates) {
  if (triangles.size() % 3 != 0)
    throw std::invalid_argument("triangles have three points each, these have " + std::to_string(triangles.size()) +
                                " in all");
  cadt_hash hash = {0, 0};
  const auto id = [&](std::size_t i) {
    const auto vertex = static_cast<std::size_t>(triangles[i]);
    if (vertex >= ids.size())
      throw std::invalid_argument("triangle " + std::to_string(i / 3) + " has the vertex " +
                                  std::to_string(triangles[i]) + ", and there are ids of " +
                                  std::to_string(ids.size()) + " points");
    return ids[vertex];
  };
  for (std::size_t i = 0; i < triangles.size(); i += 3) cadt_hash_add_triangle(&hash, id(i), id(i + 1), id(i + 2));
  for (const DuplicateId& d : duplicates) cadt_hash_add(&hash, CADT_HASH_DUPLICATE, d.point, d.representative, 0);
  return {hash.high, hash.low};
}

}  // namespace cadt
