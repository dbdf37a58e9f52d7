// SPDX-License-Identifier: Apache-2.0
// Errors of the engine in tiles, with the advice that fits there.
#pragma once

#include <functional>

namespace cadt::cli {

/// Calls `work`; its errors become Failures that say what to do.
void with_tile_errors(const std::function<void()>& work);

}  // namespace cadt::cli
