// SPDX-License-Identifier: Apache-2.0
// Compiles the kernels as host C++ for one variant (CADT_WIDE and CADT_TIMED are set by the including file) and builds
// their table.

#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "backends/host/kernel_table.hpp"

namespace {

#if defined(CADT_CHECKED)
// Only the owner of a triangle may store to it, unless it is not published yet (common/mesh/locked_mesh.dev.h).
inline void cadt_assert_owned([[maybe_unused]] std::uint32_t owned) { assert(owned != 0); }
#endif

#include "common/portable/kernels.dev.h"

template <class Parameter>
Parameter unpack(const cadt::Arg& arg) {
  if constexpr (std::is_pointer_v<Parameter>) {
    return static_cast<Parameter>(cadt::host::address(arg.buffer()));
  } else {
    Parameter value;
    assert(arg.size() == sizeof value);
    std::memcpy(&value, arg.value(), sizeof value);
    return value;
  }
}

template <auto Kernel>
struct Trampoline;

template <class... Parameters, void (*Kernel)(std::uint32_t, std::uint32_t, Parameters...)>
struct Trampoline<Kernel> {
  static void run(std::uint32_t item, std::uint32_t items, const cadt::Arg* args) {
    run(item, items, args, std::index_sequence_for<Parameters...>{});
  }
  template <std::size_t... Index>
  static void run(std::uint32_t item, std::uint32_t items, const cadt::Arg* args, std::index_sequence<Index...>) {
    Kernel(item, items, unpack<Parameters>(args[Index])...);
  }
};

#define CADT_TABLE_ENTRY(name) &Trampoline<&name>::run,
constexpr cadt::host::KernelTable table = {CADT_KERNEL_LIST(CADT_TABLE_ENTRY)};
#undef CADT_TABLE_ENTRY

}  // namespace
