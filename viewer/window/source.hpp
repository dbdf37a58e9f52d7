// SPDX-License-Identifier: Apache-2.0
// Where points come from, and what becomes of them on a thread of their own. No window, no OpenGL.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/io/generate.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/queries.hpp>
#include <cadt/triangulator.hpp>

#include "io/picture/scene.hpp"
#include "viewer/window/work.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace cadt::viewer {

/// Points with segments, triangulated. The points are all that the mesh has.
struct Constrained {
  io::PointSet points;
  ConstrainedTriangulation mesh;
};

/// A file, or a set of io::generate.
struct Source {
  std::string path;  ///< empty: generated
  io::ReadOptions read;
  /// Reads a file with segments and triangulates, on the thread that loads; null where there are none.
  std::function<Constrained(const Options&)> constrain;
  std::string distribution = "uniform";
  io::GenerateOptions generate;

  [[nodiscard]] bool is_file() const noexcept { return !path.empty(); }
  /// "terrain.xyz", "uniform".
  [[nodiscard]] std::string name() const;
  /// For names of pictures: "terrain", "uniform-1000".
  [[nodiscard]] std::string stem() const;
  /// Whether it is the same file, or the same set.
  friend bool operator==(const Source& a, const Source& b) {
    return a.path == b.path && a.distribution == b.distribution && a.generate.n == b.generate.n &&
           a.generate.seed == b.generate.seed;
  }
};

/// What is drawn of a mesh with segments.
struct Inside {
  std::vector<std::int32_t> triangles, neighbors;  ///< of the triangles inside, numbered among themselves
  std::vector<std::int32_t> region;                ///< one a triangle
  std::vector<Segment> edges;                      ///< those that are constrained
};
[[nodiscard]] Inside inside_of(const ConstrainedTriangulation& mesh);

struct Loaded {
  Source source;
  io::PointSet points;
  std::vector<float> heights;         ///< one a point, or none
  std::optional<Triangulation> mesh;  ///< empty: the points alone, the mesh is made in OpenGL's buffers
  std::optional<Inside> inside;       ///< empty: all of the mesh is drawn, and no edge is constrained
  Statistics statistics;
  DeviceInfo device;
  double read_milliseconds = 0, mesh_milliseconds = 0;

  /// Of the triangles that are drawn. \pre mesh
  [[nodiscard]] std::span<const std::int32_t> triangles() const;
  [[nodiscard]] std::span<const std::int32_t> neighbors() const;
  [[nodiscard]] io::picture::Scene scene() const;
};

/// Keeps a device open from one call to the next, while the options name the same one.
class Triangulators {
 public:
  /// The call's options are set. \throws as Triangulator
  Triangulator& open(const Options& options);
  void close() { open_.reset(); }

 private:
  std::optional<Triangulator> open_;
  Options of_;
};

/// What one has to know before any memory is taken. `available`: bytes of the host's memory that are free, 0: not
/// known. \throws LimitError, OutOfMemory
void check_room(std::size_t points, std::size_t bytes_of_mesh, std::size_t available);

/// Bytes of the host that so many points take before they are triangulated, and that OpenGL's buffers take beside.
[[nodiscard]] std::size_t bytes_of_points(std::size_t points) noexcept;

/// Reads or generates, then triangulates if `triangulators` is not null or there are segments. \throws as those
[[nodiscard]] std::shared_ptr<Loaded> load(const Source& source, const Options& options, Triangulators* triangulators,
                                           std::size_t available, Work::Desk& desk);

}  // namespace cadt::viewer
