// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/image_file.hpp"

#include <cadt/errors.hpp>

#include "io/support/atomic_file.hpp"

#include <png.h>

namespace cadt::viewer {

void write_png(const std::string& path, const Image& picture) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(picture.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) rgb.insert(rgb.end(), picture.rgba.data() + i, picture.rgba.data() + i + 3);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;  // libpng's fast choice of filters: half the time for a few per cent more bytes
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw InternalError(std::string("libpng: ") + image.message);
  io::detail::AtomicFile file(path);
  file.write(bytes.data(), size);
  file.commit();
}

}  // namespace cadt::viewer
