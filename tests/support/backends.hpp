// SPDX-License-Identifier: Apache-2.0
// The configurations that every test of a mesh runs on, and what happens when one of them is not there.
#pragma once

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace cadt::test {

struct BackendCase {
  std::string name;  ///< part of the test's name
  Backend backend = Backend::host;
  unsigned threads = 0;
  unsigned work_group_size = 0;
  [[nodiscard]] Options options() const;
};
std::ostream& operator<<(std::ostream& out, const BackendCase& c);

/// host: serial (the reference), 2, 3 and 8 threads. opencl and cuda: several work-group (block) sizes. cuda has none
/// if the back end is not compiled in.
[[nodiscard]] std::vector<BackendCase> host_cases();
[[nodiscard]] std::vector<BackendCase> opencl_cases();
[[nodiscard]] std::vector<BackendCase> cuda_cases();
[[nodiscard]] std::vector<BackendCase> cases_of(Backend backend);
/// The one a user would run; for costly tests.
[[nodiscard]] std::vector<BackendCase> main_host_case();
[[nodiscard]] std::vector<BackendCase> main_opencl_case();
[[nodiscard]] std::vector<BackendCase> main_cuda_case();

/// Why the back end, or the device that CADT_TEST_OPENCL_DEVICE names, cannot be used here; empty if it can.
[[nodiscard]] std::string unavailable(Backend backend);

/// Is the back end named in CADT_REQUIRE_BACKENDS (a list such as "host,opencl")?
[[nodiscard]] bool required(Backend backend);

/// Base of the tests that run once per configuration. A back end that is not there skips the test with the reason, or
/// fails it if the back end is required. CADT_TEST_SECONDS: a test that takes longer ends the process (SIGALRM), so
/// that one that hangs among many in a process does not take the time of all.
class BackendTest : public testing::TestWithParam<BackendCase> {
 protected:
  void SetUp() override;
  void TearDown() override;
};

[[nodiscard]] std::string case_name(const testing::TestParamInfo<BackendCase>& info);

}  // namespace cadt::test

#define CADT_ON(backend, Suite, cases) \
  INSTANTIATE_TEST_SUITE_P(backend, Suite, testing::ValuesIn(cadt::test::cases()), cadt::test::case_name)

/// All configurations of all back ends; the prefix of the name becomes the label in ctest.
#define CADT_ON_EVERY_BACKEND(Suite)    \
  CADT_ON(host, Suite, host_cases);     \
  CADT_ON(opencl, Suite, opencl_cases); \
  CADT_ON(cuda, Suite, cuda_cases)

/// One configuration of each back end.
#define CADT_ON_MAIN_BACKENDS(Suite)        \
  CADT_ON(host, Suite, main_host_case);     \
  CADT_ON(opencl, Suite, main_opencl_case); \
  CADT_ON(cuda, Suite, main_cuda_case)
