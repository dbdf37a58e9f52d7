// SPDX-License-Identifier: Apache-2.0
#include "bench/sequential.hpp"

#include <cadt/cadt.hpp>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

#include "bench/sequential_insertion.hpp"
#include "bench/sequential_order.hpp"

namespace cadt::bench {
namespace {
#include "common/predicates/bigint.dev.h"

/// Exponents of all bits of the coordinates.
cadt_span bits_of(std::span<const double> xy) {
  cadt_span span;
  cadt_span_clear(&span);
  for (std::size_t i = 0; i < xy.size(); ++i) {
    if (!std::isfinite(xy[i])) throw InputError("a coordinate is NaN or infinite", i / 2);
    cadt_span_add(&span, xy[i]);
  }
  return span;
}

}  // namespace

SequentialMesh sequential_delaunay(std::span<const double> xy) {
  const std::size_t n = xy.size() / 2;
  if (xy.size() % 2 != 0) throw std::invalid_argument("an odd number of coordinates");
  if (n > max_points())
    throw LimitError("at most " + std::to_string(max_points()) + " points, not " + std::to_string(n), n, max_points());
  constexpr std::int32_t narrow_bits = 240;
  const cadt_span bits = bits_of(xy);
  const bool narrow = bits.high - bits.low <= narrow_bits;
  std::vector<std::uint32_t> input_ids = insertion_order(xy);

  // To multiples of 2^-240 below 1, in two steps since one factor may be out of range.
  const int exponent = narrow && bits.high > bits.low ? -bits.high : 0;
  const double scale = std::ldexp(1.0, exponent / 2), scale_again = std::ldexp(1.0, exponent - exponent / 2);
  std::vector<double> points(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      points[2 * i + axis] = xy[2 * std::size_t{input_ids[i]} + axis] * scale * scale_again;
  }
  return narrow ? insert_narrow(points, input_ids) : insert_wide(points, input_ids);
}

}  // namespace cadt::bench
