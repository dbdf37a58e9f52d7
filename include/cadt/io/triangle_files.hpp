// SPDX-License-Identifier: Apache-2.0
// The files of Triangle as `cadt triangle` reads and writes them. docs/triangle.md
#pragma once

#include <cadt/io/errors.hpp>
#include <cadt/triangle.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace cadt::io {

/// A .node file with all its columns.
struct NodeFile {
  std::vector<double> xy;          ///< n x 2
  std::vector<double> attributes;  ///< n x attributes_per_point
  std::size_t attributes_per_point = 0;
  std::vector<int> markers;  ///< n, or empty if the file has none
  int base = 0;              ///< the first index: 0 or 1
};

/// Reads a .node file. \throws FileError, also for another dimension than 2, and for a line without all its columns
[[nodiscard]] NodeFile read_node_file(const std::string& path);

/// What Triangle makes of a file's name: "dots", "dots.node" and "dots.1" are read from dots.node and dots.1.node, and
/// written to dots.1.node, dots.2.ele ...; without iteration number to dots.ele, dots.1.ele ... With switch p, or for
/// "dots.poly", dots.poly is read.
struct TriangleNames {
  std::string input;   ///< the .node or .poly file
  std::string output;  ///< of the files written, without suffix
};
/// \throws SwitchError for .ele and .area files, which stand for switches that are refused; FileError for an
/// empty name or an iteration number that cannot be counted up
[[nodiscard]] TriangleNames triangle_names(const std::string& file, bool no_iteration, bool segments = false);

/// The files that `write_triangle_files` writes, in its order. `points_in_poly`: the points were read from a .poly file
/// itself (SegmentsFile::nodes_beside is false), so that with -I no .node file of the input would be overwritten.
[[nodiscard]] std::vector<std::string> triangle_output_files(const std::string& output,
                                                             const TriangleSwitches& switches,
                                                             bool points_in_poly = false);

/// Writes .node .ele .neigh .edge .v.node .v.edge .poly .off as the switches ask, counting from `base`. All files are
/// complete in temporary ones before the first of them appears under its name. \throws FileError
void write_triangle_files(const std::string& output, const TriangleOutput& mesh, const TriangleSwitches& switches,
                          int base, bool points_in_poly = false);

}  // namespace cadt::io
