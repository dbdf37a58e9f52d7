// SPDX-License-Identifier: Apache-2.0
#include "io/support/atomic_file.hpp"

#include <cadt/io/errors.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace cadt::io::detail {
namespace {

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// The file that a symbolic link leads to: renaming onto the link would replace the link itself.
std::string resolved(const std::string& path) {
  struct Free {
    void operator()(char* p) const { std::free(p); }
  };
  const std::unique_ptr<char, Free> real(::realpath(path.c_str(), nullptr));
  return real ? std::string(real.get()) : path;
}

/// Some file systems and all pipes do not support syncing; no data are lost by that.
bool sync_refused_for_good(int code) { return code == EINVAL || code == ENOTSUP || code == EROFS || code == ENOSYS; }

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : name_(path == "-" ? "<stdout>" : path), buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {
  if (path == "-") {
    descriptor_ = STDOUT_FILENO;
    owned_ = false;
    return;
  }
  if (path.empty()) throw FileError(name_, 0, "an output file needs a name");
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) throw FileError(name_, 0, "is a directory");
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot be opened", errno);
    return;
  }
  target_ = exists ? resolved(path) : path;
  open_temporary();
  // A replaced file keeps its permissions; failing to copy them is not worth losing the data for.
  if (exists) static_cast<void>(::fchmod(descriptor_, status.st_mode & 07777));
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0 && owned_) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::open_temporary() {
  static std::atomic<unsigned> serial{0};
  const std::string stem = folder_of(target_) + "/.cadt-" + std::to_string(::getpid()) + "-";
  constexpr int most_tries = 1000;  // temporary files left by a killed process with the same number
  for (int i = 0; i < most_tries; ++i) {
    std::string candidate = stem + std::to_string(serial.fetch_add(1, std::memory_order_relaxed)) + ".tmp";
    // open() rather than mkstemp(): the umask of the process decides about the permissions.
    descriptor_ = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) {
      temporary_ = std::move(candidate);
      return;
    }
    if (errno != EEXIST && errno != EINTR) break;
  }
  fail("cannot be created", errno);
}

void AtomicFile::fail(const char* action, int code) const {
  throw FileError(name_, 0, std::string(action) + ": " + std::generic_category().message(code));
}

void AtomicFile::write_through(const char* bytes, std::size_t size) {
  while (size != 0) {
    constexpr std::size_t most_per_call = std::size_t{1} << 30;
    const ssize_t put = ::write(descriptor_, bytes, std::min(size, most_per_call));
    if (put < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written", errno);
    }
    bytes += put;
    size -= static_cast<std::size_t>(put);
  }
}

void AtomicFile::flush() {
  const std::size_t size = used_;
  used_ = 0;
  write_through(buffer_.get(), size);
}

void AtomicFile::write(const void* bytes, std::size_t size) {
  if (size > buffer_size - used_) {
    flush();
    if (size >= buffer_size) {
      write_through(static_cast<const char*>(bytes), size);
      return;
    }
  }
  if (size == 0) return;
  std::memcpy(buffer_.get() + used_, bytes, size);
  used_ += size;
}

void AtomicFile::commit() {
  flush();
  if (!owned_) return;
  if (::fsync(descriptor_) != 0 && !sync_refused_for_good(errno)) fail("cannot be synced", errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 && errno != EINTR) fail("cannot be closed", errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be renamed from its temporary file", errno);
  temporary_.clear();
  // The name itself is durable once its folder is; the data already are, so a refusal is not an error.
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }
}

}  // namespace cadt::io::detail
