// SPDX-License-Identifier: Apache-2.0
// Nothing here allocates: it is asked when there is no memory left.
#pragma once

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string_view>
#include <system_error>

namespace cadt::tiles {

/// The beginning of a text file.
template <std::size_t Size>
struct SystemFile {
  std::array<char, Size> buffer{};
  std::string_view text;  ///< empty if there is no such file

  explicit SystemFile(const char* path) noexcept {
    const int file = ::open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    std::size_t size = 0;
    for (;;) {
      const ::ssize_t more = size == Size ? 0 : ::read(file, buffer.data() + size, Size - size);
      if (more <= 0) break;
      size += static_cast<std::size_t>(more);
    }
    ::close(file);
    text = std::string_view(buffer.data(), size);
  }
  SystemFile(const SystemFile&) = delete;
  SystemFile& operator=(const SystemFile&) = delete;

  /// The number behind a key at the beginning of a line and blanks; of an empty key: that at the beginning.
  [[nodiscard]] std::optional<std::uint64_t> number(std::string_view key = {}) const noexcept {
    std::size_t at = 0;
    while (at < text.size() && text.substr(at, key.size()) != key) {
      const std::size_t end = text.find('\n', at);
      at = end == text.npos ? text.size() : end + 1;
    }
    at = text.find_first_not_of(' ', std::min(at + key.size(), text.size()));
    std::uint64_t value = 0;
    if (at == text.npos || std::from_chars(text.data() + at, text.data() + text.size(), value).ec != std::errc())
      return std::nullopt;
    return value;
  }
};

/// Names of the files of a memory controller of control groups, version 1 or 2. A group above its `high` is throttled.
struct GroupFiles {
  const char *folder, *limit, *high, *used, *inactive_files, *active_files;
};
inline constexpr GroupFiles group_files_1 = {
    "/memory", "memory.limit_in_bytes", "", "memory.usage_in_bytes", "total_inactive_file ", "total_active_file "};
inline constexpr GroupFiles group_files_2 = {
    "", "memory.max", "memory.high", "memory.current", "inactive_file ", "active_file "};

/// Bytes that the limit of a group and of those above it leave; what is cached of files counts as free. Nothing if
/// there is no limit, else at least 1. `group`: its path, as in /proc/self/cgroup. A container sees its own group as
/// the uppermost one, so groups that are not there are passed over.
inline std::optional<std::uint64_t> memory_of_group(const char* root, std::string_view group,
                                                    const GroupFiles& names) noexcept {
  std::optional<std::uint64_t> least;
  std::array<char, 4096> path{};
  const auto file = [&](const char* name) noexcept {
    const int size = std::snprintf(path.data(), path.size(), "%s%s%.*s/%s", root, names.folder,
                                   static_cast<int>(group.size()), group.data(), name);
    return size > 0 && static_cast<std::size_t>(size) < path.size() ? path.data() : "";
  };
  for (;;) {
    while (!group.empty() && group.back() == '/') group.remove_suffix(1);
    constexpr std::uint64_t none = ~std::uint64_t{0};
    const std::uint64_t limit = std::min(SystemFile<64>(file(names.limit)).number().value_or(none),
                                         SystemFile<64>(file(names.high)).number().value_or(none));
    const auto used = SystemFile<64>(file(names.used)).number();
    if (limit != none && used) {
      const SystemFile<4096> statistics(file("memory.stat"));
      const std::uint64_t cached =
          statistics.number(names.inactive_files).value_or(0) + statistics.number(names.active_files).value_or(0);
      const std::uint64_t held = *used - std::min(*used, cached), left = limit > held ? limit - held : 1;
      least = std::min(least.value_or(left), left);
    }
    if (group.empty()) return least;
    group = group.substr(0, group.rfind('/') == group.npos ? 0 : group.rfind('/'));
  }
}

/// Bytes that the control groups of this process leave (Slurm, containers, systemd); nothing if they have no limit.
inline std::optional<std::uint64_t> memory_of_groups(const char* of_process, const char* root) noexcept {
  std::optional<std::uint64_t> least;
  const SystemFile<16384> groups(of_process);
  for (std::string_view rest = groups.text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);  // number:controllers:path
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t first = line.find(':'), second = first == line.npos ? first : line.find(':', first + 1);
    if (second == line.npos) continue;
    const std::string_view controllers = line.substr(first, second - first);  // ":" in version 2, ":cpu,memory" in 1
    const bool version_2 = controllers.size() == 1;
    const std::size_t at = controllers.find("memory"), behind = at == line.npos ? at : at + 6;
    const bool has_memory = at != line.npos && (controllers[at - 1] == ':' || controllers[at - 1] == ',') &&
                            (behind == controllers.size() || controllers[behind] == ',');
    if (!version_2 && !has_memory) continue;
    const auto left = memory_of_group(root, line.substr(second + 1), version_2 ? group_files_2 : group_files_1);
    if (left) least = std::min(least.value_or(*left), *left);
  }
  return least;
}

/// Bytes that the system can give to this process, its cache of files included. The paths are for tests.
[[nodiscard]] inline std::optional<std::uint64_t> memory_of_system(const char* groups_of_process = "/proc/self/cgroup",
                                                                   const char* groups = "/sys/fs/cgroup") noexcept {
  const auto kib = SystemFile<1024>("/proc/meminfo").number("MemAvailable:");  // among the first lines
  const std::optional<std::uint64_t> of_groups = memory_of_groups(groups_of_process, groups);
  if (!kib) return of_groups;
  return std::min(*kib << 10, of_groups.value_or(~std::uint64_t{0}));
}

}  // namespace cadt::tiles
