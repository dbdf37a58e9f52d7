// SPDX-License-Identifier: Apache-2.0
// Polygons that are too much for one work-item: each is a constrained triangulation of its own.
#pragma once

#include <cadt/points.hpp>
#include <cadt/polygons.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/driver/context.hpp"

namespace cadt {

/// Points of a small polygon at most. A work-item takes about half a microsecond a point on a CPU and some on a GPU,
/// where the last polygon should not keep all others waiting.
constexpr std::size_t most_swept = 512;

/// Polygons and their rings, of the caller.
struct Polygons {
  PointsView points;
  std::span<const std::int64_t> rings, polygons;

  [[nodiscard]] std::size_t size() const noexcept { return polygons.size() - 1; }
  [[nodiscard]] std::size_t first_ring(std::size_t p) const { return static_cast<std::size_t>(polygons[p]); }
  [[nodiscard]] std::size_t ring(std::size_t r) const { return static_cast<std::size_t>(rings[r]); }
  /// Of polygons [p, end).
  [[nodiscard]] std::size_t first_point(std::size_t p) const { return ring(first_ring(p)); }
  [[nodiscard]] std::size_t points_of(std::size_t p, std::size_t end) const {
    return first_point(end) - first_point(p);
  }
};

/// Whether the first ring of polygon p has three different points.
[[nodiscard]] bool has_outline(const Polygons& polygons, std::size_t p);

/// Whether another ring of polygon p has points, but fewer than three different ones.
[[nodiscard]] bool has_small_hole(const Polygons& polygons, std::size_t p);

struct PolygonAlone {
  std::size_t number;
  PolygonStatus status;
  std::int32_t first, second;           ///< as in PolygonProblem
  std::vector<std::int32_t> triangles;  ///< three indices each of points of all polygons
};

/// Triangulates polygon p: a small one by the host, which needs less time for it than a card for its launches. Holes of
/// one or two points are vertices and edges of its mesh. `statistics` get those of the call. \throws OutOfMemory with
/// what this and the memory of `ctx` need together
[[nodiscard]] PolygonAlone triangulate_alone(Context& ctx, const Polygons& polygons, std::size_t p,
                                             Statistics& statistics);

}  // namespace cadt
