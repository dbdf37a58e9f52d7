// SPDX-License-Identifier: Apache-2.0
// CADT_TEST_OPENCL_DEVICE: the OpenCL device that the tests run on, where a machine has several: a number or a part of
// the name of the device or of its platform, as Options::device takes it.
#pragma once

#include <cadt/devices.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <string_view>

namespace cadt::test {

/// What Options::device shall be; empty leaves the choice to the library.
[[nodiscard]] inline std::string chosen_device(Backend backend) {
  const char* variable = backend == Backend::opencl ? std::getenv("CADT_TEST_OPENCL_DEVICE") : nullptr;
  return variable ? variable : "";
}

/// May the tests use it?
[[nodiscard]] inline bool is_chosen(const DeviceInfo& device) {
  const std::string chosen = chosen_device(device.backend);
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (std::all_of(chosen.begin(), chosen.end(), is_digit)) {
    return chosen.empty() || chosen == std::to_string(device.index);
  }
  const auto contains_chosen = [&](const std::string& name) {
    return std::search(name.begin(), name.end(), chosen.begin(), chosen.end(), [](unsigned char a, unsigned char b) {
             return std::tolower(a) == std::tolower(b);
           }) != name.end();
  };
  return contains_chosen(device.name) || contains_chosen(device.platform);
}

}  // namespace cadt::test
