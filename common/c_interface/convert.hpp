// SPDX-License-Identifier: Apache-2.0
// Options, points and results between C and C++.
#pragma once

#include <cadt/cadt.hpp>

#include <span>

#include "common/c_interface/guard.hpp"

namespace cadt::c_interface {

/// \throws InvalidArgument if there is no constant of this number
template <class Enum>
[[nodiscard]] Enum constant(std::int32_t number, std::int32_t most, const char* name) {
  if (number < 0 || number > most)
    throw InvalidArgument(name, "there is no constant of the number " + std::to_string(number));
  return static_cast<Enum>(number);
}

/// The caller's options, and the callbacks that are asked during a call.
class CallOptions {
 public:
  /// `from` may be null. \throws InvalidArgument
  explicit CallOptions(const cadt_options* from);
  /// For one call: nothing is cancelled at its beginning.
  [[nodiscard]] Options begin_call() const;

 private:
  Options options_;
  cadt_options callbacks_{};
};

/// \throws InvalidArgument
[[nodiscard]] PointsView points_of(const cadt_points* points);
[[nodiscard]] DevicePoints points_of(const cadt_device_points* points);
[[nodiscard]] std::span<const std::size_t> offsets_of(const std::size_t* offsets, std::size_t sets);
/// Three a triangle. \throws LimitError
[[nodiscard]] std::size_t indices_of(std::size_t triangles);
[[nodiscard]] KeepPoints keep_points_of(std::int32_t number);

void give_statistics(const Statistics& from, cadt_statistics* to);
void give_device(const DeviceInfo& from, cadt_device_info* to);
[[nodiscard]] const cadt_duplicate* list_of(std::span<const Duplicate> duplicates) noexcept;

}  // namespace cadt::c_interface

// The handles.
struct cadt_triangulation {
  cadt::Triangulation mesh;
};
struct cadt_triangulator {
  explicit cadt_triangulator(const cadt_options* given) : options(given), triangulator(options.begin_call()) {}
  /// Its callbacks are asked from here on.
  cadt::Triangulator& begin_call();
  cadt::c_interface::CallOptions options;
  cadt::Triangulator triangulator;
};
struct cadt_device_triangulation {
  cadt::DeviceTriangulation mesh;
};
struct cadt_batch {
  cadt::TriangulationBatch batch;
};
struct cadt_device_batch {
  cadt::DeviceTriangulationBatch batch;
};
struct cadt_device_list {
  std::vector<cadt::DeviceInfo> devices;
};
struct cadt_queries {
  /// Its callbacks are asked from here on; what was cancelled before is forgotten.
  cadt::MeshQueries& begin_call() {
    cadt::Options now = options.begin_call();
    queries.options().stop = std::move(now.stop);
    queries.options().progress = std::move(now.progress);
    return queries;
  }
  cadt::c_interface::CallOptions options;
  cadt::MeshQueries queries;
};
struct cadt_report {
  explicit cadt_report(cadt::VerifyReport found) : report(std::move(found)), summary(report.summary()) {}
  cadt::VerifyReport report;
  std::string summary;
};
