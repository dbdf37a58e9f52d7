// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets share: numbers from bytes, and an end with a message where a promise is broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

/// The function that libFuzzer calls, or tests/robustness/fuzz/replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace cadt::fuzz {

/// Takes numbers from the front of the input; zeros when it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}
  template <class T>
  [[nodiscard]] T take() {
    T value{};
    const std::size_t size = sizeof value < rest_.size() ? sizeof value : rest_.size();
    if (size != 0) std::memcpy(&value, rest_.data(), size);
    rest_ = rest_.subspan(size);
    return value;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::uint8_t> rest_;
};

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

/// Counts what the target did, and says so at the end of the process.
class Counter {
 public:
  explicit Counter(const char* what) {
    name() = what;
    std::atexit([] { std::printf("counted: %llu %s\n", value(), name()); });
  }
  Counter& operator+=(unsigned long long n) {
    value() += n;
    return *this;
  }

 private:
  static unsigned long long& value() {
    static unsigned long long v = 0;
    return v;
  }
  static const char*& name() {
    static const char* n = "";
    return n;
  }
};

}  // namespace cadt::fuzz
