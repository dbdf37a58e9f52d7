// SPDX-License-Identifier: Apache-2.0
// The readers of files: whatever the bytes are, points that keep what the interface promises, or a FileError.
// CADT_FUZZ_FORMAT names the format, e.g. points:csv or mesh:ply; without it the first byte of the input does.
#include <sys/mman.h>
#include <unistd.h>

#include <cadt/io/mesh_file.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/io/query_files.hpp>
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
    } else {
      const std::size_t points = 8 + size % 2;  // of the nine that the corpus has: an index may be one too high
      check_mesh(cadt::io::read_mesh(file.path(), points, name), points);
    }
  } catch (const cadt::io::FileError&) {
    // what a reader may say
  }
  return 0;
}
