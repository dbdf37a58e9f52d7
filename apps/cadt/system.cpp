// SPDX-License-Identifier: Apache-2.0
#include "system.hpp"

#if defined(_WIN32)
#include <io.h>
#include <windows.h>
#else
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>
#include "tiles/system_memory.hpp"
#endif

namespace cadt::cli {
namespace {
constexpr std::size_t usual_width = 80;
}

#if defined(_WIN32)

bool errors_go_to_terminal() noexcept { return ::_isatty(2) != 0; }

std::size_t terminal_width() noexcept {
  CONSOLE_SCREEN_BUFFER_INFO info{};
  if (::GetConsoleScreenBufferInfo(::GetStdHandle(STD_ERROR_HANDLE), &info) == 0) return usual_width;
  const int columns = info.srWindow.Right - info.srWindow.Left + 1;
  return columns > 1 ? static_cast<std::size_t>(columns) : usual_width;
}

std::optional<std::uint64_t> free_memory() noexcept {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  if (::GlobalMemoryStatusEx(&status) == 0) return std::nullopt;
  return status.ullAvailPhys;
}

bool may_write(const std::string& path) noexcept { return ::_access(path.c_str(), 2) == 0; }
long process_number() noexcept { return static_cast<long>(::GetCurrentProcessId()); }

#else

bool errors_go_to_terminal() noexcept { return ::isatty(STDERR_FILENO) != 0; }

std::size_t terminal_width() noexcept {
  struct winsize size {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : usual_width;
}

std::optional<std::uint64_t> free_memory() noexcept { return tiles::memory_of_system(); }

bool may_write(const std::string& path) noexcept {
  struct stat status {};
  const bool folder = ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
  return ::access(path.c_str(), folder ? W_OK | X_OK : W_OK) == 0;
}
long process_number() noexcept { return ::getpid(); }

#endif

}  // namespace cadt::cli
