// SPDX-License-Identifier: Apache-2.0
// The insertion as GPUs compile it, and a mesh for it. Each file that includes this has its own.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/portable/atomics.dev.h"
// From here on as in a build for GPUs; the atomics remain those of the host.
#undef CADT_CONTIGUOUS
#define CADT_CONTIGUOUS 0
#include "common/insertion/insert.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#pragma GCC diagnostic pop

/// A mesh of the first three of some points, with room for the others.
struct SeededMesh {
  explicit SeededMesh(std::vector<cadt_point> all)
      : points(std::move(all)), locked(2 * points.size()), hints(points.size()), edges(1U << 16) {
    mesh.locked = locked.data();
    mesh.points = points.data();
    mesh.vertex_to_triangle = hints.data();
    mesh.second = 1;
    mesh.third = 2;
    mesh.center = {(points[0].x + points[1].x + points[2].x) / 3, (points[0].y + points[1].y + points[2].y) / 3};
    cadt_counters_clear(&counters);
    cadt_make_seed_mesh(&mesh, &counters);
  }
  SeededMesh(const SeededMesh&) = delete;
  SeededMesh& operator=(const SeededMesh&) = delete;

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(points.size()); }

  std::vector<cadt_point> points;
  std::vector<cadt_locked_triangle> locked;
  std::vector<cadt_u32> hints, edges;
  cadt_u32 counts[CADT_DEFERRED_COUNTS] = {};
  cadt_deferred deferred = {edges.data(), counts, 1U << 16};
  cadt_locked_mesh mesh{};
  cadt_counters counters{};
};

}  // namespace
