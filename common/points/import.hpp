// SPDX-License-Identifier: Apache-2.0
// The caller's coordinates on the device, interleaved as its kernels take them (device_points.hpp).
#pragma once

#include <cadt/triangulator.hpp>

#include <variant>

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

/// The points of a call, wherever they are. Does not own them.
class InputPoints {
 public:
  InputPoints(const PointsView& points) : points_(points) {}    // NOLINT: implicit on purpose
  InputPoints(const DevicePoints& points) : points_(points) {}  // NOLINT

  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] Allocation import(Context& ctx) const;
  /// The distinct points in this order, scaled, straight from the caller's memory: no copy of all points is
  /// made. \pre they are on the device
  [[nodiscard]] Allocation import_in_order(Context& ctx, const SortedPoints& order) const;

 private:
  std::variant<PointsView, DevicePoints> points_;
};

}  // namespace cadt
