// SPDX-License-Identifier: Apache-2.0
#include <cadt/triangulation.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>

#include "common/driver/device_text.hpp"
#include "common/driver/triangulation_data.hpp"

namespace cadt {
namespace {

/// The vertices of a triangle, the smallest index first.
using Corners = std::array<std::int32_t, 3>;

std::vector<Corners> sorted_triangles(const Triangulation& mesh) {
  const auto v = mesh.triangles();
  std::vector<Corners> result(mesh.number_of_triangles());
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::copy_n(v.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, result[i].begin());
    std::rotate(result[i].begin(), std::min_element(result[i].begin(), result[i].end()), result[i].end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

void require_triangle(std::size_t t, std::size_t count) {
  if (t >= count) throw InputError("there is no triangle " + std::to_string(t) + ", only " + std::to_string(count), t);
}

}  // namespace

Words make_words(std::size_t count) {
  Words words(static_cast<std::int32_t*>(platform::allocate(alignof(std::max_align_t), count * sizeof(std::int32_t))));
  if (words == nullptr) throw std::bad_alloc();
  return words;
}

Words cut_words(Words words, std::size_t all, std::size_t count) noexcept {
  platform::give_back(words.get(), all * sizeof(std::int32_t), count * sizeof(std::int32_t));
  return words;
}

std::size_t count_differing(const Triangulation& mesh, const Triangulation& other) {
  const std::vector<Corners> mine = sorted_triangles(mesh), theirs = sorted_triangles(other);
  std::size_t common = 0;
  for (auto a = mine.begin(), b = theirs.begin(); a != mine.end() && b != theirs.end();) {
    if (*a == *b) {
      ++common, ++a, ++b;
    } else {
      ++(*a < *b ? a : b);
    }
  }
  return mine.size() - common;
}

std::string_view to_string(Strategy strategy) noexcept {
  switch (strategy) {
    case Strategy::automatic:
      return "auto";
    case Strategy::locks:
      return "locks";
    case Strategy::stars:
      return "stars";
  }
  return "unknown";
}

std::string_view to_string(Stabilize mode) noexcept {
  constexpr std::array<std::string_view, 3> names = {"off", "defer", "paper"};
  return names[static_cast<std::size_t>(mode)];
}

std::string_view to_string(StatisticsDetail detail) noexcept {
  constexpr std::array<std::string_view, 3> names = {"none", "counters", "timing"};
  return names[static_cast<std::size_t>(detail)];
}

std::string Hash128::to_string() const {
  std::string text;
  for (const std::uint64_t part : {high, low})
    for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[(part >> shift) & 15U];
  return text;
}

void give_points(Triangulation::Data& mesh, const PointsView& points, KeepPoints how, std::span<const double> added) {
  if (how == KeepPoints::no) return;
  mesh.view = points;
  if (how == KeepPoints::view && added.empty()) return;
  std::vector<double>& xy = mesh.coordinates;
  xy.resize(2 * points.size() + added.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    xy[2 * i] = points.x(i);
    xy[2 * i + 1] = points.y(i);
  }
  std::ranges::copy(added, xy.end() - static_cast<std::ptrdiff_t>(added.size()));
  mesh.view = xy;
}

Triangulation::Triangulation() : data_(std::make_shared<Data>()) {}
Triangulation::Triangulation(const Triangulation&) noexcept = default;
Triangulation& Triangulation::operator=(const Triangulation&) noexcept = default;
Triangulation::Triangulation(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Triangulation::~Triangulation() = default;
Triangulation::Triangulation(Triangulation&&) noexcept = default;
Triangulation& Triangulation::operator=(Triangulation&&) noexcept = default;

std::size_t Triangulation::number_of_points() const noexcept { return data_->points; }
std::size_t Triangulation::number_of_triangles() const noexcept { return data_->triangle_count; }
std::span<const std::int32_t> Triangulation::triangles() const noexcept {
  return {data_->triangles.get(), 3 * data_->triangle_count};
}
std::span<const std::int32_t> Triangulation::neighbors() const noexcept {
  return {data_->neighbors.get(), 3 * data_->triangle_count};
}
std::array<std::int32_t, 3> Triangulation::triangle(std::size_t t) const {
  require_triangle(t, data_->triangle_count);
  const std::int32_t* vertices = data_->triangles.get() + 3 * t;
  return {vertices[0], vertices[1], vertices[2]};
}
std::int32_t Triangulation::neighbor(std::size_t t, std::size_t k) const {
  require_triangle(t, data_->triangle_count);
  if (k > 2) throw InputError("a triangle has neighbours 0, 1 and 2, not " + std::to_string(k), k);
  return data_->neighbors[3 * t + k];
}
PointsView Triangulation::points() const noexcept { return data_->view; }
std::span<const std::int32_t> Triangulation::hull() const noexcept { return data_->hull; }
std::span<const Duplicate> Triangulation::duplicates() const noexcept { return data_->duplicates; }
std::int32_t Triangulation::duplicate_of(std::size_t point) const {
  if (point >= data_->points)
    throw InputError("there is no point " + std::to_string(point) + ", only " + std::to_string(data_->points), point);
  const auto p = static_cast<std::int32_t>(point);
  const auto at = std::ranges::lower_bound(data_->duplicates, p, {}, &Duplicate::point);
  return at != data_->duplicates.end() && at->point == p ? at->representative : -1;
}
int Triangulation::dimension() const noexcept { return data_->dimension; }
const Statistics& Triangulation::statistics() const noexcept { return data_->statistics; }

std::vector<std::int32_t> Triangulation::vertex_triangle() const {
  std::vector<std::int32_t> result(data_->points, -1);
  const auto vertices = triangles();
  for (std::size_t i = vertices.size(); i-- > 0;)  // backwards: the lowest triangle is written last
    result[static_cast<std::size_t>(vertices[i])] = static_cast<std::int32_t>(i / 3);
  for (const Duplicate& d : data_->duplicates)
    result[static_cast<std::size_t>(d.point)] = result[static_cast<std::size_t>(d.representative)];
  return result;
}

Hash128 Triangulation::hash() const {
  using namespace device_text;
  cadt_hash hash = {0, 0};
  const auto id = [](auto value) { return static_cast<std::uint64_t>(value); };
  const auto v = triangles();
  for (std::size_t i = 0; i < v.size(); i += 3) cadt_hash_add_triangle(&hash, id(v[i]), id(v[i + 1]), id(v[i + 2]));
  for (const Duplicate& d : data_->duplicates)
    cadt_hash_add(&hash, CADT_HASH_DUPLICATE, id(d.point), id(d.representative), 0);
  cadt_hash_add(&hash, CADT_HASH_COUNTS, data_->points, data_->triangle_count, data_->hull.size());
  cadt_hash_add(&hash, CADT_HASH_DIMENSION, id(data_->dimension + 1), 0, 0);
  return {hash.high, hash.low};
}

}  // namespace cadt
