// SPDX-License-Identifier: Apache-2.0
// The readers of files: whatever the bytes are, points that keep what the interface promises, or a FileError.
// CADT_FUZZ_FORMAT names the format, e.g. points:csv or mesh:ply; without it the first byte of the input does.
#include <sys/mman.h>
#include <unistd.h>

#include <cadt/io/label_image_file.hpp>
#include <cadt/io/mesh_file.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/io/query_files.hpp>
#include <cadt/io/segments_file.hpp>
#include <cmath>
#include <new>
#include <string>
#include <vector>

#include "tests/robustness/fuzz/fuzz.hpp"

namespace {

std::vector<std::string> formats() {
  std::vector<std::string> all;
  for (const std::string& f : cadt::io::point_read_formats()) all.push_back("points:" + f);
  for (const std::string& f : cadt::io::mesh_read_formats()) all.push_back("mesh:" + f);
  for (const std::string& f : cadt::io::value_read_formats()) all.push_back("values:" + f);
  for (const std::string& f : cadt::io::segment_read_formats()) all.push_back("segments:" + f);
  for (const char* f : {"polygons:json", "labels:png"}) all.push_back(f);
  return all;
}

/// A file without a name, in memory.
class Memory {
 public:
  Memory(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    while (size != 0) {
      const ssize_t written = ::write(descriptor_, data, size);
      if (written <= 0) cadt::fuzz::fail("no file in memory");
      data += written, size -= static_cast<std::size_t>(written);
    }
  }
  ~Memory() { ::close(descriptor_); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void check_points(const cadt::io::PointSet& points) {
  if (points.xy.size() % 2 != 0) cadt::fuzz::fail("half a point");
  if (!points.height.empty() && points.height.size() != points.size()) cadt::fuzz::fail("heights are missing");
  for (const double v : points.xy)
    if (!std::isfinite(v)) cadt::fuzz::fail("a coordinate that is no finite number");
}

void check_values(const cadt::io::Values& values) {
  if (values.per_row == 0 || values.values.empty()) cadt::fuzz::fail("no values");
  if (values.values.size() % values.per_row != 0) cadt::fuzz::fail("a part of a row");
  for (const double v : values.values)
    if (!std::isfinite(v)) cadt::fuzz::fail("a value that is no finite number");
}

void check_mesh(const cadt::io::MeshFile& mesh, std::size_t points) {
  if (mesh.triangles.size() % 3 != 0) cadt::fuzz::fail("a part of a triangle");
  if (!mesh.neighbors.empty() && mesh.neighbors.size() != mesh.triangles.size())
    cadt::fuzz::fail("neighbours are missing");
  for (const std::int32_t v : mesh.triangles)
    if (v < 0 || static_cast<std::size_t>(v) >= points) cadt::fuzz::fail("a vertex out of range");
}

void check_segments(const cadt::io::SegmentsFile& graph) {
  if (graph.xy.size() % 2 != 0 || graph.xy.empty()) cadt::fuzz::fail("half a point, or none");
  if (graph.attributes.size() != graph.size() * graph.attributes_per_point) cadt::fuzz::fail("attributes are missing");
  if (!graph.markers.empty() && graph.markers.size() != graph.size()) cadt::fuzz::fail("markers are missing");
  if (!graph.segment_markers.empty() && graph.segment_markers.size() != graph.segments.size())
    cadt::fuzz::fail("markers of segments are missing");
  for (const auto& values : {graph.xy, graph.attributes})
    for (const double v : values)
      if (!std::isfinite(v)) cadt::fuzz::fail("a number that is not finite");
  for (const auto& segment : graph.segments)
    for (const std::int32_t v : segment)
      if (v < 0 || static_cast<std::size_t>(v) >= graph.size()) cadt::fuzz::fail("an end out of range");
}

void check_polygons(const cadt::io::PolygonsFile& file) {
  const auto check = [](const std::vector<std::int64_t>& offsets, std::size_t size, std::int64_t end,
                        bool may_be_empty) {
    if (offsets.empty() || offsets.front() != 0 || offsets.back() != end)
      cadt::fuzz::fail("offsets without their ends");
    if (size != 0 && offsets.size() != size + 1) cadt::fuzz::fail("offsets are missing");
    for (std::size_t i = 1; i < offsets.size(); ++i)
      if (offsets[i - 1] + (may_be_empty ? 0 : 1) > offsets[i]) cadt::fuzz::fail("a polygon without rings");
  };
  check(file.ring_offsets, 0, static_cast<std::int64_t>(file.xy.size() / 2), true);
  check(file.polygon_offsets, file.size(), static_cast<std::int64_t>(file.ring_offsets.size()) - 1, false);
  for (const std::int32_t feature : file.features)
    if (feature < 0 || static_cast<std::size_t>(feature) >= file.number_of_features)
      cadt::fuzz::fail("a feature out of range");
}

void check_labels(const cadt::io::LabelImage& image) {
  if (image.width == 0 || image.height == 0 || image.labels.size() != image.width * image.height)
    cadt::fuzz::fail("labels are missing");
  for (const std::int32_t label : image.labels)
    if (label < 0 || label > 0xffffff) cadt::fuzz::fail("a label that no pixel has");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static cadt::fuzz::Counter files("files");
  static const std::vector<std::string> all = formats();
  static const char* const fixed = std::getenv("CADT_FUZZ_FORMAT");
  std::string format = fixed != nullptr ? fixed : "";
  if (fixed == nullptr) {
    if (size == 0) return 0;
    format = all[data[0] % all.size()];
    ++data, --size;
  }
  files += 1;
  const Memory file(data, size);
  const std::string kind = format.substr(0, format.find(':')), name = format.substr(format.find(':') + 1);
  try {
    if (kind == "points") {
      cadt::io::ReadOptions options;
      options.format = name;
      check_points(cadt::io::read_points(file.path(), options));
    } else if (kind == "values") {
      check_values(cadt::io::read_values(file.path(), name));
    } else if (kind == "segments") {
      check_segments(cadt::io::read_segments(file.path(), name));
    } else if (kind == "polygons") {
      check_polygons(cadt::io::read_polygons(file.path(), name));
    } else if (kind == "labels") {
      check_labels(cadt::io::read_label_image(file.path()));
    } else {
      const std::size_t points = 8 + size % 2;  // of the nine that the corpus has: an index may be one too high
      check_mesh(cadt::io::read_mesh(file.path(), points, name), points);
    }
  } catch (const cadt::io::FileError&) {
    // what a reader may say
  }
  return 0;
}
