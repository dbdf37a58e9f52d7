// SPDX-License-Identifier: Apache-2.0
// One reader and one writer a format, behind read_segments and write_segments.
#pragma once

#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"
#include "io/support/text_scanner.hpp"

#include <cadt/io/segments_file.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace cadt::io::detail {

inline constexpr std::size_t most_indexed_points = std::numeric_limits<std::int32_t>::max();

/// Collects points and segments between them.
class SegmentCollector {
 public:
  /// `name` is that of the file, for messages.
  explicit SegmentCollector(const std::string& name) : name_(name) {}

  /// The index of the new point.
  std::int32_t add_point(double x, double y) {
    const std::size_t index = file_.size();
    if (index >= most_indexed_points) throw FileError(name_, 0, "has 2^31 points or more, which no segment can name");
    file_.xy.push_back(x);
    file_.xy.push_back(y);
    return static_cast<std::int32_t>(index);
  }
  void add_segment(std::int32_t from, std::int32_t to) { file_.segments.push_back({from, to}); }
  /// Segments between all points from `first` on in turn, and from the last to the first. A single point has none.
  void close_ring(std::size_t first);
  /// The same without the last segment.
  void join_from(std::size_t first);

  [[nodiscard]] std::size_t points() const noexcept { return file_.size(); }
  [[nodiscard]] SegmentsFile& file() noexcept { return file_; }
  [[nodiscard]] SegmentsFile take() { return std::move(file_); }

 private:
  const std::string& name_;
  SegmentsFile file_;
};

/// The next word as an index of `points` points that count from `base`, counted from 0.
[[nodiscard]] std::int32_t read_index(TextScanner& scanner, std::size_t points, std::int64_t base);

[[nodiscard]] SegmentsFile read_poly(const InputFile& file, const std::string& path);
[[nodiscard]] SegmentsFile read_edge(const InputFile& file, const std::string& path);
[[nodiscard]] SegmentsFile read_segment_list(const InputFile& file);
[[nodiscard]] SegmentsFile read_obj_lines(const InputFile& file);
[[nodiscard]] SegmentsFile read_geojson(const InputFile& file);
[[nodiscard]] SegmentsFile read_counted(const InputFile& file);
[[nodiscard]] SegmentsFile read_poly2tri(const InputFile& file);

/// The last sections of a .poly file: holes, and regions if there are any.
void write_places(AtomicFile& out, std::span<const std::array<double, 2>> holes, std::span<const Region> regions,
                  int base);

/// What a GeoJSON file holds, in its order. Coordinates are interleaved x y; z has one value a position, or is empty.
class GeoJsonSink {
 public:
  struct Positions {
    std::span<const double> xy, z;  ///< z: empty unless all of the geometry have one
    bool some_heights = false;      ///< some of the geometry have one
  };
  virtual ~GeoJsonSink() = default;
  virtual void points(Positions positions) = 0;
  virtual void line(Positions positions) = 0;
  /// A ring without the repetition of its first position; `outer`: the first of a polygon. It may have no positions: a
  /// polygon without rings is one of those.
  virtual void ring(Positions positions, bool outer, std::size_t feature) = 0;
};
struct GeoJsonSummary {
  std::size_t features;  ///< a geometry without one counts as one
  std::string crs;       ///< what the member "crs" of the whole names, as GeoJSON had it before RFC 7946; or empty
};
/// \throws FileError with the line
GeoJsonSummary scan_geojson(const std::string& name, std::string_view text, GeoJsonSink& sink);

}  // namespace cadt::io::detail
