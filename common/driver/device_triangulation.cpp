// SPDX-License-Identifier: Apache-2.0
#include "common/driver/device_triangulation.hpp"

#include <utility>

#include "common/output/renumber.hpp"

namespace cadt {
namespace {

using device_text::word;

void* handle_of(const DeviceTriangulation::Data& data, const Allocation& memory) noexcept {
  return memory ? data.state->device->handle(*memory) : nullptr;
}

}  // namespace

std::vector<Duplicate> read_duplicates(Device& device, const Allocation& points, const Allocation& representatives,
                                       std::size_t count) {
  std::vector<Duplicate> list(count);
  if (count == 0) return list;
  const auto all = device.read_values<std::int32_t>(*points, count),
             equal = device.read_values<std::int32_t>(*representatives, count);
  for (std::size_t i = 0; i < count; ++i) list[i] = {all[i], equal[i]};
  return list;
}

void read_mesh(Context& ctx, const DeviceTriangulation::Data& from, Triangulation::Data& to, EarlyArrays& arrays) {
  to.hull = find_hull(ctx, from.triangles, from.neighbors, from.triangle_count, from.hull_size(), from.points);
  const std::size_t values = 3 * from.triangle_count;
  const auto fetch = [&](const Allocation& array, Words& words) {
    if (words != nullptr) return;  // the array itself
    words = arrays.take(values);
    ctx.device.read(*array, 0, words.get(), values * word);
  };
  fetch(from.triangles, to.triangles);
  fetch(from.neighbors, to.neighbors);
  ctx.device.finish();
}

DeviceTriangulation::DeviceTriangulation() : data_(std::make_unique<Data>()) {}
DeviceTriangulation::DeviceTriangulation(std::unique_ptr<Data> data) : data_(std::move(data)) {}
DeviceTriangulation::~DeviceTriangulation() = default;
DeviceTriangulation::DeviceTriangulation(DeviceTriangulation&&) noexcept = default;
DeviceTriangulation& DeviceTriangulation::operator=(DeviceTriangulation&&) noexcept = default;

std::size_t DeviceTriangulation::number_of_points() const noexcept { return data_->points; }
std::size_t DeviceTriangulation::number_of_triangles() const noexcept { return data_->triangle_count; }
std::size_t DeviceTriangulation::number_of_duplicates() const noexcept { return data_->duplicate_count; }
int DeviceTriangulation::dimension() const noexcept { return data_->dimension; }
const Statistics& DeviceTriangulation::statistics() const noexcept { return data_->statistics; }

void* DeviceTriangulation::triangles() const noexcept { return handle_of(*data_, data_->triangles); }
void* DeviceTriangulation::neighbors() const noexcept { return handle_of(*data_, data_->neighbors); }
void* DeviceTriangulation::edge_flags() const noexcept { return handle_of(*data_, data_->edge_flags); }
void* DeviceTriangulation::chain_offsets() const noexcept { return handle_of(*data_, data_->chain_offsets); }
void* DeviceTriangulation::chain_vertices() const noexcept { return handle_of(*data_, data_->chains); }
std::size_t DeviceTriangulation::chain_length() const noexcept { return data_->chain_length; }
void* DeviceTriangulation::regions() const noexcept { return handle_of(*data_, data_->regions); }
void* DeviceTriangulation::inside() const noexcept { return handle_of(*data_, data_->inside); }
std::size_t DeviceTriangulation::number_of_regions() const noexcept { return data_->region_count; }
void* DeviceTriangulation::region_values() const noexcept { return handle_of(*data_, data_->region_values); }
void* DeviceTriangulation::region_attributes() const noexcept { return handle_of(*data_, data_->region_attributes); }
void* DeviceTriangulation::triangles_inside() const noexcept { return handle_of(*data_, data_->triangles_inside); }
void* DeviceTriangulation::neighbors_inside() const noexcept { return handle_of(*data_, data_->neighbors_inside); }
std::size_t DeviceTriangulation::number_inside() const noexcept { return data_->number_inside; }
std::size_t DeviceTriangulation::number_added() const noexcept { return data_->added; }
void* DeviceTriangulation::all_points() const noexcept { return handle_of(*data_, data_->places); }
void* DeviceTriangulation::added_parents() const noexcept { return handle_of(*data_, data_->added_parents); }
bool DeviceTriangulation::rounded_valid() const noexcept { return data_->rounded_valid; }
void* DeviceTriangulation::duplicate_points() const noexcept { return handle_of(*data_, data_->duplicate_points); }
void* DeviceTriangulation::representatives() const noexcept { return handle_of(*data_, data_->representatives); }

Triangulation DeviceTriangulation::download() const {
  auto copy = std::make_unique<Triangulation::Data>();
  copy->points = data_->points;
  copy->triangle_count = data_->triangle_count;
  copy->dimension = data_->dimension;
  copy->constrained = static_cast<bool>(data_->edge_flags);
  copy->statistics = data_->statistics;
  if (data_->state == nullptr) return Triangulation(std::move(copy));
  Device& device = *data_->state->device;
  copy->duplicates = read_duplicates(*data_);
  if (data_->triangle_count != 0) {
    Context ctx(device, data_->state->memory, data_->state->options, copy->statistics);
    EarlyArrays none;
    read_mesh(ctx, *data_, *copy, none);
  }
  return Triangulation(std::move(copy));
}

}  // namespace cadt
