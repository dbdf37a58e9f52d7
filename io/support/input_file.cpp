// SPDX-License-Identifier: Apache-2.0
#include "io/support/input_file.hpp"

#include <cadt/io/errors.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace cadt::io::detail {
namespace {

/// Closes a descriptor that was opened here; standard input stays open.
class Descriptor {
 public:
  Descriptor(int value, bool owned) : value_(value), owned_(owned) {}
  ~Descriptor() {
    if (owned_) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const noexcept { return value_; }

 private:
  int value_;
  bool owned_;
};

std::string system_text(int code) { return std::generic_category().message(code); }

}  // namespace

InputFile::InputFile(const std::string& path) : name_(path == "-" ? "<stdin>" : path) {
  if (path == "-") {
    read_all(STDIN_FILENO);
    return;
  }
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw FileError(name_, 0, "cannot be opened: " + system_text(errno));
  const Descriptor guard(descriptor, true);
  read_all(guard.get());
}

void InputFile::grow(std::size_t capacity) {
  auto larger = std::make_unique_for_overwrite<char[]>(capacity);
  if (size_ != 0) std::memcpy(larger.get(), data_.get(), size_);
  data_ = std::move(larger);
  capacity_ = capacity;
}

void InputFile::read_all(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw FileError(name_, 0, "cannot be read: " + system_text(errno));
  if (S_ISDIR(status.st_mode)) throw FileError(name_, 0, "is a directory");
  // One byte more than the size lets the last read see the end of the file without growing.
  constexpr std::size_t pipe_start = std::size_t{1} << 16;
  grow(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : pipe_start);
  for (;;) {
    if (size_ == capacity_) grow(capacity_ * 2);
    constexpr std::size_t most_per_call = std::size_t{1} << 30;  // the kernel reads at most 2 GiB at a time
    const ssize_t got = ::read(descriptor, data_.get() + size_, std::min(capacity_ - size_, most_per_call));
    if (got < 0) {
      if (errno == EINTR) continue;
      throw FileError(name_, 0, "cannot be read: " + system_text(errno));
    }
    if (got == 0) return;
    size_ += static_cast<std::size_t>(got);
  }
}

std::string suffix_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || dot < start) return {};
  std::string suffix = path.substr(dot + 1);
  for (char& c : suffix) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return suffix;
}

std::string choose_format(const std::string& path, const std::string& asked, const std::vector<std::string>& known) {
  const std::string format = asked.empty() ? suffix_of(path) : asked;
  if (std::find(known.begin(), known.end(), format) != known.end()) return format;
  std::string message = format.empty() ? "the format must be given, because the name has no suffix"
                                       : "'" + format + "' is not a format that can be used here";
  message += "; known:";
  for (const std::string& name : known) message += " " + name;
  throw FileError(path, 0, message);
}

}  // namespace cadt::io::detail
