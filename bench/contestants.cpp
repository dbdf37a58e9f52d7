// SPDX-License-Identifier: Apache-2.0
#include "bench/contestants.hpp"

#include "bench/machine.hpp"

#include <algorithm>

namespace cadt::bench {
namespace {

bool passes(const std::vector<std::string>& filter, std::string_view word) {
  return filter.empty() || std::ranges::find(filter, word) != filter.end();
}

bool matches(const DeviceInfo& device, const std::string& asked) {
  if (asked.empty() || device.backend == Backend::host) return true;
  if (asked.find_first_not_of("0123456789") == std::string::npos) return asked == std::to_string(device.index);
  return device.name.find(asked) != std::string::npos;
}

Contestant of_device(const DeviceInfo& device) {
  Contestant result;
  result.who = to_string(device.backend);
  result.backend = device.backend;
  result.device = device.name;
  result.gpu = device.gpu;
  if (device.backend == Backend::host) {
    result.threads = cores();
  } else {
    result.index = std::to_string(device.index);
  }
  return result;
}

/// The library's own choice: the first usable GPU, else the first usable device.
Contestant of_backend(Backend backend, const std::string& asked) {
  std::optional<DeviceInfo> chosen;
  std::string reason = "no such device";
  for (const DeviceInfo& device : list_devices()) {
    if (device.backend != backend) continue;
    if (!device.usable) {
      if (!chosen) reason = device.reason;
      continue;
    }
    if (matches(device, asked) && (!chosen || (device.gpu && !chosen->gpu))) chosen = device;
  }
  if (chosen) return of_device(*chosen);
  Contestant result;
  result.who = to_string(backend);
  result.backend = backend;
  result.missing = "not available: " + reason;
  return result;
}

Contestant of_peer(const std::string& name, const std::vector<Peer>& peers) {
  Contestant result;
  result.who = name;
  const auto found = std::ranges::find(peers, name, &Peer::name);
  if (found == peers.end()) {
    result.missing = "not installed";
    return result;
  }
  if (!found->usable()) result.missing = "not installed: " + found->reason;
  if (name != "cupy") result.threads = 1;
  result.peer = *found;
  return result;
}

}  // namespace

const std::vector<std::string>& all_who() {
  static const std::vector<std::string> names = {"sequential", "cgal", "scipy", "cupy", "host", "opencl", "cuda"};
  return names;
}

std::vector<Contestant> find_contestants(const Choice& choice, const std::vector<Peer>& peers) {
  std::vector<Contestant> result;
  for (const std::string& who : all_who()) {
    if (!passes(choice.who, who)) continue;
    if (who == "sequential") {
      result.emplace_back().who = who;
      result.back().threads = 1;
    } else if (who == "host" || who == "opencl" || who == "cuda") {
      if (passes(choice.backends, who)) result.push_back(of_backend(backend_from_string(who), choice.device));
    } else {
      result.push_back(of_peer(who, peers));
    }
  }
  return result;
}

std::vector<Contestant> every_device(const Choice& choice) {
  std::vector<Contestant> result;
  for (const DeviceInfo& device : list_devices()) {
    const std::string_view who = to_string(device.backend);
    if (device.usable && passes(choice.who, who) && passes(choice.backends, who) && matches(device, choice.device))
      result.push_back(of_device(device));
  }
  return result;
}

}  // namespace cadt::bench
