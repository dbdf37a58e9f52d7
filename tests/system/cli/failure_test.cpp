// SPDX-License-Identifier: Apache-2.0
// What the program makes of each type of error: its exit code, and what its user is told.
#include "apps/cadt/failure.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/triangle.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <system_error>
#include <vector>

namespace cadt::cli {
namespace {

struct Row {
  const char* name;
  std::function<void()> fail;
  int code;
  std::vector<std::string> says;
};
std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

template <class Error, class... Arguments>
std::function<void()> throwing(Arguments... arguments) {
  return [=] { throw Error(arguments...); };
}
std::function<void()> of_system(std::errc code) {
  return [=] { throw std::system_error(std::make_error_code(code), "thread"); };
}

constexpr const char* defect = "This is a defect of cadt: please report it";

std::vector<Row> rows() {
  return {
      {"Failure_usage", throwing<Failure>(exit_usage, "text"), 2, {"cadt: error: text\n"}},
      {"Failure_file", throwing<Failure>(exit_file, "text"), 3, {"cadt: error: text\n"}},
      {"Failure_degenerate", throwing<Failure>(exit_degenerate, "text"), 4, {"cadt: error: text\n"}},
      {"Failure_verify", throwing<Failure>(exit_verify, "text"), 7, {"cadt: error: text\n"}},
      {"SwitchError", throwing<SwitchError>("text", "p"), 8, {"cadt: error: text\n", "cadt triangle --help"}},
      {"FileError", throwing<io::FileError>("a.xy", 7u, "text"), 3, {"cadt: error: a.xy:7: text\n"}},
      {"InputError", throwing<InputError>("text", 41u), 3, {"cadt: error: point 41 (counted from 0): text\n"}},
      {"OptionError", throwing<OptionError>("threads", "text"), 2, {"cadt: error: Options::threads: text\n"}},
      {"LimitError", throwing<LimitError>("text", 900u, 800u), 3, {"text (900 points, at most 800)\n", "into tiles"}},
      {"BackendUnavailable", throwing<BackendUnavailable>("cuda", "text"), 5, {"'cuda'", "text", "cadt devices"}},
      {"KernelBuildError",
       throwing<KernelBuildError>("card", "-O", "text"),
       5,
       {"'card'", "text", "Update the driver"}},
      {"DeviceError",
       throwing<DeviceError>("call", -5, "card", "text"),
       5,
       {"call failed on 'card': text (-5)", "again"}},
      {"OutOfMemory",
       throwing<OutOfMemory>("text", 4096u, 100u),
       6,
       {"out of memory: text (needed: 4096 bytes = 4.0 KiB, free: 100 bytes)", "--max-memory"}},
      {"OutOfMemory_unknown", throwing<OutOfMemory>("text", 10u, 0u), 6, {"(needed: 10 bytes, free: unknown)"}},
      {"Cancelled", throwing<Cancelled>(), 130, {"cadt: interrupted\n"}},
      {"InternalError", throwing<InternalError>("text"), 1, {"cadt: error: internal: text\n", defect}},
      {"bad_alloc", throwing<std::bad_alloc>(), 6, {"cadt: error: out of memory", "ulimit -v"}},
      {"bad_array_new_length", throwing<std::bad_array_new_length>(), 6, {"cadt: error: out of memory"}},
      {"length_error", throwing<std::length_error>("text"), 6, {"cadt: error: out of memory"}},
      {"system_error_no_thread",
       of_system(std::errc::resource_unavailable_try_again),
       6,
       {"cadt: error: the system starts no more threads\n", "ulimit -u"}},
      {"system_error_no_memory", of_system(std::errc::not_enough_memory), 6, {"out of memory"}},
      {"system_error_other", of_system(std::errc::io_error), 1, {"cadt: error: thread", defect}},
      {"runtime_error", throwing<std::runtime_error>("text"), 1, {"cadt: error: internal: text\n", defect}},
      {"no_exception_type", [] { throw 17; }, 1, {"cadt: error: internal: unknown exception\n", defect}},
  };
}

class ReportException : public testing::TestWithParam<Row> {};

TEST_P(ReportException, CodeAndText) {
  int code = -1;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    GetParam().fail();
  } catch (...) {
    code = report_exception();
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "an error belongs on standard error";
  EXPECT_EQ(code, GetParam().code) << text;
  for (const std::string& part : GetParam().says)
    EXPECT_NE(text.find(part), std::string::npos) << text << "lacks: " << part;
  EXPECT_EQ(text.substr(0, 6), "cadt: ");
  EXPECT_EQ(text.empty() ? '\0' : text.back(), '\n');
}

INSTANTIATE_TEST_SUITE_P(Types, ReportException, testing::ValuesIn(rows()),
                         [](const auto& test) { return std::string(test.param.name); });

// Scripts compare with these numbers, and the help names each of them.
TEST(ExitCodes, AreThoseOfTheHelp) {
  const std::string help(exit_codes_help);
  const std::vector<std::pair<int, std::string>> lines = {{exit_done, "\n    0  done"},
                                                          {exit_internal, "\n    1  internal"},
                                                          {exit_usage, "\n    2  the command line"},
                                                          {exit_file, "\n    3  a file cannot"},
                                                          {exit_degenerate, "\n    4  cadt triangulate --strict"},
                                                          {exit_device, "\n    5  the back end"},
                                                          {exit_memory, "\n    6  out of memory"},
                                                          {exit_verify, "\n    7  the mesh failed"},
                                                          {exit_interrupted, "\n  130  interrupted"}};
  for (const auto& [code, line] : lines) {
    EXPECT_NE(help.find(line), std::string::npos) << line;
    EXPECT_EQ(std::stoi(line), code);
  }
}

}  // namespace
}  // namespace cadt::cli
