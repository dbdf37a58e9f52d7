// SPDX-License-Identifier: Apache-2.0
// What the commands that draw share: whose mesh, and how it looks.
#pragma once

#include "graph.hpp"
#include "input.hpp"
#include "progress.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/style.hpp"
#include "viewer/still/still.hpp"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace cadt::cli {

/// A file with points, and with segments or not, or a point set of cadt generate.
struct SubjectOptions {
  InputOptions input;
  SegmentOptions segments;
  std::string generate, n = "10000";
  io::GenerateOptions generator;
};
/// Adds the positional IN with its options, --generate, -n and --seed, --segments, --domain and --crossing.
void add_subject_options(CLI::App& command, SubjectOptions& options);
/// Whether there are segments. Throws Failure (usage) unless there is one of file and point set, and for options that
/// do not fit together.
[[nodiscard]] bool has_segments(const SubjectOptions& options);
/// \pre not has_segments()
[[nodiscard]] io::PointSet read_subject(const SubjectOptions& options, ProgressLine& line);
/// A point that the library refuses is an error of the file.
[[nodiscard]] Triangulation triangulate_subject(const SubjectOptions& subject, const io::PointSet& points,
                                                const Options& options);
/// Throws Failure for a point that the library refuses.
[[noreturn]] void refuse_points(const SubjectOptions& subject, const InputError& error);
/// "terrain.xyz", or "uniform" for a generated set.
[[nodiscard]] std::string name_of(const SubjectOptions& options);

struct StyleOptions {
  std::string colour, style = "filled";
  bool dark = false, no_hull = false;
};
/// Adds --colour, --style, --no-hull and --dark.
void add_style_options(CLI::App& command, StyleOptions& options);
/// All but the colour.
[[nodiscard]] viewer::Style style_of(const StyleOptions& options);
enum class MeshKind { points, segments, growing };
/// Not set without --colour. Throws Failure (usage) for a colour that such a mesh does not have.
[[nodiscard]] std::optional<viewer::ColourBy> colour_of(const StyleOptions& options, const io::PointSet& points,
                                                        MeshKind kind);

/// "1600" or "3840x2160"; nothing changes if empty. A width that is given is not limited by the usual `most_height`.
/// Throws Failure (usage).
void parse_size(const std::string& text, int& width, int& height, int& most_height);
/// "x,y,magnification"; not set if empty. Throws Failure (usage).
[[nodiscard]] std::optional<viewer::View> parse_camera(const std::string& text);
/// Throws Failure (usage) for a magnification that the camera does not reach there.
void aim_camera(viewer::Camera& camera, const viewer::View& view);

}  // namespace cadt::cli
