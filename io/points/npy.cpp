// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy with two or three columns: .npy
#include "io/points/readers.hpp"
#include "io/support/byte_reader.hpp"
#include "io/support/npy_format.hpp"

namespace cadt::io::detail {

PointSet read_npy(const InputFile& file, const ReadOptions& options) {
  const NpyArray array = parse_npy(file.name(), file.bytes(), 0);
  if (array.kind != 'f' || (array.item_size != sizeof(float) && array.item_size != sizeof(double))) {
    fail_at_byte(file.name(), 0, "the array must hold float32 or float64");
  }
  if (array.shape.size() != 2 || (array.shape[1] != 2 && array.shape[1] != 3)) {
    fail_at_byte(file.name(), 0, "the array must have the shape (n, 2) or (n, 3)");
  }
  const bool three = array.shape[1] == 3;
  const auto value = [&](std::size_t row, std::size_t column) {
    const std::size_t at = array.item(row, column);
    const char* bytes = array.data.data() + at;
    const double real = array.item_size == sizeof(float) ? static_cast<double>(load<float>(bytes, array.big_endian))
                                                         : load<double>(bytes, array.big_endian);
    return finite_or_fail(real, file.name(), array.data_offset + at);
  };
  // The data fill the shape, so a shape without rows cannot promise columns.
  const std::size_t rows = array.data.empty() ? 0 : array.shape[0];
  PointCollector points(file.name(), options.projection, three);
  points.reserve(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = value(i, 0);
    const double y = value(i, 1);
    points.add(x, y, three ? value(i, 2) : 0.0);
  }
  return points.take();
}

void write_npy(AtomicFile& out, std::span<const double> xy, std::span<const double> height) {
  static_assert(std::endian::native == std::endian::little, "the binary writers copy numbers as they are in memory");
  out.write(npy_header("<f8", {xy.size() / 2, height.empty() ? std::size_t{2} : std::size_t{3}}));
  if (height.empty()) {
    out.write(xy.data(), xy.size_bytes());
    return;
  }
  for (std::size_t i = 0; i < height.size(); ++i) {
    out.write(&xy[2 * i], 2 * sizeof(double));
    out.write(&height[i], sizeof(double));
  }
}

}  // namespace cadt::io::detail
