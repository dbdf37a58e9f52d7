// SPDX-License-Identifier: Apache-2.0
// A byte that several threads mark at the same time.
#pragma once

#include <atomic>
#include <cstdint>

namespace cadt::verifier {

inline void mark(std::uint8_t& byte) noexcept {
#if defined(__cpp_lib_atomic_ref)
  std::atomic_ref<std::uint8_t>(byte).store(1, std::memory_order_relaxed);
#else  // libc++ before version 19
  __atomic_store_n(&byte, std::uint8_t{1}, __ATOMIC_RELAXED);
#endif
}

}  // namespace cadt::verifier
