// SPDX-License-Identifier: Apache-2.0
// Uniform points by counter, for sets that no memory takes: each range of indices is a part of the plane.
#pragma once

#include <cadt/export.hpp>
#include <cadt/finalization.hpp>
#include <cadt/triangulator.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace cadt {

/// Points of the unit square: it is divided into 4^level() equal cells along the Z curve, which have the same number of
/// points (or one less), uniform within each. Point i is a function of i, the number of points and the seed alone, the
/// same on every device. At least 64 points a cell, so every part of a few thousand points looks as if there were no
/// cells.
class CADT_API UniformCells {
 public:
  /// \throws LimitError for more than 2^40 points
  explicit UniformCells(std::uint64_t points, std::uint64_t seed = 1);
  [[nodiscard]] std::uint64_t size() const noexcept { return points_; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }
  [[nodiscard]] unsigned level() const noexcept { return level_; }

  /// A part of the square by halving: depth times, first by x, then by y, and so on; part 0, 1, ..., 2^depth - 1.
  struct Part {
    TileBox box;  ///< half-open; infinite on the border of the square
    std::uint64_t first = 0, count = 0;
  };
  /// \pre depth <= 2 * level(), index < 2^depth
  [[nodiscard]] Part part(unsigned depth, std::uint64_t index) const noexcept;
  /// The least depth at which parts have at most `points` points; none if cells have more.
  [[nodiscard]] std::optional<unsigned> depth_for(std::uint64_t points) const noexcept;

  /// Points first, ..., first + count - 1: x0 y0 x1 y1 ... O(count). Thread-safe.
  void generate(std::uint64_t first, std::size_t count, double* xy) const noexcept;
  /// The same in device memory, of 2 x count doubles, in the order of the triangulator's queue. \throws InputError if
  /// `xy` is too small, BackendUnavailable for a device without double precision
  void generate(Triangulator& triangulator, std::uint64_t first, std::size_t count, const DeviceArray& xy) const;

 private:
  std::uint64_t points_, seed_;
  unsigned level_ = 0;
};

}  // namespace cadt
