// SPDX-License-Identifier: Apache-2.0
// The host as a device: the device text compiled as C++, on threads of this process.
#include "common/driver/backend.hpp"

#include <cadt/errors.hpp>
#include <cadt/triangulator.hpp>
#include <cadt/version.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "backends/host/kernel_table.hpp"
#include "backends/host/thread_pool.hpp"
#include "common/driver/buffer_cache.hpp"
#include "common/platform/machine.hpp"
#include "common/platform/pages.hpp"
#include "common/platform/parallel.hpp"
#include "common/self_test/self_test.hpp"

namespace cadt::host {
namespace {

// From a huge page on, memory comes straight from the system: in huge pages, which save page faults and TLB misses (the
// mesh is accessed irregularly), and zeroed at first touch by the thread that touches it.
class HostBuffer final : public Buffer {
 public:
  explicit HostBuffer(std::size_t bytes) : Buffer(bytes) {
    if (bytes >= platform::huge_page) {
      pages_ = platform::map_pages(bytes);
      data_ = pages_.data;
    } else {
      const std::size_t line = 64;
      data_ = platform::allocate(line, bytes);
      owned_ = true;
    }
    if (data_ == nullptr) throw OutOfMemory("not enough host memory: use fewer points", bytes, 0);
  }
  HostBuffer(const void* data, std::size_t bytes) : Buffer(bytes), data_(const_cast<void*>(data)) {}
  /// From the caller's allocator.
  HostBuffer(std::shared_ptr<DeviceAllocator> allocator, std::size_t bytes)
      : Buffer(bytes), data_(allocator->allocate(bytes, nullptr)) {
    if (data_ == nullptr)
      throw OutOfMemory("the caller's allocator gave no " + std::to_string(bytes) + " bytes: use fewer points", bytes,
                        0);
    allocator_ = std::move(allocator);
  }
  ~HostBuffer() override {
    if (allocator_ != nullptr) allocator_->deallocate(data_, bytes(), nullptr);
    platform::unmap_pages(pages_);
    if (owned_) platform::deallocate(data_);
  }
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;
  [[nodiscard]] void* data() const noexcept { return data_; }
  [[nodiscard]] bool zeroed() const noexcept { return pages_.data != nullptr; }

 private:
  void* data_ = nullptr;
  platform::Pages pages_;
  std::shared_ptr<DeviceAllocator> allocator_;
  bool owned_ = false;
};

/// Options::threads is the most there are: no more than any processor has cores for.
unsigned threads_of(const Options& options) noexcept {
  constexpr unsigned most_threads = 1024;
  const unsigned all = platform::threads_or_all(0);
  return options.threads == 0 ? all : std::min(options.threads, std::max(most_threads, all));
}

DeviceInfo describe() {
  DeviceInfo info;
  info.backend = Backend::host;
  info.index = 0;
  info.platform = "host";
  info.name = platform::processor_name();
  if (info.name.empty()) info.name = "host processor";
  info.driver = "cadt " CADT_VERSION;
  info.usable = true;
  info.memory_bytes = platform::memory_bytes();
  info.largest_buffer_bytes = info.memory_bytes;
  info.compute_units = platform::threads_or_all(0);
  info.fp64 = true;
  info.atomics = "C++20 acquire/release";
  return info;
}

/// Never destroyed: destructors of the program may still call the library.
const DeviceInfo& this_host() {
  static const DeviceInfo* const info = new DeviceInfo(describe());
  return *info;
}

/// Whether this thread rounds to nearest and keeps subnormal numbers, as threads do unless the program has changed it.
bool has_usual_arithmetic() noexcept {
  const volatile double one = 1, little = 0x1p-60, smallest = 0x1p-1022, half = 0.5;
  const bool to_nearest = one + little == 1 && one - little == 1;
  return to_nearest && smallest * half != 0;  // also 0 if it counts as 0 where it is compared
}

/// A launch returns when its work is done.
class HostClock final : public KernelClock {
 public:
  void begin() override { begin_ = std::chrono::steady_clock::now(); }
  void end() override {
    milliseconds_.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count());
  }
  [[nodiscard]] std::vector<double> read() override { return std::exchange(milliseconds_, {}); }
  void clear() noexcept override { milliseconds_.clear(); }

 private:
  std::chrono::steady_clock::time_point begin_;
  std::vector<double> milliseconds_;
};

class HostDevice final : public Device {
 public:
  explicit HostDevice(const Options& options)
      : pool_(threads_of(options), options.tuning.grain != 0),
        info_(this_host()),
        allocator_(options.allocator),
        clock_(options.tuning.kernel_times ? std::optional<HostClock>(std::in_place) : std::nullopt) {}

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LaunchShape shape() const noexcept override {
    return {.contiguous = true, .parallelism = pool_.threads() * 4, .grain = 512, .resident = 0};
  }
  [[nodiscard]] unsigned threads() const noexcept override { return pool_.threads(); }
  void begin_call() override;

  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override { return make(bytes); }
  [[nodiscard]] std::unique_ptr<Buffer> allocate_zeros(std::size_t bytes) override {
    auto buffer = make(bytes);
    if (!buffer->zeroed()) std::memset(buffer->data(), 0, bytes);
    return buffer;
  }
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override {
    return std::make_unique<HostBuffer>(data, bytes);
  }
  [[nodiscard]] std::unique_ptr<Buffer> alias_output(void* data, std::size_t bytes) override {
    return std::make_unique<HostBuffer>(data, bytes);
  }
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* pointer, std::size_t bytes) override {
    return std::make_unique<HostBuffer>(pointer, bytes);
  }
  [[nodiscard]] void* handle(const Buffer& buffer) const noexcept override { return bytes_of(buffer); }
  [[nodiscard]] std::unique_ptr<BufferCache> make_cache() override {
    return allocator_ != nullptr ? nullptr : Device::make_cache();
  }
  [[nodiscard]] std::size_t free_bytes() override {
    return allocator_ != nullptr ? std::numeric_limits<std::size_t>::max() : Device::free_bytes();
  }
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override {
    if (bytes != 0) std::memcpy(bytes_of(to) + offset, from, bytes);
  }
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override {
    if (bytes != 0) std::memcpy(to, bytes_of(from) + offset, bytes);
  }
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override {
    if (word == 0) {
      std::memset(bytes_of(to) + offset, 0, bytes);
    } else {
      std::fill_n(reinterpret_cast<std::uint32_t*>(bytes_of(to) + offset), bytes / sizeof word, word);
    }
  }
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
              std::uint32_t /*group*/) override {
    const std::array tables = {&narrow_kernels, &wide_kernels, &timed_kernels};  // in the order of KernelVariant
    pool_.run((*tables[static_cast<std::size_t>(variant)])[static_cast<std::size_t>(kernel)], items, args.data());
  }
  void finish() override {}
  [[nodiscard]] KernelClock* kernel_clock() noexcept override { return clock_ ? &*clock_ : nullptr; }

 private:
  static std::byte* bytes_of(const Buffer& buffer) noexcept {
    return static_cast<std::byte*>(static_cast<const HostBuffer&>(buffer).data());
  }

  [[nodiscard]] std::unique_ptr<HostBuffer> make(std::size_t bytes) const {
    return allocator_ != nullptr ? std::make_unique<HostBuffer>(allocator_, bytes)
                                 : std::make_unique<HostBuffer>(bytes);
  }

  ThreadPool pool_;
  DeviceInfo info_;
  std::shared_ptr<DeviceAllocator> allocator_;
  std::optional<HostClock> clock_;
};

void selftest_variants(Device& device) {
  for (const KernelVariant variant : {KernelVariant::narrow, KernelVariant::wide, KernelVariant::timed})
    run_selftest(device, variant);
}

/// Runs the self-test of each variant of the kernels once a process, and again if it has failed. A thread with another
/// arithmetic does the test by itself each time, so that no other thread answers for it. \throws BackendUnavailable
void require_selftest(Device& device) {
  static std::atomic<bool> passed{false};
  if (!has_usual_arithmetic()) {
    Options alone;
    alone.threads = 1;
    HostDevice of_this_thread(alone);
    try {
      selftest_variants(of_this_thread);
    } catch (const BackendUnavailable& error) {
      throw BackendUnavailable(error.backend(),
                               error.reason() +
                                   ". The program has changed the arithmetic of this thread: do not link it with "
                                   "-ffast-math, or reset the rounding mode and the flags FTZ and DAZ before the call");
    }
    return;
  }
  if (passed.load(std::memory_order_relaxed)) return;
  selftest_variants(device);
  passed.store(true, std::memory_order_relaxed);
}

void HostDevice::begin_call() { require_selftest(*this); }

class HostBackend final : public BackendEntry {
 public:
  [[nodiscard]] Backend id() const noexcept override { return Backend::host; }
  [[nodiscard]] std::vector<DeviceInfo> devices() override { return {this_host()}; }
  [[nodiscard]] std::unique_ptr<Device> open(int /*index*/, const Options& options) override {
    auto device = std::make_unique<HostDevice>(options);
    require_selftest(*device);
    return device;
  }
};

}  // namespace

void* address(Buffer* buffer) noexcept {
  return buffer == nullptr ? nullptr : static_cast<HostBuffer*>(buffer)->data();
}

}  // namespace cadt::host

namespace cadt {
BackendEntry& host_backend() {
  static host::HostBackend backend;
  return backend;
}
}  // namespace cadt
