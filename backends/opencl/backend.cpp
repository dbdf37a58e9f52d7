// SPDX-License-Identifier: Apache-2.0
#include "common/driver/backend.hpp"

#include "backends/opencl/device.hpp"
#include "backends/opencl/open.hpp"
#include "common/self_test/self_test.hpp"

namespace cadt {
namespace opencl {

std::unique_ptr<Device> open_device(const OpenRequest& request) {
  std::shared_ptr<SharedContext> shared = shared_context(request);
  auto device = std::make_unique<ClDevice>(shared, request);
  // Once per context: what is tested is the compiled program and the device, which all its users share.
  shared->once([&] {
    static_cast<void>(shared->program(Stage::self_test, KernelVariant::narrow, request.from_cache));
    run_selftest(*device);
    run_lock_test(*device);
  });
  return device;
}

}  // namespace opencl

namespace {

class OpenClEntry final : public BackendEntry {
 public:
  [[nodiscard]] Backend id() const noexcept override { return Backend::opencl; }

  [[nodiscard]] std::vector<DeviceInfo> devices() override {
    opencl::Found found = opencl::find_devices();
    std::vector<DeviceInfo> all;
    for (opencl::FoundDevice& device : found.devices) all.push_back(std::move(device.info));
    if (all.empty()) {
      DeviceInfo none;
      none.backend = Backend::opencl;
      none.index = -1;
      none.reason = std::move(found.none);
      all.push_back(std::move(none));
    }
    return all;
  }

  [[nodiscard]] std::unique_ptr<Device> open(int index, const Options& options) override {
    opencl::OpenRequest request;
    request.index = index;
    request.work_group_size = options.tuning.work_group_size;
    request.queue = options.queue;
    request.allocator = options.allocator;
    request.kernel_times = options.tuning.kernel_times;
    return opencl::open_device(request);
  }

  [[nodiscard]] int device_of(void* queue) override { return opencl::device_of(queue); }
};

}  // namespace

BackendEntry& opencl_backend() {
  static OpenClEntry entry;
  return entry;
}

}  // namespace cadt
