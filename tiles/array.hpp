// SPDX-License-Identifier: Apache-2.0
// Large arrays on the host.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace cadt::tiles {

/// Memory for at least one byte; large pieces in huge pages, where the system has them. \throws std::bad_alloc
[[nodiscard]] void* allocate_array(std::size_t bytes);
void free_array(void* memory) noexcept;

/// Leaves numbers as they are when a vector grows: nobody writes zeros first, and the pages are made by the threads
/// that fill them, at the same time.
template <class T>
struct Uninitialized {
  using value_type = T;
  Uninitialized() = default;
  template <class U>
  Uninitialized(const Uninitialized<U>& /*other*/) noexcept {}
  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > ~std::size_t{0} / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_array(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t /*count*/) noexcept { free_array(memory); }
  template <class U>
  void construct(U* at) noexcept {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const Uninitialized&, const Uninitialized&) noexcept { return true; }
};

/// A vector of numbers; resize() leaves those that it adds uninitialised.
template <class T>
using Array = std::vector<T, Uninitialized<T>>;

}  // namespace cadt::tiles
