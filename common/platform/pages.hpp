// SPDX-License-Identifier: Apache-2.0
// Memory as the operating system gives it.
#pragma once

#include <cstddef>

namespace cadt::platform {

/// What Linux backs by one page if it can: fewer page faults and TLB misses where access is irregular.
constexpr std::size_t huge_page = std::size_t{2} << 20;

/// Pages of zeros, which cost nothing until they are touched, and belong to the thread that touches them first.
struct Pages {
  void* data = nullptr;  ///< null: there is not enough memory. Else at a huge page, where the system has such
  void* base = nullptr;
  std::size_t bytes = 0;  ///< from base on
};
[[nodiscard]] Pages map_pages(std::size_t bytes) noexcept;
void unmap_pages(const Pages& pages) noexcept;

/// Null if there is not enough memory. From a huge page on, at a huge page. \pre alignment is a power of two, and
/// divides huge_page
[[nodiscard]] void* allocate(std::size_t alignment, std::size_t bytes) noexcept;
void deallocate(void* memory) noexcept;

/// Gives back the pages behind the first `kept` bytes of what allocate() returned for `bytes`. Their contents are lost.
void give_back(void* memory, std::size_t bytes, std::size_t kept) noexcept;

}  // namespace cadt::platform
