// SPDX-License-Identifier: Apache-2.0
// Passes over the blocks of a source, by several threads.
#pragma once

#include "tiles/source.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace cadt::tiles {

/// Threads for `blocks` blocks; 0: one for each core.
[[nodiscard]] unsigned threads_for(std::uint64_t blocks, unsigned threads) noexcept;

/// Calls look(thread, first, xy) for each block of [begin, end), in any order, on up to `threads` threads (0: all
/// cores), each of which reads its own blocks. If several throw InputError, that with the smallest index is thrown.
void each_block(const PointSource& source, std::uint64_t begin, std::uint64_t end, unsigned threads,
                const cadt::stop_token& stop,
                const std::function<void(unsigned, std::uint64_t, std::span<const double>)>& look);

}  // namespace cadt::tiles
