// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cadt/errors.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "backends/opencl/open.hpp"
#include "common/driver/backend.hpp"

namespace cadt::opencl {
/// selftest_only.cl, embedded like the kernels of the library.
[[nodiscard]] std::string selftest_source();
}  // namespace cadt::opencl

namespace cadt::test {

/// Sets an environment variable for its lifetime; null removes it.
class ScopedVariable {
 public:
  ScopedVariable(std::string name, const char* value);
  ~ScopedVariable();
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  std::string name_, old_;
  bool had_ = false;
};

/// A directory that goes away with this object.
class ScratchDirectory {
 public:
  ScratchDirectory();
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  std::filesystem::path path_;
};

/// Needs a usable device, the one that CADT_TEST_OPENCL_DEVICE names if it is set: skips without one, fails if
/// CADT_REQUIRE_BACKENDS names opencl. Each test has a program cache of its own.
class OpenClTest : public testing::Test {
 protected:
  void SetUp() override;

  /// A context of its own with the small program.
  [[nodiscard]] opencl::OpenRequest small() const;
  [[nodiscard]] std::unique_ptr<Device> open_small() const { return opencl::open_device(small()); }

  int index = -1;
  DeviceInfo info;
  ScratchDirectory cache;

 private:
  ScopedVariable cache_variable_{"CADT_CACHE_DIR", cache.path().c_str()};
};

/// Launches the self-test's kernel and returns how many work-items it counted.
[[nodiscard]] std::uint32_t counted_items(Device& device, std::uint32_t items);

/// Calls `work`, which must throw Exception, and returns that.
template <class Exception, class Work>
Exception caught(const Work& work) {
  try {
    work();
  } catch (const Exception& exception) {
    return exception;
  }
  throw std::logic_error("nothing was thrown");
}

}  // namespace cadt::test
