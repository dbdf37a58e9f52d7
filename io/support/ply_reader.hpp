// SPDX-License-Identifier: Apache-2.0
// PLY files of any layout: ascii, binary little-endian and binary big-endian.
#pragma once

#include "io/support/byte_reader.hpp"
#include "io/support/input_file.hpp"
#include "io/support/text_scanner.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io::detail {

enum class PlyType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;         ///< of the value, or of the items of a list
  std::optional<PlyType> length_type;  ///< set for lists
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  ///< as the header claims; bounded by the file only once `begin` has accepted it
  std::vector<PlyProperty> properties;
  std::size_t line = 0;  ///< of the header, for messages

  /// Index of the first property with one of the names.
  [[nodiscard]] std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const;
};

/// One instance of an element.
struct PlyRow {
  std::vector<double> values;  ///< one a property; 0 for lists. May be NaN or infinite.
  std::vector<double> list;    ///< items of the list that was asked for
};

/// Reads the header on construction, then the elements in the order of the file:
/// for each of elements(): begin(e), then e.count times next(), or skip(e). At last expect_end().
class PlyReader {
 public:
  explicit PlyReader(const InputFile& file);

  [[nodiscard]] const std::vector<PlyElement>& elements() const noexcept { return elements_; }

  /// Checks that the file has room for the claimed count.
  void begin(const PlyElement& element);
  /// Reads the next row; of the lists only `wanted_list` (an index of a property) is kept.
  void next(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list = std::nullopt);
  void skip(const PlyElement& element);
  void expect_end();
  /// Error at the row that was read last.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void read_header();
  void read_property(PlyElement& element);
  void next_text(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list);
  void next_binary(const PlyElement& element, PlyRow& row, std::optional<std::size_t> wanted_list);
  double text_value();
  double binary_value(PlyType type);

  const InputFile& file_;
  TextScanner scanner_;
  std::optional<ByteReader> bytes_;  ///< set if the body is binary
  std::vector<PlyElement> elements_;
  std::size_t row_start_ = 0;
};

}  // namespace cadt::io::detail
