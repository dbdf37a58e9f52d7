// SPDX-License-Identifier: Apache-2.0
// Calls on a thread of their own.
#pragma once

#include <cadt/errors.hpp>

#include <future>
#include <system_error>
#include <utility>

namespace cadt {

/// \throws OutOfMemory if the system starts no thread
template <class Work>
[[nodiscard]] auto start_async(Work work) {
  try {
    return std::async(std::launch::async, std::move(work));
  } catch (const std::system_error&) {
    throw OutOfMemory(
        "the system starts no thread for the call: end other threads or processes, raise the limit on them, or make "
        "the call on this thread, not asynchronously",
        0, 0);
  }
}

}  // namespace cadt
