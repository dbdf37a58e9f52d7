// SPDX-License-Identifier: Apache-2.0
// The parameters of every kernel, deduced from its text, so that a launch with other arguments does not compile. The
// text is the same in every language, so this holds on every back end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "common/driver/device.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {

template <KernelId kernel>
struct KernelSignature;

#define CADT_SIGNATURE(name)                   \
  template <>                                  \
  struct KernelSignature<KernelId::name> {     \
    using type = decltype(&device_text::name); \
  };
CADT_KERNEL_LIST(CADT_SIGNATURE)
#undef CADT_SIGNATURE

/// Buffers go to pointers; scalars to parameters of exactly their type, and std::size_t and bool to words.
template <class Parameter, class Argument>
inline constexpr bool is_argument_for =
    std::is_pointer_v<Parameter> ? !std::is_arithmetic_v<Argument> && std::is_constructible_v<Arg, const Argument&>
                                 : std::is_same_v<Argument, Parameter> ||
                                       (std::is_same_v<Parameter, std::uint32_t> &&
                                        (std::is_same_v<Argument, std::size_t> || std::is_same_v<Argument, bool>));

/// Whether the kernel has one parameter for each of these arguments.
template <KernelId kernel, class... Arguments>
[[nodiscard]] consteval bool takes_arguments() {
  return []<class... Parameters>(void (*)(std::uint32_t, std::uint32_t, Parameters...)) {
    if constexpr (sizeof...(Parameters) == sizeof...(Arguments))
      return (is_argument_for<Parameters, Arguments> && ...);
    else
      return false;
  }(typename KernelSignature<kernel>::type{});
}

}  // namespace cadt
