// SPDX-License-Identifier: Apache-2.0
// Memory of CUDA's that OpenGL can use. OpenGL's own has small pages on NVIDIA's cards: on an H100 50 million random
// reads of 16 bytes take 680 ms in a buffer of 1.6 GB, 12 ms in one of 0.5 GB, and 1.6 ms in this memory.
#pragma once

#include <cstddef>

namespace cadt::viewer {

class LargePages {
 public:
  LargePages() = default;
  /// On a CUDA device whose context is current. \throws DeviceError
  LargePages(int device, std::size_t bytes);
  LargePages(LargePages&& other) noexcept;
  LargePages& operator=(LargePages&& other) noexcept;
  ~LargePages();

  [[nodiscard]] void* memory() const noexcept { return reinterpret_cast<void*>(address_); }
  /// At least what was asked for.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// A file that stands for the memory, for gl::Buffer; the memory stays as long as anybody uses it. Once.
  [[nodiscard]] int take_file() noexcept;

 private:
  unsigned long long address_ = 0;  // a CUdeviceptr
  std::size_t bytes_ = 0;
  int file_ = -1;
};

}  // namespace cadt::viewer
