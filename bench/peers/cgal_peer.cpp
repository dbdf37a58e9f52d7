// SPDX-License-Identifier: Apache-2.0
// cadt-peer-cgal: CGAL's Delaunay_triangulation_2 with exact predicates, as its users write it. The protocol is that of
// bench/peers.hpp.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::vector<Kernel::Point_2> read_points(const std::string& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw std::runtime_error("cannot open " + file);
  const auto bytes = static_cast<std::size_t>(in.tellg());
  if (bytes % (2 * sizeof(double)) != 0) throw std::runtime_error(file + " does not hold whole points");
  std::vector<double> xy(bytes / sizeof(double));
  in.seekg(0);
  if (!in.read(reinterpret_cast<char*>(xy.data()), static_cast<std::streamsize>(bytes)))
    throw std::runtime_error("cannot read " + file);
  std::vector<Kernel::Point_2> points;
  points.reserve(xy.size() / 2);
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    if (!std::isfinite(xy[i]) || !std::isfinite(xy[i + 1]))
      throw std::runtime_error("point " + std::to_string(i / 2) + " is not finite");
    points.emplace_back(xy[i], xy[i + 1]);
  }
  return points;
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  int warm_up = 1, runs = 1;
  double limit = std::numeric_limits<double>::infinity();
  bool version = false;
  CLI::App app("Times CGAL's Delaunay triangulation of a file of points; prints one JSON object.");
  app.add_option("points", file, "interleaved little-endian doubles");
  app.add_option("--warm-up", warm_up, "runs before the timed ones")->check(CLI::NonNegativeNumber);
  app.add_option("--runs", runs, "timed runs")->check(CLI::PositiveNumber);
  app.add_option("--limit", limit, "seconds after which no run starts, but for one")->check(CLI::NonNegativeNumber);
  app.add_flag("--version", version, "print name and version only");
  CLI11_PARSE(app, argc, argv);

  nlohmann::ordered_json answer = {{"name", "cgal"}, {"version", CGAL_VERSION_STR}};
  try {
    if (!version) {
      const std::vector<Kernel::Point_2> points = read_points(file);
      std::size_t triangles = 0;
      int warmups = 0;
      std::vector<double> milliseconds;
      const auto once = [&] {
        CGAL::Delaunay_triangulation_2<Kernel> delaunay;
        const auto start = Clock::now();
        delaunay.insert(points.begin(), points.end());  // sorts them spatially
        const double seconds = seconds_since(start);
        triangles = delaunay.dimension() < 2 ? 0 : delaunay.number_of_faces();
        return 1e3 * seconds;
      };
      const auto begin = Clock::now();
      for (; warmups < warm_up && seconds_since(begin) < limit; ++warmups) once();
      do milliseconds.push_back(once());
      while (milliseconds.size() < static_cast<std::size_t>(runs) && seconds_since(begin) < limit);
      answer["triangles"] = triangles;
      answer["warmups"] = warmups;
      answer["milliseconds"] = milliseconds;
    }
  } catch (const std::bad_alloc&) {
    answer["error"] = "out of memory";
  } catch (const std::exception& error) {
    answer["error"] = error.what();
  }
  // A file name need not be UTF-8.
  std::cout << answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
  return 0;
}
