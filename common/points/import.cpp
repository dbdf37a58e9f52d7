// SPDX-License-Identifier: Apache-2.0
#include "common/points/import.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "common/points/device_points.hpp"

namespace cadt {
namespace {

/// Kernels index coordinates with 32 bits: 2 * (skip + n) of them.
constexpr std::size_t most_skipped = (std::size_t{1} << 31) - 1 - max_points();

/// `y` is null if the coordinates of both axes alternate in `x`.
Allocation convert(Context& ctx, const Allocation& x, const Allocation& y, std::size_t skip, Scalar scalar,
                   std::size_t count, const SortedPoints* order) {
  const std::size_t stride = y ? 1 : 2, first_x = stride * skip, first_y = y ? first_x : first_x + 1;
  Allocation points = ctx.memory.transient(count * point_bytes(ctx.device), order == nullptr);
  const Allocation all;
  const Allocation& input_ids = order != nullptr ? order->input_ids : all;
  const double scale = order != nullptr ? order->scale : 1, scale_again = order != nullptr ? order->scale_again : 1;
  const auto launch = [&]<KernelId kernel>() {
    ctx.launcher.run<kernel>(x, y ? y : x, first_x, first_y, stride, input_ids, scale, scale_again, points,
                             ctx.launcher.grid(count));
  };
  if (scalar == Scalar::float32)
    launch.template operator()<KernelId::cadt_import_floats>();
  else
    launch.template operator()<KernelId::cadt_import_doubles>();
  return points;
}

Allocation gather(Context& ctx, const Allocation& input, const SortedPoints& order) {
  Allocation points = ctx.memory.transient(order.distinct * point_bytes(ctx.device));
  ctx.launcher.run<KernelId::cadt_gather_points>(input, order.input_ids, points, ctx.launcher.grid(order.distinct),
                                                 order.scale, order.scale_again);
  return points;
}

/// Points whose coordinates have other bytes between them, as the device has its points. In pieces, so that the host
/// holds no second copy of all.
template <class Real>
Allocation pack(Context& ctx, const PointsView& points) {
  constexpr std::size_t piece = std::size_t{1} << 18;
  const std::size_t n = points.size(), bytes = 2 * sizeof(Real);
  Allocation packed = ctx.memory.transient(n * bytes, true);
  std::vector<Real> xy(2 * std::min(n, piece));
  for (std::size_t first = 0; first < n; first += piece) {
    const std::size_t count = std::min(piece, n - first);
    for (std::size_t i = 0; i < count; ++i) {
      xy[2 * i] = static_cast<Real>(points.x(first + i));  // exact: a device of floats is given floats
      xy[2 * i + 1] = static_cast<Real>(points.y(first + i));
    }
    ctx.device.write(*packed, first * bytes, xy.data(), count * bytes);
  }
  return packed;
}

/// All of the caller's points, or the distinct ones of `order`, in its order.
Allocation import_from(Context& ctx, const DevicePoints& points, const SortedPoints* order) {
  const std::size_t n = points.size, size = scalar_bytes(points.scalar);
  const std::size_t count = order != nullptr ? order->distinct : n;
  if (points.x == nullptr) throw InputError("the points have no memory: DevicePoints::x is null", 0);
  if (points.skip > most_skipped)
    throw LimitError("at most " + std::to_string(most_skipped) + " points can be skipped, not " +
                         std::to_string(points.skip) + ": pass a handle of a later place",
                     points.skip, most_skipped);
  require_scalar(ctx.device, size);
  // The kernels of the library only read it.
  Allocation x = ctx.memory.wrap(const_cast<void*>(points.x), (points.skip + n) * size * (points.y ? 1 : 2));
  Allocation y;
  if (points.y != nullptr)
    y = ctx.memory.wrap(const_cast<void*>(points.y), (points.skip + n) * size);
  else if (size == coordinate_bytes(ctx.device) && points.skip == 0)
    return order != nullptr ? gather(ctx, x, *order) : std::move(x);
  return convert(ctx, x, y, points.skip, points.scalar, count, order);
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

Allocation import_points(Context& ctx, const PointsView& points) {
  const std::size_t n = points.size(), size = points.scalar_size();
  require_scalar(ctx.device, size);
  if (!points.interleaved() && !points.separate())
    return takes_floats_only(ctx.device) ? pack<float>(ctx, points) : pack<double>(ctx, points);
  if (points.interleaved() && size == coordinate_bytes(ctx.device))
    return ctx.memory.import(points.x_data(), n * point_bytes(ctx.device));
  const Scalar scalar = size == sizeof(float) ? Scalar::float32 : Scalar::float64;
  const Allocation x = ctx.memory.import(points.x_data(), (points.interleaved() ? 2 : 1) * n * size);
  Allocation y;
  if (!points.interleaved()) y = ctx.memory.import(points.y_data(), n * size);
  return convert(ctx, x, y, 0, scalar, n, nullptr);
}

Allocation import_points(Context& ctx, const DevicePoints& points) { return import_from(ctx, points, nullptr); }

std::size_t InputPoints::size() const noexcept {
  const auto* host = std::get_if<PointsView>(&points_);
  return host != nullptr ? host->size() : std::get<DevicePoints>(points_).size;
}

Allocation InputPoints::import(Context& ctx) const {
  return std::visit([&](const auto& points) { return import_points(ctx, points); }, points_);
}

Allocation InputPoints::import_in_order(Context& ctx, const SortedPoints& order) const {
  return import_from(ctx, std::get<DevicePoints>(points_), &order);
}

}  // namespace cadt
