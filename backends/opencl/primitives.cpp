// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/primitives.hpp"

#include <algorithm>
#include <cadt/errors.hpp>
#include <limits>

namespace cadt::opencl {
namespace {

// As in kernels_cl/primitives.cl.
constexpr std::size_t group = 256, tile = group * 16;
constexpr unsigned digit_bits = 8;
// With so few tiles each group computes the offset for itself, which saves a launch.
constexpr std::size_t few_counts = 16, few_sums = group;

constexpr std::size_t tiles_of(std::size_t count) noexcept { return (count + tile - 1) / tile; }

/// Number of sums on all levels: of tiles, of tiles of these, and so on down to one tile.
std::size_t sums_of(std::size_t count) noexcept {
  std::size_t words = 0;
  for (std::size_t tiles = tiles_of(count); tiles > 1; tiles = tiles_of(tiles)) words += tiles;
  return words;
}

std::size_t counts_of(std::size_t count, unsigned bits) noexcept {
  return tiles_of(count) << std::clamp(bits, 1U, digit_bits);
}

std::uint32_t word(std::size_t value) {
  // The kernels number the elements of the last tile with 32 bits, including those beyond the end.
  if (value > std::numeric_limits<std::uint32_t>::max() - tile)
    throw InternalError("a sort or scan of " + std::to_string(value) + " words");
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::unique_ptr<Primitives> ClPrimitives::make(ClDevice& device) noexcept try {
  auto made = std::make_unique<ClPrimitives>(device);
  for (const auto* kernel : {&made->tile_sums_, &made->tile_scan_, &made->digit_counts_, &made->digit_scatter_})
    if (kernel->group < group) return nullptr;
  return made;
} catch (...) {
  return nullptr;  // the primitives of the device text serve instead; if the device is lost, they will report it
}

ClPrimitives::ClPrimitives(ClDevice& device)
    : device_(device),
      tile_sums_(device.make_ready("cadt_tile_sums", Stage::portable, KernelVariant::narrow, group)),
      tile_scan_(device.make_ready("cadt_tile_scan", Stage::portable, KernelVariant::narrow, group)),
      digit_counts_(device.make_ready("cadt_digit_counts", Stage::portable, KernelVariant::narrow, group)),
      digit_scatter_(device.make_ready("cadt_digit_scatter", Stage::portable, KernelVariant::narrow, group)) {}

std::size_t ClPrimitives::scan_scratch(std::size_t count) { return sums_of(count) * sizeof(std::uint32_t); }

void ClPrimitives::scan(Buffer& scratch, Buffer& data, std::size_t count) { scan_words(scratch, 0, data, 0, count); }

void ClPrimitives::scan_words(Buffer& scratch, std::uint32_t scratch_at, Buffer& data, std::uint32_t at,
                              std::size_t count) {
  if (count == 0) return;
  const std::size_t tiles = tiles_of(count);
  const std::unique_ptr<Buffer> null;
  const bool few = tiles <= few_sums;
  if (tiles > 1) {
    run(tile_sums_, tiles, {data, at, scratch, scratch_at, word(count)});
    if (!few) scan_words(scratch, scratch_at + word(tiles), scratch, scratch_at, tiles);
  }
  run(tile_scan_, tiles, {data, at, tiles > 1 ? Arg(scratch) : Arg(null), scratch_at, few ? 0U : 1U, word(count)});
}

std::size_t ClPrimitives::sort_scratch(std::size_t count, unsigned bits) {
  const std::size_t counts = counts_of(count, bits);
  return (counts + sums_of(counts)) * sizeof(std::uint32_t);
}

bool ClPrimitives::sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys, Buffer& other_values,
                        std::size_t count, unsigned bits, bool places) {
  if (count == 0) return false;
  const std::uint32_t n = word(count), tiles = word(tiles_of(count));
  const std::unique_ptr<Buffer> null;
  Buffer *from_keys = &keys, *from_values = &values, *to_keys = &other_keys, *to_values = &other_values;
  for (unsigned shift = 0; shift < bits; shift += digit_bits) {
    const unsigned digit = std::min(digit_bits, bits - shift);
    const std::uint32_t mask = (1U << digit) - 1;
    const std::size_t counts = std::size_t{tiles} << digit;
    run(digit_counts_, tiles, {*from_keys, scratch, n, tiles, shift, mask});
    const bool few = tiles <= few_counts;
    if (!few) scan_words(scratch, word(counts), scratch, 0, counts);
    run(digit_scatter_, tiles,
        {*from_keys, places && shift == 0 ? Arg(null) : Arg(*from_values), *to_keys, *to_values, scratch, few ? 0U : 1U,
         n, tiles, shift, mask});
    std::swap(from_keys, to_keys);
    std::swap(from_values, to_values);
  }
  return from_keys != &keys;
}

}  // namespace cadt::opencl
