// SPDX-License-Identifier: Apache-2.0
#include "io/support/npy_format.hpp"

#include "io/support/byte_reader.hpp"
#include "io/support/text_scanner.hpp"

#include <optional>

namespace cadt::io::detail {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

/// The header is a Python dictionary: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }
class HeaderParser {
 public:
  HeaderParser(const std::string& name, std::string_view text, std::size_t offset)
      : name_(name), text_(text), offset_(offset) {}

  void parse(NpyArray& array) {
    bool descr = false, order = false, shape = false;
    need('{');
    while (!accept('}')) {
      const std::string_view key = string();
      need(':');
      if (key == "descr") {
        skip_blanks();
        if (at_ < text_.size() && text_[at_] == '[') fail("arrays with fields (a structured type) cannot be read");
        parse_descr(array, string());
        descr = true;
      } else if (key == "fortran_order") {
        array.fortran_order = boolean();
        order = true;
      } else if (key == "shape") {
        parse_shape(array);
        shape = true;
      } else {
        fail("unknown key " + quoted(key) + " in the header");
      }
      if (!accept(',')) {
        need('}');
        break;
      }
    }
    if (!descr || !order || !shape) fail("the header lacks descr, fortran_order or shape");
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_at_byte(name_, offset_ + at_, message); }

  void skip_blanks() {
    while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '\n')) ++at_;
  }
  bool accept(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void need(char c) {
    if (!accept(c)) fail(std::string("the header is malformed: '") + c + "' expected");
  }
  std::string_view string() {
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '\'' && quote != '"') fail("the header is malformed: a string expected");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("the header is malformed: a string is not closed");
    const std::string_view value = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return value;
  }
  bool boolean() {
    skip_blanks();
    for (const std::string_view word : {"True", "False"}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      at_ += word.size();
      return word == "True";
    }
    fail("the header is malformed: True or False expected");
  }
  void parse_descr(NpyArray& array, std::string_view descr) const {
    const auto size = descr.size() > 2 ? parse_integer(descr.substr(2)) : std::nullopt;
    if (!size || *size < 1 || *size > 16 || std::string_view("<>=|").find(descr[0]) == std::string_view::npos ||
        std::string_view("biufc").find(descr[1]) == std::string_view::npos) {
      fail("arrays of type " + quoted(descr) + " cannot be read");
    }
    array.big_endian = descr[0] == '>' || (descr[0] == '=' && std::endian::native == std::endian::big);
    array.kind = descr[1];
    array.item_size = static_cast<std::size_t>(*size);
  }
  void parse_shape(NpyArray& array) {
    need('(');
    while (!accept(')')) {
      skip_blanks();
      const std::size_t start = at_;
      while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9') ++at_;
      const auto extent = parse_integer(text_.substr(start, at_ - start));
      if (!extent) fail("the header is malformed: the shape is not a tuple of integers");
      array.shape.push_back(static_cast<std::size_t>(*extent));
      if (!accept(',')) {
        need(')');
        break;
      }
    }
  }

  const std::string& name_;
  std::string_view text_;
  std::size_t offset_;
  std::size_t at_ = 0;
};

/// Bytes of an array of this shape; nothing if that is more than `limit`.
std::optional<std::size_t> bytes_of(const NpyArray& array, std::size_t limit) {
  std::size_t bytes = array.item_size;
  for (const std::size_t extent : array.shape) {
    if (extent == 0) return 0;
    if (bytes > limit / extent) return std::nullopt;
    bytes *= extent;
  }
  return bytes;
}

/// The header, and that the data behind it, up to byte `end` of the file, are what it says.
NpyArray parse_header(const std::string& name, std::string_view bytes, std::size_t offset, std::size_t end) {
  ByteReader reader(name, bytes, offset, false);
  if (!bytes.starts_with(magic)) reader.fail("is not an array of NumPy");
  reader.take(magic.size(), "the header");
  const auto version = reader.read<std::uint8_t>("the header");
  static_cast<void>(reader.read<std::uint8_t>("the header"));  // minor version
  if (version < 1 || version > 3) reader.fail("version " + std::to_string(version) + " of .npy is not known");
  const std::size_t length =
      version == 1 ? reader.read<std::uint16_t>("the header") : reader.read<std::uint32_t>("the header");
  const std::size_t start = reader.position();
  const std::string_view header(reader.take(length, "the header"), length);
  NpyArray array;
  HeaderParser(name, header, start).parse(array);
  array.data_offset = reader.position();
  const std::size_t left = end - array.data_offset;
  const auto needed = bytes_of(array, left);
  if (!needed) fail_at_byte(name, end, "the file ends within the array that its header describes");
  if (*needed != left) reader.fail(std::to_string(left - *needed) + " bytes after the array");
  return array;
}

}  // namespace

NpyArray parse_npy(const std::string& name, std::string_view bytes, std::size_t offset) {
  NpyArray array = parse_header(name, bytes, offset, offset + bytes.size());
  array.data = bytes.substr(array.data_offset - offset);
  return array;
}

NpyArray parse_npy_header(const std::string& name, std::string_view bytes, std::size_t file_size) {
  return parse_header(name, bytes, 0, file_size);
}

std::string npy_header(std::string_view descr, const std::vector<std::size_t>& shape) {
  std::string dictionary = "{'descr': '" + std::string(descr) + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t extent : shape) dictionary += std::to_string(extent) + ", ";
  dictionary.erase(dictionary.size() - (shape.size() == 1 ? 1 : 2));  // a tuple of one keeps its comma
  dictionary += "), }";
  // NumPy aligns the data to 64 bytes so that they can be mapped.
  constexpr std::size_t prefix = 10, alignment = 64;
  dictionary.append(alignment - 1 - (prefix + dictionary.size()) % alignment, ' ');
  dictionary += '\n';
  std::string header(magic);
  header += {'\x01', '\x00', static_cast<char>(dictionary.size() & 0xff), static_cast<char>(dictionary.size() >> 8)};
  return header + dictionary;
}

}  // namespace cadt::io::detail
