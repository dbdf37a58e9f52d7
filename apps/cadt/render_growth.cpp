// SPDX-License-Identifier: Apache-2.0
#include "render_growth.hpp"

#include "failure.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "system.hpp"
#include "text.hpp"
#include "viewer_options.hpp"

#include <cadt/io/errors.hpp>

#include "viewer/draw/image_file.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/draw/renderer.hpp"
#include "viewer/gl/errors.hpp"
#include "viewer/growth/recording.hpp"
#include "viewer/growth/video.hpp"
#include "viewer/still/scene_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace cadt::cli {
namespace {

namespace fs = std::filesystem;
using namespace viewer;

constexpr double final_seconds = 1;                              // at the end of a film nothing moves
constexpr double most_pictures = 9999;                           // names of frames have four digits
constexpr std::size_t most_pixels = (std::size_t{1} << 27) - 1;  // of a sheet: as of one picture

bool is_folder(const std::string& output) {
  std::error_code ignored;
  return output.ends_with('/') || fs::is_directory(output, ignored);
}

bool is_frame(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && !stem.empty() &&
         std::ranges::all_of(stem, [](char c) { return c >= '0' && c <= '9'; });
}

/// The folder, or the one in which it will be made.
fs::path existing(fs::path folder) {
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(folder, ignored)) folder = folder.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// What has been written into a folder, and the folder if it is new: removed again unless all of it is complete.
class FrameFolder {
 public:
  explicit FrameFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code code;
    for (fs::path at = folder_; !at.empty() && !fs::exists(at, code); at = at.parent_path())
      if (at.has_filename()) made_.push_back(at);
    fs::create_directories(folder_, code);
    if (code) {
      remove();
      throw io::FileError(folder_.string(), 0, "cannot be made: " + code.message());
    }
  }
  ~FrameFolder() {
    if (!complete_) remove();
  }
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;

  void write(std::size_t i, const Image& picture) {
    const fs::path file = folder_ / fmt::format("{:04}.png", i + 1);
    write_png(file.string(), picture);
    frames_.push_back(file);
  }
  void complete() noexcept { complete_ = true; }

 private:
  void remove() noexcept {
    std::error_code ignored;
    for (const fs::path& file : frames_) fs::remove(file, ignored);
    for (const fs::path& folder : made_) fs::remove(folder, ignored);  // if it is empty
  }

  fs::path folder_;
  std::vector<fs::path> made_, frames_;  ///< the innermost folder first
  bool complete_ = false;
};

std::size_t pictures_of(const GrowthOptions& growth) {
  return static_cast<std::size_t>(std::max(1.0, std::round(growth.fps * growth.seconds)));
}

/// Draws snapshots, all with the colours of the complete mesh.
class GrowthPainter {
 public:
  GrowthPainter(const io::PointSet& points, const Recording& recording, const GrowthView& view, int width, int height)
      : points_(points),
        recording_(recording),
        style_(view.style),
        buffers_(MeshBuffers::with_room(points.xy.size() / 2)) {
    buffers_.write_points(points.xy);
    buffers_.box = box_of(points.xy);
    camera_ = Camera(buffers_.box, width, height);
    if (view.seen) aim_camera(camera_, *view.seen);
    if (style_.colour == ColourBy::height)
      heights_ = heights_of({points.xy, points.height, recording.triangles(recording.size() - 1), {}});
    show(recording.size() - 1);
    renderer_.fit_ramp(buffers_, style_.colour);
  }

  Image draw(std::size_t frame) {
    show(frame);
    renderer_.draw(buffers_, camera_, style_);
    return renderer_.read();
  }

 private:
  void show(std::size_t frame) {
    if (shown_ == frame + 1) return;
    shown_ = frame + 1;
    buffers_.write_triangles(recording_.triangles(frame));
    renderer_.set_values(values(frame));
    renderer_.update(buffers_);
  }

  std::vector<float> values(std::size_t frame) const {
    switch (style_.colour) {
      case ColourBy::level:
        return {recording_.levels().begin(), recording_.levels().end()};
      case ColourBy::flips:
        return recording_.values(frame, GrowthValue::flips);
      case ColourBy::conflicts:
        return recording_.values(frame, GrowthValue::lost_locks);
      case ColourBy::height:
        return heights_;
      case ColourBy::degree: {
        std::vector<float> degrees(points_.xy.size() / 2);
        for (const std::int32_t v : recording_.triangles(frame)) ++degrees[static_cast<std::size_t>(v)];
        return degrees;
      }
      default:
        return {};
    }
  }

  const io::PointSet& points_;
  const Recording& recording_;
  Style style_;
  Renderer renderer_;
  MeshBuffers buffers_;
  Camera camera_;
  std::vector<float> heights_;
  std::size_t shown_ = 0;  ///< one more than the frame in the buffers
};

void paste(Image& sheet, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    const auto from = picture.rgba.begin() + std::ptrdiff_t{4} * y * picture.width;
    std::copy_n(from, std::ptrdiff_t{4} * picture.width,
                sheet.rgba.begin() + std::ptrdiff_t{4} * ((top + y) * std::ptrdiff_t{sheet.width} + left));
  }
}

std::vector<std::string> row_of(const Recording& recording, std::size_t frame) {
  const GrowthCounters& c = recording.counters(frame);
  return {std::to_string(c.level),         std::to_string(c.points),
          std::to_string(c.triangles),     std::to_string(c.flips),
          std::to_string(c.lost_locks),    std::to_string(c.deferred_points),
          std::to_string(c.waiting_edges), std::to_string(recording.illegal_edges(frame))};
}

/// One picture of several snapshots, in rows, and their counters on standard output.
void write_sheet(const io::PointSet& points, const Recording& recording, const std::string& output, int panels,
                 const GrowthView& view, ProgressLine& line) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(panels))));
  const int rows = (panels + columns - 1) / columns, gap = std::max(2, view.width / 100);
  const int width = (view.width - gap * (columns - 1)) / columns;
  const auto height_of_row = [&](int all) { return (all - gap * (rows - 1)) / rows; };
  const int height = view.height == 0 ? Camera::height_for(box_of(points.xy), width, height_of_row(view.most_height))
                                      : height_of_row(view.height);
  if (width < 1 || height < 1)
    throw Failure(exit_usage, fmt::format("--size: there is no room for {} pictures", panels));
  Image sheet{view.width, view.height == 0 ? rows * height + gap * (rows - 1) : view.height, {}};
  const std::size_t pixels = static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height);
  if (pixels > most_pixels)
    throw DisplayError(
        fmt::format("a picture of {} x {} pixels is larger than the {} million pixels that there may be: "
                    "take a smaller --size",
                    sheet.width, sheet.height, most_pixels / 1'000'000));
  sheet.rgba.resize(4 * pixels, 255);
  const std::uint32_t background = palette(view.style.dark).background;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t k = 0; k < 3; ++k) sheet.rgba[4 * i + k] = static_cast<std::uint8_t>(background >> (16 - 8 * k));
  GrowthPainter painter(points, recording, view, width, height);
  std::vector<std::vector<std::string>> lines{{"picture", "level", "points", "triangles", "flips", "lost locks",
                                               "deferred points", "waiting edges", "illegal edges"}};
  const auto all = static_cast<double>(recording.counters(recording.size() - 1).points);
  for (int k = 0; k < panels; ++k) {
    check_interrupt();
    // Points as squares: 1/16, 1/4, 9/16 and all for four pictures.
    const double share = (k + 1.0) / panels;
    const std::size_t frame = k + 1 == panels ? recording.size() - 1 : recording.frame_with_points(share * share * all);
    paste(sheet, painter.draw(frame), (width + gap) * (k % columns), (height + gap) * (k / columns));
    std::vector<std::string> row = row_of(recording, frame);
    row.insert(row.begin(), std::to_string(k + 1));
    lines.push_back(std::move(row));
  }
  write_png(output, sheet);
  check_interrupt_after({display_name(output, false)}, &line);
  if (!view.quiet) print(table(lines));
}

/// The frames of a film, in turn; equal ones are drawn once.
template <class Write>
void each_picture(const Recording& recording, const GrowthOptions& growth, GrowthPainter& painter, ProgressLine& line,
                  Write&& write) {
  const std::size_t count = pictures_of(growth);
  const double moving = std::max(
      1.0, static_cast<double>(count) - std::min(final_seconds * growth.fps, 0.25 * static_cast<double>(count)));
  Image picture;
  std::size_t drawn = recording.size();
  for (std::size_t i = 0; i < count; ++i) {
    check_interrupt();
    const std::size_t frame = count == 1 ? recording.size() - 1 : recording.frame_at(static_cast<double>(i) / moving);
    if (frame != drawn) picture = painter.draw(frame);
    drawn = frame;
    write(i, picture);
    line.step(fmt::format("picture {} of {}", i + 1, count));
  }
}

}  // namespace

void add_growth_options(CLI::App& command, GrowthOptions& options) {
  command
      .add_option("--growth", options.panels, "N snapshots of the growing mesh side by side, up to the complete one")
      ->type_name("N")
      ->transform(whole_number(1, 100));
  const auto timed = [&options](double& value) {
    return [&options, &value](const double& given) {
      value = given;
      options.timed = true;
    };
  };
  command.add_option_function<double>("--fps", timed(options.fps), "film or frames: pictures a second (default: 30)")
      ->type_name("F")
      ->check(number_within(1, 240));
  command
      .add_option_function<double>("--seconds", timed(options.seconds), "film or frames: how long it is (default: 8)")
      ->type_name("S")
      ->check(number_within(0.1, 3600));
}

bool shows_growth(const GrowthOptions& options, const std::string& output) {
  return options.panels != 0 || is_video(output) || is_folder(output);
}

void check_growth(const GrowthOptions& options, const std::string& output, const std::vector<std::string>& inputs) {
  const bool film = is_video(output), folder = is_folder(output);
  if (options.panels != 0 && (film || folder))
    throw Failure(
        exit_usage,
        "--growth is for a picture, as in -o growth.png; a film or a folder of frames shows all snapshots without it");
  if (options.timed && !film && !folder)
    throw Failure(
        exit_usage,
        "--fps and --seconds are for a film or its frames: -o growth.mp4, .webm, .gif or a folder, as in -o frames/");
  if ((film || folder) && options.fps * options.seconds > most_pictures)
    throw Failure(exit_usage, fmt::format("--fps times --seconds is {:.0f} pictures; take at most {:.0f}",
                                          options.fps * options.seconds, most_pictures));
  if (!film && !folder) {
    if (output == "-")
      throw Failure(exit_usage,
                    "-o -: standard output has the counters of the growing mesh; name a file for the picture");
    require_format(output, "", {"png"}, "");
    (void)plan_outputs({output}, {}, {"png"}, inputs);
    return;
  }
  require_no_input(output, inputs);
  if (film) {
    require_writable(output);
    if (!has_ffmpeg())
      throw io::FileError(output, 0,
                          "needs the program ffmpeg, which is not on the path: install it, or write the frames as "
                          "pictures, as in -o frames/");
    return;
  }
  std::error_code code;
  const fs::path place = existing(output);
  if (!fs::is_directory(place, code))
    throw io::FileError(output, 0, "cannot be made: " + place.string() + " is a file");
  if (!may_write(place.string()))
    throw io::FileError(output, 0, "cannot be written: " + std::generic_category().message(errno));
  if (!fs::is_directory(output, code)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(output))
    if (is_frame(entry.path()))
      throw io::FileError(output, 0,
                          "has frames already, which would mix with the new ones: name another folder, or remove them");
}

int render_growth(const io::PointSet& points, const Options& options, const std::string& output,
                  const GrowthOptions& growth, const GrowthView& view, ProgressLine& line) {
  const InPhase phase(Phase::cooperative);
  Options with = options;
  with.stop = interrupt_token();
  with.progress = [&line](const Progress& progress) { line.update(progress); };
  if (view.style.colour == ColourBy::conflicts) with.statistics = StatisticsDetail::timing;
  RecordingLimits limits;
  limits.steps = growth.panels != 0 ? 64 : pictures_of(growth);
  line.start(points.xy.size() / 2);
  const Recording recording(points.xy, with, limits);
  if (recording.size() == 0)
    throw Failure(exit_degenerate, "there is nothing that grows: the points are fewer than three, or on one line");
  if (view.style.colour == ColourBy::conflicts &&
      recording.values(recording.size() - 1, GrowthValue::lost_locks).empty())
    throw Failure(exit_device,
                  "this device does not count lost locks by triangle: take --backend host, or --colour flips");
  if (recording.dropped() != 0 && !view.quiet)
    say(fmt::format("cadt: note: {} snapshots had no room in {} and are left out\n", recording.dropped(),
                    human_bytes(limits.most_bytes)));
  line.step("drawing");
  if (growth.panels != 0) {
    write_sheet(points, recording, output, growth.panels, view, line);
    return exit_done;
  }
  const int even = is_video(output) ? ~1 : ~0;  // most films need even sizes
  const int width = view.width & even;
  const int height =
      (view.height == 0 ? Camera::height_for(box_of(points.xy), width, view.most_height) : view.height) & even;
  GrowthPainter painter(points, recording, view, width, height);
  if (!is_video(output)) {
    FrameFolder folder(output);
    each_picture(recording, growth, painter, line,
                 [&](std::size_t i, const Image& picture) { folder.write(i, picture); });
    check_interrupt();
    folder.complete();
    return exit_done;
  }
  Video video(output, width, height, growth.fps);
  each_picture(recording, growth, painter, line, [&](std::size_t, const Image& picture) { video.write(picture); });
  video.finish();
  check_interrupt_after({display_name(output, false)}, &line);
  return exit_done;
}

}  // namespace cadt::cli
