// SPDX-License-Identifier: Apache-2.0
// Rectangles on the command line.
#pragma once

#include <cadt/io/points_file.hpp>
#include <cadt/queries.hpp>

#include <optional>
#include <string>

namespace cadt::cli {

/// "x0,y0,x1,y1" with x0 < x1 and y0 < y1; nothing if `text` is empty. Throws Failure (usage) that names `option`.
[[nodiscard]] std::optional<Box> parse_rectangle(const std::string& option, const std::string& text);

/// The box of the points.
[[nodiscard]] Box rectangle_around(const io::PointSet& points);

}  // namespace cadt::cli
