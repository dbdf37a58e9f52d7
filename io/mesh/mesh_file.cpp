// SPDX-License-Identifier: Apache-2.0
// Choice of the reader and writer of mesh files.
#include "io/mesh/mesh_parts.hpp"
#include "io/points/readers.hpp"
#include "io/support/number_format.hpp"

#include <algorithm>

namespace cadt::io {

std::vector<std::string> mesh_write_formats() {
  return {"node", "ele", "neigh", "obj", "off", "ply", "vtu", "glb", "npz", "svg", "pdf", "png"};
}

std::vector<std::string> mesh_read_formats() { return {"ele", "obj", "off", "ply", "vtu", "npz"}; }

MeshFile read_mesh(const std::string& path, std::size_t number_of_points, const std::string& asked, int base) {
  const std::string format = detail::choose_format(path == "-" ? "<stdin>" : path, asked, mesh_read_formats());
  const detail::InputFile file(path);
  if (base < -1 || base > 1) throw FileError(file.name(), 0, "the first index can be 0 or 1");
  if (file.bytes().empty()) throw FileError(file.name(), 0, "is empty");
  if (format == "ele") return detail::read_ele(file, path, number_of_points, base);
  if (format == "obj") return detail::read_obj_mesh(file, number_of_points);
  if (format == "off") return detail::read_off_mesh(file, number_of_points);
  if (format == "ply") return detail::read_ply_mesh(file, number_of_points);
  if (format == "vtu") return detail::read_vtu(file, number_of_points);
  return detail::read_npz(file, number_of_points);
}

namespace detail {

std::string mesh_write_format(const std::string& path, const WriteOptions& options) {
  return choose_format(path == "-" ? "<stdout>" : path, options.format, mesh_write_formats());
}

void write_mesh_parts(const std::string& path, const MeshParts& mesh, const WriteOptions& options) {
  const std::string format = mesh_write_format(path, options);
  if (options.base != 0 && options.base != 1) throw FileError(path, 0, "the first index can be 0 or 1");
  if (mesh.xy.size() % 2 != 0 || (!mesh.height.empty() && 2 * mesh.height.size() != mesh.xy.size())) {
    throw FileError(path, 0, "the coordinates and heights to be written differ in number");
  }
  AtomicFile out(path);
  if (format == "node") {
    write_node(out, node_columns(mesh.xy, mesh.height), options.base);
  } else if (format == "ele") {
    write_ele(out, mesh.triangles, options.base, !mesh.region.empty(),
              std::vector<double>(mesh.region.begin(), mesh.region.end()));
  } else if (format == "neigh") {
    write_neigh(out, mesh.neighbors, options.base);
  } else if (format == "obj") {
    write_obj(out, mesh);
  } else if (format == "off") {
    write_off(out, mesh);
  } else if (format == "ply") {
    write_ply(out, mesh, options.ascii);
  } else if (format == "vtu") {
    write_vtu(out, mesh);
  } else if (format == "glb") {
    write_glb(out, path, mesh);
  } else if (format == "npz") {
    write_npz(out, mesh);
  } else {
    throw FileError(path, 0, "'" + format + "' is a picture, not a mesh");
  }
  out.commit();
}

void write_vertex_rows(AtomicFile& out, const MeshParts& mesh, std::string_view prefix) {
  for (std::size_t i = 0; 2 * i < mesh.xy.size(); ++i) {
    char* at = std::ranges::copy(prefix, out.room(4 * number_room)).out;
    at = put(at, mesh.xy[2 * i]);
    *at++ = ' ';
    at = put(at, mesh.xy[2 * i + 1]);
    *at++ = ' ';
    at = put(at, mesh.height.empty() ? 0.0 : mesh.height[i]);
    *at++ = '\n';
    out.advance(at);
  }
}

char* put_corners(char* at, const std::int32_t* corners, std::int64_t base) {
  for (std::size_t k = 0; k < 3; ++k) {
    *at++ = ' ';
    at = put(at, corners[k] + base);
  }
  return at;
}

std::string TriangleCollector::refusal(std::int64_t index) const {
  return "index " + std::to_string(index) + " is out of range: the " + std::to_string(points_) + " points count from " +
         std::to_string(base_);
}

std::string not_a_triangle(std::size_t corners) {
  return "a face has " + std::to_string(corners) + " corners; only triangles can be read";
}

}  // namespace detail
}  // namespace cadt::io
