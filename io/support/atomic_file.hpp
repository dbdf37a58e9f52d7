// SPDX-License-Identifier: Apache-2.0
// Output that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace cadt::io::detail {

/// A buffered output file. Everything goes to a temporary file in the folder of the target; `commit` makes it durable
/// and renames it. Without `commit` the temporary file is removed and the target stays as it was. Pipes, terminals and
/// devices cannot be renamed onto and are written directly; "-" is standard output. All failures throw FileError.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// At least `size` bytes to write to (`size` is at most `largest_room`); `advance` says how far they were used.
  [[nodiscard]] char* room(std::size_t size) {
    if (buffer_size - used_ < size) flush();
    return buffer_.get() + used_;
  }
  void advance(const char* end) noexcept { used_ = static_cast<std::size_t>(end - buffer_.get()); }
  static constexpr std::size_t largest_room = std::size_t{1} << 12;

  /// Flushes, checks, syncs and renames. Nothing may be written afterwards.
  void commit();

 private:
  static constexpr std::size_t buffer_size = std::size_t{1} << 18;

  void open_temporary();
  void flush();
  void write_through(const char* bytes, std::size_t size);
  [[noreturn]] void fail(const char* action, int code) const;

  std::string name_;       ///< as the caller wrote it, for messages
  std::string target_;     ///< what is renamed onto; empty when written directly
  std::string temporary_;  ///< empty when written directly or already renamed
  int descriptor_ = -1;
  bool owned_ = true;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
};

}  // namespace cadt::io::detail
