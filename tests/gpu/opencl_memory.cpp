// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/device_memory.hpp"

#ifdef CADT_HAVE_OPENCL
#include <vector>

#include "backends/opencl/platform.hpp"

namespace cadt::test {
namespace {

class OpenClMemory final : public DeviceMemory {
 public:
  explicit OpenClMemory(int device) {
    const opencl::Found found = opencl::find_devices();
    const cl::Device& chosen = found.devices.at(static_cast<std::size_t>(device)).device;
    context_ = cl::Context(chosen);
    queue_ = cl::CommandQueue(context_, chosen);
  }
  [[nodiscard]] void* queue() const override { return queue_(); }
  [[nodiscard]] void* upload(std::span<const std::byte> data) override {
    buffers_.emplace_back(context_, CL_MEM_READ_ONLY, data.size());
    queue_.enqueueWriteBuffer(buffers_.back(), CL_TRUE, 0, data.size(), data.data());
    return buffers_.back()();
  }
  void wait() override { queue_.finish(); }

 private:
  cl::Context context_;
  cl::CommandQueue queue_;
  std::vector<cl::Buffer> buffers_;
};

}  // namespace

std::unique_ptr<DeviceMemory> opencl_memory(int device) { return std::make_unique<OpenClMemory>(device); }

}  // namespace cadt::test
#else
namespace cadt::test {
std::unique_ptr<DeviceMemory> opencl_memory(int /*device*/) { return nullptr; }
}  // namespace cadt::test
#endif
