// SPDX-License-Identifier: Apache-2.0
// Facts that decide whether a device is usable, separate from the queries, so that tests can make up devices.
#pragma once

#include <string>

namespace cadt::opencl {

struct Facts {
  bool available = true;
  bool compiler = true;
  bool little_endian = true;
  bool fp64 = true;              ///< without it the device takes float coordinates only
  bool denormals = true;         ///< gradual underflow of double
  bool round_to_nearest = true;  ///< of double
  bool float_round_to_nearest = true;
  bool float_denormals = true;   ///< gradual underflow of float; nothing relies on it
  int version = 300;             ///< 100 * major + 10 * minor
  bool acquire_release = false;  ///< advertises acquire/release atomics at device scope
};

/// Why the library cannot use such a device; empty if it can.
[[nodiscard]] std::string unusable_reason(const Facts& facts);

/// How its atomics will be built, as far as is known before a build.
[[nodiscard]] std::string expected_atomics(const Facts& facts);

/// "OpenCL 3.0 anything" gives 300; 0 if the text is not of that form.
[[nodiscard]] int parse_version(const std::string& text);

inline constexpr const char* best_effort_atomics = "CL1.2 best effort";

}  // namespace cadt::opencl
