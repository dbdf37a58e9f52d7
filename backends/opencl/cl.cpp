// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/cl.hpp"

#include <cadt/errors.hpp>

namespace cadt::opencl {
namespace {

// CL_PLATFORM_NOT_FOUND_KHR is only in the headers of the loader, the last code only in NVIDIA's documentation.
constexpr int platform_not_found = -1001;
constexpr int nvidia_illegal_access = -9999;

}  // namespace

const char* code_name(int code) noexcept {
#define CADT_CODE(name) \
  case name:            \
    return #name
  switch (code) {
    CADT_CODE(CL_SUCCESS);
    CADT_CODE(CL_DEVICE_NOT_FOUND);
    CADT_CODE(CL_DEVICE_NOT_AVAILABLE);
    CADT_CODE(CL_COMPILER_NOT_AVAILABLE);
    CADT_CODE(CL_MEM_OBJECT_ALLOCATION_FAILURE);
    CADT_CODE(CL_OUT_OF_RESOURCES);
    CADT_CODE(CL_OUT_OF_HOST_MEMORY);
    CADT_CODE(CL_PROFILING_INFO_NOT_AVAILABLE);
    CADT_CODE(CL_MEM_COPY_OVERLAP);
    CADT_CODE(CL_BUILD_PROGRAM_FAILURE);
    CADT_CODE(CL_MAP_FAILURE);
    CADT_CODE(CL_MISALIGNED_SUB_BUFFER_OFFSET);
    CADT_CODE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
    CADT_CODE(CL_COMPILE_PROGRAM_FAILURE);
    CADT_CODE(CL_LINKER_NOT_AVAILABLE);
    CADT_CODE(CL_LINK_PROGRAM_FAILURE);
    CADT_CODE(CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
    CADT_CODE(CL_INVALID_VALUE);
    CADT_CODE(CL_INVALID_DEVICE_TYPE);
    CADT_CODE(CL_INVALID_PLATFORM);
    CADT_CODE(CL_INVALID_DEVICE);
    CADT_CODE(CL_INVALID_CONTEXT);
    CADT_CODE(CL_INVALID_QUEUE_PROPERTIES);
    CADT_CODE(CL_INVALID_COMMAND_QUEUE);
    CADT_CODE(CL_INVALID_HOST_PTR);
    CADT_CODE(CL_INVALID_MEM_OBJECT);
    CADT_CODE(CL_INVALID_BINARY);
    CADT_CODE(CL_INVALID_BUILD_OPTIONS);
    CADT_CODE(CL_INVALID_PROGRAM);
    CADT_CODE(CL_INVALID_PROGRAM_EXECUTABLE);
    CADT_CODE(CL_INVALID_KERNEL_NAME);
    CADT_CODE(CL_INVALID_KERNEL_DEFINITION);
    CADT_CODE(CL_INVALID_KERNEL);
    CADT_CODE(CL_INVALID_ARG_INDEX);
    CADT_CODE(CL_INVALID_ARG_VALUE);
    CADT_CODE(CL_INVALID_ARG_SIZE);
    CADT_CODE(CL_INVALID_KERNEL_ARGS);
    CADT_CODE(CL_INVALID_WORK_DIMENSION);
    CADT_CODE(CL_INVALID_WORK_GROUP_SIZE);
    CADT_CODE(CL_INVALID_WORK_ITEM_SIZE);
    CADT_CODE(CL_INVALID_GLOBAL_OFFSET);
    CADT_CODE(CL_INVALID_EVENT_WAIT_LIST);
    CADT_CODE(CL_INVALID_EVENT);
    CADT_CODE(CL_INVALID_OPERATION);
    CADT_CODE(CL_INVALID_BUFFER_SIZE);
    CADT_CODE(CL_INVALID_GLOBAL_WORK_SIZE);
    CADT_CODE(CL_INVALID_PROPERTY);
    CADT_CODE(CL_INVALID_COMPILER_OPTIONS);
    CADT_CODE(CL_INVALID_LINKER_OPTIONS);
    case platform_not_found:
      return "CL_PLATFORM_NOT_FOUND_KHR";
    case nvidia_illegal_access:
      return "illegal access by a kernel";
    default:
      return "unknown code";
  }
#undef CADT_CODE
}

bool is_fatal(int code) noexcept {
  return code == CL_OUT_OF_RESOURCES || code == CL_INVALID_COMMAND_QUEUE || code == CL_INVALID_CONTEXT ||
         code == CL_DEVICE_NOT_AVAILABLE || code == nvidia_illegal_access;
}

void throw_device_error(const cl::Error& error, const std::string& device) {
  throw DeviceError(error.what() == nullptr ? "OpenCL" : error.what(), error.err(), device, code_name(error.err()));
}

}  // namespace cadt::opencl
