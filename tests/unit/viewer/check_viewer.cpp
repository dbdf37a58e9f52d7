// SPDX-License-Identifier: Apache-2.0
// What scripts/check_viewer measures: from points on the device to the first frame, frames of a flight, moving points.
// Times are of the host's clock with glFinish() before and after, so they hold everything. Pictures of 1920 x 1080.
//
// usage: cadt-check-viewer [--points N]... [--moving N]... [--interop HOW] [--pictures FOLDER] [--limits 1]
#include "viewer/draw/image_file.hpp"
#include "viewer/draw/renderer.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/live/live_points.hpp"
#include "viewer/mesh/mesher.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace cadt::viewer {
namespace {

constexpr int width = 1920, height = 1080;
constexpr double slowest_frame = 20, slowest_moving_100k = 4, slowest_moving_1m = 8;  // ms, on an H100

struct Choice {
  std::vector<std::size_t> points, moving;
  std::string pictures;
  Interop interop = Interop::automatic;
  bool limits = false;
};

class Check {
 public:
  explicit Check(const Choice& choice) : choice_(choice), mesher_(Options{}, choice.interop) {}
  void run();

 private:
  void warm_up();
  void measure_size(std::size_t n);
  void measure_moving(std::size_t n, Motion motion);
  double slowest_of_flight(const MeshBuffers& mesh, const Style& style);
  void save(const std::string& name) const {
    if (!choice_.pictures.empty()) write_png(choice_.pictures + "/" + name + ".png", renderer_.read());
  }
  void require(bool passed, const std::string& what) {
    if (!passed) failures_ += (failures_.empty() ? "" : "; ") + what;
  }

  const Choice& choice_;
  Mesher mesher_;
  Renderer renderer_;
  std::string failures_;
};

template <class Work>
double milliseconds(Work&& work) {
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  work();
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double quantile(std::vector<double> values, double q) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

template <class Work>
double median(int times, Work&& work) {
  std::vector<double> all;
  for (int k = 0; k < times; ++k) all.push_back(milliseconds(work));
  return quantile(all, 0.5);
}

MeshBuffers unit_square() {
  MeshBuffers mesh;
  mesh.box = {{0, 0}, {1, 1}};
  return mesh;
}

/// The share of a picture of the unit square that is not background, within a margin.
double covered(const Image& image) {
  constexpr int margin = 40, side = height - 2 * margin, left = (width - side) / 2;
  std::size_t found = 0;
  for (int y = margin; y < margin + side; ++y) {
    for (int x = left; x < left + side; ++x) {
      const auto at = 4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
      found += std::equal(image.rgba.begin(), image.rgba.begin() + 3, image.rgba.data() + at) ? 0u : 1u;
    }
  }
  return static_cast<double>(found) / (static_cast<double>(side) * side);
}

/// What is compiled, loaded or allocated at its first use.
void Check::warm_up() {
  MeshBuffers mesh = unit_square();
  const LivePoints points(mesh, 300'000, 3);
  mesher_.triangulate(mesh);
  renderer_.update(mesh);
  renderer_.fit_ramp(mesh, ColourBy::area);
  renderer_.draw(mesh, Camera(mesh.box, width, height), Style{});
  Statistics statistics;
  mesher_.triangulate(mesh, &statistics);
  const std::uint64_t bytes = statistics.bytes_to_device + statistics.bytes_from_device;
  std::printf("between host and device, of 300,000 points (4,800,000 bytes) and their mesh: %llu bytes\n\n",
              static_cast<unsigned long long>(bytes));
  if (mesher_.interop() != Interop::copy) require(bytes < 100'000, "points went through the host");
}

/// From the whole box down to one in 2^18 at several places, the median of three frames each.
double Check::slowest_of_flight(const MeshBuffers& mesh, const Style& style) {
  constexpr double places[][2] = {{0.5, 0.5}, {0.31, 0.73}, {0.02, 0.01}, {0.875, 0.126}, {0.66, 0.66}};
  double slowest = 0;
  for (double zoom = 1; zoom < 3e5; zoom *= 2) {
    for (const auto& place : places) {
      Camera camera(mesh.box, width, height);
      camera.look_at(place[0], place[1]);
      camera.zoom(zoom, 0.5 * width, 0.5 * height);
      slowest = std::max(slowest, median(3, [&] { renderer_.draw(mesh, camera, style); }));
    }
    if (zoom == 1 || zoom == 64 || zoom == 4096)
      save(std::to_string(mesh.point_count) + "_zoom_" + std::to_string(static_cast<int>(zoom)));
  }
  return slowest;
}

void Check::measure_size(std::size_t n) {
  MeshBuffers mesh = unit_square();
  { const LivePoints points(mesh, n, 1); }
  const Camera camera(mesh.box, width, height);
  const Style style;
  mesh.bytes_through_host = 0;
  const double first = milliseconds([&] {
    mesher_.triangulate(mesh);
    renderer_.update(mesh);
    renderer_.fit_ramp(mesh, style.colour);
    renderer_.draw(mesh, camera, style);
  });
  save(std::to_string(n));
  require(covered(renderer_.read()) == 1, std::to_string(n) + " points do not cover their square");
  const double again = median(3, [&] {
    mesher_.triangulate(mesh);
    renderer_.update(mesh);
    renderer_.draw(mesh, camera, style);
  });
  const double flight = slowest_of_flight(mesh, style);
  const double pick = median(5, [&] { (void)renderer_.triangle_at(width / 2, height / 2); });
  const double fit = median(5, [&] { renderer_.draw(mesh, camera, style); });
  std::printf("%11zu %11zu %14.1f %14.1f %10.2f %10.2f %10.2f %12zu\n", n, mesh.triangle_count, first, again, fit,
              flight, pick, mesh.bytes_through_host);
  if (choice_.limits) require(flight <= slowest_frame, "a frame of " + std::to_string(n) + " points is too slow");
  if (mesher_.interop() != Interop::copy) require(mesh.bytes_through_host == 0, "bytes went through the host");
}

void Check::measure_moving(std::size_t n, Motion motion) {
  MeshBuffers mesh = unit_square();
  LivePoints points(mesh, n, 2);
  const Camera camera(mesh.box, width, height);
  const Style style;
  mesher_.triangulate(mesh);
  renderer_.update(mesh);
  renderer_.fit_ramp(mesh, style.colour);
  mesh.bytes_through_host = 0;
  const auto move = [&] { points.step(1.0 / 60, motion); };
  const auto triangulate = [&] { mesher_.triangulate(mesh); };
  const auto draw = [&] {
    renderer_.update(mesh);
    renderer_.draw(mesh, camera, style);
  };
  std::vector<double> frames;
  for (int k = 0; k < 120; ++k)
    frames.push_back(milliseconds([&] {
      move();
      triangulate();
      draw();
    }));
  const double frame = quantile(frames, 0.5);
  save("moving_" + std::to_string(n) + "_" + std::string(to_string(motion)));
  std::printf("%11zu %-11s %9.2f %9.2f %9.2f %12.2f %9.2f %12zu\n", n, std::string(to_string(motion)).c_str(), frame,
              quantile(frames, 0.95), median(15, move), median(15, triangulate), median(15, draw),
              mesh.bytes_through_host);
  const double limit = n <= 100'000 ? slowest_moving_100k : slowest_moving_1m;
  if (choice_.limits && n <= 1'000'000) require(frame <= limit, std::to_string(n) + " moving points are too slow");
  if (mesher_.interop() != Interop::copy) require(mesh.bytes_through_host == 0, "bytes went through the host");
}

void Check::run() {
  const std::string reason = mesher_.reason();
  std::printf("computes:  %s (%s)\ninterop:   %s%s%s\n", mesher_.device().name.c_str(),
              std::string(to_string(mesher_.device().backend)).c_str(),
              std::string(to_string(mesher_.interop())).c_str(), reason.empty() ? "" : ", because of ", reason.c_str());
  warm_up();
  if (!choice_.points.empty())
    std::printf("points at random, %d x %d pixels, milliseconds\n%11s %11s %14s %14s %10s %10s %10s %12s\n", width,
                height, "points", "triangles", "first frame", "mesh + frame", "whole view", "slowest", "pick",
                "through host");
  for (const std::size_t n : choice_.points) measure_size(n);
  if (!choice_.moving.empty())
    std::printf("\nmoving points, milliseconds\n%11s %-11s %9s %9s %9s %12s %9s %12s\n", "points", "motion", "frame",
                "95 %", "= step", "triangulate", "draw", "through host");
  for (const std::size_t n : choice_.moving)
    for (const Motion motion : {Motion::flow, Motion::bounce, Motion::orbit, Motion::particles})
      measure_moving(n, motion);
  require(gl::errors_seen() == 0, "OpenGL reported errors");
  if (!mesher_.reason().empty()) std::printf("\nnote: %s\n", mesher_.reason().c_str());
  if (!failures_.empty()) throw std::runtime_error(failures_);
}

Choice parse(int count, char** values) {
  Choice choice;
  for (int i = 1; i < count; i += 2) {
    const std::string name = values[i], value = i + 1 < count ? values[i + 1] : "";
    if (name == "--points") {
      choice.points.push_back(std::stoull(value));
    } else if (name == "--moving") {
      choice.moving.push_back(std::stoull(value));
    } else if (name == "--pictures") {
      choice.pictures = value;
    } else if (name == "--limits") {
      choice.limits = value != "0";
    } else if (name == "--interop") {
      const Interop all[] = {Interop::automatic, Interop::cuda, Interop::opencl, Interop::copy};
      const auto* const found = std::ranges::find_if(all, [&](Interop one) { return to_string(one) == value; });
      if (found == std::end(all)) throw std::runtime_error("--interop is auto, cuda, opencl or copy");
      choice.interop = *found;
    } else {
      throw std::runtime_error("unknown option " + name);
    }
  }
  return choice;
}

}  // namespace
}  // namespace cadt::viewer

int main(int count, char** values) {
  try {
    const cadt::viewer::Choice choice = cadt::viewer::parse(count, values);
    const cadt::viewer::gl::HeadlessContext context;
    std::printf("draws:     %s, OpenGL %s\n", context.driver().renderer.c_str(), context.driver().version.c_str());
    cadt::viewer::Check(choice).run();
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "cadt-check-viewer: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
