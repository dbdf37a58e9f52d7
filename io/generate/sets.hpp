// SPDX-License-Identifier: Apache-2.0
// One function per generated point set. Each appends about `options.n` points to `out.xy`.
#pragma once

#include <cadt/io/generate.hpp>

namespace cadt::io::generate_detail {

// Random points.
void uniform(const GenerateOptions& options, PointSet& out);
void cells(const GenerateOptions& options, PointSet& out);
void gaussian(const GenerateOptions& options, PointSet& out);
void kuzmin(const GenerateOptions& options, PointSet& out);
void line(const GenerateOptions& options, PointSet& out);
void ring(const GenerateOptions& options, PointSet& out);
void clusters(const GenerateOptions& options, PointSet& out);
void skewed(const GenerateOptions& options, PointSet& out);
void two_clusters(const GenerateOptions& options, PointSet& out);
void duplicates(const GenerateOptions& options, PointSet& out);

// Lattices and other sets with many exact or near ties.
void grid(const GenerateOptions& options, PointSet& out);
void tilted(const GenerateOptions& options, PointSet& out);
void hex(const GenerateOptions& options, PointSet& out);
void collinear(const GenerateOptions& options, PointSet& out);
void circles(const GenerateOptions& options, PointSet& out);
void concentric(const GenerateOptions& options, PointSet& out);
void ngon(const GenerateOptions& options, PointSet& out);
void spiral(const GenerateOptions& options, PointSet& out);
void parabola(const GenerateOptions& options, PointSet& out);

// Landscapes.
void terrain(const GenerateOptions& options, PointSet& out);
void contours(const GenerateOptions& options, PointSet& out);

}  // namespace cadt::io::generate_detail
