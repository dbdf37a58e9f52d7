// SPDX-License-Identifier: Apache-2.0
// Exit codes, and the one place that turns exceptions into messages and exit codes.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace cadt::cli {

enum ExitCode : int {
  exit_done = 0,
  exit_internal = 1,
  exit_usage = 2,
  exit_file = 3,
  exit_degenerate = 4,
  exit_device = 5,
  exit_memory = 6,
  exit_verify = 7,
  exit_switch = 8,
  exit_interrupted = 130  // 128 + SIGINT, as shells have it
};

/// The exit codes as text, for the help: of all commands, and of those that make tiles.
inline constexpr std::string_view exit_codes_help =
    "Exit codes:\n"
    "    0  done\n"
    "    1  internal error: please report it\n"
    "    2  the command line is wrong\n"
    "    3  a file cannot be read, is malformed, or cannot be written; segments cross, or bound no domain\n"
    "    4  cadt triangulate --strict: no triangles, the points are fewer than three or on one line\n"
    "    5  the back end or device is not available\n"
    "    6  out of memory\n"
    "    7  the mesh failed the verification\n"
    "    8  cadt triangle: a switch of Triangle that cadt does not take\n"
    "  130  interrupted (SIGINT, SIGTERM or SIGHUP)\n";
inline constexpr std::string_view exit_codes_of_tiles =
    "Exit codes:\n"
    "    0  done\n"
    "    1  internal error: please report it\n"
    "    2  the command line is wrong\n"
    "    3  a file cannot be read, is malformed, or cannot be written\n"
    "    5  the back end or device is not available\n"
    "    6  out of memory\n"
    "  130  interrupted (SIGINT, SIGTERM or SIGHUP)\n";

/// An error detected by the program, not the library, with its exit code.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// Writes to standard error; never throws, so that a closed terminal does not hide the exit code.
void say(std::string_view text) noexcept;

/// To be called in a catch block: explains the exception on standard error and returns the exit code.
[[nodiscard]] int report_exception() noexcept;

/// Writes to standard output; a failure throws io::FileError.
void print(std::string_view text);
/// Flushes standard output. Without this a full disk would go unnoticed.
void finish_stdout();

}  // namespace cadt::cli
