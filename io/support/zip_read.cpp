// SPDX-License-Identifier: Apache-2.0
#include "io/support/byte_reader.hpp"
#include "io/support/text_scanner.hpp"
#include "io/support/zip_archive.hpp"
#include "io/support/zip_format.hpp"

#include <algorithm>
#include <limits>

namespace cadt::io::detail {
namespace {

std::uint16_t u16(const char* at) { return load<std::uint16_t>(at, false); }
std::uint32_t u32(const char* at) { return load<std::uint32_t>(at, false); }
std::uint64_t u64(const char* at) { return load<std::uint64_t>(at, false); }

/// Replaces the numbers that did not fit 32 bits by those of the extra field, which come in a fixed order.
bool take_extra64(std::string_view extra, std::span<std::uint64_t* const> numbers) {
  while (extra.size() >= 4) {
    const std::size_t size = u16(extra.data() + 2);
    if (size > extra.size() - 4) return false;
    std::string_view field = extra.substr(4, size);
    if (u16(extra.data()) == zip::extra64) {
      for (std::uint64_t* number : numbers) {
        if (*number != zip::in_extra) continue;
        if (field.size() < sizeof(std::uint64_t)) return false;
        *number = u64(field.data());
        field.remove_prefix(sizeof(std::uint64_t));
      }
      return true;
    }
    extra.remove_prefix(4 + size);
  }
  return std::none_of(numbers.begin(), numbers.end(), [](const std::uint64_t* n) { return *n == zip::in_extra; });
}

/// Inflates `packed` into exactly `size` bytes; false if it is anything else.
bool inflate_all(std::string_view packed, char* out, std::size_t size) {
  z_stream stream{};
  if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
  constexpr std::size_t most = std::numeric_limits<uInt>::max();  // zlib counts in 32 bits
  std::size_t in = 0, done = 0;
  int code = Z_OK;
  while (code == Z_OK) {
    const std::size_t take = std::min(most, packed.size() - in), room = std::min(most, size - done);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));  // zlib reads it only
    stream.avail_in = static_cast<uInt>(take);
    stream.next_out = reinterpret_cast<Bytef*>(out + done);
    stream.avail_out = static_cast<uInt>(room);
    code = ::inflate(&stream, Z_NO_FLUSH);
    in += take - stream.avail_in;
    done += room - stream.avail_out;
  }
  ::inflateEnd(&stream);
  return code == Z_STREAM_END && done == size && in == packed.size();
}

}  // namespace

std::string_view ZipReader::slice(std::uint64_t offset, std::uint64_t size, const char* what) const {
  if (offset > bytes_.size() || size > bytes_.size() - offset) {
    fail_at_byte(name_, bytes_.size(), std::string("the file ends within ") + what);
  }
  return bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

ZipReader::Directory ZipReader::find_directory() const {
  constexpr std::size_t longest_comment = 0xffff;
  const std::size_t lowest =
      bytes_.size() > zip::end_size + longest_comment ? bytes_.size() - zip::end_size - longest_comment : 0;
  for (std::size_t at = bytes_.size() < zip::end_size ? 0 : bytes_.size() - zip::end_size + 1; at-- > lowest;) {
    const char* end = bytes_.data() + at;
    if (u32(end) != zip::end_signature || at + zip::end_size + u16(end + 20) != bytes_.size()) continue;
    Directory directory{u16(end + 10), u32(end + 12), u32(end + 16)};
    if (at >= zip::locator64_size && u32(end - zip::locator64_size) == zip::locator64_signature) {
      const std::string_view end64 =
          slice(u64(end - zip::locator64_size + 8), zip::end64_size, "the directory of the archive");
      if (u32(end64.data()) != zip::end64_signature) fail_at_byte(name_, at, "the archive is damaged");
      directory = {u64(end64.data() + 32), u64(end64.data() + 40), u64(end64.data() + 48)};
    }
    return directory;
  }
  fail_at_byte(name_, bytes_.size(), "is not an archive of NumPy, or was cut short");
}

ZipReader::Entry ZipReader::parse_entry(std::string_view record, std::size_t at) const {
  if (record.size() < zip::entry_size || u32(record.data()) != zip::entry_signature) {
    fail_at_byte(name_, at, "the directory of the archive is damaged");
  }
  const char* p = record.data();
  const std::size_t name_size = u16(p + 28), extra_size = u16(p + 30);
  if (record.size() - zip::entry_size < name_size + extra_size)
    fail_at_byte(name_, at, "the directory of the archive is damaged");
  Entry entry{record.substr(zip::entry_size, name_size),
              u16(p + 8),
              u16(p + 10),
              u32(p + 16),
              u32(p + 20),
              u32(p + 24),
              u32(p + 42)};
  std::uint64_t* const numbers[] = {&entry.size, &entry.stored_size, &entry.offset};
  if (!take_extra64(record.substr(zip::entry_size + name_size, extra_size), numbers)) {
    fail_at_byte(name_, at, "the directory of the archive is damaged");
  }
  return entry;
}

ZipReader::ZipReader(const InputFile& file) : name_(file.name()), bytes_(file.bytes()) {
  const Directory directory = find_directory();
  std::string_view records = slice(directory.offset, directory.size, "the directory of the archive");
  while (!records.empty()) {
    const auto at = static_cast<std::size_t>(records.data() - bytes_.data());
    entries_.push_back(parse_entry(records, at));
    const char* p = records.data();
    const std::size_t size = zip::entry_size + u16(p + 28) + u16(p + 30) + u16(p + 32);
    if (size > records.size()) fail_at_byte(name_, at, "the directory of the archive is damaged");
    records.remove_prefix(size);
  }
  if (entries_.size() != directory.entries)
    fail_at_byte(name_, static_cast<std::size_t>(directory.offset), "the directory of the archive is damaged");
}

bool ZipReader::contains(std::string_view wanted) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == wanted; });
}

ZipReader::Member ZipReader::read(std::string_view wanted) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == wanted; });
  if (found == entries_.end()) throw FileError(name_, 0, "the archive has no member " + quoted(wanted));
  const std::string_view local = slice(found->offset, zip::local_size, "a member of the archive");
  const auto at = static_cast<std::size_t>(found->offset);
  if (u32(local.data()) != zip::local_signature) fail_at_byte(name_, at, "the archive is damaged");
  if ((found->flags & 1) != 0) fail_at_byte(name_, at, "the archive is encrypted");
  const std::uint64_t start = found->offset + zip::local_size + u16(local.data() + 26) + u16(local.data() + 28);
  const std::string_view packed = slice(start, found->stored_size, "a member of the archive");

  Member member;
  member.offset = static_cast<std::size_t>(start);
  if (found->method == zip::stored) {
    if (found->size != found->stored_size) fail_at_byte(name_, at, "the archive is damaged");
    member.content = packed;
  } else if (found->method == zip::deflated) {
    // Deflate packs at most 258 bytes into 2 bits, so a larger claim is false and must not be allocated.
    constexpr std::uint64_t largest_ratio = 1032;
    if (found->size / largest_ratio > packed.size())
      fail_at_byte(name_, at, "a member claims more bytes than it can hold");
    const auto size = static_cast<std::size_t>(found->size);
    member.inflated = std::make_unique_for_overwrite<char[]>(size);
    if (!inflate_all(packed, member.inflated.get(), size)) fail_at_byte(name_, at, "a member cannot be inflated");
    member.content = {member.inflated.get(), size};
  } else {
    fail_at_byte(name_, at, "a member is compressed by a method that is not known");
  }
  if (zip::checksum(0, member.content) != found->crc)
    fail_at_byte(name_, at, "the checksum of " + quoted(wanted) + " is wrong");
  return member;
}

}  // namespace cadt::io::detail
