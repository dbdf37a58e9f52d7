// SPDX-License-Identifier: Apache-2.0
#include "tests/system/resident/device_memory.hpp"

#ifdef CADT_HAVE_OPENCL
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
  ~OpenClMemory() override {
    clFinish(queue_());
    free_uploads();
  }
  [[nodiscard]] void* queue() const override { return queue_(); }
  [[nodiscard]] void* allocate(std::size_t bytes) noexcept override {
    cl_int code = CL_SUCCESS;
    cl_mem memory = clCreateBuffer(context_(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
    return code == CL_SUCCESS ? memory : nullptr;
  }
  void free(void* memory) noexcept override { clReleaseMemObject(static_cast<cl_mem>(memory)); }
  void read(const void* memory, std::size_t offset, std::span<std::byte> to) override {
    queue_.enqueueReadBuffer(buffer(const_cast<void*>(memory)), CL_TRUE, offset, to.size(), to.data());
  }
  void write(void* memory, std::size_t offset, std::span<const std::byte> from) override {
    queue_.enqueueWriteBuffer(buffer(memory), CL_TRUE, offset, from.size(), from.data());
  }
  void wait() override { queue_.finish(); }

 private:
  static cl::Buffer buffer(void* memory) { return cl::Buffer(static_cast<cl_mem>(memory), true); }
  cl::Context context_;
  cl::CommandQueue queue_;
};

}  // namespace

std::unique_ptr<DeviceMemory> opencl_memory(int device) { return std::make_unique<OpenClMemory>(device); }

}  // namespace cadt::test
#else
namespace cadt::test {
std::unique_ptr<DeviceMemory> opencl_memory(int /*device*/) { return nullptr; }
}  // namespace cadt::test
#endif
