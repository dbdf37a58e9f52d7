// SPDX-License-Identifier: Apache-2.0
// What machine this is.
#pragma once

#include <cstdint>
#include <string>

namespace cadt::platform {

/// Empty if the system does not say.
[[nodiscard]] std::string processor_name();
/// Of this machine, in bytes; 0 if the system does not say.
[[nodiscard]] std::uint64_t memory_bytes() noexcept;

}  // namespace cadt::platform
