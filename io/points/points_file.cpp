// SPDX-License-Identifier: Apache-2.0
// Choice of the reader and writer of point files.
#include "io/points/readers.hpp"

#include <cadt/io/points_file.hpp>

namespace cadt::io {
namespace {

using namespace detail;

bool is_table(const std::string& format) {
  return format == "xy" || format == "txt" || format == "csv" || format == "xyz";
}

PointSet read_as(const std::string& format, const InputFile& file, const ReadOptions& options) {
  if (is_table(format)) return read_table(file, options);
  if (!options.columns.empty())
    throw FileError(file.name(), 0, "columns can be chosen in tables only, not in " + format);
  if (format == "node") return read_node(file, options);
  if (format == "ply") return read_ply_points(file, options);
  if (format == "obj") return read_obj_points(file, options);
  if (format == "off") return read_off_points(file, options);
  if (format == "npy") return read_npy(file, options);
  return read_raw(file, options, format == "f32" ? sizeof(float) : sizeof(double));
}

}  // namespace

std::vector<std::string> point_read_formats() {
  return {"xy", "txt", "csv", "xyz", "node", "ply", "obj", "off", "npy", "f64", "f32"};
}

std::vector<std::string> point_write_formats() {
  return {"xy", "txt", "csv", "xyz", "node", "ply", "npy", "f64", "f32"};
}

PointSet read_points(const std::string& path, const ReadOptions& options) {
  const std::string format = choose_format(path == "-" ? "<stdin>" : path, options.format, point_read_formats());
  const InputFile file(path);
  if (file.bytes().empty()) throw FileError(file.name(), 0, "is empty");
  PointSet points = read_as(format, file, options);
  if (points.size() == 0) throw FileError(file.name(), 0, "has no points");
  points.format = format;
  return points;
}

void write_points(const std::string& path, const PointSet& points, const std::string& asked) {
  const std::string format = choose_format(path == "-" ? "<stdout>" : path, asked, point_write_formats());
  if (points.xy.size() % 2 != 0 || (!points.height.empty() && points.height.size() != points.size())) {
    throw FileError(path, 0, "the coordinates and heights to be written differ in number");
  }
  AtomicFile out(path);
  if (is_table(format)) {
    write_table(out, points.xy, points.height, format);
  } else if (format == "node") {
    write_node(out, node_columns(points.xy, points.height), 0);
  } else if (format == "ply") {
    write_ply_points(out, points.xy, points.height);
  } else if (format == "npy") {
    write_npy(out, points.xy, points.height);
  } else {
    write_raw(out, path, points.xy, format == "f32" ? sizeof(float) : sizeof(double));
  }
  out.commit();
}

}  // namespace cadt::io
