// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace cadt::bench {

struct ChildResult {
  std::string output;     ///< what it wrote to standard output
  std::string errors;     ///< the end of its standard error
  int status = -1;        ///< exit status, 128 + signal if a signal ended it
  std::string failure;    ///< why there is no exit status: not started, too slow, too much output
  bool too_slow = false;  ///< killed at the timeout
};

/// Runs a program (looked for on the path if its name has no slash), without a shell and with an empty input, and waits
/// for its end. After so many seconds, or if it writes more than a peer would, it is killed. Throws nothing but
/// bad_alloc.
[[nodiscard]] ChildResult run_child(const std::vector<std::string>& command, double timeout_seconds);

}  // namespace cadt::bench
