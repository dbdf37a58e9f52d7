// SPDX-License-Identifier: Apache-2.0
// What all kinds of interop have in common. Private to this folder.
#pragma once

#include <cadt/triangulator.hpp>

#include "viewer/draw/mesh_buffers.hpp"

#include <memory>
#include <string>

namespace cadt::viewer {

/// An open triangulator that reads and writes OpenGL's buffers.
class MeshInterop {
 public:
  virtual ~MeshInterop() = default;
  [[nodiscard]] virtual Triangulator& triangulator() noexcept = 0;
  /// Triangulates into `mesh.triangles`; returns the number of triangles. With `statistics` the work is counted.
  virtual std::size_t triangulate(MeshBuffers& mesh, Statistics* statistics) = 0;
  /// What is slower than it could be, and why; empty if nothing.
  [[nodiscard]] virtual std::string note() const { return {}; }
};

/// Each is null where it is not possible; `reason` then says why, in half a sentence. Errors of an open device are
/// thrown.
[[nodiscard]] std::unique_ptr<MeshInterop> open_cuda(const Options& options, std::string& reason);
[[nodiscard]] std::unique_ptr<MeshInterop> open_opencl(const Options& options, std::string& reason);
/// Always possible.
[[nodiscard]] std::unique_ptr<MeshInterop> open_copy(const Options& options);

/// Does Options::device mean this device? As the library reads it: a number, or a part of the name or platform.
[[nodiscard]] bool is_named(const DeviceInfo& info, const std::string& device);
/// What draws the current context, as its driver calls it.
[[nodiscard]] std::string name_of_display();

/// Sets the detail of the statistics for one call.
class Detail {
 public:
  Detail(Options& options, bool counted) : options_(options), before_(options.statistics) {
    options_.statistics = counted ? StatisticsDetail::counters : StatisticsDetail::none;
  }
  ~Detail() { options_.statistics = before_; }
  Detail(const Detail&) = delete;
  Detail& operator=(const Detail&) = delete;

 private:
  Options& options_;
  StatisticsDetail before_;
};

}  // namespace cadt::viewer
