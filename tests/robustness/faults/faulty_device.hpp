// SPDX-License-Identifier: Apache-2.0
// A device that fails on request: it stands between the driver and a real device and knows nothing of the back ends.
// The test program's linker puts it there (inject.cpp); the library has no hook for it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/driver/device.hpp"

namespace cadt::test {

/// What a device is asked for.
enum class Step { allocation, launch, copy, fill, wait };
constexpr std::size_t steps = 5;
[[nodiscard]] const char* to_string(Step step) noexcept;

/// The code that injected errors carry.
constexpr int injected_code = -7777;

/// Decides what fails, counts the requests, and tracks the memory that is allocated. Shared by a test and the devices
/// that it opens; for one thread.
class Faults {
 public:
  static constexpr std::size_t never = ~std::size_t{0};
  enum class Moment {
    before,  ///< nothing is done
    after    ///< it is done, and reported as failed, as where an earlier command is what failed
  };

  /// The k-th step of this kind fails, counted from 0 now.
  void fail(Step step, std::size_t k, Moment moment = Moment::before) noexcept;
  /// The k-th step of any kind fails, and all steps after it: the device is lost.
  void lose(std::size_t k) noexcept;
  /// Nothing fails from now on; counts begin at 0.
  void clear() noexcept;

  [[nodiscard]] std::size_t count(Step step) const noexcept { return counts_[static_cast<std::size_t>(step)]; }
  [[nodiscard]] std::size_t count() const noexcept { return all_; }
  /// How many steps have failed.
  [[nodiscard]] std::size_t failed() const noexcept { return failed_; }
  [[nodiscard]] std::size_t live_buffers() const noexcept { return live_buffers_; }
  [[nodiscard]] std::size_t live_bytes() const noexcept { return live_bytes_; }
  /// Most since the last clear().
  [[nodiscard]] std::size_t most_bytes() const noexcept { return most_bytes_; }
  /// Parts made since the last clear().
  [[nodiscard]] std::size_t parts() const noexcept { return parts_made_; }

  /// What was copied since the last clear(), as this counts it.
  Device::Copied copied;

  // What a test may change or look at, if set. Buffers are those that the driver holds.
  /// The arguments of each launch, before it.
  std::function<void(KernelId, std::vector<Arg>&)> change_launch;
  /// Before each launch, when what was launched before has come to its end.
  std::function<void(KernelId, std::span<const Arg>, Device&)> before_launch;
  /// After each launch, which has come to its end, with the milliseconds that it took.
  std::function<void(KernelId, std::span<const Arg>, Device&, double)> after_launch;
  /// What was read from a buffer.
  std::function<void(const Buffer&, std::size_t offset, void* to, std::size_t bytes)> change_read;
  /// Instead of the device's own, if not 0.
  std::uint64_t largest_buffer_bytes = 0;
  /// Memory of the device, if not 0: what is not out is free, and no more is given.
  std::size_t device_bytes = 0;
  bool watchdog = false;  ///< as if it drew a screen
  /// It pools buffers even if the real one does not. What overlaps another part, and a launch with a buffer of
  /// which there are parts, is an InternalError.
  bool makes_parts = false;

  // For the device.
  /// Does the step unless it is to fail. \throws DeviceError, OutOfMemory for allocations
  template <class Work>
  void take(Step step, std::size_t bytes, const std::string& device, const Work& work) {
    const bool fails = next(step);
    if (fails && (moment_ == Moment::before || lost_)) raise(step, bytes, device);
    work();
    if (fails) raise(step, bytes, device);
  }
  void add(std::size_t bytes) noexcept {
    ++live_buffers_, live_bytes_ += bytes;
    most_bytes_ = std::max(most_bytes_, live_bytes_);
  }
  void add_part(const Buffer& whole, std::size_t begin, std::size_t end);
  void remove_part(const Buffer& whole, std::size_t begin) noexcept;
  void require_whole(const Buffer& buffer) const;
  void remove(std::size_t bytes) noexcept { --live_buffers_, live_bytes_ -= bytes; }

 private:
  [[nodiscard]] bool next(Step step) noexcept;
  [[noreturn]] void raise(Step step, std::size_t bytes, const std::string& device) const;

  std::array<std::size_t, steps> counts_{};
  struct Part {
    const Buffer* whole;
    std::size_t begin, end;
  };
  std::vector<Part> live_parts_;
  std::size_t all_ = 0, failed_ = 0, live_buffers_ = 0, live_bytes_ = 0, most_bytes_ = 0, parts_made_ = 0;
  Step step_ = Step::allocation;
  std::size_t at_ = never, lose_at_ = never;
  Moment moment_ = Moment::before;
  bool lost_ = false;
};

/// A device that does what `device` does, as long as `faults` lets it.
[[nodiscard]] std::unique_ptr<Device> faulty_device(std::unique_ptr<Device> device, std::shared_ptr<Faults> faults);

/// Devices opened by this process are faulty ones as long as this object lives.
class Injection {
 public:
  explicit Injection(std::shared_ptr<Faults> faults);
  ~Injection();
  Injection(const Injection&) = delete;
  Injection& operator=(const Injection&) = delete;
};

}  // namespace cadt::test
