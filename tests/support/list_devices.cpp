// SPDX-License-Identifier: Apache-2.0
// Prints what scripts/check_gpu wants to know: back end, number, "gpu" or "processor", "usable" or why not, name.
#include <cadt/devices.hpp>

#include <iostream>

int main() {
  for (const cadt::DeviceInfo& device : cadt::list_devices()) {
    std::cout << to_string(device.backend) << '\t' << device.index << '\t' << (device.gpu ? "gpu" : "processor") << '\t'
              << (device.usable ? "usable" : device.reason) << '\t' << device.name << '\n';
  }
}
