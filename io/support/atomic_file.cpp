// SPDX-License-Identifier: Apache-2.0
#include "io/support/atomic_file.hpp"

#include <cadt/io/errors.hpp>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/support/system_file.hpp"

namespace cadt::io::detail {

AtomicFile::AtomicFile(const std::string& path)
    : name_(path == "-" ? "<stdout>" : path), buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {
  if (path == "-") {
    descriptor_ = system_file::standard_output();
    owned_ = false;
    return;
  }
  if (path.empty()) throw FileError(name_, 0, "an output file needs a name");
  const system_file::Kind kind = system_file::kind_of(path);
  if (kind.folder) throw FileError(name_, 0, "is a directory");
  if (kind.exists && !kind.regular) {
    descriptor_ = system_file::open_to_write(path);
    if (descriptor_ < 0) fail("cannot be opened", errno);
    return;
  }
  // Renaming onto a symbolic link would replace the link itself.
  target_ = kind.exists ? system_file::resolved(path) : path;
  open_temporary();
  // A replaced file keeps its permissions; failing to copy them is not worth losing the data for.
  if (kind.exists) system_file::set_permissions(descriptor_, kind.permissions);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0 && owned_) system_file::close(descriptor_);
  if (!temporary_.empty()) system_file::remove(temporary_);
}

void AtomicFile::open_temporary() {
  static std::atomic<unsigned> serial{0};
  const std::string stem =
      system_file::folder_of(target_) + "/.cadt-" + std::to_string(system_file::process_number()) + "-";
  constexpr int most_tries = 1000;  // temporary files left by a killed process with the same number
  for (int i = 0; i < most_tries; ++i) {
    std::string candidate = stem + std::to_string(serial.fetch_add(1, std::memory_order_relaxed)) + ".tmp";
    descriptor_ = system_file::create(candidate);
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
    const std::ptrdiff_t put = system_file::write(descriptor_, bytes, size);
    if (put < 0) fail("cannot be written", errno);
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
  if (!system_file::sync(descriptor_)) fail("cannot be synced", errno);
  const bool closed = system_file::close(descriptor_);
  descriptor_ = -1;
  if (!closed) fail("cannot be closed", errno);
  if (temporary_.empty()) return;
  if (!system_file::replace(temporary_, target_)) fail("cannot be renamed from its temporary file", errno);
  temporary_.clear();
}

}  // namespace cadt::io::detail
