// SPDX-License-Identifier: Apache-2.0
// What scripts/check_viewer measures: from points on the device to the first frame, frames of a flight, moving points.
// All times are of the host's clock with glFinish() at the end, so they hold everything.
//
// usage: cadt-check-viewer [--points N]... [--moving N]... [--pictures FOLDER] [--interop WAY] [--backend NAME]
#include "viewer/draw/image_file.hpp"
#include "viewer/draw/renderer.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/live/live_points.hpp"
#include "viewer/mesh/mesher.hpp"

#include <cadt/cadt.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace cadt::viewer {
namespace {

constexpr int width = 1920, height = 1080;

struct Choice {
  std::vector<std::size_t> points, moving;
  std::string pictures;
  Interop interop = Interop::automatic;
  Options options;
};

double now() { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

template <class Work>
double milliseconds(Work&& work) {
  glFinish();
  const double start = now();
  work();
  glFinish();
  return now() - start;
}

double quantile(std::vector<double> values, double q) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

void save(const Choice& choice, const Renderer& renderer, const std::string& name) {
  if (!choice.pictures.empty()) write_png(choice.pictures + "/" + name + ".png", renderer.read());
}

/// Frames from the whole box down to one in 2^18 at several places, three of each.
double fly(const Choice& choice, Renderer& renderer, const MeshBuffers& mesh, const Style& style) {
  constexpr double places[][2] = {{0.5, 0.5}, {0.31, 0.73}, {0.02, 0.01}, {0.875, 0.126}, {0.66, 0.66}};
  double worst = 0, worst_zoom = 1;
  std::string line;
  for (double zoom = 1; zoom < 3e5; zoom *= 2) {
    double here = 0;
    int number = 0;
    for (const auto& place : places) {
      Camera camera(mesh.box, width, height);
      camera.look_at(place[0], place[1]);
      camera.zoom(zoom, 0.5 * width, 0.5 * height);
      std::vector<double> times;
      for (int k = 0; k < 3; ++k) times.push_back(milliseconds([&] { renderer.draw(mesh, camera, style); }));
      here = std::max(here, quantile(times, 0.5));
      if (number == (zoom == 1 ? 0 : 1) && (zoom == 1 || zoom == 16 || zoom == 512 || zoom == 65536))
        save(choice, renderer, "flight_" + std::to_string(mesh.point_count / 1'000'000) + "M_" + std::to_string(static_cast<int>(zoom)));
      ++number;
    }
    char text[64];
    std::snprintf(text, sizeof text, " %.0f:%.2f", zoom, here);
    line += text;
    if (here > worst) {
      worst = here;
      worst_zoom = zoom;
    }
  }
  std::printf("  zoom:ms%s\n", line.c_str());
  std::printf("  slowest %.2f ms at zoom %.0f\n", worst, worst_zoom);
  return worst;
}

/// Share of the samples within the square that belong to a triangle.
double covered(const Renderer& renderer) {
  const Image image = renderer.read();
  const int side = height - 2 * 40, left = (width - side) / 2;
  std::size_t found = 0;
  for (int y = 40; y < 40 + side; ++y) {
    for (int x = left; x < left + side; ++x) {
      const std::uint8_t* const pixel = image.rgba.data() + 4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
      found += pixel[0] != image.rgba[0] || pixel[1] != image.rgba[1] || pixel[2] != image.rgba[2] ? 1u : 0u;
    }
  }
  return static_cast<double>(found) / (static_cast<double>(side) * side);
}

void measure_size(const Choice& choice, Mesher& mesher, Renderer& renderer, std::size_t n) {
  MeshBuffers mesh;
  mesh.box = {{0, 0}, {1, 1}};
  { const LivePoints points(mesh, n, 1); }
  Camera camera(mesh.box, width, height);
  Style style;
  style.hull = false;
  mesh.bytes_through_host = 0;
  double parts[4];
  const double first = milliseconds([&] {
    parts[0] = milliseconds([&] { mesher.triangulate(mesh); });
    parts[1] = milliseconds([&] { renderer.update(mesh); });
    parts[2] = milliseconds([&] { renderer.fit_ramp(mesh, style.colour); });
    parts[3] = milliseconds([&] { renderer.draw(mesh, camera, style); });
  });
  std::printf("%zu points, %zu triangles: first frame %.1f ms = triangulate %.1f + boxes %.1f + ramp %.1f + draw %.1f; through the host %zu bytes\n", n,
              mesh.triangle_count, first, parts[0], parts[1], parts[2], parts[3], mesh.bytes_through_host);
  const double again = milliseconds([&] {
    mesher.triangulate(mesh);
    renderer.update(mesh);
    renderer.draw(mesh, camera, style);
  });
  std::printf("  again %.1f ms\n", again);
  std::printf("  covered %.6f\n", covered(renderer));
  fly(choice, renderer, mesh, style);
}

void measure_moving(const Choice& choice, Mesher& mesher, Renderer& renderer, std::size_t n) {
  MeshBuffers mesh;
  mesh.box = {{0, 0}, {1, 1}};
  LivePoints points(mesh, n, 2);
  Camera camera(mesh.box, width, height);
  Style style;
  mesher.triangulate(mesh);
  renderer.update(mesh);
  renderer.fit_ramp(mesh, style.colour);
  mesh.bytes_through_host = 0;
  for (const Motion motion : {Motion::flow, Motion::bounce, Motion::orbit, Motion::particles}) {
    std::vector<double> frames, parts[4];
    const double start = now();
    for (int k = 0; k < 120 && (k < 3 || now() - start < 3000); ++k) {
      frames.push_back(milliseconds([&] {
        points.step(1.0 / 60, motion);
        mesher.triangulate(mesh);
        renderer.update(mesh);
        renderer.draw(mesh, camera, style);
      }));
    }
    for (int k = 0; k < 30 && (k < 3 || now() - start < 5000); ++k) {
      parts[0].push_back(milliseconds([&] { points.step(1.0 / 60, motion); }));
      parts[1].push_back(milliseconds([&] { mesher.triangulate(mesh); }));
      parts[2].push_back(milliseconds([&] { renderer.update(mesh); }));
      parts[3].push_back(milliseconds([&] { renderer.draw(mesh, camera, style); }));
    }
    save(choice, renderer, "moving_" + std::to_string(n) + "_" + std::string(to_string(motion)));
    std::printf("moving %zu, %s: frame %.2f ms (95 %%: %.2f) = step %.2f + triangulate %.2f + boxes %.2f + draw %.2f; through the host %zu bytes\n", n,
                std::string(to_string(motion)).c_str(), quantile(frames, 0.5), quantile(frames, 0.95), quantile(parts[0], 0.5),
                quantile(parts[1], 0.5), quantile(parts[2], 0.5), quantile(parts[3], 0.5), mesh.bytes_through_host);
  }
}

void run(const Choice& choice) {
  const gl::HeadlessContext context;
  std::printf("display: %s, OpenGL %s\n", context.driver().renderer.c_str(), context.driver().version.c_str());
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  GLint blocks = 0;
  glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &blocks);
  std::printf("storage blocks: %d of at most %lld bytes\n", blocks, static_cast<long long>(largest));
  Mesher mesher(choice.options, choice.interop);
  std::printf("interop: %s (%s) %s\n", std::string(to_string(mesher.interop())).c_str(), mesher.device().name.c_str(), mesher.reason().c_str());
  Renderer renderer;
  {  // whatever is compiled or loaded at its first use
    MeshBuffers mesh;
    mesh.box = {{0, 0}, {1, 1}};
    const LivePoints points(mesh, 300'000, 3);
    mesher.triangulate(mesh);
    renderer.update(mesh);
    renderer.fit_ramp(mesh, ColourBy::area);
    renderer.draw(mesh, Camera(mesh.box, width, height), Style{});
    Statistics statistics;
    mesher.triangulate(mesh, &statistics);
    std::printf("counted by the library for 300,000 points (4,800,000 bytes): %llu bytes to the device, %llu from it\n",
                static_cast<unsigned long long>(statistics.bytes_to_device), static_cast<unsigned long long>(statistics.bytes_from_device));
  }
  for (const std::size_t n : choice.moving) measure_moving(choice, mesher, renderer, n);
  for (const std::size_t n : choice.points) measure_size(choice, mesher, renderer, n);
  const int errors = gl::errors_seen();
  std::printf("OpenGL errors: %d\n", errors);
  if (errors != 0) throw std::runtime_error("OpenGL reported errors");
}

Choice parse(int count, char** values) {
  Choice choice;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = values[i], value = values[i + 1];
    if (name == "--points") {
      choice.points.push_back(std::stoull(value));
    } else if (name == "--moving") {
      choice.moving.push_back(std::stoull(value));
    } else if (name == "--pictures") {
      choice.pictures = value;
    } else if (name == "--backend") {
      choice.options.backend = backend_from_string(value);
    } else if (name == "--interop") {
      for (const Interop way : {Interop::automatic, Interop::cuda, Interop::opencl, Interop::copy})
        if (to_string(way) == value) choice.interop = way;
    } else {
      throw std::runtime_error("what is " + name + "?");
    }
  }
  return choice;
}

}  // namespace
}  // namespace cadt::viewer

int main(int count, char** values) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    cadt::viewer::run(cadt::viewer::parse(count, values));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cadt-check-viewer: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
