// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/errors.hpp>

#include <string>
#include <type_traits>

namespace cadt {

/// For what must not happen; the parts of the message are texts and numbers. \throws InternalError
template <class... Parts>
[[noreturn]] void give_up(const Parts&... parts) {
  const auto text = [](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(part)>>)
      return std::to_string(part);
    else
      return std::string(part);
  };
  throw InternalError((text(parts) + ... + "; please report this with the input"));
}

}  // namespace cadt
