// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/program.hpp"

#include <array>
#include <cadt/errors.hpp>
#include <cstdlib>
#include <optional>
#include <vector>

#include "backends/opencl/binary_cache.hpp"

namespace cadt::opencl {
namespace {

// Every operation that common/portable/atomics.dev.h needs: a compiler that accepts this source accepts that file.
constexpr const char* probe_source = R"(
__kernel void probe(__global uint* p) {
  volatile __global atomic_uint* a = (volatile __global atomic_uint*)p;
  uint expected = atomic_load_explicit(a, memory_order_acquire, memory_scope_device);
  atomic_store_explicit(a, 1u, memory_order_release, memory_scope_device);
  if (!atomic_compare_exchange_strong_explicit(a, &expected, 2u, memory_order_acq_rel, memory_order_relaxed,
                                               memory_scope_device))
    atomic_fetch_add_explicit(a, 1u, memory_order_relaxed, memory_scope_device);
  atomic_fetch_min_explicit(a, 3u, memory_order_relaxed, memory_scope_device);
}
)";

constexpr const char* c11_options = " -DCADT_CL_C11=1";

bool compiles(const cl::Context& context, const cl::Device& device, const std::string& options) {
  try {
    cl::Program program(context, std::string(probe_source));
    program.build(std::vector<cl::Device>{device}, options.c_str());
    // Some drivers defer the link: the kernel must exist as well.
    const cl::Kernel kernel(program, "probe");
    return kernel() != nullptr;
  } catch (const cl::Error&) {
    return false;
  }
}

AtomicsPath c11_path(const std::string& standard) {
  return {standard + " acquire/release, device scope", "-cl-std=" + standard + c11_options};
}

std::string log_of(const cl::Program& program, const cl::Device& device, const cl::Error& error) {
  std::string log;
  try {
    log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
  } catch (const cl::Error&) {
    // fall through to the next path
  }
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log + (log.empty() ? "" : "\n") + code_name(error.err()) + " (" + std::to_string(error.err()) + ")";
}

Digest key_of(const FoundDevice& device, const std::string& source, const std::string& options) {
  const std::array<std::string, 7> identity = {source,
                                               options,
                                               device.info.name,
                                               device.vendor,
                                               device.device_version,
                                               device.info.driver,
                                               device.platform_version};
  return digest_of(std::span<const std::string>(identity));
}

// Drivers that keep on disk what they have compiled. A second cache gains nothing there, and PoCL, which compiles a
// kernel at its first launch, would have to compile all of them to hand out the program: 23 s for the first call
// instead of 5.
bool driver_caches(const FoundDevice& device) {
  const std::string& platform = device.info.platform;
  return platform == "Portable Computing Language" || platform == "NVIDIA CUDA" || platform == "rusticl";
}

/// Empty: no cache.
std::filesystem::path cache_directory_for(const FoundDevice& device) {
  return driver_caches(device) && std::getenv("CADT_CACHE_DIR") == nullptr ? std::filesystem::path()
                                                                           : cache_directory();
}

// A driver may reject its own binary, e.g. after an update that kept the version: then the program is built again.
std::optional<cl::Program> from_binary(const cl::Context& context, const FoundDevice& device,
                                       std::vector<unsigned char> binary, const std::string& options) {
  try {
    std::vector<cl_int> status;
    cl::Program program(context, {device.device}, {std::move(binary)}, &status);
    for (const cl_int code : status)
      if (code != CL_SUCCESS) return std::nullopt;
    program.build(std::vector<cl::Device>{device.device}, options.c_str());
    return program;
  } catch (const cl::Error&) {
    return std::nullopt;
  }
}

void keep_binary(const cl::Program& program, const std::filesystem::path& directory, Digest key) {
  if (directory.empty()) return;
  try {
    const std::vector<std::vector<unsigned char>> binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (!binaries.empty()) store_binary(directory, key, binaries.front());
  } catch (const cl::Error&) {
    // Not every driver returns its binaries; the next process builds again.
  }
}

}  // namespace

AtomicsPath choose_atomics(const cl::Context& context, const FoundDevice& device, AtomicsChoice choice) {
  const AtomicsPath best_effort = {best_effort_atomics, "-cl-std=CL1.2"};
  if (choice == AtomicsChoice::best_effort || device.facts.version < 200) return best_effort;
  const std::array<const char*, 2> standards = {"CL3.0", "CL2.0"};
  for (const char* standard : standards) {
    if (device.facts.version < 300 && standard == standards[0]) continue;
    AtomicsPath path = c11_path(standard);
    if (device.facts.acquire_release && choice == AtomicsChoice::automatic) return path;
    if (compiles(context, device.device, path.options)) return path;
  }
  return best_effort;
}

std::string build_options(const FoundDevice& device, const AtomicsPath& atomics, KernelVariant variant,
                          const std::string& extra) {
  // No option that relaxes arithmetic may ever be added: the filters rely on each rounding (and the self-test would
  // reject the device).
  std::string options = atomics.options;
  // Without doubles, literals must be floats. A device that does not promise subnormal numbers shall flush them always,
  // rather than sometimes.
  if (!device.facts.fp64)
    options += std::string(" -DCADT_FLOAT=1 -cl-single-precision-constant") +
               (device.facts.float_denormals ? "" : " -cl-denorms-are-zero");
  else
    options += variant == KernelVariant::wide ? " -DCADT_WIDE=1" : " -DCADT_WIDE=0";
  if (variant == KernelVariant::timed) options += " -DCADT_TIMED=1";
  options += device.info.gpu ? " -DCADT_CONTIGUOUS=0 -DCADT_RADIX_BITS=4" : " -DCADT_CONTIGUOUS=1 -DCADT_RADIX_BITS=8";
  // cadt_insert uses 118 registers if it may; with 96 more work-items are resident, which is faster (measured with
  // CUDA).
  if (device.info.platform == "NVIDIA CUDA") options += " -cl-nv-maxrregcount=96";
  if (!extra.empty()) options += " " + extra;
  return options;
}

cl::Program build_program(const cl::Context& context, const FoundDevice& device, const std::string& source,
                          const std::string& options, bool* from_cache) {
  const Digest key = key_of(device, source, options);
  const std::filesystem::path directory = cache_directory_for(device);
  if (from_cache != nullptr) *from_cache = false;
  if (auto binary = load_binary(directory, key)) {
    if (auto program = from_binary(context, device, std::move(*binary), options)) {
      if (from_cache != nullptr) *from_cache = true;
      return *program;
    }
  }

  cl::Program program;
  try {
    program = cl::Program(context, source);
  } catch (const cl::Error& error) {
    throw_device_error(error, device.info.name);
  }
  try {
    program.build(std::vector<cl::Device>{device.device}, options.c_str());
  } catch (const cl::Error& error) {
    throw KernelBuildError(device.info.name, options, log_of(program, device.device, error));
  }
  keep_binary(program, directory, key);
  return program;
}

}  // namespace cadt::opencl
