// SPDX-License-Identifier: Apache-2.0
#include "tiles/files.hpp"

#include <cadt/io/errors.hpp>

#include "io/support/npy_format.hpp"
#include "tiles/hash.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

namespace cadt::tiles {
namespace {

namespace fs = std::filesystem;
namespace system_file = io::detail::system_file;

[[noreturn]] void fail(const std::string& path, const char* what, int code) {
  throw io::FileError(path, 0, std::string(what) + ": " + std::generic_category().message(code));
}

/// A new file; without finish() it is removed.
class NewFile {
 public:
  /// Messages name `shown`.
  NewFile(std::string path, std::string shown)
      : path_(std::move(path)), shown_(std::move(shown)), file_(system_file::create(path_)) {
    if (!file_.is_open()) fail(shown_, "cannot be created", errno);
  }
  ~NewFile() {
    if (file_.is_open()) system_file::remove(path_);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const void* from, std::size_t size) {
    const auto* at = static_cast<const char*>(from);
    while (size != 0) {
      const std::size_t piece =
          std::min(size, std::size_t{1} << 20);  // what was hashed is in the cache when it is copied
      hash_.add(at, piece);
      bytes_ += piece;
      for (std::size_t done = 0; done != piece;) {
        const std::ptrdiff_t put = system_file::write(file_.get(), at + done, piece - done);
        if (put < 0) fail(shown_, "cannot be written", errno);
        done += static_cast<std::size_t>(put);
      }
      at += piece, size -= piece;
    }
  }
  FileRecord finish() {
    if (!file_.close()) {
      const int code = errno;
      system_file::remove(path_);
      fail(shown_, "cannot be closed", code);
    }
    return {.name = {}, .bytes = bytes_, .hash = hash_.value().to_string()};
  }

 private:
  std::string path_, shown_;
  system_file::Descriptor file_;
  std::uint64_t bytes_ = 0;
  HashStream hash_;
};

}  // namespace

FileRecord write_array(const std::string& path, const ArrayView& array) {
  NewFile file(path, path);
  const std::string header = io::detail::npy_header(array.type, array.shape);
  file.write(header.data(), header.size());
  file.write(array.data, array.bytes);
  return file.finish();
}

void write_text(const std::string& path, std::string_view text) {
  NewFile file(path, path);
  file.write(text.data(), text.size());
  file.finish();
}

void sync_file(const std::string& path) {
  const system_file::Descriptor file(system_file::open_to_read(path));
  if (!file.is_open()) fail(path, "cannot be opened", errno);
  if (!system_file::sync(file.get())) fail(path, "cannot be synced", errno);
}

FolderLock::~FolderLock() {
  // Closing is not enough: a process that was forked meanwhile has the descriptor too. It does not own the lock.
  if (folder_ && process_ == ::getpid()) ::flock(folder_->get(), LOCK_UN);
}

bool FolderLock::take(const std::string& path) {
  folder_.emplace(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder_->is_open()) fail(path, "cannot be opened", errno);
  process_ = ::getpid();
  if (::flock(folder_->get(), LOCK_EX | LOCK_NB) == 0) return true;
  const int code = errno;
  if (code == EWOULDBLOCK) return false;
  // What file systems without locks say; EBADF: one that locks for writing what is open for writing alone.
  for (const int no_locks : {ENOLCK, EOPNOTSUPP, ENOSYS, EINVAL, EBADF})
    if (code == no_locks) return true;
  fail(path, "cannot be locked", code);
}

void rename_file(const std::string& from, const std::string& to) {
  std::error_code code;
  fs::rename(from, to, code);
  if (code) fail(to, "cannot be renamed from its temporary file", code.value());
}

void replace_text(const std::string& path, std::string_view text) {
  // A fixed name, so that those of killed processes do not pile up.
  const std::string temporary = path + ".tmp";
  system_file::remove(temporary);
  {
    NewFile file(temporary, path);
    file.write(text.data(), text.size());
    file.finish();
  }
  sync_file(temporary);
  rename_file(temporary, path);
  sync_folder(system_file::folder_of(path));
}

std::string read_text(const std::string& path) {
  const MappedFile file(path);
  return std::string(file.bytes());
}

std::vector<std::uint64_t> read_words(const std::string& path) {
  const MappedFile file(path);
  const auto words = numbers_of<std::uint64_t>(file, path, "<u8", 1);
  return {words.begin(), words.end()};
}

std::string difference(const std::string& path, const FileRecord& record) {
  const system_file::Kind kind = system_file::kind_of(path);
  if (!kind.regular) return "is not there";
  if (kind.size != record.bytes)
    return "has " + std::to_string(kind.size) + " bytes, and not " + std::to_string(record.bytes);
  const system_file::Descriptor file(system_file::open_to_read(path));
  if (!file.is_open()) return "cannot be opened: " + std::generic_category().message(errno);
  constexpr std::size_t piece = std::size_t{1} << 20;
  const auto buffer = std::make_unique_for_overwrite<char[]>(piece);
  HashStream hash;
  std::ptrdiff_t got = 0;
  while ((got = system_file::read(file.get(), buffer.get(), piece)) > 0)
    hash.add(buffer.get(), static_cast<std::size_t>(got));
  if (got < 0) return "cannot be read: " + std::generic_category().message(errno);
  if (hash.value().to_string() != record.hash) return "is not what was written: its hash differs";
  return {};
}

void make_folder(const std::string& path) {
  std::error_code code;
  fs::create_directory(path, code);
  std::error_code ignored;
  if (code || !fs::is_directory(path, ignored)) fail(path, "the folder cannot be made", code ? code.value() : ENOTDIR);
}

void sync_folder(const std::string& path) {
  const system_file::Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.is_open()) fail(path, "cannot be opened", errno);
  if (!system_file::sync(folder.get())) fail(path, "cannot be synced", errno);
}

void rename_folder(const std::string& from, const std::string& to) {
  sync_folder(from);
  std::error_code code;
  fs::rename(from, to, code);
  if (code) fail(to, "cannot be renamed from its temporary folder", code.value());
  sync_folder(system_file::folder_of(to));
}

void remove_folder(const std::string& path) {
  std::error_code code;
  fs::remove_all(path, code);
  if (code) fail(path, "cannot be removed", code.value());
}

MappedFile::MappedFile(const std::string& path) {
  const system_file::Descriptor file(system_file::open_to_read(path));
  if (!file.is_open()) fail(path, "cannot be opened", errno);
  const system_file::Kind kind = system_file::kind_of(file.get());
  if (!kind.regular) fail(path, "cannot be read", kind.folder ? EISDIR : EINVAL);
  size_ = kind.size;
  if (!is_small()) {
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.get(), 0);
    if (data_ == MAP_FAILED) fail(path, "cannot be mapped", errno);
    return;
  }
  small_.resize(size_);
  errno = EIO;
  for (std::size_t at = 0; at < size_;) {
    const std::ptrdiff_t got = system_file::read(file.get(), small_.data() + at, size_ - at);
    if (got <= 0) fail(path, "cannot be read", errno);
    at += static_cast<std::size_t>(got);
  }
}
MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      small_(std::move(other.small_)) {}
MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

template <class Number>
std::span<const Number> numbers_of(const MappedFile& file, const std::string& path, std::string_view type,
                                   std::size_t columns) {
  const io::detail::NpyArray array = io::detail::parse_npy(path, file.bytes(), 0);
  const bool fits = type.size() == 3 && type[1] == array.kind &&
                    static_cast<std::size_t>(type[2] - '0') == array.item_size && array.item_size == sizeof(Number) &&
                    !array.big_endian && !array.fortran_order && array.shape.size() == (columns == 1 ? 1U : 2U) &&
                    (columns == 1 || array.shape[1] == columns) && array.data_offset % alignof(Number) == 0;
  if (!fits) {
    throw io::FileError(path, 0,
                        "is not an array of type " + std::string(type) + " with " + std::to_string(columns) +
                            (columns == 1 ? " column" : " columns"));
  }
  if (array.data.empty()) return {};
  return {reinterpret_cast<const Number*>(array.data.data()), array.size()};
}
template std::span<const double> numbers_of(const MappedFile&, const std::string&, std::string_view, std::size_t);
template std::span<const std::uint64_t> numbers_of(const MappedFile&, const std::string&, std::string_view,
                                                   std::size_t);
template std::span<const std::int32_t> numbers_of(const MappedFile&, const std::string&, std::string_view, std::size_t);

}  // namespace cadt::tiles
