// SPDX-License-Identifier: Apache-2.0
// What a back end supplies: memory, launches, and the properties of the device. The driver knows nothing else of it.
#pragma once

#include <cadt/devices.hpp>
#include <cadt/triangulation.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "common/driver/kernel_id.hpp"

namespace cadt {

/// Memory of a device. Freed by its destructor, which never throws. Must not outlive its device.
class Buffer {
 public:
  explicit Buffer(std::size_t bytes) noexcept : bytes_(bytes) {}
  virtual ~Buffer() = default;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// A part of it, which is destroyed before it; null if the device has no parts. \throws DeviceError
  [[nodiscard]] virtual std::unique_ptr<Buffer> part(std::size_t /*offset*/, std::size_t /*bytes*/) { return nullptr; }

 private:
  std::size_t bytes_;
};

class BufferCache;

/// One argument of a kernel: a buffer or a scalar of 4 or 8 bytes, in the order of the kernel's parameters.
class Arg {
 public:
  Arg(Buffer& buffer) noexcept : buffer_(&buffer) {}  // NOLINT: implicit on purpose
  template <class Deleter>
  Arg(const std::unique_ptr<Buffer, Deleter>& buffer) noexcept
      : buffer_(buffer.get()) {}  // NOLINT; null passes a null pointer
  template <class Scalar>
  requires(std::is_arithmetic_v<Scalar> && (sizeof(Scalar) == 4 || sizeof(Scalar) == 8)) Arg(Scalar value)
  noexcept : size_(sizeof(Scalar)), real_(std::is_same_v<Scalar, double>) {  // NOLINT
    std::memcpy(value_, &value, sizeof value);
  }

  [[nodiscard]] bool is_buffer() const noexcept { return size_ == 0; }
  [[nodiscard]] Buffer* buffer() const noexcept { return buffer_; }
  [[nodiscard]] const void* value() const noexcept { return value_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// A double: a parameter of type cadt_real, which is a float on devices without doubles.
  [[nodiscard]] bool is_real() const noexcept { return real_; }

 private:
  Buffer* buffer_ = nullptr;
  std::uint32_t size_ = 0;
  bool real_ = false;
  alignas(8) std::byte value_[8] = {};
};

/// How a device wants its work divided into work-items.
struct LaunchShape {
  bool contiguous = true;         ///< a work-item takes contiguous elements (CPUs), not strided ones (GPUs)
  std::uint32_t parallelism = 1;  ///< work-items that keep the device busy
  std::uint32_t grain = 256;      ///< most contiguous elements of a work-item where the driver chooses
  std::uint32_t resident = 0;     ///< GPUs: work-items of a large kernel that are resident at the same time
};

/// Times launches on the device (Tuning::kernel_times).
class KernelClock {
 public:
  virtual ~KernelClock() = default;
  /// What is launched between these two is timed. A begin without an end, after an error, is dropped. \throws
  /// DeviceError
  virtual void begin() = 0;
  virtual void end() = 0;
  /// Milliseconds of each begin-end pair since the last read or clear. Waits for the device. \throws DeviceError
  [[nodiscard]] virtual std::vector<double> read() = 0;
  virtual void clear() noexcept = 0;
};

/// Sort and scan of the device's own library. The caller supplies scratch memory, so that the budget counts it.
class Primitives {
 public:
  virtual ~Primitives() = default;
  [[nodiscard]] virtual std::size_t sort_scratch(std::size_t count, unsigned bits) = 0;
  /// Whether it can sort so many keys with the values 0, 1, 2, ... that are not written before (`places`).
  [[nodiscard]] virtual bool sorts_places(std::size_t count) const noexcept = 0;
  /// Stable sort of pairs of words by the lowest `bits` bits of the key. `places`: the values are 0, 1, 2, ... and
  /// `values` is uninitialised. Returns whether the result is in the second pair of buffers, not in the first. \pre
  /// !places || sorts_places(count) \throws DeviceError
  [[nodiscard]] virtual bool sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys,
                                  Buffer& other_values, std::size_t count, unsigned bits, bool places) = 0;
  [[nodiscard]] virtual std::size_t scan_scratch(std::size_t count) = 0;
  /// Exclusive prefix sum of words in place. \throws DeviceError
  virtual void scan(Buffer& scratch, Buffer& data, std::size_t count) = 0;
};

/// One device with one in-order queue: every operation starts after the ones before it have finished.
class Device {
 public:
  virtual ~Device() = default;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;
  [[nodiscard]] virtual LaunchShape shape() const noexcept = 0;
  /// Worker threads (host) or compute units.
  [[nodiscard]] virtual unsigned threads() const noexcept = 0;
  /// Begins a call: where the program may have changed the arithmetic since the self-test, it is made again. \throws
  /// BackendUnavailable
  virtual void begin_call() {}

  /// Uninitialised memory. \throws OutOfMemory, DeviceError
  [[nodiscard]] virtual std::unique_ptr<Buffer> allocate(std::size_t bytes) = 0;
  /// Memory of zeros. \throws OutOfMemory, DeviceError
  [[nodiscard]] virtual std::unique_ptr<Buffer> allocate_zeros(std::size_t bytes) {
    auto buffer = allocate(bytes);
    fill(*buffer, 0, bytes / 4 * 4, 0);
    return buffer;
  }
  /// A read-only buffer that aliases the caller's memory where the device can, else nullptr (then copy it).
  [[nodiscard]] virtual std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) = 0;
  /// A buffer that aliases the caller's memory for writing where the device can, else nullptr (then read back).
  [[nodiscard]] virtual std::unique_ptr<Buffer> alias_output(void* /*data*/, std::size_t /*bytes*/) { return nullptr; }

  /// A buffer of the caller's device memory by its native handle (triangulator.hpp); not freed with the buffer.
  [[nodiscard]] virtual std::unique_ptr<Buffer> wrap(void* handle, std::size_t bytes) = 0;
  /// The native handle of a buffer.
  [[nodiscard]] virtual void* handle(const Buffer& buffer) const noexcept = 0;
  /// A new cache of freed buffers (buffer_cache.hpp); nullptr if the device itself caches memory that is freed.
  [[nodiscard]] virtual std::unique_ptr<BufferCache> make_cache();
  /// Makes `bytes` more available without asking the system. Only where make_cache() is null.
  virtual void reserve(std::size_t /*bytes*/) {}
  /// Returns cached memory to the system.
  virtual void trim() {}
  /// Bytes that can still be allocated as far as the device knows.
  [[nodiscard]] virtual std::size_t free_bytes() { return static_cast<std::size_t>(info().memory_bytes); }

  /// As Triangulator::occupancy().
  [[nodiscard]] virtual std::optional<double> occupancy(unsigned /*work_group_size*/) { return std::nullopt; }

  /// nullptr if the device was opened without Tuning::kernel_times.
  [[nodiscard]] virtual KernelClock* kernel_clock() noexcept { return nullptr; }

  /// nullptr: the kernels of common/portable sort and scan.
  [[nodiscard]] virtual Primitives* primitives() noexcept { return nullptr; }

  /// Bytes copied between host and device so far.
  struct Copied {
    std::uint64_t to_device = 0, from_device = 0;
  };
  [[nodiscard]] virtual Copied copied() const noexcept { return {}; }
  /// Blocking copies; offsets and sizes in bytes. \throws DeviceError
  virtual void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) = 0;
  virtual void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) = 0;
  /// The `count` values from the one of this index on.
  template <class T = std::uint32_t>
  [[nodiscard]] std::vector<T> read_values(const Buffer& from, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    read(from, first * sizeof(T), values.data(), count * sizeof(T));
    return values;
  }
  /// Fills with copies of a word; offset and size in bytes, multiples of 4.
  virtual void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) = 0;

  /// Runs a kernel with `items` work-items (possibly rounded up: kernels ignore items beyond their data). Returns
  /// before the work is done where the device can. \throws DeviceError, KernelBuildError (a variant may be built at its
  /// first launch). `group`: size of a work-group unless the options name one; 0: the device's choice.
  virtual void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
                      std::uint32_t group) = 0;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant) {
    launch(kernel, items, args, variant, 0);
  }
  /// Waits for everything launched. \throws DeviceError
  virtual void finish() = 0;

  /// Times of phases: drops all marks and sets the first one. \throws DeviceError
  virtual void start_times() {
    marks_.clear();
    mark_time();
  }
  /// Marks the time at which everything launched so far is done. Devices with clocks of their own do not wait for it.
  virtual void mark_time() {
    finish();
    marks_.push_back(std::chrono::steady_clock::now());
  }
  /// Milliseconds between one mark and the next. Waits for the last. \throws DeviceError
  [[nodiscard]] virtual std::vector<double> times() {
    std::vector<double> between;
    for (std::size_t i = 1; i < marks_.size(); ++i)
      between.push_back(std::chrono::duration<double, std::milli>(marks_[i] - marks_[i - 1]).count());
    return between;
  }

 private:
  std::vector<std::chrono::steady_clock::time_point> marks_;
};

}  // namespace cadt
