// SPDX-License-Identifier: Apache-2.0
#include "large_picture.hpp"

#include "failure.hpp"

#include <fmt/format.h>

#ifdef CADT_HAS_VIEWER
#include "viewer/draw/image_file.hpp"
#include "viewer/still/still.hpp"
#endif

namespace cadt::cli {

#ifdef CADT_HAS_VIEWER
void write_large_picture(const std::string& path, const io::PointSet& points, const Triangulation& mesh, int width) {
  viewer::StillOptions still;
  still.width = width;
  viewer::write_png(path, viewer::draw_still(points, mesh, still));
}
#else
void write_large_picture(const std::string& path, const io::PointSet&, const Triangulation& mesh, int) {
  throw Failure(exit_usage, fmt::format("{}: a picture of {} triangles needs the viewer, which this program was built "
                                        "without: build it where libepoxy-dev is installed, or draw fewer points",
                                        path, mesh.number_of_triangles()));
}
#endif

}  // namespace cadt::cli
