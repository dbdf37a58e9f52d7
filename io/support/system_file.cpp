// SPDX-License-Identifier: Apache-2.0
#include "io/support/system_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>

#if defined(_WIN32)
#include <io.h>
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace cadt::io::detail::system_file {
namespace {

constexpr std::size_t most_per_call = std::size_t{1} << 30;  // systems take at most 2 GiB at a time

#if defined(_WIN32)
std::filesystem::path wide(const std::string& path) { return std::u8string(path.begin(), path.end()); }

int in_mode_of_bytes(int descriptor) noexcept {
  ::_setmode(descriptor, _O_BINARY);
  return descriptor;
}

Kind kind_of(int failed, const struct ::_stat64& status) noexcept {
  if (failed != 0) return {};
  const bool regular = (status.st_mode & _S_IFMT) == _S_IFREG;
  return {.exists = true,
          .regular = regular,
          .folder = (status.st_mode & _S_IFMT) == _S_IFDIR,
          .size = regular ? static_cast<std::size_t>(status.st_size) : 0};
}
#else
Kind kind_of(int failed, const struct ::stat& status) noexcept {
  if (failed != 0) return {};
  return {.exists = true,
          .regular = S_ISREG(status.st_mode),
          .folder = S_ISDIR(status.st_mode),
          .size = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0,
          .permissions = static_cast<unsigned>(status.st_mode & 07777)};
}

/// Some file systems and all pipes do not support syncing; no data are lost by that.
bool sync_refused_for_good(int code) { return code == EINVAL || code == ENOTSUP || code == EROFS || code == ENOSYS; }
#endif

}  // namespace

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.find_last_of(separators);
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

#if defined(_WIN32)

int standard_input() noexcept { return in_mode_of_bytes(0); }
int standard_output() noexcept { return in_mode_of_bytes(1); }

int open_to_read(const std::string& path) { return ::_wopen(wide(path).c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT); }
int open_to_write(const std::string& path) {
  return ::_wopen(wide(path).c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT);
}
int create(const std::string& path) {
  return ::_wopen(wide(path).c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}

std::ptrdiff_t read(int descriptor, char* bytes, std::size_t size) noexcept {
  return ::_read(descriptor, bytes, static_cast<unsigned>(std::min(size, most_per_call)));
}
std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t size, std::uint64_t at) noexcept {
  OVERLAPPED place{};
  place.Offset = static_cast<DWORD>(at);
  place.OffsetHigh = static_cast<DWORD>(at >> 32);
  DWORD got = 0;
  const auto file = reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
  if (::ReadFile(file, bytes, static_cast<DWORD>(std::min(size, most_per_call)), &got, &place) != 0) return got;
  if (::GetLastError() == ERROR_HANDLE_EOF) return 0;
  errno = EIO;
  return -1;
}
std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t size) noexcept {
  return ::_write(descriptor, bytes, static_cast<unsigned>(std::min(size, most_per_call)));
}
std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t size, std::uint64_t at) noexcept {
  OVERLAPPED place{};
  place.Offset = static_cast<DWORD>(at);
  place.OffsetHigh = static_cast<DWORD>(at >> 32);
  DWORD put = 0;
  const auto file = reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
  if (::WriteFile(file, bytes, static_cast<DWORD>(std::min(size, most_per_call)), &put, &place) != 0) return put;
  errno = ::GetLastError() == ERROR_DISK_FULL ? ENOSPC : EIO;
  return -1;
}
bool sync(int descriptor) noexcept { return ::_commit(descriptor) == 0 || errno == EBADF || errno == EINVAL; }
bool close(int descriptor) noexcept { return ::_close(descriptor) == 0; }

Kind kind_of(const std::string& path) {
  struct ::_stat64 status {};
  return kind_of(::_wstat64(wide(path).c_str(), &status), status);
}
Kind kind_of(int descriptor) noexcept {
  struct ::_stat64 status {};
  return kind_of(::_fstat64(descriptor, &status), status);
}
void set_permissions(int /*descriptor*/, unsigned /*permissions*/) noexcept {}

bool replace(const std::string& from, const std::string& to) {
  if (::MoveFileExW(wide(from).c_str(), wide(to).c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0)
    return true;
  errno = ::GetLastError() == ERROR_ACCESS_DENIED || ::GetLastError() == ERROR_SHARING_VIOLATION ? EACCES : EIO;
  return false;
}
void remove(const std::string& path) noexcept { ::_wunlink(wide(path).c_str()); }

std::string resolved(const std::string& path) {
  std::error_code code;
  const std::u8string real = std::filesystem::canonical(wide(path), code).u8string();
  return code ? path : std::string(real.begin(), real.end());
}
bool is_readable(const std::string& path) { return ::_waccess(wide(path).c_str(), 4) == 0; }
long process_number() noexcept { return static_cast<long>(::GetCurrentProcessId()); }

#else

int standard_input() noexcept { return STDIN_FILENO; }
int standard_output() noexcept { return STDOUT_FILENO; }

int open_to_read(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }
int open_to_write(const std::string& path) { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }
// open() rather than mkstemp(): the umask of the process decides about the permissions.
int create(const std::string& path) { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }

std::ptrdiff_t read(int descriptor, char* bytes, std::size_t size) noexcept {
  ssize_t got = 0;
  do got = ::read(descriptor, bytes, std::min(size, most_per_call));
  while (got < 0 && errno == EINTR);
  return got;
}
std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t size, std::uint64_t at) noexcept {
  ssize_t got = 0;
  do got = ::pread(descriptor, bytes, std::min(size, most_per_call), static_cast<off_t>(at));
  while (got < 0 && errno == EINTR);
  return got;
}
std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t size) noexcept {
  ssize_t put = 0;
  do put = ::write(descriptor, bytes, std::min(size, most_per_call));
  while (put < 0 && errno == EINTR);
  return put;
}
std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t size, std::uint64_t at) noexcept {
  ssize_t put = 0;
  do put = ::pwrite(descriptor, bytes, std::min(size, most_per_call), static_cast<off_t>(at));
  while (put < 0 && errno == EINTR);
  return put;
}
bool sync(int descriptor) noexcept { return ::fsync(descriptor) == 0 || sync_refused_for_good(errno); }
bool close(int descriptor) noexcept { return ::close(descriptor) == 0 || errno == EINTR; }

Kind kind_of(const std::string& path) {
  struct ::stat status {};
  return kind_of(::stat(path.c_str(), &status), status);
}
Kind kind_of(int descriptor) noexcept {
  struct ::stat status {};
  return kind_of(::fstat(descriptor, &status), status);
}
void set_permissions(int descriptor, unsigned permissions) noexcept {
  static_cast<void>(::fchmod(descriptor, static_cast<mode_t>(permissions)));
}

bool replace(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return false;
  // The name itself is durable once its folder is; the data already are, so a refusal is not an error.
  const int folder = ::open(folder_of(to).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }
  return true;
}
void remove(const std::string& path) noexcept { ::unlink(path.c_str()); }

std::string resolved(const std::string& path) {
  struct Free {
    void operator()(char* p) const { std::free(p); }
  };
  const std::unique_ptr<char, Free> real(::realpath(path.c_str(), nullptr));
  return real ? std::string(real.get()) : path;
}
bool is_readable(const std::string& path) { return ::access(path.c_str(), R_OK) == 0; }
long process_number() noexcept { return ::getpid(); }

#endif

}  // namespace cadt::io::detail::system_file
