// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/clock.hpp"

namespace cadt::opencl {

std::vector<double> ClClock::read() {
  std::vector<double> result;
  result.reserve(done_.size());
  try {
    for (const std::vector<cl::Event>& events : done_) {
      cl_ulong nanoseconds = 0;
      for (const cl::Event& event : events) {
        event.wait();
        nanoseconds +=
            event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
      }
      result.push_back(1e-6 * static_cast<double>(nanoseconds));
    }
  } catch (const cl::Error& error) {
    clear();
    throw_device_error(error, device_);
  }
  clear();
  return result;
}

}  // namespace cadt::opencl
