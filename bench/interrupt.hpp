// SPDX-License-Identifier: Apache-2.0
// Ctrl-C. A measurement is of no use once it is interrupted, so the process ends at once, but leaves nothing half:
// files that are being written get their names first, temporary ones are removed.
#pragma once

#include <string>

namespace cadt::bench {

void install_interrupt_handlers();

/// For as long as it lives, the end of the process waits.
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
