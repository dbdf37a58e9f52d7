// SPDX-License-Identifier: Apache-2.0
// Rasters: ESRI ASCII grids, arrays of NumPy, pictures.
#include "io/picture/colour.hpp"
#include "io/picture/png.hpp"
#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"
#include "io/support/npy_format.hpp"
#include "io/support/number_format.hpp"

#include <cadt/io/query_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadt::io {
namespace detail {
namespace {

void write_asc(AtomicFile& out, const std::string& path, const Grid& grid, std::span<const double> cells,
               double nodata) {
  if (grid.dx != -grid.dy) throw FileError(path, 0, "the cells of an .asc are square, with the top row first");
  const double left = grid.x0 + grid.dx * static_cast<double>(grid.first_column);
  const double bottom = grid.y0 + grid.dy * static_cast<double>(grid.first_row + grid.rows);
  out.write(fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value {}\n", grid.columns,
                        grid.rows, left, bottom, grid.dx, nodata));
  std::size_t in_row = 0;
  for (const double value : cells) {
    if (value == nodata) {
      throw FileError(path, 0,
                      fmt::format("a cell has the value {}, which stands for no data: choose another such "
                                  "value (--nodata)",
                                  nodata));
    }
    char* at = put(out.room(number_room + 1), std::isnan(value) ? nodata : value);
    in_row = in_row + 1 == grid.columns ? 0 : in_row + 1;
    *at++ = in_row == 0 ? '\n' : ' ';
    out.advance(at);
  }
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

/// Colours by height; light from the upper left, as strong as for a mesh: the 85 % quantile of slopes is one in one.
std::string raster_png(const Grid& grid, std::span<const double> cells) {
  using namespace picture;
  Range range;
  for (const double v : cells) {
    if (std::isnan(v)) continue;
    range.low = std::min(range.low, v);
    range.high = std::max(range.high, v);
  }
  const double span = range.high > range.low ? range.high - range.low : 1.0;
  const auto relative = [&](std::size_t i) { return static_cast<float>((cells[i] - range.low) / span); };
  // Difference to the neighbour before or after; 0 beside cells without data.
  const auto slope = [&](std::size_t i, std::size_t place, std::size_t length, std::size_t step) {
    const std::size_t a = place == 0 ? i : i - step;
    const std::size_t b = place + 1 == length ? i : i + step;
    if (a == b) return 0.0f;
    const float d = (relative(b) - relative(a)) / static_cast<float>((b - a) / step);
    return std::isnan(d) ? 0.0f : d;
  };
  std::vector<float> slopes;
  for (std::size_t i = 0; i < cells.size(); i += 1 + cells.size() / 100'000) {
    if (std::isnan(cells[i])) continue;
    slopes.push_back(
        std::hypot(slope(i, i % grid.columns, grid.columns, 1), slope(i, i / grid.columns, grid.rows, grid.columns)));
  }
  float scale = 0;
  if (!slopes.empty()) {
    const auto steep = slopes.begin() + static_cast<std::ptrdiff_t>(0.85 * static_cast<double>(slopes.size() - 1));
    std::nth_element(slopes.begin(), steep, slopes.end());
    if (*steep > 0) scale = 1 / *steep;
  }
  Pixels pixels(static_cast<int>(grid.columns), static_cast<int>(grid.rows), paper);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::isnan(cells[i])) continue;
    const std::size_t x = i % grid.columns, y = i / grid.columns;
    const float light = hill_shade(scale * slope(i, x, grid.columns, 1), scale * slope(i, y, grid.rows, grid.columns));
    const Rgb colour = terrain_ramp()(relative(i));
    pixels.row(static_cast<int>(y))[x] = to_srgb({colour.r * light, colour.g * light, colour.b * light});
  }
  return pixels.png();
}

}  // namespace
}  // namespace detail

std::vector<std::string> raster_write_formats() { return {"asc", "npy", "png"}; }

void write_raster(const std::string& path, const Grid& grid, std::span<const double> cells, double nodata,
                  const std::string& asked) {
  using namespace detail;
  const std::string format = choose_format(path == "-" ? "<stdout>" : path, asked, raster_write_formats());
  if (cells.size() != grid.cells()) throw FileError(path, 0, "the raster has another size than its grid");
  constexpr std::size_t largest_picture = 32767;  // Cairo's
  if (format == "png" && std::max(grid.columns, grid.rows) > largest_picture) {
    throw FileError(path, 0,
                    fmt::format("{} x {} cells are too many for a picture (at most {} a side): take larger "
                                "cells, or write an .asc or .npy",
                                grid.columns, grid.rows, largest_picture));
  }
  AtomicFile out(path);
  if (format == "asc") {
    write_asc(out, path, grid, cells, nodata);
  } else if (format == "npy") {
    out.write(npy_header("<f8", {grid.rows, grid.columns}));
    out.write(cells.data(), cells.size_bytes());
  } else {
    out.write(raster_png(grid, cells));
  }
  out.commit();
}

}  // namespace cadt::io
