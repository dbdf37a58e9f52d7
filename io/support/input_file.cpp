// SPDX-License-Identifier: Apache-2.0
#include "io/support/input_file.hpp"

#include <cadt/io/errors.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/support/system_file.hpp"

namespace cadt::io::detail {
namespace {

std::string system_text(int code) { return std::generic_category().message(code); }

}  // namespace

InputFile::InputFile(const std::string& path) : name_(path == "-" ? "<stdin>" : path) {
  if (path == "-") {
    read_all(system_file::standard_input());
    return;
  }
  // Windows opens no folder and says "permission denied".
  if (system_file::kind_of(path).folder) throw FileError(name_, 0, "is a directory");
  const system_file::Descriptor file(system_file::open_to_read(path));
  if (!file.is_open()) throw FileError(name_, 0, "cannot be opened: " + system_text(errno));
  read_all(file.get());
}

void InputFile::grow(std::size_t capacity) {
  auto larger = std::make_unique_for_overwrite<char[]>(capacity);
  if (size_ != 0) std::memcpy(larger.get(), data_.get(), size_);
  data_ = std::move(larger);
  capacity_ = capacity;
}

void InputFile::read_all(int descriptor) {
  const system_file::Kind kind = system_file::kind_of(descriptor);
  if (!kind.exists) throw FileError(name_, 0, "cannot be read: " + system_text(errno));
  if (kind.folder) throw FileError(name_, 0, "is a directory");
  // One byte more than the size lets the last read see the end of the file without growing.
  constexpr std::size_t pipe_start = std::size_t{1} << 16;
  grow(kind.regular ? kind.size + 1 : pipe_start);
  for (;;) {
    if (size_ == capacity_) grow(capacity_ * 2);
    const std::ptrdiff_t got = system_file::read(descriptor, data_.get() + size_, capacity_ - size_);
    if (got < 0) throw FileError(name_, 0, "cannot be read: " + system_text(errno));
    if (got == 0) return;
    size_ += static_cast<std::size_t>(got);
  }
}

std::string suffix_of(const std::string& path) {
  const std::size_t slash = path.find_last_of(system_file::separators);
  const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || dot < start) return {};
  std::string suffix = path.substr(dot + 1);
  for (char& c : suffix) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return suffix;
}

std::string sibling(const std::string& path, const char* suffix) {
  const std::size_t dot = path.find_last_of('.');
  const std::size_t slash = path.find_last_of(system_file::separators);
  const bool has_suffix = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  return (has_suffix ? path.substr(0, dot) : path) + suffix;
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
