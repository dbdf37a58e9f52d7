// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/backends/opencl/support.hpp"

#include "tests/support/device_choice.hpp"

#include <array>
#include <cstdlib>
#include <random>
#include <string_view>

namespace cadt::test {

namespace fs = std::filesystem;

ScopedVariable::ScopedVariable(std::string name, const char* value) : name_(std::move(name)) {
  if (const char* old = std::getenv(name_.c_str())) {
    old_ = old;
    had_ = true;
  }
  if (value != nullptr)
    setenv(name_.c_str(), value, 1);
  else
    unsetenv(name_.c_str());
}
ScopedVariable::~ScopedVariable() {
  if (had_)
    setenv(name_.c_str(), old_.c_str(), 1);
  else
    unsetenv(name_.c_str());
}

ScratchDirectory::ScratchDirectory() {
  std::random_device random;
  path_ = fs::temp_directory_path() / ("cadt-test-" + std::to_string(random()) + std::to_string(random()));
  fs::create_directories(path_);
}
ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}
std::vector<fs::path> ScratchDirectory::files() const {
  std::vector<fs::path> result;
  for (const auto& entry : fs::directory_iterator(path_)) result.push_back(entry.path());
  return result;
}

void OpenClTest::SetUp() {
  std::string reason;
  for (const DeviceInfo& device : opencl_backend().devices()) {
    if (device.usable && index < 0 && is_chosen(device)) {
      index = device.index;
      info = device;
    }
    reason += device.name + " " + device.reason + "; ";
  }
  if (index >= 0) return;
  const char* needed = std::getenv("CADT_REQUIRE_BACKENDS");
  if (needed != nullptr && std::string_view(needed).find("opencl") != std::string_view::npos)
    FAIL() << "CADT_REQUIRE_BACKENDS names opencl, but: " << reason;
  GTEST_SKIP() << "no usable OpenCL device"
               << (chosen_device(Backend::opencl).empty()
                       ? ""
                       : " matches CADT_TEST_OPENCL_DEVICE=" + chosen_device(Backend::opencl))
               << ": " << reason;
}

opencl::OpenRequest OpenClTest::small() const {
  opencl::OpenRequest request;
  request.index = index;
  request.source = opencl::selftest_source();
  request.fresh = true;
  return request;
}

std::uint32_t counted_items(Device& device, std::uint32_t items) {
  const std::vector<double> ones(16, 1.0);
  std::array<std::uint32_t, 5> words{};
  const auto in = device.allocate(ones.size() * sizeof(double)), out = device.allocate(8 * sizeof(double)),
             counters = device.allocate(sizeof words);
  device.write(*in, 0, ones.data(), in->bytes());
  device.fill(*counters, 0, sizeof words, 0);
  const std::array<Arg, 4> arguments = {Arg(in), Arg(out), Arg(counters), Arg(items)};
  device.launch(KernelId::cadt_selftest, items, arguments, KernelVariant::narrow);
  device.finish();
  device.read(*counters, 0, words.data(), sizeof words);
  return words[2];
}

}  // namespace cadt::test
