// SPDX-License-Identifier: Apache-2.0
// Bare coordinates, interleaved and little-endian: .f64 .f32
#include "io/points/readers.hpp"
#include "io/support/byte_reader.hpp"

#include <limits>

namespace cadt::io::detail {
namespace {

template <class Real>
PointSet read_reals(const InputFile& file, const ReadOptions& options) {
  const std::string_view bytes = file.bytes();
  if (const std::size_t odd = bytes.size() % (2 * sizeof(Real)); odd != 0) {
    fail_at_byte(file.name(), bytes.size(), "the file ends within a point");
  }
  PointCollector points(file.name(), options.projection, false);
  points.reserve(bytes.size() / (2 * sizeof(Real)));
  const auto value = [&](std::size_t at) {
    return finite_or_fail(static_cast<double>(load<Real>(bytes.data() + at, false)), file.name(), at);
  };
  for (std::size_t at = 0; at < bytes.size(); at += 2 * sizeof(Real))
    points.add(value(at), value(at + sizeof(Real)), 0.0);
  return points.take();
}

}  // namespace

PointSet read_raw(const InputFile& file, const ReadOptions& options, std::size_t bytes) {
  return bytes == sizeof(float) ? read_reals<float>(file, options) : read_reals<double>(file, options);
}

void write_raw(AtomicFile& out, const std::string& name, std::span<const double> xy, std::size_t bytes) {
  static_assert(std::endian::native == std::endian::little, "the binary writers copy numbers as they are in memory");
  if (bytes == sizeof(double)) {
    out.write(xy.data(), xy.size_bytes());
    return;
  }
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const double largest = static_cast<double>(std::numeric_limits<float>::max());
    if (std::abs(xy[i]) > largest) {
      throw FileError(name, 0, "coordinate of point " + std::to_string(i / 2) + " is too large for f32");
    }
    const float value = static_cast<float>(xy[i]);
    out.write(&value, sizeof value);
  }
}

}  // namespace cadt::io::detail
