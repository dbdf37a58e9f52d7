// SPDX-License-Identifier: Apache-2.0
// Where points come from, and what becomes of them on a thread of their own. No window, no OpenGL.
#pragma once

#include <cadt/io/generate.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/queries.hpp>
#include <cadt/triangulator.hpp>

#include "viewer/window/work.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace cadt::viewer {

/// A file, or a set of io::generate.
struct Source {
  std::string path;  ///< empty: generated
  io::ReadOptions read;
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

struct Loaded {
  Source source;
  io::PointSet points;
  std::vector<float> heights;         ///< one a point, or none
  std::optional<Triangulation> mesh;  ///< empty: the points alone, the mesh is made in OpenGL's buffers
  Statistics statistics;
  DeviceInfo device;
  double read_milliseconds = 0, mesh_milliseconds = 0;
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

/// Reads or generates, then triangulates if `triangulators` is not null. \throws as those
[[nodiscard]] std::shared_ptr<Loaded> load(const Source& source, const Options& options, Triangulators* triangulators,
                                           std::size_t available, Work::Desk& desk);

}  // namespace cadt::viewer
