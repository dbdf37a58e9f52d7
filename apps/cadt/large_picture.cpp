// SPDX-License-Identifier: Apache-2.0
#include "large_picture.hpp"

#include "failure.hpp"

#include <fmt/format.h>

#include <algorithm>

#ifdef CADT_HAS_VIEWER
#include "viewer/draw/image_file.hpp"
#include "viewer/still/still.hpp"
#endif

namespace cadt::cli {

#ifdef CADT_HAS_VIEWER
void write_large_picture(const std::string& path, const io::PointSet& points, const Triangulation& mesh,
                         const io::WriteOptions& how) {
  constexpr int most_side = 16384;  // of an image of OpenGL
  if (how.width > most_side)
    throw Failure(exit_usage, fmt::format("{}: --width {}: a picture of {} triangles has at most {} pixels a side",
                                          path, how.width, mesh.number_of_triangles(), most_side));
  viewer::StillOptions still;
  still.width = how.width;
  still.most_height = std::min(how.max_height, most_side);
  viewer::write_png(path, viewer::draw_still(points, mesh, still));
}
#else
void write_large_picture(const std::string& path, const io::PointSet&, const Triangulation& mesh,
                         const io::WriteOptions&) {
  throw Failure(exit_usage, fmt::format("{}: a picture of {} triangles needs the viewer, which this program was built "
                                        "without: build it where libepoxy-dev is installed, or draw fewer points",
                                        path, mesh.number_of_triangles()));
}
#endif

}  // namespace cadt::cli
