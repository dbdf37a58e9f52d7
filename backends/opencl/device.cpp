// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/device.hpp"

#include "backends/opencl/buffer_pool.hpp"
#include "backends/opencl/primitives.hpp"

#include <algorithm>
#include <cadt/errors.hpp>
#include <cstring>
#include <limits>
#include <mutex>
#include <vector>

namespace cadt::opencl {
namespace {

// On a CPU a work-item processes a contiguous range of elements, so groups of one cost nothing and balance best.
constexpr std::size_t cpu_group = 1;
constexpr std::size_t largest_fill = std::size_t{1} << 30;

std::size_t left_bytes(const SharedContext& shared) {
  const std::uint64_t memory = shared.device().info.memory_bytes, held = shared.held;
  return static_cast<std::size_t>(memory > held ? memory - held : 0);
}

void check_range(const char* what, const Buffer& buffer, std::size_t offset, std::size_t bytes) {
  if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
    throw InternalError(std::string(what) + " of " + std::to_string(bytes) + " bytes at " + std::to_string(offset) +
                        " exceeds a buffer of " + std::to_string(buffer.bytes()));
}

void check_not_lost(const SharedContext& shared) {
  if (shared.lost)
    throw DeviceError("OpenCL", CL_INVALID_CONTEXT, shared.device().info.name,
                      "an earlier error took the context; open it again");
}

/// Calls `work` and translates exceptions of the bindings.
template <class Work>
void run(SharedContext& shared, const Work& work) {
  check_not_lost(shared);
  try {
    work();
  } catch (const cl::Error& error) {
    const std::string& name = shared.device().info.name;
    // Some drivers allocate a buffer only when a command needs it.
    if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE) {
      const std::size_t held = shared.held;
      throw OutOfMemory("'" + name + "' found too little memory in " + error.what() + "; the buffers are " +
                            std::to_string(held) + " bytes together",
                        held, left_bytes(shared));
    }
    if (is_fatal(error.err())) shared.lost = true;
    throw_device_error(error, name);
  }
}

class ClBuffer final : public Buffer {
 public:
  ClBuffer(std::shared_ptr<SharedContext> shared, cl::Buffer memory, std::size_t bytes, std::size_t counted)
      : Buffer(bytes), shared_(std::move(shared)), memory_(std::move(memory)), counted_(counted) {
    shared_->held += counted_;
  }
  ~ClBuffer() override { shared_->held -= counted_; }

  [[nodiscard]] std::unique_ptr<Buffer> part(std::size_t offset, std::size_t bytes) override {
    check_range("a part", *this, offset, bytes);
    std::unique_ptr<Buffer> made;
    run(*shared_, [&] {
      const cl_buffer_region region{offset, bytes};
      made = std::make_unique<ClBuffer>(
          shared_, memory_.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region), bytes, 0);
    });
    return made;
  }
  [[nodiscard]] const cl::Buffer& memory() const noexcept { return memory_; }

 private:
  std::shared_ptr<SharedContext> shared_;
  cl::Buffer memory_;
  std::size_t counted_;
};

class AllocatorBuffer final : public Buffer {
 public:
  AllocatorBuffer(std::shared_ptr<DeviceAllocator> allocator, cl::CommandQueue queue, void* memory, std::size_t bytes)
      : Buffer(bytes),
        allocator_(std::move(allocator)),
        queue_(std::move(queue)),
        memory_(static_cast<cl_mem>(memory), true) {}
  ~AllocatorBuffer() override { allocator_->deallocate(memory_(), bytes(), queue_()); }

  [[nodiscard]] const cl::Buffer& memory() const noexcept { return memory_; }

 private:
  std::shared_ptr<DeviceAllocator> allocator_;
  cl::CommandQueue queue_;
  cl::Buffer memory_;
};

// The caller may free its memory as soon as the buffer is destroyed, so the device must have finished with it.
class AliasBuffer final : public Buffer {
 public:
  AliasBuffer(cl::Buffer memory, cl::CommandQueue queue, std::size_t bytes)
      : Buffer(bytes), memory_(std::move(memory)), queue_(std::move(queue)) {}
  ~AliasBuffer() override { clFinish(queue_()); }

  [[nodiscard]] const cl::Buffer& memory() const noexcept { return memory_; }

 private:
  cl::Buffer memory_;
  cl::CommandQueue queue_;
};

const cl::Buffer& memory_of(const Buffer& buffer) {
  if (const auto* own = dynamic_cast<const ClBuffer*>(&buffer)) return own->memory();
  if (const auto* alias = dynamic_cast<const AliasBuffer*>(&buffer)) return alias->memory();
  if (const auto* from = dynamic_cast<const AllocatorBuffer*>(&buffer)) return from->memory();
  throw InternalError("a buffer of another back end was passed to an OpenCL device");
}

/// A parameter of type cadt_real on a device without doubles. All of these may be rounded: the grid of the sort keys, a
/// centre that is not read, a bound chosen by the user.
cl_float as_float(const Arg& arg) {
  double value = 0;
  std::memcpy(&value, arg.value(), sizeof value);
  constexpr double most = std::numeric_limits<float>::max();
  return static_cast<cl_float>(std::clamp(value, -most, most));
}

bool is_out_of_memory(int code) {
  return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES || code == CL_OUT_OF_HOST_MEMORY ||
         code == CL_INVALID_BUFFER_SIZE;
}

[[noreturn]] void throw_out_of_memory(const DeviceInfo& info, const std::string& why, std::size_t needed,
                                      std::size_t available) {
  throw OutOfMemory("'" + info.name + "' cannot hold a buffer of " + std::to_string(needed) + " bytes: " + why + " " +
                        std::to_string(available) + " bytes",
                    needed, available);
}

// PoCL counts the users of a compiled kernel without a lock (pocl_release_dlhandle_cache, seen in 3.1): two concurrent
// launches from different queues end the process with a failed assertion. So there is one launch at a time in the
// process.
std::mutex launching;
bool launches_alone(const FoundDevice& device) {
  return !device.gpu_hardware && device.info.platform.find("Portable Computing Language") != std::string::npos;
}

// Oclgrind looks for uses of uninitialised memory. To version 21.10 memory is uninitialised after a fill; so is the end
// of a part of a buffer after a write, and that of a buffer at the address of a shorter one that was freed.
bool reports_uninitialised(const FoundDevice& device) { return device.info.platform == "Oclgrind"; }

}  // namespace

ClDevice::ClDevice(std::shared_ptr<SharedContext> shared, const OpenRequest& request)
    : shared_(std::move(shared)), work_group_size_(request.work_group_size), allocator_(request.allocator) {
  try {
    if (request.queue) {
      queue_ = cl::CommandQueue(static_cast<cl_command_queue>(*request.queue), true);
      const auto properties = queue_.getInfo<CL_QUEUE_PROPERTIES>();
      if ((properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0)
        throw BackendUnavailable("opencl", "the queue executes out of order; cadt needs one that keeps the order");
      if (request.kernel_times && (properties & CL_QUEUE_PROFILING_ENABLE) == 0)
        throw OptionError("tuning.kernel_times", "Options::queue was made without CL_QUEUE_PROFILING_ENABLE");
    } else {
      queue_ = cl::CommandQueue(shared_->context(), shared_->device().device,
                                request.kernel_times ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0});
    }
    if (request.kernel_times) clock_.emplace(info().name);
    constexpr std::size_t bits = 8;
    if (info().gpu && !reports_uninitialised(shared_->device()))
      part_alignment_ = shared_->device().device.getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>() / bits;
  } catch (const cl::Error& error) {
    throw_device_error(error, info().name);
  }
}

ClDevice::~ClDevice() { clFinish(queue_()); }

template <class Work>
void ClDevice::run(const Work& work) {
  opencl::run(*shared_, work);
}

LaunchShape ClDevice::shape() const noexcept {
  const std::uint32_t units = std::max(1u, info().compute_units);
  if (info().gpu) return {.contiguous = false, .parallelism = units * 2048u, .grain = 1, .resident = units * 512u};
  return {.contiguous = true, .parallelism = units * 4u, .grain = 256, .resident = 0};
}

std::unique_ptr<Buffer> ClDevice::allocate(std::size_t bytes) {
  check_not_lost(*shared_);
  if (allocator_ != nullptr) {
    const std::size_t size = std::max<std::size_t>(bytes, 8);
    void* memory = allocator_->allocate(size, queue_());
    if (memory == nullptr) throw_out_of_memory(info(), "the caller's allocator gave none; it has", bytes, 0);
    return std::make_unique<AllocatorBuffer>(allocator_, queue_, memory, size);
  }
  if (bytes > info().largest_buffer_bytes)
    throw_out_of_memory(info(), "its largest buffer is", bytes, info().largest_buffer_bytes);
  if (bytes > left_bytes(*shared_)) throw_out_of_memory(info(), "it has left", bytes, left_bytes(*shared_));
  // OpenCL has no empty buffers.
  const std::size_t size = std::max<std::size_t>(bytes, 8);
  try {
    cl::Buffer memory(shared_->context(), CL_MEM_READ_WRITE, size);
    if (reports_uninitialised(shared_->device())) clRetainMemObject(memory());  // never freed
    return std::make_unique<ClBuffer>(shared_, std::move(memory), bytes, size);
  } catch (const cl::Error& error) {
    if (is_out_of_memory(error.err()))
      throw_out_of_memory(info(), std::string(code_name(error.err())) + "; as far as known it has left", bytes,
                          left_bytes(*shared_));
    throw_device_error(error, info().name);
  }
}

std::unique_ptr<BufferCache> ClDevice::make_cache() {
  if (allocator_ != nullptr) return nullptr;
  // On a CPU, device memory is memory of the process, which is not limited by this number.
  if (part_alignment_ == 0) return Device::make_cache();
  return std::make_unique<BufferPool>(part_alignment_, info().largest_buffer_bytes);
}

std::unique_ptr<Buffer> ClDevice::alias(const void* data, std::size_t bytes) {
  // A GPU would fetch it over the bus again and again. The alignment must be that of the elements, no more.
  const bool aligned = reinterpret_cast<std::uintptr_t>(data) % alignof(double) == 0;
  if (info().gpu || data == nullptr || bytes == 0 || !aligned || bytes > info().largest_buffer_bytes) return nullptr;
  try {
    cl::Buffer memory(shared_->context(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes, const_cast<void*>(data));
    return std::make_unique<AliasBuffer>(std::move(memory), queue_, bytes);
  } catch (const cl::Error&) {
    return nullptr;  // copying is always possible
  }
}

std::unique_ptr<Buffer> ClDevice::wrap(void* memory, std::size_t bytes) {
  check_not_lost(*shared_);
  cl::Buffer buffer(static_cast<cl_mem>(memory), true);  // retained: the caller may release its own reference
  std::size_t size = 0;
  run([&] {
    if (buffer.getInfo<CL_MEM_CONTEXT>()() != shared_->context()())
      throw BackendUnavailable("opencl", "the buffer belongs to another context than the triangulator's queue");
    size = buffer.getInfo<CL_MEM_SIZE>();
  });
  if (size < bytes)
    throw InputError("a buffer of " + std::to_string(size) + " bytes where " + std::to_string(bytes) + " are needed",
                     0);
  return std::make_unique<ClBuffer>(shared_, std::move(buffer), bytes, 0);
}

void* ClDevice::handle(const Buffer& buffer) const noexcept { return memory_of(buffer)(); }

std::size_t ClDevice::free_bytes() {
  if (allocator_ != nullptr) return std::numeric_limits<std::size_t>::max();
  return left_bytes(*shared_);
}

void ClDevice::write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) {
  check_range("a write", to, offset, bytes);
  copied_.to_device += bytes;
  if (bytes != 0) run([&] { queue_.enqueueWriteBuffer(memory_of(to), CL_TRUE, offset, bytes, from); });
}

void ClDevice::read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) {
  check_range("a read", from, offset, bytes);
  copied_.from_device += bytes;
  if (bytes != 0) run([&] { queue_.enqueueReadBuffer(memory_of(from), CL_TRUE, offset, bytes, to); });
}

void ClDevice::fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) {
  check_range("a fill", to, offset, bytes);
  if (offset % 4 != 0 || bytes % 4 != 0) throw InternalError("a fill is not a multiple of four bytes");
  if (reports_uninitialised(shared_->device())) {
    const std::vector<std::uint32_t> words(bytes / 4, word);
    return write(to, offset, words.data(), bytes);
  }
  // In pieces: some drivers mishandle fills of more than 4 GiB.
  for (std::size_t done = 0; done < bytes; done += largest_fill) {
    run([&] { queue_.enqueueFillBuffer(memory_of(to), word, offset + done, std::min(bytes - done, largest_fill)); });
  }
}

ClDevice::ReadyKernel ClDevice::make_ready(const char* name, Stage stage, KernelVariant variant, std::size_t group) {
  const cl::Program program = shared_->program(stage, variant);
  ReadyKernel made;
  made.name = name;
  run([&] {
    try {
      made.kernel = cl::Kernel(program, name);
    } catch (const cl::Error& error) {
      if (error.err() != CL_INVALID_KERNEL_NAME) throw;
      throw KernelBuildError(info().name, "",
                             std::string("the driver has built the program, but not its kernel ") + name);
    }
    made.parameters = made.kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    const auto limit = made.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(shared_->device().device);
    const auto along = shared_->device().device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();
    made.group = std::max<std::size_t>(1, std::min({group, limit, along.empty() ? limit : along.front()}));
  });
  return made;
}

ClDevice::ReadyKernel& ClDevice::ready(KernelId kernel, KernelVariant variant) {
  const auto number = static_cast<std::size_t>(kernel);
  auto& slot = kernels_[static_cast<std::size_t>(variant)].at(number);
  if (!slot) {
    const std::size_t group =
        work_group_size_ != 0 ? work_group_size_ : (info().gpu ? shared_->device().gpu_group : cpu_group);
    slot = make_ready(kernel_names[number], stage_of(kernel), variant, group);
  }
  return *slot;
}

void ClDevice::launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, KernelVariant variant,
                      std::uint32_t wanted) {
  if (items == 0) return;
  ReadyKernel& target = ready(kernel, variant);
  // On a GPU one work-item must be launched alone, not as a group: lanes of a group would obstruct each other in what
  // one lane can do. On a CPU the other work-items find nothing to do, and PoCL compiles anew for each group size.
  std::size_t group = target.group;
  if (info().gpu && wanted != 0 && work_group_size_ == 0) group = std::min<std::size_t>(group, wanted);
  if (info().gpu && (items == 1 || !launches_alone(shared_->device()))) group = std::min<std::size_t>(group, items);
  enqueue(target, (items + group - 1) / group, group, args);
}

void ClDevice::enqueue(ReadyKernel& target, std::size_t groups, std::size_t group, std::span<const Arg> args) {
  if (args.size() != target.parameters)
    throw InternalError(std::string(target.name) + " takes " + std::to_string(target.parameters) + " arguments, not " +
                        std::to_string(args.size()));
  // The kernels number their work-items with 32 bits: numbers beyond would wrap around.
  if (groups > std::numeric_limits<std::uint32_t>::max() / group)
    throw InternalError(std::string(target.name) + " was launched with " + std::to_string(groups) + " groups of " +
                        std::to_string(group) + " work-items");
  run([&] {
    cl_uint position = 0;
    for (const Arg& arg : args) {
      if (arg.is_real() && !info().fp64)
        target.kernel.setArg(position, as_float(arg));
      else if (!arg.is_buffer())
        target.kernel.setArg(position, arg.size(), arg.value());
      else if (arg.buffer() == nullptr)
        target.kernel.setArg(position, sizeof(cl_mem), nullptr);
      else
        target.kernel.setArg(position, memory_of(*arg.buffer()));
      ++position;
    }
    const bool alone = launches_alone(shared_->device());
    const auto one_at_a_time = alone ? std::unique_lock(launching) : std::unique_lock<std::mutex>();
    queue_.enqueueNDRangeKernel(target.kernel, cl::NullRange, cl::NDRange(groups * group), cl::NDRange(group), nullptr,
                                clock_ ? clock_->next() : nullptr);
    if (alone) queue_.finish();
  });
}

std::optional<double> ClDevice::occupancy(unsigned work_group_size) {
  const auto insert = static_cast<std::size_t>(KernelId::cadt_insert);
  if (work_group_size == 0 ||
      make_ready(kernel_names[insert], Stage::insertion, KernelVariant::narrow, work_group_size).group <
          work_group_size)
    return 0.0;
  return std::nullopt;
}

Primitives* ClDevice::primitives() noexcept {
  if (!primitives_) primitives_ = info().gpu ? ClPrimitives::make(*this) : nullptr;
  return primitives_->get();
}

void ClDevice::finish() {
  run([&] { queue_.finish(); });
}

}  // namespace cadt::opencl
