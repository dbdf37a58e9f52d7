// SPDX-License-Identifier: Apache-2.0
// Files of a mesh directory: written and synced as a whole, hashed, mapped.
#pragma once

#include "io/support/system_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::tiles {

struct FileRecord {
  std::string name;  ///< relative to the mesh directory
  std::uint64_t bytes = 0;
  std::string hash;  ///< XXH3-128, 32 hexadecimal digits
  friend bool operator==(const FileRecord&, const FileRecord&) = default;
};

/// An array as NumPy names its type: "<f8".
struct ArrayView {
  std::string_view type;
  std::vector<std::size_t> shape;
  const void* data = nullptr;
  std::size_t bytes = 0;
};

/// All functions throw io::FileError that names the file. What could not be written is removed.

/// A new .npy file, which is on the disk after sync_file: those of a node are synced together, which takes the time of
/// one. The record's name is left to the caller.
FileRecord write_array(const std::string& path, const ArrayView& array);
void write_text(const std::string& path, std::string_view text);
void sync_file(const std::string& path);
/// A text under its name at once, in place of what was there, and on the disk.
void replace_text(const std::string& path, std::string_view text);
[[nodiscard]] std::string read_text(const std::string& path);
/// The numbers of a one-dimensional .npy file of type <u8.
[[nodiscard]] std::vector<std::uint64_t> read_words(const std::string& path);

/// What is wrong with a file that should be as recorded; empty if nothing is. Reads it.
[[nodiscard]] std::string difference(const std::string& path, const FileRecord& record);

void make_folder(const std::string& path);
/// Names in the folder are on the disk.
void sync_folder(const std::string& path);
/// A file under another name, at once, in place of what was there.
void rename_file(const std::string& from, const std::string& to);
/// A folder under its final name, at once, and on the disk: `to` must not exist.
void rename_folder(const std::string& from, const std::string& to);
/// With all that is in it; not an error if it is not there.
void remove_folder(const std::string& path);

/// Keeps a folder for one run: until it is destroyed, or the process ends in any way, the folder has no other lock.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// False if another one, of this process or another, has the folder. File systems that know no locks of folders (some
  /// of those shared by machines) do not tell. \throws io::FileError
  [[nodiscard]] bool take(const std::string& path);

 private:
  std::optional<io::detail::system_file::Descriptor> folder_;
  std::int64_t process_ = 0;  // that has taken it
};

/// A file in memory as its pages are read. Must not become shorter meanwhile. Small ones are read at once: a process
/// may have some ten thousand mappings alone.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  [[nodiscard]] std::string_view bytes() const noexcept {
    return {is_small() ? small_.data() : static_cast<const char*>(data_), size_};
  }

 private:
  [[nodiscard]] bool is_small() const noexcept { return size_ < (std::size_t{1} << 16); }
  void* data_ = nullptr;
  std::size_t size_ = 0;
  std::vector<char> small_;
};

/// The numbers of a mapped .npy file, which must be of this type and have `columns` columns (1: one dimension).
/// \throws io::FileError
template <class Number>
[[nodiscard]] std::span<const Number> numbers_of(const MappedFile& file, const std::string& path, std::string_view type,
                                                 std::size_t columns);

}  // namespace cadt::tiles
