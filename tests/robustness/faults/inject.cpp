// SPDX-License-Identifier: Apache-2.0
// The linker gives the library this function instead of its own open_device (--wrap, CMakeLists.txt), which has the
// other name here.
#include "common/driver/registry.hpp"
#include "tests/robustness/faults/faulty_device.hpp"

#include <utility>

namespace cadt::test {
namespace {

std::shared_ptr<Faults>& installed() {
  static std::shared_ptr<Faults> faults;
  return faults;
}

}  // namespace

std::unique_ptr<Device> real_open_device(const Options& options) asm("__real__ZN4cadt11open_deviceERKNS_7OptionsE");
std::unique_ptr<Device> wrapped_open_device(const Options& options) asm("__wrap__ZN4cadt11open_deviceERKNS_7OptionsE");

std::unique_ptr<Device> wrapped_open_device(const Options& options) {
  std::unique_ptr<Device> device = real_open_device(options);
  if (installed() == nullptr) return device;
  return faulty_device(std::move(device), installed());
}

Injection::Injection(std::shared_ptr<Faults> faults) { installed() = std::move(faults); }
Injection::~Injection() { installed().reset(); }

}  // namespace cadt::test
