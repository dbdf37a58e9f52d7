// SPDX-License-Identifier: Apache-2.0
// Errors in words for the window: what happened, and what to do.
#pragma once

#include <exception>
#include <string>

#include "io/support/human_bytes.hpp"

namespace cadt::viewer {

struct Message {
  std::string title, text, advice;
  bool error = true;
  bool memory = false;  ///< there was not enough of it
};

/// Of any exception.
[[nodiscard]] Message explain(const std::exception_ptr& error);

using io::detail::human_bytes;
/// "1,234,567".
[[nodiscard]] std::string number_text(std::size_t number);
/// A number of points: "250000", "2M", "1e6", "1,000"; K M G count 1000. Throws std::invalid_argument.
[[nodiscard]] std::size_t parse_number(const std::string& text);

}  // namespace cadt::viewer
