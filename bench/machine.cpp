// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.hpp"

#include "apps/cadt/device_json.hpp"
#include "commit.hpp"

#include <cadt/version.hpp>

#include <fmt/format.h>
#include <sched.h>
#include <sys/sysinfo.h>

#include <ctime>
#include <fstream>
#include <limits>
#include <thread>

namespace cadt::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The text after `key` and `separator` in the first line that starts with it; empty if there is none.
std::string entry(const char* file, std::string_view key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    if (first != std::string::npos) return line.substr(first, last - first + 1);
  }
  return {};
}

std::string compiler() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return {};
#endif
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::uint64_t memory_bytes() {
  struct sysinfo system {};
  return sysinfo(&system) == 0 ? std::uint64_t{system.totalram} * system.mem_unit : 0;
}

}  // namespace

std::string cpu_name() { return entry("/proc/cpuinfo", "model name", ':'); }

unsigned cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
  return std::thread::hardware_concurrency();
}

std::uint64_t memory_available() {
  const std::string kibibytes = entry("/proc/meminfo", "MemAvailable", ':');
  if (kibibytes.empty()) return std::numeric_limits<std::uint64_t>::max();
  return std::stoull(kibibytes) * 1024;
}

std::string default_machine_name() {
  for (const DeviceInfo& device : list_devices())
    if (device.usable && device.gpu) return device.name;
  const std::string name = cpu_name();
  return fmt::format("{}, {} cores", name.empty() ? "processor" : name, cores());
}

std::string machine_json(const std::string& name, const std::vector<PeerInfo>& peers) {
  Json json{{"schema", 1},
            {"name", name},
            {"cpu", cpu_name()},
            {"cores", cores()},
            {"memory_bytes", memory_bytes()},
            {"os", entry("/etc/os-release", "PRETTY_NAME", '=')},
            {"compiler", compiler()},
            {"cadt", CADT_VERSION},
            {"commit", CADT_BENCH_COMMIT},
            {"date", now()},
            {"devices", Json::array()},
            {"peers", Json::array()}};
  for (const DeviceInfo& device : list_devices()) json["devices"].push_back(cli::device_json(device));
  for (const PeerInfo& peer : peers) {
    json["peers"].push_back(
        {{"name", peer.name}, {"version", peer.version}, {"usable", peer.usable}, {"reason", peer.reason}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace cadt::bench
