// SPDX-License-Identifier: Apache-2.0
// Independent verification of a mesh against its points. It shares no predicate with what triangulates points, and
// segments that do not cross. docs/constrained.md says what it shares with exact crossings, grids and seeds.
#pragma once

#include <cadt/export.hpp>
#include <cadt/points.hpp>
#include <cadt/triangulation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt {

/// Outcome of one check of `verify`.
struct Check {
  std::string name;  ///< "counts", "range", "neighbors", "orientation", "vertices", "boundary", "euler", "hull",
                     ///< "delaunay", "ties"
  bool passed = false;
  std::uint64_t failures = 0;
  std::int64_t first = -1;  ///< first failing triangle, point or edge (3 * triangle + k), as `what` says
  std::string what;         ///< what failed; empty if passed
};

struct CADT_API VerifyReport {
  bool ok = false;
  std::vector<Check> checks;
  std::uint64_t points = 0, triangles_examined = 0, edges_examined = 0, hull_vertices = 0;
  std::uint64_t ties = 0;          ///< interior edges whose four points are cocircular
  std::uint64_t unusual_ties = 0;  ///< of these, not decided as cadt and CGAL decide them
  /// verify_on_device only: how the signs of all triangles and interior edges were decided: by its filter, by exact
  /// sums on the device, or by the exact predicates of `verify` on the host.
  std::uint64_t signs_filtered = 0, signs_exact = 0, signs_on_host = 0;
  /// One line: "ok: 945 triangles, ..." or the first failure.
  [[nodiscard]] std::string summary() const;
};

/// A mesh from any program; views of the caller's arrays. Only `triangles` is required; empty spans are derived
/// (neighbours) or not compared.
struct MeshView {
  std::span<const std::int32_t> triangles;  ///< n x 3, counterclockwise, 0-based
  std::span<const std::int32_t> neighbors;  ///< n x 3; the k-th is opposite vertex k, -1 outside
  std::span<const std::int32_t> hull;       ///< counterclockwise loop
  std::span<const Duplicate> duplicates;
  bool has_duplicates = false;  ///< compare `duplicates` with the points; otherwise derive them
  /// One a triangle, bit k: edge k (opposite vertex k) is constrained. It need not be Delaunay, and the triangle across
  /// must say so as well.
  std::span<const std::uint32_t> edge_flags = {};
};

struct VerifyOptions {
  unsigned threads = 0;        ///< 0: all cores
  bool canonical_ties = true;  ///< ties must be decided as cadt and CGAL decide them
};

/// Checks structure, orientation, symmetry of neighbours, Euler's formula, the hull, that every input point is a vertex
/// or equals one, and the exact empty-circle property of every interior edge that is not constrained, which implies
/// that of the whole triangulation if none is (Delaunay's lemma). O(triangles) expected; exact arithmetic only where a
/// filter does not decide. A wrong mesh is reported, not thrown. Thread-safe. \throws InputError for NaN or infinity,
/// Error if the floating-point mode is not IEEE 754
[[nodiscard]] CADT_API VerifyReport verify(PointsView points, const MeshView& mesh, const VerifyOptions& options = {});
[[nodiscard]] CADT_API VerifyReport verify(PointsView points, const Triangulation& mesh,
                                           const VerifyOptions& options = {});

/// The same checks, with the same names and outcomes, on a device: 20 bytes a point and 24 a triangle are uploaded. Its
/// predicates differ from the builder's in code, formula and arithmetic; the few signs that they cannot decide are left
/// to those of `verify`, as are the boundary and meshes without triangles. Missing neighbours are derived on the host
/// first. On a device without double precision `verify` does all the work. `device` says where: backend, device,
/// threads, max_memory, stop, progress (phase "verify"), tuning.work_group_size and tuning.grain are as for
/// `triangulate`; memory is asked for step by step (Options::max_memory).
///
/// Throws InputError (NaN or infinity, with the index of the first), BackendUnavailable, OutOfMemory, DeviceError,
/// KernelBuildError, Cancelled.
[[nodiscard]] CADT_API VerifyReport verify_on_device(PointsView points, const MeshView& mesh, const Options& device,
                                                     const VerifyOptions& options = {});
[[nodiscard]] CADT_API VerifyReport verify_on_device(PointsView points, const Triangulation& mesh,
                                                     const Options& device, const VerifyOptions& options = {});

/// The predicates of the verifier of the host, exact for all finite doubles, for those who check more than `verify`
/// does. They share no code with what triangulates points, and segments that do not cross. Thread-safe; a filter
/// decides most in some nanoseconds. The thread must round to nearest and keep subnormal numbers, as threads do unless
/// the program changes it (-ffast-math may): else signs may be wrong, and these functions do not look.
///
/// Sign of the area of the triangle abc: 1 if counterclockwise, 0 if the points are on a line, else -1.
[[nodiscard]] CADT_API int exact_orientation(const std::array<double, 2>& a, const std::array<double, 2>& b,
                                             const std::array<double, 2>& c) noexcept;
/// 1 if d lies inside the circle of the counterclockwise triangle abc, 0 if on it, else -1.
[[nodiscard]] CADT_API int exact_in_circle(const std::array<double, 2>& a, const std::array<double, 2>& b,
                                           const std::array<double, 2>& c, const std::array<double, 2>& d) noexcept;
/// The side of d for cocircular points, as cadt and CGAL decide it: 1 or -1 for distinct points.
[[nodiscard]] CADT_API int exact_in_circle_of_tie(const std::array<double, 2>& a, const std::array<double, 2>& b,
                                                  const std::array<double, 2>& c,
                                                  const std::array<double, 2>& d) noexcept;

}  // namespace cadt
