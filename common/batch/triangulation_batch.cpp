// SPDX-License-Identifier: Apache-2.0
#include "common/batch/triangulation_batch.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/output/renumber.hpp"

namespace cadt {
namespace {

using device_text::word;

void require_set(const BatchShape& shape, std::size_t set) {
  if (set >= shape.dimensions.size())
    throw InputError("there is no set " + std::to_string(set) + ", only " + std::to_string(shape.dimensions.size()),
                     set);
}

std::span<const Duplicate> duplicates_of(const BatchShape& shape, std::size_t set) {
  require_set(shape, set);
  return std::span(shape.duplicate_list)
      .subspan(shape.duplicates[set], shape.duplicates[set + 1] - shape.duplicates[set]);
}

int dimension_of(const BatchShape& shape, std::size_t set) {
  require_set(shape, set);
  return shape.dimensions[set];
}

std::span<const std::int32_t> all_of(const BatchShape& shape, const Words& words) noexcept {
  return {words.get(), 3 * shape.triangles.back()};
}

std::span<const std::int32_t> part_of(const BatchShape& shape, const Words& words, std::size_t set) {
  require_set(shape, set);
  return all_of(shape, words).subspan(3 * shape.triangles[set], 3 * (shape.triangles[set + 1] - shape.triangles[set]));
}

}  // namespace

TriangulationBatch::TriangulationBatch() : data_(std::make_unique<Data>()) {}
TriangulationBatch::TriangulationBatch(std::unique_ptr<Data> data) : data_(std::move(data)) {}
TriangulationBatch::~TriangulationBatch() = default;
TriangulationBatch::TriangulationBatch(TriangulationBatch&&) noexcept = default;
TriangulationBatch& TriangulationBatch::operator=(TriangulationBatch&&) noexcept = default;

std::size_t TriangulationBatch::size() const noexcept { return data_->shape.dimensions.size(); }
std::span<const std::size_t> TriangulationBatch::triangle_offsets() const noexcept { return data_->shape.triangles; }
std::span<const std::int32_t> TriangulationBatch::triangles() const noexcept {
  return all_of(data_->shape, data_->triangles);
}
std::span<const std::int32_t> TriangulationBatch::neighbors() const noexcept {
  return all_of(data_->shape, data_->neighbors);
}
std::span<const std::int32_t> TriangulationBatch::triangles(std::size_t set) const {
  return part_of(data_->shape, data_->triangles, set);
}
std::span<const std::int32_t> TriangulationBatch::neighbors(std::size_t set) const {
  return part_of(data_->shape, data_->neighbors, set);
}
std::size_t TriangulationBatch::number_of_points(std::size_t set) const {
  require_set(data_->shape, set);
  return data_->shape.points[set + 1] - data_->shape.points[set];
}
int TriangulationBatch::dimension(std::size_t set) const { return dimension_of(data_->shape, set); }
std::span<const Duplicate> TriangulationBatch::duplicates(std::size_t set) const {
  return duplicates_of(data_->shape, set);
}
const Statistics& TriangulationBatch::statistics() const noexcept { return data_->shape.statistics; }

Triangulation TriangulationBatch::triangulation(std::size_t set) const {
  const auto vertices = triangles(set), half_edges = neighbors(set);
  const auto equal = duplicates(set);
  auto one = std::make_unique<Triangulation::Data>();
  one->points = number_of_points(set);
  one->triangle_count = vertices.size() / 3;
  one->dimension = dimension(set);
  one->duplicates.assign(equal.begin(), equal.end());
  one->statistics = statistics();
  one->triangles = make_words(vertices.size());
  one->neighbors = make_words(half_edges.size());
  std::ranges::copy(vertices, one->triangles.get());
  std::ranges::copy(half_edges, one->neighbors.get());
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    if (half_edges[i] >= 0) continue;
    const std::size_t first = i / 3 * 3;
    edges.push_back({static_cast<std::uint32_t>(vertices[first + (i + 1) % 3]),
                     static_cast<std::uint32_t>(vertices[first + (i + 2) % 3])});
  }
  if (!edges.empty()) one->hull = chain_loop(std::move(edges), one->points);
  return Triangulation(std::move(one));
}

DeviceTriangulationBatch::DeviceTriangulationBatch() : data_(std::make_unique<Data>()) {}
DeviceTriangulationBatch::DeviceTriangulationBatch(std::unique_ptr<Data> data) : data_(std::move(data)) {}
DeviceTriangulationBatch::~DeviceTriangulationBatch() = default;
DeviceTriangulationBatch::DeviceTriangulationBatch(DeviceTriangulationBatch&&) noexcept = default;
DeviceTriangulationBatch& DeviceTriangulationBatch::operator=(DeviceTriangulationBatch&&) noexcept = default;

std::size_t DeviceTriangulationBatch::size() const noexcept { return data_->shape.dimensions.size(); }
std::span<const std::size_t> DeviceTriangulationBatch::triangle_offsets() const noexcept {
  return data_->shape.triangles;
}
void* DeviceTriangulationBatch::device_triangle_offsets() const noexcept {
  return data_->offsets ? data_->state->device->handle(*data_->offsets) : nullptr;
}
void* DeviceTriangulationBatch::triangles() const noexcept {
  return data_->shape.triangles.back() != 0 ? data_->state->device->handle(*data_->triangles) : nullptr;
}
void* DeviceTriangulationBatch::neighbors() const noexcept {
  return data_->shape.triangles.back() != 0 ? data_->state->device->handle(*data_->neighbors) : nullptr;
}
int DeviceTriangulationBatch::dimension(std::size_t set) const { return dimension_of(data_->shape, set); }
std::span<const Duplicate> DeviceTriangulationBatch::duplicates(std::size_t set) const {
  return duplicates_of(data_->shape, set);
}
const Statistics& DeviceTriangulationBatch::statistics() const noexcept { return data_->shape.statistics; }

TriangulationBatch DeviceTriangulationBatch::download() const {
  auto copy = std::make_unique<TriangulationBatch::Data>();
  copy->shape = data_->shape;
  if (const std::size_t values = 3 * data_->shape.triangles.back(); values != 0) {
    copy->triangles = make_words(values);
    copy->neighbors = make_words(values);
    data_->state->device->read(*data_->triangles, 0, copy->triangles.get(), values * word);
    data_->state->device->read(*data_->neighbors, 0, copy->neighbors.get(), values * word);
  }
  return TriangulationBatch(std::move(copy));
}

}  // namespace cadt
