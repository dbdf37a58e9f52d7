// SPDX-License-Identifier: Apache-2.0
// The viewer while the mesh grows: its recording, one snapshot after the other.
#include "viewer/window/app.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cadt::viewer {
namespace {

constexpr std::size_t steps_of_recording = 240;
constexpr std::size_t most_bytes = std::size_t{1} << 30;

}  // namespace

void App::start_growing() {
  if (loaded == nullptr || loading.running()) return;
  if (scene->mesh.triangle_count == 0) {
    report({"There is nothing that grows", "The points are fewer than three, or on one line.", "", false});
    return;
  }
  if (editing != nullptr) stop_editing();
  asking.abandon();
  asked_.reset();
  const auto result = std::make_shared<std::shared_ptr<const Recording>>();
  RecordingLimits limits;
  limits.steps = steps_of_recording;
  limits.most_bytes = most_bytes;
  if (const std::size_t free = options.free_memory ? options.free_memory() : 0; free != 0)
    limits.most_bytes = std::min(limits.most_bytes, free / 4);
  recorded_ = result;
  loading.start([result, of = loaded, limits, compute = options.compute](Work::Desk& desk) {
    Options o = compute;
    o.statistics = StatisticsDetail::timing;  // who lost locks
    o.stop = desk.stop();
    o.progress = [&desk](const Progress& p) { desk.report("recording: " + std::string(p.phase), p.fraction); };
    *result = std::make_shared<const Recording>(of->points.xy, o, limits);
  });
}

void App::finish_recording(const std::shared_ptr<const Recording>& recording) {
  if (recording->size() == 0) return;
  growing.emplace();
  growing->recording = recording;
  growing->playback = Playback(recording->size());
  growing->illegal_edges.resize(recording->size());
  hovered.reset();
  mark({});
  view.voronoi = false;
  view.colours = {ColourBy::nothing, ColourBy::angle, ColourBy::area,
                  ColourBy::order,   ColourBy::level, ColourBy::flips};
  if (!recording->values(recording->size() - 1, GrowthValue::lost_locks).empty())
    view.colours.push_back(ColourBy::conflicts);
  before_growing_ = view.colour;
  ramp_of_growth_.reset();
  view.colour = ColourBy::level;
  upload_snapshot();
  say(fmt::format("recorded {} snapshots", recording->size()));
  growing->playback.play(growing->speed);
}

void App::stop_growing() {
  if (!growing) return;
  const auto recording = growing->recording;
  const std::span<const std::int32_t> last = recording->triangles(recording->size() - 1);
  growing.reset();
  offer_colours();
  view.colour = before_growing_;
  if (loaded->mesh)
    scene->mesh.write_triangles(loaded->mesh->triangles());
  else if (scene->mesher != nullptr)
    scene->mesher->triangulate(scene->mesh);
  else
    scene->mesh.write_triangles(last);
  scene->renderer.update(scene->mesh);
  hovered.reset();
  mark({});
  values_of_.reset();
  update_strokes();
  say("growth ended");
}

void App::upload_snapshot() {
  Growing& g = *growing;
  const std::size_t frame = g.playback.frame();
  if (g.shown == frame) return;
  g.shown = frame;
  const std::span<const std::int32_t> triangles = g.recording->triangles(frame);
  if (scene->mesh.triangles.bytes() < triangles.size_bytes())
    scene->mesh.triangles = gl::Buffer(triangles.size_bytes());
  scene->mesh.write_triangles(triangles);
  scene->renderer.update(scene->mesh);
  hovered.reset();
  mark({});
  values_of_.reset();
  ++version_;
}

std::vector<float> App::growth_values() const {
  const Recording& r = *growing->recording;
  const std::size_t frame = *growing->shown;
  switch (view.colour) {
    case ColourBy::level:
      return {r.levels().begin(), r.levels().end()};
    case ColourBy::flips:
      return r.values(frame, GrowthValue::flips);
    case ColourBy::conflicts:
      return r.values(frame, GrowthValue::lost_locks);
    default:
      return {};
  }
}

void App::advance_growing(double seconds) {
  Growing& g = *growing;
  const bool played = g.playback.playing();
  if (played) g.playback.advance(std::min(seconds, 0.25));
  upload_snapshot();
  if (played && !g.playback.playing())
    say(fmt::format("snapshot {} of {}", g.playback.frame() + 1, g.recording->size()));
}

void App::show_snapshot(std::size_t which) {
  if (!growing) return;
  growing->playback.pause();
  growing->playback.seek(static_cast<double>(which));
  upload_snapshot();
}

void App::grow_command(Command command) {
  if (command == Command::grow) {
    growing ? stop_growing() : start_growing();
    return;
  }
  if (!growing) return;
  Growing& g = *growing;
  switch (command) {
    case Command::play:
      g.playback.playing() ? g.playback.pause() : g.playback.play(g.speed);
      break;
    case Command::step:
    case Command::back:
      g.playback.step(command == Command::step ? 1 : -1);
      upload_snapshot();
      say(fmt::format("snapshot {} of {}", g.playback.frame() + 1, g.recording->size()));
      break;
    case Command::faster:
    case Command::slower:
      g.speed = std::clamp(g.speed * (command == Command::faster ? 2.0 : 0.5), 0.25, 128.0);
      if (g.playback.playing()) g.playback.play(g.speed);
      break;
    default:
      break;
  }
}

}  // namespace cadt::viewer
