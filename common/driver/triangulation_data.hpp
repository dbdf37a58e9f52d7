// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/platform/pages.hpp"

namespace cadt {

struct FreeWords {
  void operator()(std::int32_t* words) const noexcept { platform::deallocate(words); }
};
using Words = std::unique_ptr<std::int32_t[], FreeWords>;

/// Uninitialised words. Large arrays are in huge pages where the system has them: triangles are written in no regular
/// order, and each first write to a page costs a page fault.
[[nodiscard]] Words make_words(std::size_t count);
/// The first `count` of `all` words of make_words(all): the system gets back whole pages behind them, where it can.
[[nodiscard]] Words cut_words(Words words, std::size_t all, std::size_t count) noexcept;

/// What a Triangulation holds.
struct Triangulation::Data {
  std::size_t points = 0;
  std::size_t triangle_count = 0;
  Words triangles, neighbors;  ///< 3 * triangle_count each, left uninitialised until filled
  std::vector<std::int32_t> hull;
  std::vector<Duplicate> duplicates;
  int dimension = -1;
  bool constrained =
      false;  ///< that of a ConstrainedTriangulation: edges may be those of segments, or beside crossings
  Statistics statistics;
  PointsView view;  ///< of the points that are kept: the caller's, or of `coordinates`
  std::vector<double> coordinates;
};

/// Gives the mesh its points (Options::keep_points). `added`: x0 y0 x1 y1 ... of the points behind them, which no view
/// has: with some, a view becomes a copy.
void give_points(Triangulation::Data& mesh, const PointsView& points, KeepPoints how,
                 std::span<const double> added = {});

}  // namespace cadt
