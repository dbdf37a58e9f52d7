// SPDX-License-Identifier: Apache-2.0
// Points with segments between them as the program reads them, and the options that say what is made of them.
#pragma once

#include "input.hpp"

#include <cadt/constrained.hpp>
#include <cadt/io/points_file.hpp>
#include <cadt/io/segments_file.hpp>

#include <CLI/CLI.hpp>

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::cli {

struct SegmentOptions {
  std::string file, domain, crossing;
};

/// Adds --crossing.
void add_crossing_option(CLI::App& command, SegmentOptions& options);
/// Adds --segments.
void add_segments_option(CLI::App& command, SegmentOptions& options);
/// Adds --segments, --domain and --crossing.
void add_segment_options(CLI::App& command, SegmentOptions& options);

/// Whether there are segments: by the format of the input (-f or the suffix), or of --segments. Throws Failure (usage)
/// for options that do not fit together.
[[nodiscard]] bool has_segments(const InputOptions& input, const SegmentOptions& options);

struct Graph {
  io::PointSet points;
  std::vector<Segment> segments;
  std::vector<std::array<double, 2>> holes;
  std::vector<Region> regions;
  std::string crs = {};        ///< reference system of a GeoJSON file
  bool some_heights = false;   ///< as in io::SegmentsFile
  std::size_t own_points = 0;  ///< of the input; those of --segments follow
};

/// The files that points and segments are read from, for messages.
[[nodiscard]] std::string name_of(const InputOptions& input, const SegmentOptions& options);
/// A note that heights are left out, since the file has none, or has none at some points.
void note_no_heights(const std::string& name, bool some);

/// A note if the file has holes that --domain leaves out of account.
void note_holes(const Graph& graph, const SegmentOptions& options);

/// A warning if holes or regions are outside of the points' extent, where they do nothing: most often they are
/// misplaced.
void note_far_seeds(PointsView points, const ConstrainedTriangulation& mesh,
                    std::span<const std::array<double, 2>> holes, std::span<const Region> regions,
                    const std::string& name);

/// A note if points of --segments, those from `own_points` on, have other heights than those of the input at the same
/// places, which count.
void note_other_heights(const io::PointSet& points, std::size_t own_points, const Triangulation& mesh,
                        const std::string& name);

/// What the library is told, with what the file says of seeds. Throws Failure (usage).
[[nodiscard]] ConstraintOptions constraint_options(const SegmentOptions& options, const Graph& graph = {});

/// The points of a file with its segments.
[[nodiscard]] Graph graph_of(io::SegmentsFile file);

/// Reads the input, and the file of --segments, whose points come behind those of the input unless they are the same.
/// Notes go to standard error unless `quiet`. \pre has_segments()
[[nodiscard]] Graph read_graph(const InputOptions& input, const SegmentOptions& options, bool quiet);

/// How many pairs of segments cross, `how` they do, and the first of them with their ends, counted from 0; to be
/// followed by what can be done.
[[nodiscard]] std::string name_crossings(const CrossingError& error, std::string_view how, PointsView points,
                                         std::span<const Segment> segments);

/// Triangulates. Segments that cross, or bound no domain, are a Failure that names the file, them and what can be done.
[[nodiscard]] ConstrainedTriangulation triangulate_graph(PointsView points, std::span<const Segment> segments,
                                                         const std::string& name, const ConstraintOptions& constraints,
                                                         const Options& options);

/// The same for errors that are caught: CrossingError, DomainError and InputError; others are thrown on.
[[nodiscard]] std::string explain_graph_error(PointsView points, std::span<const Segment> segments);

/// All points of the mesh: as they are in the file or where they have moved, and those that were added.
/// `height`: empty or one a point; added points are given those along the first of their segments.
[[nodiscard]] io::PointSet points_of(const Graph& graph, const ConstrainedTriangulation& mesh);

/// A note if rounding the added points has turned triangles over.
void note_rounding(const ConstrainedTriangulation& mesh, const std::string& name, bool quiet);

}  // namespace cadt::cli
