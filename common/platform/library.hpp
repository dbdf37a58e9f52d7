// SPDX-License-Identifier: Apache-2.0
// Libraries that are looked for at run time.
#pragma once

#include <string>

namespace cadt::platform {

/// Null if it cannot be loaded; then `failure` says why. Its names stay its own. Never closed.
[[nodiscard]] void* open_library(const char* name, std::string& failure);
/// A function of an open library; null if it has none of this name.
[[nodiscard]] void* find_function(void* library, const char* name) noexcept;

}  // namespace cadt::platform
