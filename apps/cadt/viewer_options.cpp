// SPDX-License-Identifier: Apache-2.0
#include "viewer_options.hpp"

#include "failure.hpp"
#include "generated_set.hpp"
#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace cadt::cli {
namespace {

constexpr int largest_side = 16384;

}  // namespace

void add_subject_options(CLI::App& command, SubjectOptions& options) {
  add_input_options(command, options.input, "IN", "file with points, or with points and segments", true);
  command.get_option("IN")->required(false);
  add_generated_set(command, options.generate, options.n, options.generator.seed);
  add_segment_options(command, options.segments);
}

std::string name_of(const SubjectOptions& options) {
  return options.generate.empty() ? name_of(options.input, options.segments) : options.generate;
}

bool has_segments(const SubjectOptions& options) {
  if (options.generate.empty() == options.input.path.empty())
    throw Failure(exit_usage, "name a file with points, or a point set with --generate, and not both");
  const bool segments = has_segments(options.input, options.segments);
  if (segments && !options.generate.empty())
    throw Failure(exit_usage, "--segments is for a file of points, not for --generate: leave one of them out");
  return segments;
}

io::PointSet read_subject(const SubjectOptions& options, ProgressLine& line) {
  if (options.generate.empty()) {
    line.step(fmt::format("reading {}", name_of(options)));
    return read_input(options.input);
  }
  require_point_set(options.generate);
  io::GenerateOptions generator = options.generator;
  generator.n = parse_count(options.n);
  if (generator.n > max_points())
    throw Failure(exit_usage, fmt::format("-n {}: a triangulation takes at most {} points", options.n, max_points()));
  line.step(fmt::format("making {} points", options.n));
  return io::generate(options.generate, generator);
}

Triangulation triangulate_subject(const SubjectOptions& subject, const io::PointSet& points, const Options& options) {
  try {
    const InPhase phase(Phase::cooperative);
    return triangulate(points.view(), options);
  } catch (const InputError& e) {
    refuse_points(subject, e);
  }
}

void refuse_points(const SubjectOptions& subject, const InputError& e) {
  throw Failure(exit_file, fmt::format("{}: point {} (counted from 0): {}", name_of(subject), e.index(), e.what()));
}

void add_style_options(CLI::App& command, StyleOptions& options) {
  command
      .add_option("--colour,--color", options.colour,
                  "what decides the colour of a triangle: " + join(viewer::names_of_colours(), " ") +
                      " (default: region if segments separate some, else height if the points have one, else area)")
      ->type_name("BY")
      ->check(CLI::IsMember(viewer::names_of_colours()).description(""));
  command.add_option("--style", options.style, "filled (default), wireframe, or points without triangles")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"filled", "wireframe", "points"}).description(""));
  command.add_flag("--no-hull", options.no_hull, "do not emphasise the convex hull");
  command.add_flag("--dark", options.dark, "light on dark");
}

viewer::Style style_of(const StyleOptions& options) {
  viewer::Style style;
  style.fill = options.style == "filled";
  style.points_alone = options.style == "points";
  style.hull = !options.no_hull;
  style.dark = options.dark;
  return style;
}

std::optional<viewer::ColourBy> colour_of(const StyleOptions& options, const io::PointSet& points, MeshKind kind) {
  const auto colour = viewer::colour_from_string(options.colour);
  if (!colour) return std::nullopt;
  using enum viewer::ColourBy;
  if ((colour == level || colour == conflicts || colour == flips) && kind != MeshKind::growing)
    throw Failure(exit_usage, fmt::format("--colour {} is known of a mesh that grows only", options.colour));
  if (colour == region && kind != MeshKind::segments)
    throw Failure(exit_usage, "--colour region is known of a mesh with segments only");
  if (colour == height && points.height.empty())
    throw Failure(exit_usage,
                  "--colour height: the points have no third column; take another colour, or name it with --columns");
  return colour;
}

void parse_size(const std::string& text, int& width, int& height, int& most_height) {
  if (text.empty()) return;
  const std::size_t x = text.find('x');
  const auto side_of = [](std::string_view of) {
    const double side = parse_number(of).value_or(0);
    return side == std::floor(side) && side >= 16 && side <= largest_side ? static_cast<int>(side) : 0;
  };
  const bool both = x != std::string::npos;
  const int w = side_of(std::string_view(text).substr(0, x)),
            h = both ? side_of(std::string_view(text).substr(x + 1)) : 0;
  if (w == 0 || (both && h == 0)) {
    throw Failure(exit_usage, fmt::format("--size {}: a width, or width and height as 1920x1080, of 16 to {} pixels",
                                          text, largest_side));
  }
  width = w;
  height = h;
  most_height = largest_side;
}

std::optional<viewer::View> parse_camera(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::array<double, 3> number{0, 0, 0};
  if (!parse_numbers(text, number) || !(number[2] >= viewer::Camera::least_magnification))
    throw Failure(exit_usage,
                  fmt::format("--camera {}: three numbers are needed, x,y,magnification, the last at least {}", text,
                              viewer::Camera::least_magnification));
  return viewer::View{number[0], number[1], number[2]};
}

void aim_camera(viewer::Camera& camera, const viewer::View& view) {
  viewer::aim(camera, view);
  if (const double reached = camera.magnification(); reached != view.magnification)
    throw Failure(exit_usage, fmt::format("--camera: there is no magnification {} in that place; the nearest is {}",
                                          view.magnification, reached));
}

}  // namespace cadt::cli
