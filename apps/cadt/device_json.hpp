// SPDX-License-Identifier: Apache-2.0
// A device as JSON, for cadt-bench too.
#pragma once

#include <cadt/devices.hpp>
#include <nlohmann/json.hpp>

namespace cadt::cli {

[[nodiscard]] inline nlohmann::ordered_json device_json(const DeviceInfo& d) {
  return {{"backend", to_string(d.backend)},
          {"index", d.index},
          {"usable", d.usable},
          {"reason", d.reason},
          {"platform", d.platform},
          {"name", d.name},
          {"driver", d.driver},
          {"gpu", d.gpu},
          {"watchdog", d.watchdog},
          {"memory_bytes", d.memory_bytes},
          {"largest_buffer_bytes", d.largest_buffer_bytes},
          {"compute_units", d.compute_units},
          {"fp64", d.fp64},
          {"atomics", d.atomics}};
}

}  // namespace cadt::cli
