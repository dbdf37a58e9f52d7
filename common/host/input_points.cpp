// SPDX-License-Identifier: Apache-2.0
#include "common/host/input_points.hpp"

#include <string>

#include "common/host/device_points.hpp"

namespace cadt {
namespace {

/// Kernels count coordinates in 32 bits: 2 * (skip + n) of them.
constexpr std::size_t most_skipped = (std::size_t{1} << 31) - 1 - max_points();

/// Where the coordinates of one axis are: the i-th at first + i * stride.
struct Axis {
  const Allocation& memory;
  std::size_t first;
};

Allocation convert(Run& run, Axis x, Axis y, std::uint32_t stride, Scalar scalar, std::size_t count,
                   const SpatialOrder* order) {
  Allocation points = run.memory.borrow(count * point_bytes(run.device), order == nullptr);
  const Allocation all;
  const Allocation& labels = order != nullptr ? order->labels : all;
  const double scale = order != nullptr ? order->scale : 1, scale_again = order != nullptr ? order->scale_again : 1;
  const Cut c = run.launcher.cut(count);
  run.launcher.run(scalar == Scalar::float32 ? KernelId::cadt_import_floats : KernelId::cadt_import_doubles, c.items,
                   x.memory, y.memory, static_cast<std::uint32_t>(x.first), static_cast<std::uint32_t>(y.first), stride,
                   labels, scale, scale_again, points, static_cast<std::uint32_t>(count), c.grain);
  return points;
}

Allocation gather(Run& run, const Allocation& input, const SpatialOrder& order) {
  Allocation points = run.memory.borrow(order.distinct * point_bytes(run.device));
  const Cut c = run.launcher.cut(order.distinct);
  run.launcher.run(KernelId::cadt_gather_points, c.items, input, order.labels, points,
                   static_cast<std::uint32_t>(order.distinct), c.grain, order.scale, order.scale_again);
  return points;
}

/// The caller's points, all or (`order`) the distinct ones in this order.
Allocation import_from(Run& run, const DevicePoints& points, const SpatialOrder* order) {
  const std::size_t n = points.size, size = scalar_bytes(points.scalar);
  const std::size_t count = order != nullptr ? order->distinct : n;
  if (points.x == nullptr) throw InputError("the points have no memory: DevicePoints::x is null", 0);
  if (points.skip > most_skipped)
    throw LimitError("at most " + std::to_string(most_skipped) + " points can be skipped, not " +
                         std::to_string(points.skip) + ": pass a handle of a later place",
                     points.skip, most_skipped);
  require_scalar(run.device, size);
  // Kernels of the library only read it.
  const Allocation x = run.memory.wrap(const_cast<void*>(points.x), (points.skip + n) * size * (points.y ? 1 : 2));
  if (points.y != nullptr) {
    const Allocation y = run.memory.wrap(const_cast<void*>(points.y), (points.skip + n) * size);
    return convert(run, {x, points.skip}, {y, points.skip}, 1, points.scalar, count, order);
  }
  if (size == coordinate_bytes(run.device) && points.skip == 0)
    return order != nullptr ? gather(run, x, *order)
                            : run.memory.wrap(const_cast<void*>(points.x), n * point_bytes(run.device));
  return convert(run, {x, 2 * points.skip}, {x, 2 * points.skip + 1}, 2, points.scalar, count, order);
}

}  // namespace

void require_scalar(const Device& device, std::size_t scalar_bytes) {
  if (scalar_bytes == sizeof(float) || !takes_floats_only(device)) return;
  const DeviceInfo& info = device.info();
  throw BackendUnavailable(std::string(to_string(info.backend)),
                           "'" + info.name +
                               "' has no double precision and takes float coordinates only: give floats (float spans, "
                               "Scalar::float32; in the program the option --floats), or name another device");
}

Allocation import_points(Run& run, const PointsView& points) {
  const std::size_t n = points.size(), size = points.scalar_size();
  require_scalar(run.device, size);
  if (points.interleaved() && size == coordinate_bytes(run.device))
    return run.memory.import(points.x_data(), n * point_bytes(run.device));
  const Scalar scalar = size == sizeof(float) ? Scalar::float32 : Scalar::float64;
  if (points.interleaved()) {
    const Allocation xy = run.memory.import(points.x_data(), 2 * n * size);
    return convert(run, {xy, 0}, {xy, 1}, 2, scalar, n, nullptr);
  }
  const Allocation x = run.memory.import(points.x_data(), n * size), y = run.memory.import(points.y_data(), n * size);
  return convert(run, {x, 0}, {y, 0}, 1, scalar, n, nullptr);
}

Allocation import_points(Run& run, const DevicePoints& points) { return import_from(run, points, nullptr); }

Allocation import_in_order(Run& run, const DevicePoints& points, const SpatialOrder& order) {
  return import_from(run, points, &order);
}

}  // namespace cadt
