// SPDX-License-Identifier: Apache-2.0
// Ctrl-C: the first signal asks for a clean end, the second one ends the process at once.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/stop_token.hpp>

namespace cadt::cli {

/// How the process reacts to a signal at the moment.
enum class Phase {
  free,         ///< nothing is on disk and nothing listens (reading, checking): end at once
  cooperative,  ///< the library listens to the stop token and throws Cancelled
  writing       ///< a temporary file exists: rename it first, then stop
};

/// Installs the handlers. A signal that the parent process ignores (nohup, background jobs) stays ignored.
void install_interrupt_handlers();

[[nodiscard]] cadt::stop_token interrupt_token();

/// Throws Cancelled if a signal came.
void check_interrupt();

/// Sets the phase during its lifetime.
class InPhase {
 public:
  explicit InPhase(Phase phase);
  ~InPhase();
  InPhase(const InPhase&) = delete;
  InPhase& operator=(const InPhase&) = delete;

 private:
  Phase before_;
};

}  // namespace cadt::cli
