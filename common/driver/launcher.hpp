// SPDX-License-Identifier: Apache-2.0
// Launches with a grid that fits the device; scan and sort, the device's own or from kernels.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <vector>

#include "common/driver/argument_group.hpp"
#include "common/driver/device.hpp"
#include "common/driver/kernel_signature.hpp"
#include "common/driver/kernel_times.hpp"
#include "common/driver/memory.hpp"

namespace cadt {

/// How elements are divided into work-items. As an argument it stands for the parameters `count` and `grain`.
struct LaunchGrid {
  std::uint32_t items;  ///< work-items
  std::uint32_t count;  ///< elements
  std::uint32_t grain;  ///< elements of a work-item; after grid_spread on GPUs, work-items of an element
  [[nodiscard]] auto arguments() const { return std::tie(count, grain); }
};

template <class... Args>
concept WithGrid = (std::is_same_v<Args, LaunchGrid> || ...);

class Launcher {
 public:
  /// `grain` as in Options; 0: chosen by the number of elements.
  Launcher(Device& device, Memory& memory, unsigned grain) noexcept
      : device_(device), memory_(memory), times_(device), grain_(grain) {}

  [[nodiscard]] std::uint64_t launches() const noexcept { return launches_; }
  /// Work-items of the largest launch so far.
  [[nodiscard]] std::uint32_t most_items() const noexcept { return most_items_; }
  /// As Statistics::kernels. \throws DeviceError
  [[nodiscard]] std::vector<KernelTime> kernel_times() { return times_.sums(); }
  /// The variant of all kernels launched from here on.
  void set_variant(KernelVariant variant) noexcept { variant_ = variant; }

  /// For kernels over `count` independent elements.
  [[nodiscard]] LaunchGrid grid(std::size_t count) const noexcept;
  /// The same if each takes long: on CPUs few of them share a work-item.
  [[nodiscard]] LaunchGrid grid_of_long(std::size_t count) const noexcept;
  /// For kernels with CADT_FOR_SPREAD: on GPUs, if elements are few, each gets several work-items.
  [[nodiscard]] LaunchGrid grid_spread(std::size_t count) const noexcept;
  /// For kernels whose work-items add to sums: on GPUs few work-items with many elements each.
  [[nodiscard]] LaunchGrid grid_strided(std::size_t count) const noexcept;
  /// For kernels with CADT_FOR_TEAMS: on GPUs a group of `lanes` work-items for each of `count` elements.
  [[nodiscard]] LaunchGrid grid_of_teams(std::size_t count, std::size_t lanes) const noexcept;
  /// For kernels with one row of partial results for each work-item (CADT_FOR_PART).
  [[nodiscard]] LaunchGrid parts(std::size_t count) const noexcept;
  /// For kernels whose work-items take a contiguous chunk on every device.
  [[nodiscard]] LaunchGrid chunks(std::size_t count) const noexcept;

  /// Runs a kernel. Arguments, or groups of them (argument_group.hpp), of other types than its parameters do not
  /// compile. \throws as Device::launch
  template <KernelId kernel, class... Args>
  requires(!WithGrid<Args...>) void run(std::uint32_t items, const Args&... args) {
    run_in_groups<kernel>(items, 0, args...);
  }
  /// The same with the work-items of the one grid among the arguments.
  template <KernelId kernel, class... Args>
  requires WithGrid<Args...>
  void run(const Args&... args) {
    run_in_groups<kernel>(std::get<const LaunchGrid&>(std::tie(args...)).items, 0, args...);
  }
  /// The same with work-groups of `group` work-items on GPUs, unless the options name a size; 0: the device's choice.
  template <KernelId kernel, class... Args>
  void run_in_groups(std::uint32_t items, std::uint32_t group, const Args&... args) {
    if (items == 0) return;
    std::apply([&](const auto&... all) { launch<kernel>(items, group, all...); },
               std::tuple_cat(arguments_of(args)...));
  }

  /// Words of zeros, for small results.
  [[nodiscard]] Allocation zeros(std::size_t words);
  /// Waits for the device.
  [[nodiscard]] std::uint32_t read_word(const Allocation& from, std::size_t index);

  /// Exclusive prefix sum of words in place.
  void scan(const Allocation& data, std::size_t count);

  /// Stable sort of 32-bit keys with values by the lowest `bits` bits. `identity`: the values are 0, 1, 2, ...,
  /// whatever `values` holds. `spare_*` are of the same size; on return `keys` and `values` hold the result (the
  /// buffers may have been swapped).
  void sort(Allocation& keys, Allocation& values, Allocation& spare_keys, Allocation& spare_values, std::size_t count,
            unsigned bits, bool identity);

 private:
  template <KernelId kernel, class... Args>
  void launch(std::uint32_t items, std::uint32_t group, const Args&... args) {
    static_assert(takes_arguments<kernel, Args...>(), "other arguments than the kernel has parameters");
    const Arg list[] = {Arg(as_parameter(args))...};
    ++launches_;
    most_items_ = std::max(most_items_, items);
    times_.time(static_cast<std::size_t>(kernel), [&] { device_.launch(kernel, items, list, variant_, group); });
  }

  /// For CPUs: `grain` contiguous elements for each work-item, unless the options say otherwise.
  [[nodiscard]] LaunchGrid grid_of_grains(std::size_t count, std::size_t grain) const noexcept;
  /// The same with several work-items for each thread, if that leaves `smallest` elements for each of them.
  [[nodiscard]] LaunchGrid grid_balanced(std::size_t count, std::size_t smallest) const noexcept;

  /// Kernels take sizes and booleans as words.
  template <class T>
  static decltype(auto) as_parameter(const T& argument) {
    if constexpr (std::is_same_v<T, std::size_t> || std::is_same_v<T, bool>) {
      assert(std::size_t{argument} <= std::numeric_limits<std::uint32_t>::max());
      return static_cast<std::uint32_t>(argument);
    } else {
      return (argument);
    }
  }

  Device& device_;
  Memory& memory_;
  KernelTimes times_;
  unsigned grain_;
  KernelVariant variant_ = KernelVariant::narrow;
  std::uint64_t launches_ = 0;
  std::uint32_t most_items_ = 0;
};

}  // namespace cadt
