// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/image_file.hpp"

#include "io/picture/png.hpp"
#include "io/support/atomic_file.hpp"

namespace cadt::viewer {

void write_png(const std::string& path, const Image& picture) {
  io::picture::Pixels pixels(picture.width, picture.height, 0);
  const std::uint8_t* from = picture.rgba.data();
  for (std::uint32_t* to = pixels.row(0); to != pixels.row(picture.height); ++to, from += 4)
    *to = static_cast<std::uint32_t>(from[0] << 16 | from[1] << 8 | from[2]);
  const std::string bytes = pixels.png();
  io::detail::AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace cadt::viewer
