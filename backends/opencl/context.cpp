// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/context.hpp"

#include <cadt/errors.hpp>
#include <map>
#include <memory>
#include <tuple>

#include "backends/opencl/kernel_source.hpp"

namespace cadt::opencl {
namespace {

FoundDevice find(int index) {
  Found found = find_devices();
  if (found.devices.empty()) throw BackendUnavailable("opencl", found.none);
  if (index < 0 || static_cast<std::size_t>(index) >= found.devices.size())
    throw BackendUnavailable("opencl", "there is no device " + std::to_string(index) + "; devices are 0 to " +
                                           std::to_string(found.devices.size() - 1));
  FoundDevice device = std::move(found.devices[static_cast<std::size_t>(index)]);
  if (!device.info.usable) throw BackendUnavailable("opencl", "'" + device.info.name + "': " + device.info.reason);
  return device;
}

AtomicsChoice choice_of(const OpenRequest& request) {
  if (request.best_effort_atomics) return AtomicsChoice::best_effort;
  return request.probe_atomics ? AtomicsChoice::always_probe : AtomicsChoice::automatic;
}

using Key = std::tuple<int, std::string, std::string, AtomicsChoice>;

// An entry of the map with a lock of its own: opening one device must not wait for the compiler of another.
struct Slot {
  std::mutex mutex;
  std::shared_ptr<SharedContext> context;
};

std::shared_ptr<Slot> slot_of(const OpenRequest& request) {
  // Never destroyed, on purpose: at exit a driver may have shut down before the static destructors run, and releasing a
  // context then crashes in some of them. The system reclaims everything anyway.
  static auto* const mutex = new std::mutex;
  static auto* const slots = new std::map<Key, std::shared_ptr<Slot>>;
  const std::lock_guard lock(*mutex);
  auto& slot = (*slots)[Key(request.index, request.extra_options, request.source, choice_of(request))];
  if (slot == nullptr) slot = std::make_shared<Slot>();
  return slot;
}

/// Triangulators on queues of the same context share its programs.
std::shared_ptr<SharedContext> context_of_queue(const OpenRequest& request) {
  static auto* const mutex = new std::mutex;
  static auto* const contexts = new std::map<std::pair<cl_context, int>, std::weak_ptr<SharedContext>>;
  cl_context context = nullptr;
  try {
    context = cl::CommandQueue(static_cast<cl_command_queue>(*request.queue), true).getInfo<CL_QUEUE_CONTEXT>()();
  } catch (const cl::Error& error) {
    throw BackendUnavailable("opencl", std::string("Options::queue is no cl_command_queue: ") + code_name(error.err()));
  }
  const std::lock_guard lock(*mutex);
  // The pointer identifies this context as long as the entry lives, for the entry holds the context.
  std::erase_if(*contexts, [](const auto& known) { return known.second.expired(); });
  auto& entry = (*contexts)[{context, request.index}];
  std::shared_ptr<SharedContext> shared = entry.lock();
  if (shared == nullptr || shared->lost) entry = shared = std::make_shared<SharedContext>(request);
  return shared;
}

}  // namespace

SharedContext::SharedContext(const OpenRequest& request)
    : device_(find(request.index)), source_(request.source), extra_options_(request.extra_options) {
  try {
    if (request.queue) {
      context_ = cl::CommandQueue(static_cast<cl_command_queue>(*request.queue), true).getInfo<CL_QUEUE_CONTEXT>();
    } else {
      context_ = cl::Context(device_.device);
    }
  } catch (const cl::Error& error) {
    throw_device_error(error, device_.info.name);
  }
  atomics_ = choose_atomics(context_, device_, choice_of(request));
  device_.info.atomics = atomics_.text;
}

cl::Program SharedContext::program(Stage stage, KernelVariant variant, bool* from_cache) {
  if (!device_.facts.fp64 && variant == KernelVariant::wide)
    variant = KernelVariant::narrow;  // the float variant takes any exponent already
  if (!source_.empty()) stage = {};
  const std::lock_guard lock(build_mutex_);
  auto& slot = programs_[static_cast<std::size_t>(variant)][static_cast<std::size_t>(stage)];
  if (!slot)
    slot = build_program(context_, device_, source_.empty() ? kernel_source(stage) : source_,
                         build_options(device_, atomics_, variant, extra_options_), from_cache);
  return *slot;
}

std::shared_ptr<SharedContext> shared_context(const OpenRequest& request) {
  if (request.queue) return context_of_queue(request);
  if (request.fresh) return std::make_shared<SharedContext>(request);
  const std::shared_ptr<Slot> slot = slot_of(request);
  const std::lock_guard lock(slot->mutex);
  if (slot->context == nullptr || slot->context->lost) slot->context = std::make_shared<SharedContext>(request);
  return slot->context;
}

int device_of(void* queue) {
  if (queue == nullptr) return -1;
  try {
    const cl::Device wanted = cl::CommandQueue(static_cast<cl_command_queue>(queue), true).getInfo<CL_QUEUE_DEVICE>();
    const Found found = find_devices();
    for (std::size_t i = 0; i < found.devices.size(); ++i)
      if (found.devices[i].device() == wanted()) return static_cast<int>(i);
  } catch (const cl::Error&) {
    // not a queue
  }
  return -1;
}

void lose_context(const OpenRequest& request) { shared_context(request)->lost = true; }

}  // namespace cadt::opencl
