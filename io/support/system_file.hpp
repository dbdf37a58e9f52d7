// SPDX-License-Identifier: Apache-2.0
// What io asks of the operating system: files by their descriptors, which tell why something failed, and names.
// Functions that return -1 or false leave the reason in errno. Names are UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace cadt::io::detail::system_file {

/// What separates folders in a name.
#if defined(_WIN32)
constexpr std::string_view separators = "/\\";
#else
constexpr std::string_view separators = "/";
#endif

/// In the mode of bytes: nothing changes the ends of lines.
[[nodiscard]] int standard_input() noexcept;
[[nodiscard]] int standard_output() noexcept;

[[nodiscard]] int open_to_read(const std::string& path);
/// Something that exists and is no regular file.
[[nodiscard]] int open_to_write(const std::string& path);
/// A file that does not exist. The process decides about its permissions (umask).
[[nodiscard]] int create(const std::string& path);
/// At most 1 GiB at a time; 0 at the end. Calls that a signal interrupts are repeated.
[[nodiscard]] std::ptrdiff_t read(int descriptor, char* bytes, std::size_t size) noexcept;
/// Read and write from byte `at` on; from several threads at once.
[[nodiscard]] std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t size, std::uint64_t at) noexcept;
[[nodiscard]] std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t size) noexcept;
[[nodiscard]] std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t size, std::uint64_t at) noexcept;
/// On the disk. True as well where pipes and file systems do not know how.
[[nodiscard]] bool sync(int descriptor) noexcept;
bool close(int descriptor) noexcept;

/// What was opened, or -1: closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int value) noexcept : value_(value) {}
  ~Descriptor() {
    if (is_open()) close();
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] bool is_open() const noexcept { return value_ >= 0; }
  [[nodiscard]] int get() const noexcept { return value_; }
  /// Also tells what of the writing has failed.
  bool close() noexcept { return system_file::close(std::exchange(value_, -1)); }

 private:
  int value_;
};

struct Kind {
  bool exists = false, regular = false, folder = false;
  std::size_t size = 0;      ///< of a regular file
  unsigned permissions = 0;  ///< of POSIX
};
[[nodiscard]] Kind kind_of(const std::string& path);
/// That of what is open. \post exists, unless the system refuses to say
[[nodiscard]] Kind kind_of(int descriptor) noexcept;
void set_permissions(int descriptor, unsigned permissions) noexcept;  ///< as far as possible

/// Renames, also over an existing file; the new name is on the disk when it returns, where the system can do that.
[[nodiscard]] bool replace(const std::string& from, const std::string& to);
void remove(const std::string& path) noexcept;

/// The file that symbolic links lead to; the name as it is if there is none.
[[nodiscard]] std::string resolved(const std::string& path);
[[nodiscard]] std::string folder_of(const std::string& path);
[[nodiscard]] bool is_readable(const std::string& path);
[[nodiscard]] long process_number() noexcept;

}  // namespace cadt::io::detail::system_file
