// SPDX-License-Identifier: Apache-2.0
// A device that has a given number of bytes and nothing in them: for tests of the budget and of caches.
#pragma once

#include <gtest/gtest.h>

#include <cadt/errors.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "common/driver/buffer_cache.hpp"
#include "common/driver/device.hpp"

namespace cadt::test {

/// What is in use of a device.
struct Usage {
  std::size_t capacity = 0, bytes = 0;
  std::size_t requests = 0, refused = 0;
  bool no_parts = false;  ///< the next part fails
};

class PartBuffer final : public Buffer {
 public:
  PartBuffer(std::size_t offset, std::size_t bytes) : Buffer(bytes), offset_(offset) {}
  [[nodiscard]] std::size_t offset() const noexcept { return offset_; }

 private:
  std::size_t offset_;
};

class WholeBuffer final : public Buffer {
 public:
  WholeBuffer(std::size_t bytes, std::shared_ptr<Usage> usage) : Buffer(bytes), usage_(std::move(usage)) {
    usage_->bytes += bytes;
  }
  ~WholeBuffer() override { usage_->bytes -= bytes(); }
  [[nodiscard]] std::unique_ptr<Buffer> part(std::size_t offset, std::size_t bytes) override {
    if (usage_->no_parts) throw DeviceError("test", 1, "small device", "no parts now");
    return std::make_unique<PartBuffer>(offset, bytes);
  }

 private:
  std::shared_ptr<Usage> usage_;
};

class SmallDevice final : public Device {
 public:
  explicit SmallDevice(std::size_t capacity) { usage->capacity = capacity; }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LaunchShape shape() const noexcept override { return {}; }
  [[nodiscard]] unsigned threads() const noexcept override { return 1; }
  [[nodiscard]] std::size_t free_bytes() override { return usage->capacity - usage->bytes; }
  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override {
    ++usage->requests;
    if (bytes > free_bytes()) {
      ++usage->refused;
      throw OutOfMemory("the small device is full", bytes, free_bytes());
    }
    return std::make_unique<WholeBuffer>(bytes, usage);
  }
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* /*data*/, std::size_t bytes) override {
    return aliases ? std::make_unique<PartBuffer>(0, bytes) : nullptr;
  }
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* /*handle*/, std::size_t bytes) override {
    return std::make_unique<PartBuffer>(0, bytes);
  }
  [[nodiscard]] void* handle(const Buffer& /*buffer*/) const noexcept override { return nullptr; }
  [[nodiscard]] std::unique_ptr<BufferCache> make_cache() override {
    return cache != nullptr ? std::move(cache) : Device::make_cache();
  }
  void write(Buffer& /*to*/, std::size_t /*offset*/, const void* /*from*/, std::size_t /*bytes*/) override {}
  void read(const Buffer& /*from*/, std::size_t /*offset*/, void* /*to*/, std::size_t /*bytes*/) override {}
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t /*word*/) override {
    EXPECT_LE(offset + bytes, to.bytes());
    filled += bytes;
  }
  using Device::launch;
  void launch(KernelId /*kernel*/, std::uint32_t /*items*/, std::span<const Arg> /*args*/, KernelVariant /*variant*/,
              std::uint32_t /*group*/) override {}
  void finish() override {}

  const std::shared_ptr<Usage> usage = std::make_shared<Usage>();
  std::unique_ptr<BufferCache> cache;  ///< what make_cache() gives, if set
  std::size_t filled = 0;              ///< bytes
  bool aliases = false;

 private:
  DeviceInfo info_;
};

}  // namespace cadt::test
