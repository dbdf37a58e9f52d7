// SPDX-License-Identifier: Apache-2.0
#include "common/driver/registry.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "common/driver/backend.hpp"
#include "common/driver/gpu_bound.hpp"

namespace cadt {
namespace {

std::array<BackendEntry*, 3> all_backends() { return {&cuda_backend(), &opencl_backend(), &host_backend()}; }

BackendEntry& entry(Backend id) {
  for (BackendEntry* backend : all_backends())
    if (backend->id() == id) return *backend;
  throw InternalError("a back end without an entry");
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool matches(const DeviceInfo& info, const std::string& wanted) {
  if (wanted.empty()) return true;
  int number = -1;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  if (error == std::errc{} && end == wanted.data() + wanted.size()) return info.index == number;
  return lower(info.name).find(lower(wanted)) != std::string::npos ||
         lower(info.platform).find(lower(wanted)) != std::string::npos;
}

/// The device of the caller's queue.
std::unique_ptr<Device> open_queue(BackendEntry& backend, const Options& options) {
  const std::string name(to_string(backend.id()));
  const int index = backend.device_of(*options.queue);
  for (const DeviceInfo& info : backend.devices()) {
    if (info.index < 0) throw BackendUnavailable(name, info.reason);
    if (info.index != index) continue;
    if (!matches(info, options.device))
      throw BackendUnavailable(name, "the queue belongs to '" + info.name + "' and not to '" + options.device + "'");
    return backend.open(index, options);
  }
  throw BackendUnavailable(name, "Options::queue is not a stream or queue of one of its devices");
}

std::unique_ptr<Device> open_in(BackendEntry& backend, const Options& options) {
  if (options.queue) return open_queue(backend, options);
  const std::string name(to_string(backend.id()));
  std::string reason;
  const std::vector<DeviceInfo> devices = backend.devices();
  const int preferred = options.device.empty() ? backend.preferred_device() : -1;
  for (const DeviceInfo& info : devices)
    if (info.index >= 0 && info.index == preferred && info.usable) return backend.open(info.index, options);
  // A GPU before a CPU; devices without double precision last.
  if (options.device.empty())
    for (const bool gpu : {true, false})
      for (const DeviceInfo& info : devices)
        if (info.index >= 0 && info.usable && info.fp64 && info.gpu >= gpu) return backend.open(info.index, options);
  for (const DeviceInfo& info : devices) {
    if (info.index < 0) throw BackendUnavailable(name, info.reason);
    if (!matches(info, options.device)) continue;
    if (info.usable) return backend.open(info.index, options);
    reason += (reason.empty() ? "" : "; ") + info.name + ": " + info.reason;
  }
  if (reason.empty()) reason = "no device matches '" + options.device + "'; 'cadt devices' lists what is there";
  throw BackendUnavailable(name, reason);
}

}  // namespace

std::string_view to_string(Backend backend) noexcept {
  switch (backend) {
    case Backend::automatic:
      return "auto";
    case Backend::host:
      return "host";
    case Backend::opencl:
      return "opencl";
    case Backend::cuda:
      return "cuda";
  }
  return "unknown";
}

Backend backend_from_string(std::string_view name) {
  for (const Backend backend : {Backend::automatic, Backend::host, Backend::opencl, Backend::cuda})
    if (name == to_string(backend)) return backend;
  throw BackendUnavailable(std::string(name), "there is no such back end; the names are auto, host, opencl, cuda");
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> list;
  for (BackendEntry* backend : all_backends()) {
    const std::vector<DeviceInfo> some = backend->devices();
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

std::unique_ptr<Device> open_device(const Options& options) {
  if (options.backend != Backend::automatic) return open_in(entry(options.backend), options);
  if (options.queue) throw BackendUnavailable("auto", "a queue needs its back end to be named in Options::backend");
  if (!options.device.empty()) {  // a device was named: the first back end that has it
    for (BackendEntry* backend : all_backends())
      for (const DeviceInfo& info : backend->devices())
        if (info.index >= 0 && info.usable && matches(info, options.device)) return backend->open(info.index, options);
    throw BackendUnavailable("auto",
                             "no usable device matches '" + options.device + "'; 'cadt devices' lists what is there");
  }
  // A GPU is the fastest, but one without double precision must be named. Without a GPU the host's threads are faster
  // than OpenCL on the same cores.
  for (BackendEntry* backend : all_backends())
    for (const DeviceInfo& info : backend->devices())
      if (info.index >= 0 && info.usable && info.gpu && info.fp64) return open_in(*backend, options);
  return open_in(host_backend(), options);
}

bool is_free_to_choose(const Options& options) noexcept {
  return options.backend == Backend::automatic && options.device.empty() && !options.queue;
}

bool takes_host(const Options& options, std::size_t points) noexcept {
  return is_free_to_choose(options) && points < gpu_bound().points();
}

std::unique_ptr<Device> open_device(const Options& options, std::size_t points) {
  if (!takes_host(options, points)) return open_device(options);
  Options on_host = options;
  on_host.backend = Backend::host;
  return open_device(on_host);
}

}  // namespace cadt
