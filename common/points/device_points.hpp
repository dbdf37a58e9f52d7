// SPDX-License-Identifier: Apache-2.0
// Points as the kernels of a device have them (cadt_point): two doubles, or two floats where there are no doubles.
#pragma once

#include <array>
#include <cstddef>

#include "common/driver/device.hpp"

namespace cadt {

/// Whether the device takes float coordinates only.
[[nodiscard]] inline bool takes_floats_only(const Device& device) noexcept { return !device.info().fp64; }

[[nodiscard]] inline std::size_t coordinate_bytes(const Device& device) noexcept {
  return takes_floats_only(device) ? sizeof(float) : sizeof(double);
}
[[nodiscard]] inline std::size_t point_bytes(const Device& device) noexcept { return 2 * coordinate_bytes(device); }

/// Reads `Count` coordinates from byte `offset` on; waits for the device.
template <std::size_t Count>
[[nodiscard]] std::array<double, Count> read_coordinates(Device& device, const Buffer& from, std::size_t offset) {
  std::array<double, Count> values;
  if (!takes_floats_only(device)) {
    device.read(from, offset, values.data(), sizeof values);
    return values;
  }
  std::array<float, Count> floats;
  device.read(from, offset, floats.data(), sizeof floats);
  for (std::size_t i = 0; i < Count; ++i) values[i] = static_cast<double>(floats[i]);
  return values;
}

/// \throws BackendUnavailable if the device cannot take coordinates of this size; they are never rounded
void require_scalar(const Device& device, std::size_t scalar_bytes);

}  // namespace cadt
