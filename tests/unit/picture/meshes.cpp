// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/picture/meshes.hpp"

#include "io/picture/colour.hpp"

#include <gtest/gtest.h>
#include <png.h>

namespace cadt::test {

Mesh lattice(int m) {
  Mesh mesh;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m; ++i) mesh.xy.insert(mesh.xy.end(), {static_cast<double>(i), static_cast<double>(j)});
  }
  for (int j = 0; j + 1 < m; ++j) {
    for (int i = 0; i + 1 < m; ++i) {
      const std::int32_t a = j * m + i;
      mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + m + 1, a, a + m + 1, a + m});
    }
  }
  for (int i = 0; i + 1 < m; ++i) mesh.hull.push_back(i);
  for (int j = 0; j + 1 < m; ++j) mesh.hull.push_back(j * m + m - 1);
  for (int i = m - 1; i > 0; --i) mesh.hull.push_back((m - 1) * m + i);
  for (int j = m - 1; j > 0; --j) mesh.hull.push_back(j * m);
  return mesh;
}

Mesh fan(int n, double left_height) {
  Mesh mesh;
  for (int i = 0; i < n; ++i) mesh.xy.insert(mesh.xy.end(), {0.0, left_height * i / (n - 1)});
  mesh.xy.insert(mesh.xy.end(), {1.0, 0.5 * left_height});
  for (int i = 0; i + 1 < n; ++i) mesh.triangles.insert(mesh.triangles.end(), {i, n, i + 1});
  mesh.hull.push_back(0);
  mesh.hull.push_back(n);
  for (int i = n - 1; i > 0; --i) mesh.hull.push_back(i);
  return mesh;
}

Mesh moved(Mesh mesh, double scale, double shift) {
  for (double& v : mesh.xy) v = v * scale + shift;
  return mesh;
}

int Image::light(int x, int y) const {
  const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  return rgb[i] + rgb[i + 1] + rgb[i + 2];
}

bool Image::is_paper(int x, int y) const {
  const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  const auto seen = static_cast<std::uint32_t>(rgb[i] << 16 | rgb[i + 1] << 8 | rgb[i + 2]);
  return seen == io::picture::paper;
}

Image decode(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Image out;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    ADD_FAILURE() << "not a PNG: " << image.message;
    return out;
  }
  image.format = PNG_FORMAT_RGB;
  out.width = static_cast<int>(image.width);
  out.height = static_cast<int>(image.height);
  out.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, out.rgb.data(), 0, nullptr) == 0) {
    ADD_FAILURE() << "damaged PNG: " << image.message;
  }
  return out;
}

}  // namespace cadt::test
