// SPDX-License-Identifier: Apache-2.0
#include "io/support/ply_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace cadt::io::detail {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
// The names of the first PLY description and the sized ones that replaced them; 64-bit integers are a later habit.
constexpr std::array<TypeName, 18> type_names = {{{"char", PlyType::i8},
                                                  {"uchar", PlyType::u8},
                                                  {"short", PlyType::i16},
                                                  {"ushort", PlyType::u16},
                                                  {"int", PlyType::i32},
                                                  {"uint", PlyType::u32},
                                                  {"float", PlyType::f32},
                                                  {"double", PlyType::f64},
                                                  {"int8", PlyType::i8},
                                                  {"uint8", PlyType::u8},
                                                  {"int16", PlyType::i16},
                                                  {"uint16", PlyType::u16},
                                                  {"int32", PlyType::i32},
                                                  {"uint32", PlyType::u32},
                                                  {"int64", PlyType::i64},
                                                  {"uint64", PlyType::u64},
                                                  {"float32", PlyType::f32},
                                                  {"float64", PlyType::f64}}};

constexpr std::size_t size_of(PlyType type) noexcept {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// Bytes that a row takes at least; lists may be empty.
std::size_t least_row_size(const PlyElement& element) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) size += size_of(property.length_type.value_or(property.type));
  return size;
}

bool has_list(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& p) { return p.length_type.has_value(); });
}

PlyType need_type(const TextScanner& scanner, std::string_view word) {
  for (const TypeName& entry : type_names) {
    if (entry.name == word) return entry.type;
  }
  scanner.fail(quoted(word) + " is not a type of PLY");
}

/// No data line of a PLY file is a comment: a character that cannot be in a line turns them off.
constexpr char no_comment = '\n';

}  // namespace

std::optional<std::size_t> PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view wanted : names) {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == wanted) return i;
    }
  }
  return std::nullopt;
}

PlyReader::PlyReader(const InputFile& file) : file_(file), scanner_(file.name(), file.bytes()) { read_header(); }

void PlyReader::read_property(PlyElement& element) {
  PlyProperty property;
  std::string_view type = scanner_.word();
  if (type == "list") {
    property.length_type = need_type(scanner_, scanner_.word());
    if (*property.length_type >= PlyType::f32) scanner_.fail("the length of a list must be of an integer type");
    type = scanner_.word();
  }
  property.type = need_type(scanner_, type);
  property.name = scanner_.word();
  if (property.name.empty()) scanner_.fail("a property needs a name");
  scanner_.expect_end_of_line();
  element.properties.push_back(std::move(property));
}

void PlyReader::read_header() {
  if (!scanner_.next_line() || scanner_.word() != "ply") scanner_.fail("a PLY file starts with 'ply'");
  scanner_.expect_end_of_line();
  std::string_view format;
  for (;;) {
    if (!scanner_.next_line()) scanner_.fail("the header has no 'end_header'");
    const std::string_view keyword = scanner_.word();
    if (keyword == "format") {
      format = scanner_.word();
      if (scanner_.word() != "1.0") scanner_.fail("only version 1.0 of PLY is known");
    } else if (keyword == "element") {
      PlyElement element;
      element.name = scanner_.word();
      element.count = scanner_.count("the number of elements", std::numeric_limits<std::int64_t>::max());
      element.line = scanner_.line_number();
      scanner_.expect_end_of_line();
      elements_.push_back(std::move(element));
    } else if (keyword == "property") {
      if (elements_.empty()) scanner_.fail("a property before the first element");
      read_property(elements_.back());
    } else if (keyword == "end_header") {
      break;
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      scanner_.fail(quoted(keyword) + " is not a keyword of a PLY header");
    }
  }
  const bool big = format == "binary_big_endian";
  if (big || format == "binary_little_endian") {
    const std::size_t start = scanner_.position();
    bytes_.emplace(file_.name(), file_.bytes().substr(start), start, big);
  } else if (format != "ascii") {
    scanner_.fail(format.empty() ? "the header has no 'format'" : quoted(format) + " is not a format of PLY");
  }
}

void PlyReader::begin(const PlyElement& element) {
  row_start_ = bytes_ ? bytes_->position() : 0;
  if (element.count == 0) return;
  const std::size_t least = least_row_size(element);
  if (least == 0) scanner_.fail_at(element.line, "element " + quoted(element.name) + " has no properties");
  // In text a value takes a character and a separator; the last line may lack its end.
  const std::size_t room =
      bytes_ ? bytes_->left() / least : (scanner_.bytes_left() + 1) / (2 * element.properties.size());
  if (element.count > room) {
    const std::string message = "the header claims " + std::to_string(element.count) + " rows of element " +
                                quoted(element.name) + ", the file has room for " + std::to_string(room);
    if (bytes_) bytes_->fail(message);
    scanner_.fail_at(element.line, message);
  }
}

double PlyReader::text_value() {
  const std::string_view word = scanner_.word();
  if (word.empty()) scanner_.fail("the line ends where a value should be");
  const ParsedNumber parsed = parse_number(word);
  if (parsed.problem == NumberProblem::malformed) scanner_.fail(describe(parsed.problem, word));
  return parsed.value;
}

double PlyReader::binary_value(PlyType type) {
  constexpr const char* what = "the data";
  switch (type) {
    case PlyType::i8:
      return bytes_->read<std::int8_t>(what);
    case PlyType::u8:
      return bytes_->read<std::uint8_t>(what);
    case PlyType::i16:
      return bytes_->read<std::int16_t>(what);
    case PlyType::u16:
      return bytes_->read<std::uint16_t>(what);
    case PlyType::i32:
      return bytes_->read<std::int32_t>(what);
    case PlyType::u32:
      return bytes_->read<std::uint32_t>(what);
    case PlyType::i64:
      return static_cast<double>(bytes_->read<std::int64_t>(what));
    case PlyType::u64:
      return static_cast<double>(bytes_->read<std::uint64_t>(what));
    case PlyType::f32:
      return static_cast<double>(bytes_->read<float>(what));
    case PlyType::f64:
      break;
  }
  return bytes_->read<double>(what);
}

void PlyReader::next(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list) {
  row.values.resize(element.properties.size());
  row.list.clear();
  if (bytes_) {
    next_binary(element, row, wanted_list);
  } else {
    next_text(element, row, wanted_list);
  }
}

void PlyReader::next_text(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list) {
  if (!scanner_.next_content_line(no_comment)) scanner_.fail("the file ends within element " + quoted(element.name));
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    row.values[i] = 0;
    if (!element.properties[i].length_type) {
      row.values[i] = text_value();
      continue;
    }
    // A line cannot hold more items than characters, so a hostile length ends at the end of its line.
    const std::size_t length = scanner_.count("the length of a list", std::numeric_limits<std::int64_t>::max());
    for (std::size_t k = 0; k < length; ++k) {
      const double item = text_value();
      if (wanted_list == i) row.list.push_back(item);
    }
  }
  scanner_.expect_end_of_line();
}

void PlyReader::next_binary(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list) {
  row_start_ = bytes_->position();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    row.values[i] = 0;
    if (!property.length_type) {
      row.values[i] = binary_value(property.type);
      continue;
    }
    const double length = binary_value(*property.length_type);
    if (length < 0) bytes_->fail("the length of a list is negative");
    if (length > static_cast<double>(bytes_->left() / size_of(property.type))) {
      bytes_->fail("a list claims more items than the file has room for");
    }
    const auto items = static_cast<std::size_t>(length);
    if (wanted_list == i) {
      for (std::size_t k = 0; k < items; ++k) row.list.push_back(binary_value(property.type));
    } else {
      bytes_->take(items * size_of(property.type), "a list");
    }
  }
}

void PlyReader::skip(const PlyElement& element) {
  begin(element);
  if (bytes_ && !has_list(element)) {
    bytes_->take(element.count * least_row_size(element), "the data");  // no overflow: `begin` has checked the product
    return;
  }
  PlyRow row;
  for (std::size_t i = 0; i < element.count; ++i) next(element, row);
}

void PlyReader::expect_end() {
  if (bytes_) {
    bytes_->expect_end();
  } else {
    scanner_.expect_end_of_text(no_comment);
  }
}

void PlyReader::fail(const std::string& message) const {
  if (bytes_) fail_at_byte(file_.name(), row_start_, message);
  scanner_.fail(message);
}

}  // namespace cadt::io::detail
