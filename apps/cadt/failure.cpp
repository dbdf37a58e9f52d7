// SPDX-License-Identifier: Apache-2.0
#include "failure.hpp"

#include "system.hpp"
#include "text.hpp"

#include <cadt/constrained.hpp>
#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/triangle.hpp>

#include "viewer/gl/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

namespace cadt::cli {
namespace {

int error(ExitCode code, std::string_view message, std::string_view advice = {}) {
  say(fmt::format("cadt: error: {}\n", message));
  if (!advice.empty()) say(fmt::format("  {}\n", advice));
  return code;
}

// No allocation here: there may be nothing left to allocate.
int out_of_host_memory() noexcept {
  char line[256];
  if (const auto free = free_memory()) {
    const double free_gib = static_cast<double>(*free) / (1024.0 * 1024.0 * 1024.0);
    std::snprintf(line, sizeof line,
                  "cadt: error: out of memory: bytes needed: more than the system gave this process, free: %.2f GiB\n",
                  free_gib);
  } else {
    std::snprintf(line, sizeof line, "cadt: error: out of memory\n");
  }
  say(line);
  say("  Use fewer points, close other programs, or look at the limit of this shell (ulimit -v).\n");
  return exit_memory;
}

int out_of_memory(const OutOfMemory& e) {
  const auto amount = [](std::size_t bytes) {
    return bytes < 1024 ? human_bytes(bytes) : fmt::format("{} bytes = {}", bytes, human_bytes(bytes));
  };
  return error(exit_memory,
               fmt::format("out of memory: {} (needed: {}, free: {})", e.what(), amount(e.needed()),
                           e.available() == 0 ? "unknown" : amount(e.available())),
               "Use fewer points, raise --max-memory, or choose another device (see: cadt devices).");
}

int report_known_exception() {
  try {
    throw;
  } catch (const Failure& e) {
    return error(e.code(), e.what());
  } catch (const io::FileError& e) {
    return error(exit_file, e.what());
  } catch (const InputError& e) {
    return error(exit_file, fmt::format("point {} (counted from 0): {}", e.index(), e.what()));
  } catch (const CrossingError& e) {
    return error(exit_file, e.what(), "--crossing exact makes a vertex of each crossing.");
  } catch (const DomainError& e) {
    return error(exit_file, fmt::format("point {} (counted from 0): {}", e.vertex(), e.what()),
                 "--domain layers and --domain outer take segments with loose ends.");
  } catch (const SwitchError& e) {
    return error(exit_switch, e.what(), "cadt triangle --help lists the switches that it takes.");
  } catch (const OptionError& e) {
    return error(exit_usage, e.what());
  } catch (const LimitError& e) {
    return error(exit_file, fmt::format("{} ({} points, at most {})", e.what(), e.count(), e.limit()),
                 "Split the input into tiles.");
  } catch (const BackendUnavailable& e) {
    return error(exit_device, e.what(), "See what there is with: cadt devices. `--backend auto` takes the best one.");
  } catch (const viewer::DisplayError& e) {
    return error(exit_device, e.what());
  } catch (const KernelBuildError& e) {
    return error(exit_device, e.what(), "Update the driver of this device, or use --backend host.");
  } catch (const DeviceError& e) {
    return error(exit_device, e.what(),
                 "Run it again, choose another device (see: cadt devices), or use --backend host.");
  } catch (const OutOfMemory& e) {
    return out_of_memory(e);
  } catch (const Cancelled&) {
    say("cadt: interrupted\n");
    return exit_interrupted;
  } catch (const std::bad_alloc&) {
    return out_of_host_memory();
  } catch (const std::length_error&) {  // a container that no memory could hold
    return out_of_host_memory();
  } catch (const std::system_error& e) {
    if (e.code() == std::errc::not_enough_memory) return out_of_host_memory();
    if (e.code() == std::errc::resource_unavailable_try_again) {
      return error(exit_memory, "the system starts no more threads",
                   "End other threads or processes, raise the limit on them (ulimit -u), or use fewer: --threads.");
    }
    return error(exit_internal, e.what(),
                 "This is a defect of cadt: please report it with the command line and the input.");
  } catch (const std::exception& e) {
    return error(exit_internal, fmt::format("internal: {}", e.what()),
                 "This is a defect of cadt: please report it with the command line and the input.");
  }
}

}  // namespace

void say(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

int report_exception() noexcept {
  try {
    return report_known_exception();
  } catch (const std::bad_alloc&) {  // the message itself did not fit
    return out_of_host_memory();
  } catch (...) {
    say("cadt: error: internal: unknown exception\n  This is a defect of cadt: please report it.\n");
    return exit_internal;
  }
}

void print(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
    throw io::FileError("standard output", 0, std::string("cannot be written: ") + std::strerror(errno));
  }
}

void finish_stdout() {
  errno = 0;
  std::cout.flush();
  if (!std::cout.good() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    const int why = errno == 0 ? EIO : errno;
    throw io::FileError("standard output", 0, std::string("cannot be written: ") + std::strerror(why));
  }
}

}  // namespace cadt::cli
