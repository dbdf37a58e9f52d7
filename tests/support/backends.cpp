// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"

#include "tests/support/device_choice.hpp"

#if !defined(_WIN32)
#include <unistd.h>
#endif

#include <cstdlib>
#include <ostream>
#include <string_view>

namespace cadt::test {

Options BackendCase::options() const {
  Options options;
  options.backend = backend;
  options.device = chosen_device(backend);
  options.threads = threads;
  options.tuning.work_group_size = work_group_size;
  // Cards would do small sets without a lock: as users have it where the size of a group is theirs, else by insertion.
  if (work_group_size != 0) options.tuning.strategy = Strategy::locks;
  // So would the host, with one thread: as users have it with one thread and with eight, else by all threads.
  if (backend == Backend::host && (threads == 2 || threads == 3)) options.tuning.strategy = Strategy::locks;
  return options;
}

std::ostream& operator<<(std::ostream& out, const BackendCase& c) {
  return out << to_string(c.backend) << '/' << c.name;
}

std::vector<BackendCase> host_cases() {
  return {{"serial", Backend::host, 1, 0},
          {"threads2", Backend::host, 2, 0},
          {"threads3", Backend::host, 3, 0},
          {"threads8", Backend::host, 8, 0}};
}

std::vector<BackendCase> opencl_cases() {
  return {
      {"chosen", Backend::opencl, 0, 0}, {"groups16", Backend::opencl, 0, 16}, {"groups128", Backend::opencl, 0, 128}};
}

std::vector<BackendCase> cuda_cases() {
  if (!CADT_TEST_CUDA) return {};
  std::vector<BackendCase> cases = {{"chosen", Backend::cuda, 0, 0}};
  for (const unsigned block : {32u, 64u, 128u, 256u})
    cases.push_back({"blocks" + std::to_string(block), Backend::cuda, 0, block});
  return cases;
}

std::vector<BackendCase> cases_of(Backend backend) {
  switch (backend) {
    case Backend::host:
      return host_cases();
    case Backend::opencl:
      return opencl_cases();
    case Backend::cuda:
      return cuda_cases();
    case Backend::automatic:
      break;
  }
  return {};
}

std::vector<BackendCase> main_host_case() { return {{"threads2", Backend::host, 2, 0}}; }
std::vector<BackendCase> main_opencl_case() { return {{"chosen", Backend::opencl, 0, 0}}; }
std::vector<BackendCase> main_cuda_case() {
  return CADT_TEST_CUDA ? std::vector<BackendCase>{{"chosen", Backend::cuda, 0, 0}} : std::vector<BackendCase>{};
}

std::string unavailable(Backend backend) {
  std::string reason = "no device matches '" + chosen_device(backend) + "'; 'cadt devices' lists what is there";
  for (const DeviceInfo& device : list_devices()) {
    if (device.backend != backend) continue;
    if (device.index < 0) return device.reason;
    if (!is_chosen(device)) continue;
    if (device.usable) return {};
    reason = device.name + ": " + device.reason;
  }
  return reason;
}

bool required(Backend backend) {
  const char* variable = std::getenv("CADT_REQUIRE_BACKENDS");
  std::string_view list = variable ? variable : "";
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    if (list.substr(0, comma) == to_string(backend)) return true;
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
  }
  return false;
}

/// Ends the process then; 0: not any more. On Windows ctest's own limit is all there is.
static void end_after([[maybe_unused]] int seconds) {
#if !defined(_WIN32)
  alarm(static_cast<unsigned>(seconds));
#endif
}

void BackendTest::SetUp() {
  if (const char* seconds = std::getenv("CADT_TEST_SECONDS")) end_after(std::atoi(seconds));
  const std::string reason = unavailable(GetParam().backend);
  if (reason.empty()) return;
  const std::string text = "back end '" + std::string(to_string(GetParam().backend)) + "' is not available: " + reason;
  if (required(GetParam().backend)) FAIL() << text << " (required by CADT_REQUIRE_BACKENDS)";
  GTEST_SKIP() << text;
}

void BackendTest::TearDown() {
  if (std::getenv("CADT_TEST_SECONDS") != nullptr) end_after(0);
}

std::string case_name(const testing::TestParamInfo<BackendCase>& info) { return info.param.name; }

}  // namespace cadt::test
