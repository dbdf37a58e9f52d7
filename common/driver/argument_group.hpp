// SPDX-License-Identifier: Apache-2.0
// Kernel arguments that are always passed together form a group: `arguments()` gives them as a tuple of references, in
// the order of the kernel's parameters.
#pragma once

#include <tuple>

namespace cadt {

template <class T>
concept ArgumentGroup = requires(const T& group) {
  group.arguments();
};

/// The arguments that an argument stands for: those of a group, or itself.
template <class T>
[[nodiscard]] auto arguments_of(const T& argument) {
  if constexpr (ArgumentGroup<T>)
    return argument.arguments();
  else
    return std::tuple<const T&>(argument);
}

}  // namespace cadt
