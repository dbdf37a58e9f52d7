// SPDX-License-Identifier: Apache-2.0
#include "common/points/bounds.hpp"

#include <algorithm>
#include <string>

#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// cadt_bounds_row of a device without double precision.
struct FloatRow {
  float min_x, max_x, min_y, max_y;
  std::uint32_t low, high, bad, rows;
};

std::size_t row_bytes(const Device& device) noexcept {
  return takes_floats_only(device) ? sizeof(FloatRow) : sizeof(cadt_bounds_row);
}

cadt_bounds_row read_row(Device& device, const Buffer& from) {
  cadt_bounds_row row;
  if (!takes_floats_only(device)) {
    device.read(from, 0, &row, sizeof row);
    return row;
  }
  FloatRow f;
  device.read(from, 0, &f, sizeof f);
  return {f.min_x, f.max_x, f.min_y, f.max_y, f.low, f.high, f.bad, f.rows};
}

/// The row of all points; sets `totals` to 0. `group`: work-items that share a row on this device.
cadt_bounds_row merge_bounds(Context& ctx, const Allocation& input, std::size_t n, std::uint32_t group,
                             const Allocation& totals) {
  const LaunchGrid c = ctx.launcher.parts(n);
  const std::uint32_t room = (c.items - 1) / group + 1;
  const Allocation rows = ctx.memory.allocate(room * row_bytes(ctx.device));
  ctx.launcher.run<KernelId::cadt_bounds>(input, c, c.items, room, rows);
  const std::uint32_t team = ctx.device.shape().contiguous ? 1 : CADT_BOUNDS_LANES;
  ctx.launcher.run_in_groups<KernelId::cadt_merge_bounds>(team, team, rows, room, totals);
  const cadt_bounds_row all = read_row(ctx.device, *rows);
  // Devices may make smaller groups than asked for.
  return all.rows > room ? merge_bounds(ctx, input, n, 1, totals) : all;
}

}  // namespace

Bounds find_bounds(Context& ctx, const Allocation& input, std::size_t n, const Allocation& totals) {
  constexpr std::uint32_t usual_group = 128;  // the smallest group of a GPU unless the options say so
  const unsigned asked = ctx.options.tuning.work_group_size;
  const std::uint32_t group = ctx.device.shape().contiguous ? 1
                              : asked == 0                  ? usual_group
                                                            : std::min(asked, usual_group);
  const cadt_bounds_row all = merge_bounds(ctx, input, n, group, totals);
  if (all.bad != CADT_NONE) {
    throw InputError("point " + std::to_string(all.bad) +
                         " (counted from 0) has a coordinate that is NaN or infinite: "
                         "remove or repair it",
                     all.bad);
  }
  return {
      all.min_x, all.max_x, all.min_y, all.max_y, static_cast<int>(all.low) - 4096, static_cast<int>(all.high) - 4096};
}

}  // namespace cadt
