// SPDX-License-Identifier: Apache-2.0
#include "tests/robustness/faults/faulty_device.hpp"

#include <cadt/errors.hpp>

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "backends/opencl/buffer_pool.hpp"

namespace cadt::test {
namespace {

/// A part of a counted buffer.
class PartOf final : public Buffer {
 public:
  PartOf(std::unique_ptr<Buffer> real, std::shared_ptr<Faults> faults, const Buffer& whole, std::size_t begin)
      : Buffer(real->bytes()), real_(std::move(real)), faults_(std::move(faults)), whole_(whole), begin_(begin) {
    faults_->add_part(whole_, begin_, begin_ + bytes());
  }
  ~PartOf() override { faults_->remove_part(whole_, begin_); }
  [[nodiscard]] Buffer& real() const noexcept { return *real_; }

 private:
  std::unique_ptr<Buffer> real_;
  std::shared_ptr<Faults> faults_;
  const Buffer& whole_;
  std::size_t begin_;
};

/// A buffer of the real device. Only memory that was allocated is counted: what is aliased or wrapped is the caller's.
class CountedBuffer final : public Buffer {
 public:
  CountedBuffer(std::unique_ptr<Buffer> real, std::shared_ptr<Faults> faults, Device& device, bool allocated)
      : Buffer(real->bytes()),
        real_(std::move(real)),
        faults_(std::move(faults)),
        device_(device),
        allocated_(allocated) {
    if (allocated_) faults_->add(bytes());
  }
  ~CountedBuffer() override {
    if (allocated_) faults_->remove(bytes());
  }
  [[nodiscard]] Buffer& real() const noexcept { return *real_; }
  [[nodiscard]] std::unique_ptr<Buffer> part(std::size_t offset, std::size_t bytes) override {
    std::unique_ptr<Buffer> made;
    faults_->take(Step::allocation, bytes, device_.info().name, [&] {
      made = real_->part(offset, bytes);
      if (made == nullptr)  // the handle is an address
        made = device_.wrap(static_cast<std::byte*>(device_.handle(*real_)) + offset, bytes);
    });
    return std::make_unique<PartOf>(std::move(made), faults_, *this, offset);
  }

 private:
  std::unique_ptr<Buffer> real_;
  std::shared_ptr<Faults> faults_;
  Device& device_;
  bool allocated_;
};

Buffer& real(const Buffer& buffer) {
  if (const auto* part = dynamic_cast<const PartOf*>(&buffer)) return part->real();
  return static_cast<const CountedBuffer&>(buffer).real();
}

class FaultyPrimitives final : public Primitives {
 public:
  FaultyPrimitives(Primitives& own, const Device& device, std::shared_ptr<Faults> faults)
      : own_(own), device_(device), faults_(std::move(faults)) {}
  [[nodiscard]] std::size_t sort_scratch(std::size_t count, unsigned bits) override {
    return own_.sort_scratch(count, bits);
  }
  [[nodiscard]] bool sorts_places(std::size_t count) const noexcept override { return own_.sorts_places(count); }
  [[nodiscard]] bool sort(Buffer& scratch, Buffer& keys, Buffer& values, Buffer& other_keys, Buffer& other_values,
                          std::size_t count, unsigned bits, bool places) override {
    bool in_other = false;
    faults_->take(Step::launch, 0, device_.info().name, [&] {
      in_other =
          own_.sort(real(scratch), real(keys), real(values), real(other_keys), real(other_values), count, bits, places);
    });
    return in_other;
  }
  [[nodiscard]] std::size_t scan_scratch(std::size_t count) override { return own_.scan_scratch(count); }
  void scan(Buffer& scratch, Buffer& data, std::size_t count) override {
    faults_->take(Step::launch, 0, device_.info().name, [&] { own_.scan(real(scratch), real(data), count); });
  }

 private:
  Primitives& own_;
  const Device& device_;
  std::shared_ptr<Faults> faults_;
};

class FaultyDevice final : public Device {
 public:
  FaultyDevice(std::unique_ptr<Device> device, std::shared_ptr<Faults> faults)
      : device_(std::move(device)), faults_(std::move(faults)) {
    if (Primitives* own = device_->primitives()) primitives_.emplace(*own, *device_, faults_);
    info_ = device_->info();
    if (faults_->largest_buffer_bytes != 0) info_.largest_buffer_bytes = faults_->largest_buffer_bytes;
    if (faults_->watchdog) info_.watchdog = true;
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LaunchShape shape() const noexcept override { return device_->shape(); }
  [[nodiscard]] unsigned threads() const noexcept override { return device_->threads(); }
  void begin_call() override { device_->begin_call(); }
  /// A pool is one of this device: the test decides whether there is one, and how large the largest buffer is.
  [[nodiscard]] std::unique_ptr<BufferCache> make_cache() override {
    constexpr std::size_t any_alignment = 64, large = std::size_t{1} << 30;
    auto own = device_->make_cache();
    if (own == nullptr || !(faults_->makes_parts || own->pools(large))) return own;
    return std::make_unique<opencl::BufferPool>(any_alignment, info_.largest_buffer_bytes);
  }
  void trim() override { device_->trim(); }
  [[nodiscard]] std::size_t free_bytes() override {
    const std::size_t all = faults_->device_bytes, out = faults_->live_bytes();
    return all == 0 ? device_->free_bytes() : all - std::min(all, out);
  }
  [[nodiscard]] std::optional<double> occupancy(unsigned size) override { return device_->occupancy(size); }
  [[nodiscard]] KernelClock* kernel_clock() noexcept override { return device_->kernel_clock(); }
  [[nodiscard]] Primitives* primitives() noexcept override { return primitives_ ? &*primitives_ : nullptr; }
  [[nodiscard]] void* handle(const Buffer& buffer) const noexcept override { return device_->handle(real(buffer)); }

  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override {
    std::unique_ptr<Buffer> buffer;
    check_size(bytes);
    take(Step::allocation, bytes, [&] { buffer = account(device_->allocate(bytes), true); });
    return buffer;
  }
  [[nodiscard]] std::unique_ptr<Buffer> allocate_zeros(std::size_t bytes) override {
    std::unique_ptr<Buffer> buffer;
    check_size(bytes);
    take(Step::allocation, bytes, [&] { buffer = account(device_->allocate_zeros(bytes), true); });
    return buffer;
  }
  void reserve(std::size_t bytes) override {
    take(Step::allocation, bytes, [&] { device_->reserve(bytes); });
  }
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override {
    return account(device_->alias(data, bytes), false);
  }
  [[nodiscard]] std::unique_ptr<Buffer> alias_output(void* data, std::size_t bytes) override {
    return account(device_->alias_output(data, bytes), false);
  }
  [[nodiscard]] std::unique_ptr<Buffer> wrap(void* handle, std::size_t bytes) override {
    return account(device_->wrap(handle, bytes), false);
  }

  [[nodiscard]] Copied copied() const noexcept override { return device_->copied(); }
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override {
    take(Step::copy, 0, [&] { device_->write(real(to), offset, from, bytes); });
    faults_->copied.to_device += bytes;
  }
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override {
    take(Step::copy, 0, [&] { device_->read(real(from), offset, to, bytes); });
    faults_->copied.from_device += bytes;
    if (faults_->change_read) faults_->change_read(from, offset, to, bytes);
  }
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override {
    take(Step::fill, 0, [&] { device_->fill(real(to), offset, bytes, word); });
  }
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant build,
              std::uint32_t group) override {
    std::vector<Arg> given(args.begin(), args.end());
    if (faults_->change_launch) faults_->change_launch(kernel, given);
    if (faults_->before_launch) {
      device_->finish();
      faults_->before_launch(kernel, given, *this);
    }
    std::vector<Arg> own = given;
    for (Arg& arg : own) {
      if (!arg.is_buffer() || arg.buffer() == nullptr) continue;
      faults_->require_whole(*arg.buffer());
      arg = Arg(real(*arg.buffer()));
    }
    take(Step::launch, 0, [&] {
      if (faults_->after_launch) device_->finish();
      const auto start = std::chrono::steady_clock::now();
      device_->launch(kernel, items, own, build, group);
      if (!faults_->after_launch) return;
      device_->finish();
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
      faults_->after_launch(kernel, given, *this, took.count());
    });
  }
  void finish() override {
    take(Step::wait, 0, [&] { device_->finish(); });
  }
  void start_times() override {
    take(Step::wait, 0, [&] { device_->start_times(); });
  }
  void mark_time() override {
    take(Step::wait, 0, [&] { device_->mark_time(); });
  }
  [[nodiscard]] std::vector<double> times() override {
    std::vector<double> between;
    take(Step::wait, 0, [&] { between = device_->times(); });
    return between;
  }

 private:
  void check_size(std::size_t bytes) {
    if (faults_->device_bytes != 0 && bytes > free_bytes())
      throw OutOfMemory("a buffer of " + std::to_string(bytes) + " bytes, and the device has " +
                            std::to_string(free_bytes()) + " free",
                        bytes, free_bytes());
    const std::uint64_t largest = faults_->largest_buffer_bytes;
    if (largest != 0 && bytes > largest)
      throw OutOfMemory(
          "a buffer of " + std::to_string(bytes) + " bytes, and the largest has " + std::to_string(largest), bytes,
          static_cast<std::size_t>(largest));
  }
  template <class Work>
  void take(Step step, std::size_t bytes, const Work& work) {
    faults_->take(step, bytes, info().name, work);
  }
  [[nodiscard]] std::unique_ptr<Buffer> account(std::unique_ptr<Buffer> buffer, bool allocated) {
    if (buffer == nullptr) return nullptr;
    return std::make_unique<CountedBuffer>(std::move(buffer), faults_, *device_, allocated);
  }

  std::unique_ptr<Device> device_;
  std::shared_ptr<Faults> faults_;
  DeviceInfo info_;
  std::optional<FaultyPrimitives> primitives_;
};

}  // namespace

const char* to_string(Step step) noexcept {
  constexpr std::array<const char*, steps> names = {"allocation", "launch", "copy", "fill", "wait"};
  return names[static_cast<std::size_t>(step)];
}

void Faults::clear() noexcept {
  copied = {};
  counts_.fill(0);
  all_ = failed_ = parts_made_ = 0;
  most_bytes_ = live_bytes_;
  at_ = lose_at_ = never;
  moment_ = Moment::before;
  lost_ = false;
}

void Faults::fail(Step step, std::size_t k, Moment moment) noexcept {
  clear();
  step_ = step;
  at_ = k;
  moment_ = moment;
}

void Faults::lose(std::size_t k) noexcept {
  clear();
  lose_at_ = k;
}

void Faults::add_part(const Buffer& whole, std::size_t begin, std::size_t end) {
  if (end > whole.bytes()) throw InternalError("a part is not within its buffer");
  for (const Part& other : live_parts_)
    if (other.whole == &whole && begin < other.end && other.begin < end) throw InternalError("two parts overlap");
  live_parts_.push_back({&whole, begin, end});
  ++parts_made_;
}

void Faults::remove_part(const Buffer& whole, std::size_t begin) noexcept {
  std::erase_if(live_parts_, [&](const Part& part) { return part.whole == &whole && part.begin == begin; });
}

void Faults::require_whole(const Buffer& buffer) const {
  for (const Part& part : live_parts_)
    if (part.whole == &buffer) throw InternalError("a launch has a buffer of which there are parts");
}

bool Faults::next(Step step) noexcept {
  const std::size_t of_this = counts_[static_cast<std::size_t>(step)]++, of_all = all_++;
  if (of_all >= lose_at_) lost_ = true;
  const bool fails = lost_ || (step == step_ && of_this == at_);
  if (fails) ++failed_;
  return fails;
}

void Faults::raise(Step step, std::size_t bytes, const std::string& device) const {
  if (step == Step::allocation && !lost_) throw OutOfMemory("an injected fault", bytes, 0);
  throw DeviceError(std::string("injected ") + to_string(step), injected_code, device, "an injected fault");
}

std::unique_ptr<Device> faulty_device(std::unique_ptr<Device> device, std::shared_ptr<Faults> faults) {
  return std::make_unique<FaultyDevice>(std::move(device), std::move(faults));
}

}  // namespace cadt::test
