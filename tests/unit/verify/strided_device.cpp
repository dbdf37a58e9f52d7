// SPDX-License-Identifier: Apache-2.0
#include "strided_device.hpp"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "backends/host/kernel_table.hpp"

namespace {

#include "common/portable/atomics.dev.h"
// From here on as in a build for GPUs (dialect.dev.h); the atomics remain those of the host.
#undef CADT_CONTIGUOUS
#define CADT_CONTIGUOUS 0
#undef CADT_FOR_PART
#define CADT_FOR_PART(i, part, parts, count, chunk) for (cadt_u32 i = (part); i < (count); i += (parts))
#pragma GCC diagnostic ignored "-Wunused-parameter"  // grain
#include "common/verify/device/verify.dev.h"

using cadt::Arg;
using cadt::KernelId;

template <class Parameter>
Parameter unpack(const Arg& arg) {
  if constexpr (std::is_pointer_v<Parameter>) {
    return static_cast<Parameter>(cadt::host::address(arg.buffer()));
  } else {
    Parameter value;
    std::memcpy(&value, arg.value(), sizeof value);
    return value;
  }
}

template <class... Parameters, std::size_t... Index>
void run_all(void (*kernel)(std::uint32_t, std::uint32_t, Parameters...), std::uint32_t items, const Arg* args,
             std::index_sequence<Index...>) {
  for (std::uint32_t item = 0; item < items; ++item) kernel(item, items, unpack<Parameters>(args[Index])...);
}

template <class... Parameters>
void run(void (*kernel)(std::uint32_t, std::uint32_t, Parameters...), std::uint32_t items, const Arg* args) {
  run_all(kernel, (items + 95) / 96 * 96, args, std::index_sequence_for<Parameters...>{});
}

class Strided final : public cadt::Device {
 public:
  explicit Strided(cadt::Device& host) : host_(host) {}
  [[nodiscard]] const cadt::DeviceInfo& info() const noexcept override { return host_.info(); }
  [[nodiscard]] cadt::LaunchShape shape() const noexcept override { return {false, 4096, 1, 4096}; }
  [[nodiscard]] unsigned threads() const noexcept override { return 1; }
  [[nodiscard]] std::unique_ptr<cadt::Buffer> allocate(std::size_t bytes) override { return host_.allocate(bytes); }
  [[nodiscard]] std::unique_ptr<cadt::Buffer> alias(const void*, std::size_t) override { return nullptr; }
  [[nodiscard]] std::unique_ptr<cadt::Buffer> wrap(void* handle, std::size_t bytes) override {
    return host_.wrap(handle, bytes);
  }
  [[nodiscard]] void* handle(const cadt::Buffer& buffer) const noexcept override { return host_.handle(buffer); }
  void write(cadt::Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override {
    host_.write(to, offset, from, bytes);
  }
  void read(const cadt::Buffer& from, std::size_t offset, void* to, std::size_t bytes) override {
    host_.read(from, offset, to, bytes);
  }
  void fill(cadt::Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override {
    host_.fill(to, offset, bytes, word);
  }
  using Device::launch;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, cadt::KernelVariant build,
              std::uint32_t /*group*/) override {
    switch (kernel) {
      case KernelId::cadt_verify_structure:
        return run(cadt_verify_structure, items, args.data());
      case KernelId::cadt_verify_points:
        return run(cadt_verify_points, items, args.data());
      case KernelId::cadt_verify_duplicates:
        return run(cadt_verify_duplicates, items, args.data());
      case KernelId::cadt_verify_boundary:
        return run(cadt_verify_boundary, items, args.data());
      case KernelId::cadt_verify_filter:
        return run(cadt_verify_filter, items, args.data());
      case KernelId::cadt_verify_exact:
        return run(cadt_verify_exact, items, args.data());
      case KernelId::cadt_verify_gather:
        return run(cadt_verify_gather, items, args.data());
      default:
        host_.launch(kernel, items, args, build);
    }
  }
  void finish() override {}

 private:
  cadt::Device& host_;
};

}  // namespace

std::unique_ptr<cadt::Device> strided_device(cadt::Device& host) { return std::make_unique<Strided>(host); }
