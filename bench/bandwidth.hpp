// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

namespace cadt::bench {

/// Bytes a second that the device of the options reads and writes when a kernel copies a large buffer: the best of
/// several runs with words and with points. This is what a kernel can achieve, not what a data sheet says. The buffers
/// have `bytes` each, or less if memory is short. \throws as Triangulator
[[nodiscard]] double copy_bandwidth(const Options& options, std::size_t bytes);

}  // namespace cadt::bench
