// SPDX-License-Identifier: Apache-2.0
// Ctrl-C. An interrupted measurement is useless, so the process ends at once, but leaves nothing incomplete: files that
// are being written get their names first, temporary ones are removed.
#pragma once

#include <string>

namespace cadt::bench {

void install_interrupt_handlers();

/// Delays the end of the process during its lifetime.
class Writing {
 public:
  Writing() noexcept;
  ~Writing();
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

/// The one temporary file that an interrupt removes; empty: none. Longer than a path can be: not removed.
void remove_on_interrupt(const std::string& path) noexcept;

}  // namespace cadt::bench
