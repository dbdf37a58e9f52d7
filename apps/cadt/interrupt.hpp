// SPDX-License-Identifier: Apache-2.0
// Ctrl-C. The first signal asks for a clean end, the second one ends the process at once.
#pragma once

#include <cadt/errors.hpp>

#include <stop_token>

namespace cadt::cli {

/// What a signal has to respect at the moment it comes.
enum class Phase {
  free,         ///< nothing is on disk and nothing listens (reading, checking): end right away
  cooperative,  ///< the library listens to the stop token and throws Cancelled
  writing       ///< a temporary file exists: let it get its name, then stop
};

/// Starts to listen. A signal that the parent process set to be ignored (nohup, background jobs) stays ignored.
void install_interrupt_handlers();

[[nodiscard]] std::stop_token interrupt_token();

/// Throws Cancelled if a signal came.
void check_interrupt();

/// The phase for as long as the object lives.
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
