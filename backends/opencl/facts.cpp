// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/facts.hpp"

#include <cctype>

namespace cadt::opencl {

std::string unusable_reason(const Facts& facts) {
  if (!facts.available) return "the driver reports the device as not available";
  if (facts.version < 120)
    return "OpenCL 1.2 or later is needed, the device offers " + std::to_string(facts.version / 100) + "." +
           std::to_string(facts.version / 10 % 10);
  if (!facts.compiler) return "the driver has no compiler for OpenCL C";
  if (!facts.little_endian) return "the device is big-endian";
  if (!facts.fp64)
    return facts.float_round_to_nearest
               ? ""
               : "neither double precision (cl_khr_fp64) nor floats that are rounded to nearest "
                 "(CL_FP_ROUND_TO_NEAREST)";
  if (!facts.denormals) return "double precision without gradual underflow (CL_FP_DENORM)";
  if (!facts.round_to_nearest) return "double precision without rounding to nearest (CL_FP_ROUND_TO_NEAREST)";
  return {};
}

std::string expected_atomics(const Facts& facts) {
  if (facts.version < 200) return best_effort_atomics;
  if (!facts.acquire_release) return "acquire/release not advertised, tried when opened";
  return std::string(facts.version >= 300 ? "CL3.0" : "CL2.0") + " acquire/release, device scope";
}

int parse_version(const std::string& text) {
  const std::string prefix = "OpenCL ";
  if (text.compare(0, prefix.size(), prefix) != 0) return 0;
  int major = 0;
  std::size_t at = prefix.size();
  const auto digit = [&] { return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0; };
  if (!digit()) return 0;
  for (; digit() && major < 1000; ++at) major = 10 * major + (text[at] - '0');
  if (at >= text.size() || text[at++] != '.' || !digit()) return 0;
  return 100 * major + 10 * (text[at] - '0');
}

}  // namespace cadt::opencl
