// SPDX-License-Identifier: Apache-2.0
#include "bench/sequential_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <utility>

namespace cadt::bench {
namespace {

/// An element to sort: the key above, the point below.
using Keyed = std::uint64_t;

constexpr std::uint32_t point_of(Keyed element) { return static_cast<std::uint32_t>(element); }
constexpr std::uint32_t key_of(Keyed element) { return static_cast<std::uint32_t>(element >> 32); }

// Each axis has 16 bits. The curve in a quadrant is the whole one, perhaps mirrored in both axes (bit 0 of the state)
// and with its axes swapped (bit 1). Four levels are one look-up: [state][4 bits of x, 4 bits of y] gives 8 bits of the
// key and the next state above them.
constexpr unsigned key_bits = 16;
constexpr auto hilbert_steps = [] {
  std::array<std::array<std::uint16_t, 256>, 4> table{};
  for (unsigned start = 0; start < 4; ++start) {
    for (unsigned cell = 0; cell < 256; ++cell) {
      unsigned state = start, key = 0;
      for (unsigned level = 4; level-- > 0;) {
        const unsigned mirrored = state & 1u;
        unsigned x = ((cell >> (4 + level)) & 1u) ^ mirrored, y = ((cell >> level) & 1u) ^ mirrored;
        if (state & 2u) std::swap(x, y);
        key = key << 2 | ((3 * x) ^ y);
        if (y == 0) state ^= 2u | x;
      }
      table[start][cell] = static_cast<std::uint16_t>(state << 8 | key);
    }
  }
  return table;
}();

std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = 0, state = 0;
  for (unsigned level = key_bits; level > 0; level -= 4) {
    const std::uint32_t step = hilbert_steps[state][((x >> (level - 4)) & 15u) << 4 | ((y >> (level - 4)) & 15u)];
    key = key << 8 | (step & 255u);
    state = step >> 8;
  }
  return key;
}

/// Least significant digit first, 11 bits at a time; a comparison sort where the tables would cost more.
void sort_by_key(std::span<Keyed> elements, std::span<Keyed> spare) {
  constexpr unsigned digit_bits = 11, digits = 3;
  constexpr std::uint32_t mask = (1u << digit_bits) - 1;
  if (elements.size() < (std::size_t{1} << digit_bits)) {
    std::sort(elements.begin(), elements.end());
    return;
  }
  std::array<std::array<std::uint32_t, mask + 1>, digits> places{};
  for (const Keyed element : elements)
    for (unsigned d = 0; d < digits; ++d) ++places[d][(key_of(element) >> (d * digit_bits)) & mask];
  for (auto& digit : places) {
    std::uint32_t sum = 0;
    for (std::uint32_t& place : digit) sum += std::exchange(place, sum);
  }
  for (unsigned d = 0; d < digits; ++d) {
    for (const Keyed element : elements) spare[places[d][(key_of(element) >> (d * digit_bits)) & mask]++] = element;
    std::swap(elements, spare);
  }
  // An odd number of passes: the result is in what was the spare memory.
  std::copy(elements.begin(), elements.end(), spare.begin());
}

/// Sets the keys of the elements by their places in their own bounding box; false if the box has no extent.
bool set_keys(std::span<const double> xy, std::span<Keyed> elements) {
  // Halved, for the width of the box may exceed the largest double.
  const auto at = [&](Keyed element, std::size_t axis) { return 0.5 * xy[2 * std::size_t{point_of(element)} + axis]; };
  std::array<double, 2> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Keyed element : elements) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], at(element, axis));
      high[axis] = std::max(high[axis], at(element, axis));
    }
  }
  const double width = std::max(high[0] - low[0], high[1] - low[1]);
  if (!(width > 0.0)) return false;
  const auto cell = [&](Keyed element, std::size_t axis) {
    constexpr double last = (1u << key_bits) - 1;
    return static_cast<std::uint32_t>((at(element, axis) - low[axis]) / width * last);
  };
  for (Keyed& element : elements)
    element = Keyed{hilbert_key(cell(element, 0), cell(element, 1))} << 32 | point_of(element);
  return true;
}

/// Sorts along the curve. Points that share a cell with many others are sorted again in the bounding box of that cell's
/// points; the extreme coordinates have different keys there, so this terminates.
void sort_along_curve(std::span<const double> xy, std::span<Keyed> elements, std::span<Keyed> spare) {
  constexpr std::size_t overfull = 16;
  std::vector<std::span<Keyed>> waiting = {elements};
  while (!waiting.empty()) {
    const std::span<Keyed> range = waiting.back();
    waiting.pop_back();
    if (!set_keys(xy, range)) continue;
    sort_by_key(range, spare.first(range.size()));
    for (std::size_t begin = 0, end = 0; begin < range.size(); begin = end) {
      while (end < range.size() && key_of(range[end]) == key_of(range[begin])) ++end;
      if (end - begin > overfull) waiting.push_back(range.subspan(begin, end - begin));
    }
  }
}

std::uint64_t mixed(std::uint64_t z) {
  z = (z + 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const double> xy) {
  // Each round has an eighth of the points of the next. On a million points of seven distributions 4 to 64 differ
  // little; one round, the curve alone, is slower by a fifth on most, for it makes long triangles at its front.
  constexpr unsigned ratio_bits = 3;
  constexpr std::size_t smallest_round = 64;
  const std::size_t n = xy.size() / 2;
  unsigned rounds = 1;
  while (n >> (ratio_bits * rounds) >= smallest_round) ++rounds;
  const auto round_of = [&](std::size_t i) {
    return rounds - 1 - std::min(rounds - 1, static_cast<unsigned>(std::countr_zero(mixed(i))) / ratio_bits);
  };
  std::vector<std::size_t> ends(rounds);
  for (std::size_t i = 0; i < n; ++i) ++ends[round_of(i)];
  for (std::size_t round = 0, sum = 0; round < rounds; ++round) sum += std::exchange(ends[round], sum);
  std::vector<Keyed> elements(n), spare(n);
  for (std::size_t i = 0; i < n; ++i) elements[ends[round_of(i)]++] = i;
  for (std::size_t round = 0, begin = 0; round < rounds; begin = ends[round++])
    sort_along_curve(xy, std::span(elements).subspan(begin, ends[round] - begin), spare);
  std::vector<std::uint32_t> order(n);
  std::ranges::transform(elements, order.begin(), point_of);
  return order;
}

}  // namespace cadt::bench
