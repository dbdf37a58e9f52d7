// SPDX-License-Identifier: Apache-2.0
// Many small sets in one call: the mean area of the triangles of each.
//
// usage: example-batch [sets [points of each [back end]]]      e.g. example-batch 10000 1000 cuda
#include <cadt/cadt.hpp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <random>
#include <vector>

int main(int count, char** values) {
  try {
    const std::size_t sets = count > 1 ? std::strtoul(values[1], nullptr, 10) : 1000;
    const std::size_t size = count > 2 ? std::strtoul(values[2], nullptr, 10) : 1000;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> coordinate(0.0, 1.0);
    std::vector<double> xy(2 * sets * size);
    for (double& value : xy) value = coordinate(random);
    std::vector<std::size_t> offsets(sets + 1);  // set s has the points from offsets[s] on, below offsets[s + 1]
    for (std::size_t s = 0; s <= sets; ++s) offsets[s] = s * size;

    cadt::Options options;
    if (count > 3) options.backend = cadt::backend_from_string(values[3]);
    const cadt::TriangulationBatch batch = cadt::triangulate_batch(xy, offsets, options);

    double least = 1, most = 0;
    for (std::size_t s = 0; s < batch.size(); ++s) {
      const auto triangles = batch.triangles(s);  // vertices are numbers of the set's own points
      const double* points = xy.data() + 2 * offsets[s];
      double area = 0;
      for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const double *a = points + 2 * triangles[t], *b = points + 2 * triangles[t + 1],
                     *c = points + 2 * triangles[t + 2];
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
      }
      least = std::min(least, area);
      most = std::max(most, area);
    }
    std::cout << "sets        " << batch.size() << ", " << batch.statistics().batched_sets << " of them together\n"
              << "triangles   " << batch.triangle_offsets().back() << '\n'
              << "hull areas  " << least << " to " << most << '\n'
              << "back end    " << batch.statistics().backend << ", " << batch.statistics().device << '\n';

    const cadt::Triangulation one = batch.triangulation(sets / 2);  // a copy with hull and hash
    const auto part = std::span<const double>(xy).subspan(2 * offsets[sets / 2], 2 * size);
    std::cout << "one set     " << one.hull().size() << " points on its hull, " << cadt::verify(part, one).summary()
              << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "example-batch: " << error.what() << '\n';
    return 1;
  }
}
