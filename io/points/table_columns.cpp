// SPDX-License-Identifier: Apache-2.0
#include "io/points/table_columns.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

namespace cadt::io::detail {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

using Names = std::vector<std::string_view>;

/// Pairs of names that go together, the more specific to a plane first.
struct Family {
  Names x, y;
};
const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {{"x"}, {"y"}},
      {{"lon", "longitude", "long", "lng"}, {"lat", "latitude"}},
      {{"easting", "east"}, {"northing", "north"}},
  };
  return all;
}
const Names& height_names() {
  static const Names names = {"z", "height", "elevation", "elev", "altitude", "alt", "depth"};
  return names;
}

std::optional<std::size_t> find_column(const std::vector<std::string>& header, const Names& names) {
  for (const std::string_view name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found != header.end()) return static_cast<std::size_t>(found - header.begin());
  }
  return std::nullopt;
}

std::optional<Columns> recognise(const std::vector<std::string>& header) {
  for (const Family& family : families()) {
    const auto x = find_column(header, family.x), y = find_column(header, family.y);
    if (!x || !y) continue;
    const auto z = find_column(header, height_names());
    return Columns{{*x, *y, z.value_or(0)}, z ? std::size_t{3} : std::size_t{2}};
  }
  return std::nullopt;
}

std::vector<std::string_view> split_choice(std::string_view choice) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = choice.find(',');
    parts.push_back(trimmed(choice.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    choice.remove_prefix(end + 1);
  }
}

/// A column given by the caller: a number from 1, or a name of the header.
std::size_t chosen_column(const TableRows& row, std::string_view wanted, const std::vector<std::string>& header,
                          bool& by_name) {
  if (const auto number = parse_integer(wanted)) {
    constexpr std::int64_t most_columns = 1'000'000;
    if (*number < 1 || *number > most_columns) row.fail("column " + quoted(wanted) + ": columns are counted from 1");
    return static_cast<std::size_t>(*number - 1);
  }
  by_name = true;
  const std::string name = lower(wanted);
  const auto found = std::find(header.begin(), header.end(), name);
  if (name.empty() || found == header.end())
    row.fail("there is no column named " + quoted(wanted) + " in the first line");
  return static_cast<std::size_t>(found - header.begin());
}

}  // namespace

std::size_t Columns::last() const noexcept {
  return *std::max_element(index.begin(), index.begin() + static_cast<std::ptrdiff_t>(count));
}

TableLayout table_layout(const TableRows& first_row, const std::string& columns) {
  const auto& fields = first_row.fields();
  std::vector<std::string> header;
  for (const std::string_view field : fields) header.push_back(lower(field));
  const bool numbers = std::any_of(fields.begin(), fields.end(), looks_numeric);
  const std::optional<Columns> recognised = recognise(header);

  TableLayout layout;
  layout.has_header = !numbers || recognised.has_value();
  if (columns.empty()) {
    if (layout.has_header && !recognised && fields.size() > 3) {
      first_row.fail("of " + std::to_string(fields.size()) +
                     " columns with names none are x and y, lon and lat, or "
                     "easting and northing: choose columns by number or name, or name two of them x and y");
    }
    layout.columns = recognised.value_or(Columns{});
    layout.third_if_numeric = !recognised;
    return layout;
  }
  const auto parts = split_choice(columns);
  if (parts.size() != 2 && parts.size() != 3)
    first_row.fail("columns " + quoted(columns) + ": two or three are needed");
  bool by_name = false;
  layout.columns.count = parts.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    layout.columns.index[i] = chosen_column(first_row, parts[i], header, by_name);
  }
  layout.has_header = layout.has_header || by_name;
  return layout;
}

}  // namespace cadt::io::detail
