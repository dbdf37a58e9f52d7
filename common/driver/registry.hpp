// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "common/driver/device.hpp"

namespace cadt {

/// Opens the device that the options name, never another one in its place. \throws BackendUnavailable
[[nodiscard]] std::unique_ptr<Device> open_device(const Options& options);
/// The same for one call of so many points: Backend::automatic takes a GPU only if they are enough.
[[nodiscard]] std::unique_ptr<Device> open_device(const Options& options, std::size_t points);

/// Whether the library chooses the back end and the device.
[[nodiscard]] bool is_free_to_choose(const Options& options) noexcept;
/// Whether Backend::automatic means the host for one call of so many points.
[[nodiscard]] bool takes_host(const Options& options, std::size_t points) noexcept;

}  // namespace cadt
