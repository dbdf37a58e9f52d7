// SPDX-License-Identifier: Apache-2.0
#include "tiles/machine.hpp"

#include <cadt/io/errors.hpp>

#include "tiles/system_memory.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace cadt::tiles {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t unknown = ~std::uint64_t{0};

std::uint64_t available_in_address_space() noexcept {
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
  std::ifstream status("/proc/self/statm");
  std::uint64_t pages = 0;
  status >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

/// The path, or the nearest folder above it that exists.
fs::path existing(const std::string& path) {
  std::error_code code;
  fs::path at = fs::absolute(path, code);
  while (!fs::exists(at, code) && at.has_relative_path()) at = at.parent_path();
  return at;
}

}  // namespace

std::uint64_t available_memory() noexcept {
  try {
    return std::min(memory_of_system().value_or(unknown), available_in_address_space());
  } catch (...) {
    return unknown;
  }
}

std::uint64_t available_disk(const std::string& path) {
  std::error_code code;
  const fs::space_info space = fs::space(existing(path), code);
  if (code) throw io::FileError(path, 0, "its file system cannot be asked for free space: " + code.message());
  return space.available;
}

void require_disk(const std::string& path, std::uint64_t bytes) {
  const std::uint64_t free = available_disk(path);
  if (bytes <= free) return;
  throw io::FileError(
      path, 0,
      "the disk is too small: about " + human_bytes(bytes) + " are needed, and " + human_bytes(free) + " are free");
}

std::uint64_t bytes_in_folder(const std::string& path) noexcept {
  try {
    std::error_code code;
    std::uint64_t bytes = 0;
    for (fs::recursive_directory_iterator at(path, code), end; !code && at != end; at.increment(code))
      if (at->is_regular_file(code)) bytes += at->file_size(code);
    return bytes;
  } catch (...) {
    return 0;
  }
}

bool same_disk(const std::string& a, const std::string& b) noexcept {
  try {
    struct stat first {
    }, second{};
    return ::stat(existing(a).c_str(), &first) == 0 && ::stat(existing(b).c_str(), &second) == 0 &&
           first.st_dev == second.st_dev;
  } catch (...) {
    return false;
  }
}

}  // namespace cadt::tiles
