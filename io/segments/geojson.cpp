// SPDX-License-Identifier: Apache-2.0
// Segments and polygons of GeoJSON files: .geojson .json
#include "io/segments/readers.hpp"

#include <limits>

namespace cadt::io {
namespace detail {
namespace {

class ToSegments : public GeoJsonSink {
 public:
  explicit ToSegments(const std::string& name) : graph_(name) {}
  void points(Positions positions) override { add(positions); }
  void line(Positions positions) override {
    const std::size_t first = graph_.points();
    add(positions);
    graph_.join_from(first);
  }
  void ring(Positions positions, bool, std::size_t) override {
    const std::size_t first = graph_.points();
    add(positions);
    graph_.close_ring(first);
  }
  [[nodiscard]] SegmentsFile take(std::string crs) {
    SegmentsFile& file = graph_.file();
    file.crs = std::move(crs);
    file.some_heights = file.some_heights && heights_.size() != graph_.points();
    if (!heights_.empty() && !file.some_heights) {
      file.attributes = std::move(heights_);
      file.attributes_per_point = 1;
    }
    return graph_.take();
  }

 private:
  void add(Positions positions) {
    for (std::size_t i = 0; i < positions.xy.size(); i += 2) {
      static_cast<void>(graph_.add_point(positions.xy[i], positions.xy[i + 1]));
    }
    graph_.file().some_heights |= positions.some_heights;
    heights_.insert(heights_.end(), positions.z.begin(), positions.z.end());
  }

  SegmentCollector graph_;
  std::vector<double> heights_;
};

class ToPolygons : public GeoJsonSink {
 public:
  void points(Positions) override { ++file.other_geometries; }
  void line(Positions) override { ++file.other_geometries; }
  void ring(Positions positions, bool outer, std::size_t feature) override {
    if (outer) {
      file.polygon_offsets.push_back(file.polygon_offsets.back());
      file.features.push_back(static_cast<std::int32_t>(feature));  // less than the bytes of the file
    }
    ++file.polygon_offsets.back();
    file.xy.insert(file.xy.end(), positions.xy.begin(), positions.xy.end());
    file.some_heights |= positions.some_heights;
    file.height.insert(file.height.end(), positions.z.begin(), positions.z.end());
    file.ring_offsets.push_back(static_cast<std::int64_t>(file.xy.size() / 2));
  }

  PolygonsFile file;
};

}  // namespace

SegmentsFile read_geojson(const InputFile& file) {
  ToSegments sink(file.name());
  GeoJsonSummary summary = scan_geojson(file.name(), file.bytes(), sink);
  return sink.take(std::move(summary.crs));
}

}  // namespace detail

PolygonsFile read_polygons(const std::string& path, const std::string& format) {
  static_cast<void>(detail::choose_format(path == "-" ? "<stdin>" : path, format, {"geojson", "json"}));
  const detail::InputFile file(path);
  if (file.bytes().empty()) throw FileError(file.name(), 0, "is empty");
  detail::ToPolygons sink;
  detail::GeoJsonSummary summary = detail::scan_geojson(file.name(), file.bytes(), sink);
  sink.file.number_of_features = summary.features;
  sink.file.crs = std::move(summary.crs);
  sink.file.some_heights = sink.file.some_heights && 2 * sink.file.height.size() != sink.file.xy.size();
  if (sink.file.some_heights) sink.file.height.clear();
  if (sink.file.size() == 0) throw FileError(file.name(), 0, "has no polygons");
  return std::move(sink.file);
}

}  // namespace cadt::io
