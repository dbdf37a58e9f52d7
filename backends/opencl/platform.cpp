// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/platform.hpp"

#include <cstdlib>
#include <mutex>
#include <string_view>

namespace cadt::opencl {
namespace {

std::string failure(const cl::Error& error) {
  return std::string(error.what() == nullptr ? "OpenCL" : error.what()) + ": " + code_name(error.err()) + " (" +
         std::to_string(error.err()) + ")";
}

std::string no_platform() {
  std::string where = "/etc/OpenCL/vendors";
  if (const char* vendors = std::getenv("OCL_ICD_VENDORS")) where = std::string("OCL_ICD_VENDORS=") + vendors;
  return "no OpenCL platform (CL_PLATFORM_NOT_FOUND_KHR): the loader found no driver in " + where +
         "; install the driver of the GPU, or PoCL for the CPU";
}

// Drivers pad their strings with blanks, some with a terminator.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  std::size_t first = 0;
  while (first < text.size() && text[first] == ' ') ++first;
  return text.substr(first);
}

bool wished(const char* variable) {
  const char* wish = std::getenv(variable);
  return wish != nullptr && std::string_view(wish) == "1";
}

// For tests on machines without a GPU: with CADT_OPENCL_AS_GPU=1 every device is driven like a GPU (strided work-items,
// relaxed accesses with fences, sort and scan of kernels_cl/primitives.cl). Correct on all devices, only slower on
// CPUs. A larger number is the size of its groups in addition. 0: no.
unsigned long used_as_gpu() {
  const char* wish = std::getenv("CADT_OPENCL_AS_GPU");
  return wish != nullptr ? std::strtoul(wish, nullptr, 10) : 0;
}

// CADT_OPENCL_NO_FP64=1: devices are treated as the least that is usable: without double precision and without
// subnormal floats.
bool used_without_doubles() { return wished("CADT_OPENCL_NO_FP64"); }

bool advertises_acquire_release(const cl::Device& device, int version) {
  if (version < 200) return false;
  if (version < 300) return true;  // part of OpenCL 2; optional since 3.0
  const auto has = device.getInfo<CL_DEVICE_ATOMIC_MEMORY_CAPABILITIES>();
  return (has & CL_DEVICE_ATOMIC_ORDER_ACQ_REL) != 0 && (has & CL_DEVICE_ATOMIC_SCOPE_DEVICE) != 0;
}

// NVIDIA's cl_nv_device_attribute_query; other vendors do not report it.
bool has_watchdog(const cl::Device& device) {
  constexpr cl_device_info kernel_exec_timeout = 0x4005;
  if (device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_nv_device_attribute_query") == std::string::npos) return false;
  cl_bool timeout = CL_FALSE;
  return clGetDeviceInfo(device(), kernel_exec_timeout, sizeof timeout, &timeout, nullptr) == CL_SUCCESS &&
         timeout != CL_FALSE;
}

void describe(FoundDevice& found) {
  const cl::Device& device = found.device;
  DeviceInfo& info = found.info;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.largest_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  found.gpu_hardware = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
  const unsigned long as_gpu = used_as_gpu();
  info.gpu = found.gpu_hardware || as_gpu != 0;
  if (as_gpu > 1) found.gpu_group = as_gpu;
  info.watchdog = has_watchdog(device);
  found.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  found.device_version = trimmed(device.getInfo<CL_DEVICE_VERSION>());

  Facts& facts = found.facts;
  facts.version = parse_version(found.device_version);
  facts.available = device.getInfo<CL_DEVICE_AVAILABLE>() != 0;
  facts.compiler = device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() != 0;
  facts.little_endian = device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() != 0;
  // Before 1.2 the query itself needs the extension; those devices are refused for their version anyway.
  const cl_device_fp_config config =
      facts.version >= 120 && !used_without_doubles() ? device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() : 0;
  facts.fp64 = config != 0;
  facts.denormals = (config & CL_FP_DENORM) != 0;
  facts.round_to_nearest = (config & CL_FP_ROUND_TO_NEAREST) != 0;
  const cl_device_fp_config float_config = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  facts.float_round_to_nearest = (float_config & CL_FP_ROUND_TO_NEAREST) != 0;
  facts.float_denormals = (float_config & CL_FP_DENORM) != 0 && !used_without_doubles();
  facts.acquire_release = advertises_acquire_release(device, facts.version);

  info.fp64 = facts.fp64;
  info.atomics = expected_atomics(facts);
  info.reason = unusable_reason(facts);
  info.usable = info.reason.empty();
}

// A platform without devices is no error: the driver is installed, its hardware is absent.
std::vector<cl::Device> devices_of(const cl::Platform& platform, std::string& why) {
  std::vector<cl::Device> devices;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
  } catch (const cl::Error& error) {
    why = failure(error);
  }
  return devices;
}

}  // namespace

Found find_devices() {
  // Loaders and drivers make their platforms and devices at the first question, which is one at a time: PoCL lets
  // another thread see devices that are not ready.
  static std::mutex first_question;
  const std::lock_guard lock(first_question);
  Found result;
  result.none = loader_failure();
  if (!result.none.empty()) return result;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error& error) {
    result.none = error.err() == -1001 ? no_platform() : failure(error);
    return result;
  }
  if (platforms.empty()) {
    result.none = no_platform();
    return result;
  }

  std::string empty_platforms;
  for (const cl::Platform& platform : platforms) {
    std::string name = "unnamed platform", version, why = "no device";
    try {
      name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
      version = trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
    } catch (const cl::Error& error) {
      why = failure(error);
    }
    const std::vector<cl::Device> devices = devices_of(platform, why);
    if (devices.empty()) empty_platforms += (empty_platforms.empty() ? "" : "; ") + name + ": " + why;
    for (const cl::Device& device : devices) {
      FoundDevice found;
      found.device = device;
      found.platform_version = version;
      found.info.backend = Backend::opencl;
      found.info.index = static_cast<int>(result.devices.size());
      found.info.platform = name;
      try {
        describe(found);
      } catch (const cl::Error& error) {
        found.info.usable = false;
        found.info.reason = failure(error);
      }
      result.devices.push_back(std::move(found));
    }
  }
  if (result.devices.empty()) result.none = "no OpenCL device: " + empty_platforms;
  return result;
}

}  // namespace cadt::opencl
