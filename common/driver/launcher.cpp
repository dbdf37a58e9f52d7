// SPDX-License-Identifier: Apache-2.0
#include "common/driver/launcher.hpp"

namespace cadt {
namespace {

using device_text::word;
// Waking a thread of a CPU takes 10 to 30 microseconds, and more where cores are busy: the launch ends with its slowest
// thread. What is not worth it, in elements: of the cheap kernels (5 to 20 nanoseconds each), of a chunk (1 to 3),
// points or edges of insertion (500), and what is for a team elsewhere, such as a set or a tile.
constexpr std::size_t most_serial = 16384, smallest_chunk = 8192, smallest_spread = 64, smallest_of_teams = 8;
constexpr std::size_t usual_grain = 4096;  // of the cheap kernels, beyond most_serial
constexpr std::size_t device_chunk = 512;  // contiguous elements that a work-item of a GPU scans or sorts
// Several elements a work-item cost less set-up; with more elements than this the mesh does not stay in the cache
// between two elements of a work-item.
constexpr std::size_t most_strided = std::size_t{1} << 23;
constexpr std::size_t longest_serial_scan = 4096;  // sums that one work-item adds up

constexpr std::size_t divide_up(std::size_t a, std::size_t b) noexcept { return (a + b - 1) / b; }

constexpr LaunchGrid make_grid(std::size_t items, std::size_t count, std::size_t grain) noexcept {
  return {static_cast<std::uint32_t>(items), static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(grain)};
}

}  // namespace

LaunchGrid Launcher::grid_of_grains(std::size_t count, std::size_t grain) const noexcept {
  if (grain_ != 0) grain = std::min<std::size_t>(grain_, std::max<std::size_t>(count, 1));
  return make_grid(divide_up(count, grain), count, grain);
}

LaunchGrid Launcher::grid_balanced(std::size_t count, std::size_t smallest) const noexcept {
  const LaunchShape shape = device_.shape();
  // A small grain balances the load at the end; a large one keeps each thread in its own part of the mesh.
  return grid_of_grains(
      count, std::clamp<std::size_t>(divide_up(count, std::size_t{shape.parallelism} * 4), smallest, shape.grain));
}

LaunchGrid Launcher::grid(std::size_t count) const noexcept {
  if (!device_.shape().contiguous) return make_grid(count, count, 1);
  return grid_of_grains(count, count <= most_serial ? most_serial : usual_grain);
}

LaunchGrid Launcher::grid_of_long(std::size_t count) const noexcept {
  return device_.shape().contiguous ? grid_balanced(count, 1) : grid(count);
}

LaunchGrid Launcher::grid_spread(std::size_t count) const noexcept {
  const LaunchShape shape = device_.shape();
  if (shape.contiguous) return grid_balanced(count, smallest_spread);
  std::uint32_t lanes = 1;  // for each element; a warp has 32
  while (lanes < 32 && count * lanes * 2 <= shape.resident) lanes *= 2;
  if (lanes == 1 && count <= most_strided) return grid_strided(count);
  return make_grid(count * lanes, count, lanes);
}

LaunchGrid Launcher::grid_strided(std::size_t count) const noexcept {
  const LaunchShape shape = device_.shape();
  if (shape.contiguous) return grid(count);
  constexpr std::size_t waves = 4;  // of work-items: those that start late have less left to do
  return make_grid(std::min(count, waves * std::max(1U, shape.parallelism)), count, 1);
}

LaunchGrid Launcher::grid_of_teams(std::size_t count, std::size_t lanes) const noexcept {
  if (device_.shape().contiguous) return grid_balanced(count, smallest_of_teams);
  constexpr std::size_t most = std::size_t{1} << 30;  // beyond it each group takes several elements
  return make_grid(std::min(count * lanes, most), count, 1);
}

LaunchGrid Launcher::parts(std::size_t count) const noexcept {
  const LaunchShape shape = device_.shape();
  if (shape.contiguous) return chunks(count);
  return make_grid(std::min<std::size_t>(count, std::max(1U, shape.parallelism)), count, 1);
}

LaunchGrid Launcher::chunks(std::size_t count) const noexcept {
  const LaunchShape shape = device_.shape();
  const std::size_t grain =
      shape.contiguous ? std::max<std::size_t>(divide_up(count, shape.parallelism), smallest_chunk) : device_chunk;
  return make_grid(divide_up(count, grain), count, grain);
}

Allocation Launcher::zeros(std::size_t words) { return memory_.allocate_zeros(words * word); }

std::uint32_t Launcher::read_word(const Allocation& from, std::size_t index) {
  std::uint32_t value = 0;
  device_.read(*from, index * word, &value, word);
  return value;
}

void Launcher::scan(const Allocation& data, std::size_t count) {
  if (count == 0) return;
  if (Primitives* own = device_.primitives()) {
    const Allocation scratch = memory_.transient(own->scan_scratch(count));
    times_.time(KernelTimes::scan, [&] { own->scan(*scratch, *data, count); });
    return;
  }
  const LaunchGrid c = chunks(count);
  Allocation sums = memory_.transient(c.items * word);
  if (c.items == 1) {  // nothing is before the only chunk
    device_.fill(*sums, 0, word, 0);
    run<KernelId::cadt_scan_apply>(data, sums, c);
    return;
  }
  run<KernelId::cadt_scan_sums>(data, sums, c);
  if (c.items <= longest_serial_scan) {
    run<KernelId::cadt_scan_total>(1, sums, c.items);
  } else {
    scan(sums, c.items);
  }
  run<KernelId::cadt_scan_apply>(data, sums, c);
}

void Launcher::sort(Allocation& keys, Allocation& values, Allocation& spare_keys, Allocation& spare_values,
                    std::size_t count, unsigned bits, bool identity) {
  if (Primitives* own = device_.primitives()) {
    const Allocation scratch = memory_.transient(own->sort_scratch(count, bits));
    const bool places = identity && own->sorts_places(count);
    if (identity && !places) run<KernelId::cadt_identity>(values, grid(count));
    bool in_spare = false;
    times_.time(KernelTimes::sort, [&] {
      in_spare = own->sort(*scratch, *keys, *values, *spare_keys, *spare_values, count, std::max(bits, 1U), places);
    });
    if (in_spare) {
      std::swap(keys, spare_keys);
      std::swap(values, spare_values);
    }
    return;
  }
  const unsigned digit = device_.shape().contiguous ? 8 : 4;  // CADT_RADIX_BITS of the kernels
  const LaunchGrid c = chunks(count);
  const std::size_t entries = (std::size_t{1} << digit) * c.items;
  Allocation counts = memory_.transient(entries * word);
  const Allocation none;
  for (unsigned shift = 0; shift < std::max(bits, 1U); shift += digit) {
    run<KernelId::cadt_radix_count>(keys, counts, c, c.items, shift);
    scan(counts, entries);
    const Allocation& from = identity && shift == 0 ? none : values;
    run<KernelId::cadt_radix_scatter>(keys, from, spare_keys, spare_values, counts, c, c.items, shift);
    std::swap(keys, spare_keys);
    std::swap(values, spare_values);
  }
}

}  // namespace cadt
