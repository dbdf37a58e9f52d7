// SPDX-License-Identifier: Apache-2.0
#include "common/platform/pages.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#if defined(_WIN32)
#include <windows.h>

#include <malloc.h>
#else
#include <sys/mman.h>
#endif

namespace cadt::platform {
namespace {

constexpr std::size_t whole(std::size_t bytes, std::size_t unit) noexcept { return (bytes + unit - 1) / unit * unit; }

#if !defined(_WIN32)
void prefer_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(MADV_HUGEPAGE)
  ::madvise(data, bytes, MADV_HUGEPAGE);  // advice only: failure changes nothing
#endif
}
#endif

}  // namespace

Pages map_pages(std::size_t bytes) noexcept {
  Pages pages;
#if defined(_WIN32)
  pages.bytes = whole(bytes, huge_page);
  pages.data = pages.base = ::VirtualAlloc(nullptr, pages.bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
#else
  // One page more than needed, so that the data can begin at a huge page.
  pages.bytes = whole(bytes, huge_page) + huge_page;
  void* const mapped = ::mmap(nullptr, pages.bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return {};
  pages.base = mapped;
  const auto at = reinterpret_cast<std::uintptr_t>(mapped);
  pages.data = static_cast<std::byte*>(mapped) + ((huge_page - at % huge_page) % huge_page);
  prefer_huge_pages(pages.data, bytes);
#endif
  return pages;
}

void unmap_pages(const Pages& pages) noexcept {
  if (pages.base == nullptr) return;
#if defined(_WIN32)
  ::VirtualFree(pages.base, 0, MEM_RELEASE);
#else
  ::munmap(pages.base, pages.bytes);
#endif
}

void* allocate(std::size_t alignment, std::size_t bytes) noexcept {
  if (bytes >= huge_page) alignment = huge_page;
  const std::size_t rounded = whole(std::max<std::size_t>(bytes, 1), alignment);
#if defined(_WIN32)
  return ::_aligned_malloc(rounded, alignment);
#else
  void* const memory = std::aligned_alloc(alignment, rounded);
  if (memory != nullptr && bytes >= huge_page) prefer_huge_pages(memory, bytes);
  return memory;
#endif
}

void deallocate(void* memory) noexcept {
#if defined(_WIN32)
  ::_aligned_free(memory);
#else
  std::free(memory);
#endif
}

void give_back([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes,
               [[maybe_unused]] std::size_t kept) noexcept {
#if defined(__linux__)  // elsewhere MADV_DONTNEED keeps the contents, and the pages
  // Whole huge pages, counted from the first byte, which lies at one.
  const std::size_t from = whole(kept, huge_page);
  if (bytes >= huge_page && from < bytes)
    ::madvise(static_cast<std::byte*>(memory) + from, (bytes - from) / huge_page * huge_page, MADV_DONTNEED);
#endif
}

}  // namespace cadt::platform
