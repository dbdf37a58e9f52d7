// SPDX-License-Identifier: Apache-2.0
// Files of values, and of the answers to queries: tables, rasters, Voronoi diagrams.
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/queries.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace cadt::io {

/// Numbers at points, row by row.
struct Values {
  std::vector<double> values;  ///< rows x per_row
  std::size_t per_row = 1;
  [[nodiscard]] std::size_t rows() const noexcept { return per_row == 0 ? 0 : values.size() / per_row; }
};

/// Reads a file of numbers, a row a point: txt, csv (all columns; a header line is skipped) or npy of shape (n,) or (n,
/// m), floats or integers. "-" is standard input, for which `format` is required. \throws FileError with the line or
/// byte, also for NaN, infinity, and rows of different lengths
[[nodiscard]] Values read_values(const std::string& path, const std::string& format = {});

/// Names of the formats that values can be read from.
[[nodiscard]] std::vector<std::string> value_read_formats();

/// A view of an array with a name, row by row. `columns` = 0: one number a row, an array of one dimension.
struct NamedArray {
  std::string name;
  std::variant<std::span<const double>, std::span<const std::int32_t>, std::span<const std::uint32_t>> data;
  std::size_t columns = 0;
};

/// Writes arrays. csv, txt: side by side as columns, in csv with a header line of names (name0, name1 ... if an array
/// has several columns); they must have equally many rows. npy: one array. npz: all, by name. Numbers are the shortest
/// decimals that read back to the same doubles; NaN is "nan". The file appears when it is complete; "-" is standard
/// output. \throws FileError
void write_arrays(const std::string& path, std::span<const NamedArray> arrays, const std::string& format = {});

/// Names of the formats that arrays can be written to.
[[nodiscard]] std::vector<std::string> array_write_formats();

/// Writes a raster whose first row is the top one (`grid.dy` is negative). asc: ESRI ASCII grid, cells must be square;
/// npy: rows x columns doubles; png: a picture, a pixel a cell. NaN is `nodata` in .asc and stays NaN in .npy. \throws
/// FileError, also if a cell has the value `nodata`
void write_raster(const std::string& path, const Grid& grid, std::span<const double> cells, double nodata,
                  const std::string& format = {});

/// Names of the formats that rasters can be written to.
[[nodiscard]] std::vector<std::string> raster_write_formats();

/// Cells whose polygon has an area. Where the box runs along the side of a cell, others may touch it in a line or
/// point.
[[nodiscard]] std::size_t number_of_cells(const VoronoiPolygons& polygons);

/// Writes the polygons of Voronoi cells that have an area. geojson: a feature a cell, with the property "point"; svg: a
/// picture of the cells and of the points within `box`. \throws FileError
void write_voronoi(const std::string& path, std::span<const double> xy, const VoronoiPolygons& polygons, const Box& box,
                   const std::string& format = {});

}  // namespace cadt::io
