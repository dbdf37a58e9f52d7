// SPDX-License-Identifier: Apache-2.0
#include "tiles/array.hpp"

#include <sys/mman.h>
#include <cstdlib>

namespace cadt::tiles {

void* allocate_array(std::size_t bytes) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const bool large = bytes >= 2 * huge_page;
  void* memory = large ? std::aligned_alloc(huge_page, (bytes + huge_page - 1) / huge_page * huge_page)
                       : std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (large) ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint
#endif
  return memory;
}

void free_array(void* memory) noexcept { std::free(memory); }

}  // namespace cadt::tiles
