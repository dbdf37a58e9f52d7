// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "device_json.hpp"
#include "failure.hpp"
#include "text.hpp"

#include <cadt/version.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>

namespace cadt::cli {
namespace {

std::string devices_json(const std::vector<DeviceInfo>& devices) {
  using Json = nlohmann::ordered_json;
  Json json{{"schema", 1}, {"cadt", CADT_VERSION}, {"devices", Json::array()}};
  for (const DeviceInfo& device : devices) json["devices"].push_back(device_json(device));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

std::string devices_text(const std::vector<DeviceInfo>& devices) {
  std::vector<std::vector<std::string>> rows = {
      {"BACK END", "DEVICE", "USABLE", "NAME", "MEMORY", "UNITS", "FP64", "ATOMICS", "DRIVER"}};
  std::string reasons, floats;
  for (const DeviceInfo& d : devices) {
    const std::string backend(to_string(d.backend));
    const bool device = d.index >= 0;
    rows.push_back({backend, device ? std::to_string(d.index) : "-", d.usable ? "yes" : "no", or_dash(d.name),
                    d.memory_bytes > 0 ? human_bytes(d.memory_bytes) : "-",
                    d.compute_units > 0 ? std::to_string(d.compute_units) : "-", device ? (d.fp64 ? "yes" : "no") : "-",
                    or_dash(d.atomics), or_dash(d.driver)});
    // Reasons are sentences: below the table, where they do not widen every line.
    if (!d.usable)
      reasons += fmt::format("{}{}: {}\n", backend, device ? fmt::format(" {}", d.index) : "", or_dash(d.reason));
    else if (!d.fp64)
      floats += fmt::format("{} {}: {}\n", backend, d.index, d.name);
  }
  return table(rows) + (floats.empty() ? "" : "\nFloat coordinates only (--floats), when they are named:\n" + floats) +
         (reasons.empty() ? "" : "\nNot usable:\n" + reasons);
}

}  // namespace

void add_devices(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("devices", "list every back end and device, and why one is not usable");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "as JSON");
  command->footer(
      "The number or a part of the name is what `cadt triangulate --device` takes.\n\n"
      "Example:\n"
      "  cadt devices\n"
      "  cadt triangulate points.xy --backend opencl --device 0\n");
  command->callback([json, &chosen] {
    chosen = [json] {
      const auto devices = list_devices();
      print(*json ? devices_json(devices) : devices_text(devices));
      return exit_done;
    };
  });
}

}  // namespace cadt::cli
