// SPDX-License-Identifier: Apache-2.0
// Segments that must be edges: a plate with a hole and a slit, slits that cross, and polygons in one call.
//
// usage: example-constrained [picture.svg]
#include <cadt/cadt.hpp>

#include <array>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Point = std::array<double, 2>;

/// The triangles inside, y upwards.
void write_svg(const char* path, const std::vector<Point>& points, const std::vector<std::int32_t>& triangles) {
  std::ofstream file(path);
  file << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-0.2 -0.2 6.4 4.4\">\n";
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [x, y] = points[static_cast<std::size_t>(triangles[t])];
    file << (t % 3 == 0 ? "<polygon fill=\"#cde\" stroke=\"#024\" stroke-width=\"0.02\" points=\"" : " ") << x << ','
         << 4 - y << (t % 3 == 2 ? "\"/>\n" : "");
  }
  file << "</svg>\n";
  if (!file.flush()) throw cadt::Error(std::string("cannot write ") + path);
}

}  // namespace

int main(int count, char** values) {
  try {
    const std::vector<Point> points = {{0, 0}, {6, 0}, {6, 4}, {0, 4}, {1, 1},   {3, 1},
                                       {3, 3}, {1, 3}, {4, 2}, {5, 2}, {4.5, 1}, {4.5, 3}};
    std::vector<cadt::Segment> segments = cadt::ring_segments(std::vector<std::int64_t>{0, 4, 8});  // outline, hole
    segments.push_back({8, 9});                                                                     // the slit

    cadt::ConstraintOptions rules;
    rules.domain = cadt::Domain::seeds;  // with even_odd the slit, which bounds nothing, would be a DomainError
    rules.holes = {{2, 2}};
    cadt::Options options;
    options.backend = cadt::Backend::host;
    const cadt::ConstrainedTriangulation plate = cadt::triangulate_constrained(points, segments, rules, options);
    std::cout << "plate      " << plate.number_inside() << " of " << plate.mesh().number_of_triangles()
              << " triangles are inside\n";
    if (count > 1) write_svg(values[1], points, plate.triangles_inside());

    segments.push_back({10, 11});  // a second slit, across the first one
    try {
      static_cast<void>(cadt::triangulate_constrained(points, segments, rules, options));
    } catch (const cadt::CrossingError& error) {
      for (const auto& [a, b] : error.pairs()) std::cout << "crossing   segments " << a << " and " << b << '\n';
    }
    rules.crossing = cadt::Crossing::exact;  // a crossing becomes a vertex, behind the points
    const cadt::ConstrainedTriangulation both = cadt::triangulate_constrained(points, segments, rules, options);
    const auto added = both.added_points();
    std::cout << "exact      " << both.number_inside() << " triangles inside, vertex " << points.size() << " at ("
              << added[0] << ", " << added[1] << ")\n";

    // The plate without slits as a polygon of two rings, and a bow-tie, which has no triangles and is reported.
    std::vector<Point> rings(points.begin(), points.begin() + 8);
    rings.insert(rings.end(), {{7, 0}, {8, 1}, {8, 0}, {7, 1}});
    const std::vector<std::int64_t> ring_offsets = {0, 4, 8, 12}, polygon_offsets = {0, 2, 3};
    const cadt::PolygonsResult polygons = cadt::triangulate_polygons(rings, ring_offsets, polygon_offsets, options);
    std::cout << "polygon 0  " << polygons.triangles(0).size() / 3 << " triangles\n";
    for (const auto& [polygon, status, first, second] : polygons.problems())
      std::cout << "polygon " << polygon << "  " << to_string(status) << ": edges from points " << first << " and "
                << second << '\n';

    const bool right = plate.number_inside() == 16 && added.size() == 2 && both.number_inside() == 18 &&
                       polygons.triangles(0).size() == 3 * 8 && polygons.problems().size() == 1 &&
                       cadt::verify(points, segments, both, rules).ok;
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "example-constrained: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
