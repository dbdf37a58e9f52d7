// SPDX-License-Identifier: Apache-2.0
#include "bench/kernel_bytes.hpp"

#include <algorithm>
#include <bit>

namespace cadt::bench {
namespace {

// Bytes: a point 16, a locked triangle 32, a star 24, a triangle of a mesh in arrays 24; keys, places, input ids,
// ranks, vertex_to_triangle and flags 4 each, marks 2.
constexpr KernelBytes table[] = {
    {"cadt_import_doubles", Unit::point, 16, 16, "points"},
    {"cadt_bounds", Unit::point, 16, 0, "points"},
    {"cadt_hilbert_keys", Unit::point, 16, 4, "points; keys; once: the tiles may keep them"},
    {"cadt_identity", Unit::point, 0, 4, "places"},
    {"sort", Unit::pass, 8, 8, "keys and places"},
    {"cadt_radix_count", Unit::pass, 4, 0, "keys"},
    {"cadt_radix_scatter", Unit::pass, 4, 8, "keys; keys and places"},
    {"cadt_radix_scatter", Unit::later_pass, 4, 0, "places"},
    {"scan", Unit::slot, 4, 4, "flags of triangles; ranks"},
    {"scan", Unit::starred, 12, 12, "tiles, owned triangles, unproven vertices"},
    {"cadt_scan_sums", Unit::slot, 4, 0, "flags of triangles"},
    {"cadt_scan_sums", Unit::starred, 12, 0, "tiles, owned triangles, unproven vertices"},
    {"cadt_scan_apply", Unit::slot, 4, 4, "flags of triangles; ranks"},
    {"cadt_scan_apply", Unit::starred, 12, 12, "tiles, owned triangles, unproven vertices"},
    {"cadt_flag_overfull", Unit::point, 4, 4, "keys; flags"},
    {"cadt_gather_points", Unit::point, 20, 16, "places and points; points in order"},
    {"cadt_sort_runs", Unit::point, 4, 0, "keys"},
    {"cadt_unique_flags", Unit::point, 4, 4, "keys; flags"},
    {"cadt_unique_pack", Unit::point, 4, 0, "ranks"},
    {"cadt_unique_pack", Unit::distinct, 20, 20, "points and input ids"},
    {"cadt_insert", Unit::inserted, 48, 100,
     "the point and its triangle; the three that replace it, vertex_to_triangle"},
    {"cadt_legality_sweep", Unit::swept_slot, 40, 0, "locked triangles, and their points: one for two of them"},
    {"cadt_tile_flags", Unit::starred, 4, 4, "keys; flags"},
    {"cadt_tile_pack", Unit::starred, 4, 0, "ranks"},
    {"cadt_prove_stars", Unit::starred, 16, 4, "points; sizes"},
    {"cadt_prove_stars", Unit::proven, 0, 28, "stars, where they begin"},
    {"cadt_pack_proven", Unit::starred, 4, 0, "sizes"},
    {"cadt_star_counts", Unit::starred, 4, 10, "sizes; marks, owned triangles, unproven vertices"},
    {"cadt_star_counts", Unit::proven, 28, 0, "stars, where they begin"},
    {"cadt_star_half_edges", Unit::starred, 6, 0, "marks, first numbers"},
    {"cadt_star_half_edges", Unit::proven, 28, 24, "stars, where they begin; two triangles for each"},
    {"cadt_star_vertices", Unit::starred, 2, 0, "marks"},
    {"cadt_star_vertices", Unit::proven, 28, 24, "stars, where they begin; two triangles for each"},
    {"cadt_pack_residual", Unit::starred, 4, 0, "ranks"},
    {"cadt_pack_residual", Unit::unproven, 16, 20, "points; points and places"},
    {"cadt_certify", Unit::starred, 64, 0, "two triangles and a point for each"},
    {"cadt_flag_triangles", Unit::slot, 32, 4, "locked triangles; flags"},
    {"cadt_drop_locks", Unit::slot, 36, 0, "locked triangles and ranks"},
    {"cadt_drop_locks", Unit::distinct, 4, 0, "input ids"},
    {"cadt_drop_locks", Unit::triangle, 0, 24, "vertices and neighbours"},
    {"cadt_count_triangles", Unit::triangle, 12, 0, "vertices"},
    {"cadt_count_triangles", Unit::distinct, 8, 4, "input ids and buckets; buckets"},
    {"cadt_sizes_by_input", Unit::distinct, 8, 4, "buckets and input ids; their sizes by input id"},
    {"cadt_bucket_triangles", Unit::triangle, 12, 8, "vertices; members"},
    {"cadt_bucket_triangles", Unit::distinct, 8, 4, "input ids and buckets; buckets"},
    {"cadt_number_buckets", Unit::distinct, 12, 0, "buckets, input ids, places"},
    {"cadt_number_buckets", Unit::triangle, 8, 4, "members; numbers"},
    {"cadt_write_triangles", Unit::distinct, 4, 0, "input ids"},
    {"cadt_write_triangles", Unit::triangle, 28, 24, "numbers, vertices and neighbours; the same"},
    {"cadt_write_numbered", Unit::distinct, 4, 0, "input ids"},
    {"cadt_write_numbered", Unit::triangle, 32, 24, "numbers twice, vertices and neighbours; the same"},
    {"cadt_boundary_edges", Unit::triangle, 12, 0, "neighbours"},
};

/// As choose_grid of common/points/key_grid.cpp, for a bounding box that is about as wide as high.
std::uint64_t sort_passes(std::uint64_t points) noexcept {
  const int bits = std::clamp(static_cast<int>(std::bit_width(points)) + 4, 4, 32);
  return static_cast<std::uint64_t>((bits + 7) / 8);
}

std::uint64_t units(Unit unit, const Statistics& run, std::uint64_t triangles) noexcept {
  const bool stars = run.proven_stars != 0;
  switch (unit) {
    case Unit::point:
      return run.points;
    case Unit::distinct:
      return run.distinct;
    case Unit::inserted:
      return run.splits + run.edge_splits;
    case Unit::proven:
      return run.proven_stars;
    case Unit::unproven:
      return stars ? run.distinct - run.proven_stars : 0;
    case Unit::starred:
      return stars ? run.distinct : 0;
    case Unit::slot:
      return stars ? 0 : 2 * run.distinct;  // meshes from stars are in arrays
    case Unit::swept_slot:
      return 2 * (stars ? run.distinct - run.proven_stars : run.distinct) * run.legality_sweeps;
    case Unit::triangle:
      return triangles;
    case Unit::pass:
      return run.points * sort_passes(run.points);
    case Unit::later_pass:
      return run.points * (sort_passes(run.points) - 1);
  }
  return 0;
}

}  // namespace

std::span<const KernelBytes> kernel_bytes() noexcept { return table; }

std::optional<std::uint64_t> least_bytes(std::string_view kernel, const Statistics& run, std::uint64_t triangles) {
  std::optional<std::uint64_t> sum;
  for (const KernelBytes& line : table) {
    if (line.kernel != kernel) continue;
    sum = sum.value_or(0) + std::uint64_t{line.read + line.written} * units(line.unit, run, triangles);
  }
  return sum;
}

}  // namespace cadt::bench
