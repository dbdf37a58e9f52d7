// SPDX-License-Identifier: Apache-2.0
// The table of generated point sets.
#include <cadt/io/generate.hpp>

#include "io/generate/sets.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>

namespace cadt::io {

namespace {

struct Entry {
  Distribution about;
  void (*make)(const GenerateOptions&, PointSet&);
};

namespace sets = generate_detail;

constexpr std::array entries{
    Entry{{"uniform", "independent uniform points of the unit square", true}, sets::uniform},
    Entry{{"cells",
           "uniform in each of equal cells of the unit square, which have the same number of points: cadt tiles makes "
           "them tile by tile on the device"},
          sets::cells},
    Entry{{"gaussian", "one standard normal cloud", true}, sets::gaussian},
    Entry{{"grid", "integer lattice, row by row, near-square: every four neighbours are cocircular"}, sets::grid},
    Entry{{"tilted", "integer lattice turned by 302.328 degrees and rounded: near ties everywhere"}, sets::tilted},
    Entry{{"hex", "triangular lattice with unit spacing"}, sets::hex},
    Entry{{"circles",
           "k points on each circle of a grid of circles in the unit square, each coordinate displaced by at "
           "most epsilon cells; n rounded to k times a square"},
          sets::circles},
    Entry{{"concentric", "108 integer points on each of many concentric circles, exactly cocircular"},
          sets::concentric},
    Entry{{"ngon", "corners of one regular polygon on the unit circle, rounded: all nearly cocircular"}, sets::ngon},
    Entry{{"kuzmin", "Kuzmin disk: dense centre, heavy tail, radius sqrt(1/(1-u)^2 - 1)", true}, sets::kuzmin},
    Entry{{"line", "singular along the line x = 0: x = b/(u - b u + b) with b = 0.001", true}, sets::line},
    Entry{{"collinear", "integer points exactly on one line of slope 2/3, in shuffled order: no triangles"},
          sets::collinear},
    Entry{{"spiral", "points of a spiral with turns of equal distance"}, sets::spiral},
    Entry{{"parabola", "integer points (i, i^2): all on the hull, very long triangles"}, sets::parabola},
    Entry{{"clusters", "100 normal clusters of standard deviation 1e-6 in the unit square"}, sets::clusters},
    Entry{{"skewed", "99.9 % of the points in a square of side 1e-12, the others uniform in the unit square"},
          sets::skewed},
    Entry{{"two-clusters", "two unit squares 1e12 apart in x and in y"}, sets::two_clusters},
    Entry{{"duplicates", "uniform points of which every second one is a copy of an earlier one"}, sets::duplicates},
    Entry{{"ring", "uniform in an annulus of radius 0.45 and width 0.001", true}, sets::ring},
    Entry{{"terrain", "uniform points of the unit square with the height of fractal mountains"}, sets::terrain},
    Entry{{"contours", "points along level lines of the same mountains, with heights"}, sets::contours},
};

}  // namespace

const std::vector<Distribution>& distributions() {
  static const std::vector<Distribution> list = [] {
    std::vector<Distribution> all;
    for (const Entry& entry : entries) all.push_back(entry.about);
    return all;
  }();
  return list;
}

PointSet generate(std::string_view distribution, const GenerateOptions& options) {
  for (const Entry& entry : entries) {
    if (entry.about.name != distribution) continue;
    if (options.first != 0 && (!entry.about.by_range || options.first > options.n))
      throw std::invalid_argument(fmt::format("a part of the set '{}' cannot be made", distribution));
    PointSet out;
    out.format = distribution;
    entry.make(options, out);
    return out;
  }
  std::string known;
  for (const Entry& entry : entries) {
    if (!known.empty()) known += ' ';
    known += entry.about.name;
  }
  throw std::invalid_argument(fmt::format("unknown distribution '{}'; known: {}", distribution, known));
}

}  // namespace cadt::io
