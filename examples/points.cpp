// SPDX-License-Identifier: Apache-2.0
// Points in the arrays that a program has anyway: structs, lists, separate arrays, iterators with getters.
#include <cadt/cadt.hpp>

#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <vector>

struct Point {
  double x, y;
};
struct Station {
  std::string name;
  double lon, lat;
};

int main() {
  try {
    const std::vector<Point> points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}};
    cadt::Options options;
    options.backend = cadt::Backend::host;
    const cadt::Triangulation mesh = cadt::triangulate(points, options);

    const double xs[] = {0, 1, 1, 0, 0.5}, ys[] = {0, 0, 1, 1, 0.5};
    const std::vector<Station> stations = {{"A", 0, 0}, {"B", 1, 0}, {"C", 1, 1}, {"D", 0, 1}, {"E", 0.5, 0.5}};
    std::map<std::string, Point> by_name;
    for (const Station& station : stations) by_name[station.name] = {station.lon, station.lat};

    std::vector<cadt::Triangulation> same;
    same.push_back(cadt::triangulate({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}}, options));
    same.push_back(cadt::triangulate({xs, ys}, options));
    same.push_back(cadt::triangulate({stations, &Station::lon, &Station::lat}, options));
    same.push_back(
        cadt::triangulate(cadt::copy_points(
                              by_name.begin(), by_name.end(), [](const auto& entry) { return entry.second.x; },
                              [](const auto& entry) { return entry.second.y; }),
                          options));
    for (const cadt::Triangulation& other : same)
      if (other.hash() != mesh.hash()) throw cadt::Error("not the same mesh");

    for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
      const auto [a, b, c] = mesh.triangle(t);
      std::cout << stations[static_cast<std::size_t>(a)].name << stations[static_cast<std::size_t>(b)].name
                << stations[static_cast<std::size_t>(c)].name << '\n';
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "example-points: " << error.what() << '\n';
    return 1;
  }
}
