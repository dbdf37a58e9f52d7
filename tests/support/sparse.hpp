// SPDX-License-Identifier: Apache-2.0
// Arrays of the sizes of large calls, without their memory.
#pragma once

#include <sys/mman.h>

#include <cstddef>

namespace cadt::test {

/// Zeros that take memory where they are written.
template <class T>
class Sparse {
 public:
  explicit Sparse(std::size_t size) : bytes_(size * sizeof(T)) {
    void* pages = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (pages == MAP_FAILED) return;
    madvise(pages, bytes_, MADV_NOHUGEPAGE);
    data_ = static_cast<T*>(pages);
  }
  ~Sparse() {
    if (data_ != nullptr) munmap(data_, bytes_);
  }
  Sparse(const Sparse&) = delete;
  Sparse& operator=(const Sparse&) = delete;
  [[nodiscard]] explicit operator bool() const { return data_ != nullptr; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] T& operator[](std::size_t i) { return data_[i]; }

 private:
  std::size_t bytes_;
  T* data_ = nullptr;
};

}  // namespace cadt::test
