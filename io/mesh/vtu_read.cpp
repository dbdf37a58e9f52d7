// SPDX-License-Identifier: Apache-2.0
// Triangles of .vtu files in the layout that cadt writes: one piece, raw appended data, 64-bit sizes.
#include "io/mesh/mesh_parts.hpp"
#include "io/support/byte_reader.hpp"
#include "io/support/text_scanner.hpp"

#include <algorithm>

namespace cadt::io::detail {
namespace {

/// Value of an attribute in the text of a tag; empty if it has none.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string wanted = std::string(1, ' ').append(name).append("=\"");
  const std::size_t start = tag.find(wanted);
  if (start == std::string_view::npos) return {};
  const std::string_view rest = tag.substr(start + wanted.size());
  return rest.substr(0, rest.find('"'));
}

class VtuFile {
 public:
  explicit VtuFile(const InputFile& file) : name_(file.name()), bytes_(file.bytes()) {
    constexpr std::string_view start_of_data = "<AppendedData encoding=\"raw\">";
    const std::size_t data = bytes_.find(start_of_data);
    if (data == std::string_view::npos) fail("has no raw appended data; only files as cadt writes them can be read");
    xml_ = bytes_.substr(0, data);
    const std::string_view root = tag("<VTKFile ");
    if (attribute(root, "type") != "UnstructuredGrid") fail("is not an unstructured grid");
    if (attribute(root, "byte_order") != "LittleEndian" || attribute(root, "header_type") != "UInt64") {
      fail("must be little-endian with headers of type UInt64, as cadt writes it");
    }
    if (!attribute(root, "compressor").empty()) fail("is compressed; only files as cadt writes them can be read");
    const std::size_t mark = bytes_.find_first_not_of(" \t\r\n", data + start_of_data.size());
    if (mark == std::string_view::npos || bytes_[mark] != '_') fail("the appended data do not start with '_'");
    data_ = mark + 1;
  }

  [[noreturn]] void fail(const std::string& message) const { throw FileError(name_, 0, message); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  struct Array {
    std::string_view data;
    std::size_t offset = 0;  ///< in the file
  };
  /// The appended array of that name, which must have the given type.
  [[nodiscard]] Array array(std::string_view wanted, std::string_view type) const {
    for (std::size_t at = xml_.find("<DataArray "); at != std::string_view::npos;
         at = xml_.find("<DataArray ", at + 1)) {
      const std::string_view text = xml_.substr(at, xml_.find('>', at) - at);
      if (attribute(text, "Name") != wanted) continue;
      if (attribute(text, "type") != type)
        fail("array '" + std::string(wanted) + "' must be of type " + std::string(type));
      const auto offset = parse_integer(attribute(text, "offset"));
      if (attribute(text, "format") != "appended" || !offset || *offset < 0) {
        fail("array '" + std::string(wanted) + "' is not appended");
      }
      return appended(static_cast<std::size_t>(*offset));
    }
    fail("has no array '" + std::string(wanted) + "'");
  }
  [[nodiscard]] std::int64_t cells() const {
    const auto count = parse_integer(attribute(tag("<Piece "), "NumberOfCells"));
    if (!count || *count < 0) fail("has no valid NumberOfCells");
    return *count;
  }

 private:
  [[nodiscard]] std::string_view tag(std::string_view start) const {
    const std::size_t at = xml_.find(start);
    if (at == std::string_view::npos) fail("has no tag " + std::string(start));
    return xml_.substr(at, xml_.find('>', at) - at);
  }
  [[nodiscard]] Array appended(std::size_t offset) const {
    const std::size_t room = bytes_.size() - data_;
    if (offset > room || room - offset < sizeof(std::uint64_t)) {
      fail_at_byte(name_, bytes_.size(), "the file ends before an array that its header describes");
    }
    const std::size_t start = data_ + offset;
    const auto size = load<std::uint64_t>(bytes_.data() + start, false);
    const std::size_t left = bytes_.size() - start - sizeof size;
    if (size > left)
      fail_at_byte(name_, start,
                   "an array claims " + std::to_string(size) + " bytes, " + std::to_string(left) + " are left");
    return {bytes_.substr(start + sizeof size, static_cast<std::size_t>(size)), start + sizeof size};
  }

  const std::string& name_;
  std::string_view bytes_, xml_;
  std::size_t data_ = 0;
};

}  // namespace

MeshFile read_vtu(const InputFile& input, std::size_t points) {
  const VtuFile file(input);
  const auto connectivity = file.array("connectivity", "Int32");
  const auto offsets = file.array("offsets", "Int64");
  const auto types = file.array("types", "UInt8");
  const auto cells = static_cast<std::size_t>(file.cells());
  constexpr std::size_t cell_size = corners_of_triangle * sizeof(std::int32_t);
  if (types.data.size() != cells || offsets.data.size() / sizeof(std::int64_t) != cells ||
      connectivity.data.size() / cell_size != cells || connectivity.data.size() % cell_size != 0) {
    file.fail("the sizes of the cell arrays do not fit " + std::to_string(cells) + " triangles");
  }
  constexpr char vtk_triangle = 5;
  TriangleCollector triangles(points, 0);
  triangles.reserve(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const auto end = load<std::int64_t>(offsets.data.data() + i * sizeof(std::int64_t), false);
    if (types.data[i] != vtk_triangle || end != static_cast<std::int64_t>(corners_of_triangle * (i + 1))) {
      fail_at_byte(file.name(), types.offset + i, "cell " + std::to_string(i) + " is not a triangle");
    }
    for (std::size_t k = 0; k < corners_of_triangle; ++k) {
      const std::size_t at = i * cell_size + k * sizeof(std::int32_t);
      const auto index = load<std::int32_t>(connectivity.data.data() + at, false);
      if (!triangles.add(index)) fail_at_byte(file.name(), connectivity.offset + at, triangles.refusal(index));
    }
  }
  return {triangles.take(), {}};
}

}  // namespace cadt::io::detail
