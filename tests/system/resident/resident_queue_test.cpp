// SPDX-License-Identifier: Apache-2.0
// Options::queue, right and wrong.
#include "tests/system/resident/resident.hpp"

#ifdef CADT_HAVE_OPENCL
#include "backends/opencl/platform.hpp"
#endif

namespace cadt::test {
namespace {

TEST(Queue, NeedsItsBackEndToBeNamed) {
  int something = 0;
  Options options;
  options.queue = &something;
  if (const auto error = thrown<BackendUnavailable>([&] { const Triangulator t(options); }); error != nullptr) {
    EXPECT_EQ(error->backend(), "auto");
  }
  (void)thrown<BackendUnavailable>([&] { (void)triangulate(std::span<const double>(Points{0, 0}), options); });
}

TEST(Queue, HostHasNone) {
  int something = 0;
  Options options;
  options.backend = Backend::host;
  for (void* queue : {static_cast<void*>(&something), static_cast<void*>(nullptr)}) {
    options.queue = queue;
    if (const auto error = thrown<BackendUnavailable>([&] { const Triangulator t(options); }); error != nullptr) {
      EXPECT_EQ(error->backend(), "host");
    }
  }
}

class QueueOfTheCaller : public ResidentTest {};

TEST_P(QueueOfTheCaller, OfAnotherDeviceThanNamed) {
  Options with = options();
  with.device = "no such device";
  if (const auto error = thrown<BackendUnavailable>([&] { const Triangulator t(with); }); error != nullptr) {
    EXPECT_NE(error->reason().find("no such device"), std::string::npos) << error->reason();
  }
  with.device.clear();  // the queue says it
  const Known known(uniform_points(200));
  Triangulator triangulator(with);
  EXPECT_EQ(triangulator.device().index, device_index(GetParam().backend));
  expect_same(*memory, triangulator.triangulate(upload(known.xy)), known.mesh);
}

CADT_ON(opencl, QueueOfTheCaller, main_opencl_case);
CADT_ON(cuda, QueueOfTheCaller, main_cuda_case);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(QueueOfTheCaller);

#ifdef CADT_HAVE_OPENCL
class ClQueue : public ResidentTest {
 protected:
  [[nodiscard]] cl::CommandQueue own() const {
    return cl::CommandQueue(static_cast<cl_command_queue>(memory->queue()), true);
  }
};

TEST_P(ClQueue, Null) {
  Options with = options();
  with.queue = nullptr;
  (void)thrown<BackendUnavailable>([&] { const Triangulator t(with); });
}

TEST_P(ClQueue, OutOfOrder) {
  const auto device = own().getInfo<CL_QUEUE_DEVICE>();
  if ((device.getInfo<CL_DEVICE_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) == 0)
    GTEST_SKIP() << "the device has no such queues";
  const cl::CommandQueue queue(own().getInfo<CL_QUEUE_CONTEXT>(), device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  Options with = options();
  with.queue = queue();
  if (const auto error = thrown<BackendUnavailable>([&] { const Triangulator t(with); }); error != nullptr) {
    EXPECT_NE(error->reason().find("order"), std::string::npos) << error->reason();
  }
}

TEST_P(ClQueue, WithoutProfiling) {
  Options with = options();
  with.tuning.kernel_times = true;
  if (const auto error = thrown<OptionError>([&] { const Triangulator t(with); }); error != nullptr) {
    EXPECT_EQ(error->option(), "tuning.kernel_times");
  }
  const cl::CommandQueue queue(own().getInfo<CL_QUEUE_CONTEXT>(), own().getInfo<CL_QUEUE_DEVICE>(),
                               CL_QUEUE_PROFILING_ENABLE);
  with.queue = queue();
  const Known known(uniform_points(200));
  Triangulator triangulator(with);
  const DeviceTriangulation mesh = triangulator.triangulate(upload(known.xy));
  EXPECT_FALSE(mesh.statistics().kernels.empty());
}

TEST_P(ClQueue, BufferOfAnotherContext) {
  const Known known(uniform_points(200));
  const auto other = device_memory(Backend::opencl, device_index(Backend::opencl));
  const void* strange = other->upload(std::span<const double>(known.xy));
  Triangulator triangulator(options());
  const DevicePoints points = upload(known.xy);
  (void)thrown<BackendUnavailable>(
      [&] { (void)triangulator.triangulate(DevicePoints{.x = strange, .size = known.size()}); });
  (void)thrown<BackendUnavailable>(
      [&] { (void)triangulator.triangulate(DevicePoints{.x = points.x, .y = strange, .size = known.size()}); });
  expect_same(*memory, triangulator.triangulate(points), known.mesh);
}

TEST_P(ClQueue, BufferTooSmall) {
  const Known known(uniform_points(200));
  Triangulator triangulator(options());
  const DevicePoints points = upload(known.xy);
  const void* small = memory->upload(std::span<const double>(known.xy).first(199));
  const std::size_t n = known.size();
  for (const DevicePoints& wrong :
       {DevicePoints{.x = points.x, .size = n + 1}, DevicePoints{.x = points.x, .size = n, .skip = 1},
        DevicePoints{.x = points.x, .size = 2 * n + 1, .scalar = Scalar::float32},
        DevicePoints{.x = points.x, .y = small, .size = n}, DevicePoints{.x = small, .y = points.x, .size = n},
        DevicePoints{.x = points.x, .size = n, .skip = 1000000000}})
    (void)thrown<InputError>([&] { (void)triangulator.triangulate(wrong); });
  expect_same(*memory, triangulator.triangulate(points), known.mesh);
}

/// The caller may release its queue and its points once the triangulator has them.
TEST_P(ClQueue, IsRetained) {
  const Known known(uniform_points(2000));
  cl::CommandQueue queue(own().getInfo<CL_QUEUE_CONTEXT>(), own().getInfo<CL_QUEUE_DEVICE>());
  Options with = options();
  with.queue = queue();
  Triangulator triangulator(with);
  queue = cl::CommandQueue();
  expect_same(*memory, triangulator.triangulate(upload(known.xy)), known.mesh);
}

CADT_ON(opencl, ClQueue, main_opencl_case);
#endif

}  // namespace
}  // namespace cadt::test
