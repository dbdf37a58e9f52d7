// SPDX-License-Identifier: Apache-2.0
// The caller's coordinates on the device, interleaved as its kernels take them (device_points.hpp).
#pragma once

#include <cadt/triangulator.hpp>

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

[[nodiscard]] constexpr std::size_t scalar_bytes(Scalar scalar) noexcept {
  return scalar == Scalar::float32 ? sizeof(float) : sizeof(double);
}

/// Points of the host. No copy where the device can read the caller's memory, which must then outlive the result.
[[nodiscard]] Allocation import_points(Context& ctx, const PointsView& points);

/// Points of the device. No copy if they have the device's layout already. \throws InputError if the handle is null
[[nodiscard]] Allocation import_points(Context& ctx, const DevicePoints& points);

/// The distinct points of `order`, scaled and in its order, straight from the caller's memory: no copy of all points is
/// made.
[[nodiscard]] Allocation import_in_order(Context& ctx, const DevicePoints& points, const SortedPoints& order);

}  // namespace cadt
