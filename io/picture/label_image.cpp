// SPDX-License-Identifier: Apache-2.0
// Labels from PNG files.
#include <cadt/io/label_image_file.hpp>

#include "io/support/input_file.hpp"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <string_view>

namespace cadt::io {
namespace picture {
namespace {

/// libpng's objects, and what its callbacks need. libpng leaves by longjmp: between setjmp and it there are no objects
/// with destructors.
struct PngReader {
  std::string_view bytes;
  std::size_t at = 0;
  char message[160] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit PngReader(std::string_view file) : bytes(file) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // the size of the file bounds memory
    png_set_read_fn(png, this, read);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  static void read(png_structp png, png_bytep to, std::size_t size) {
    auto& self = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (self.bytes.size() - self.at < size) png_error(png, "the file ends too early");
    std::memcpy(to, self.bytes.data() + self.at, size);
    self.at += size;
  }
  static void fail(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(self.message, text, sizeof self.message - 1);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  /// False if there is a message.
  bool read_header() noexcept {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_info(png, info);
    if (png_get_bit_depth(png, info) < 8) png_set_packing(png);  // one byte a pixel, the value unchanged
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
  }
  bool read_rows(png_bytepp rows) noexcept {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
  }
};

/// Colours that the file makes transparent by a list (tRNS).
class TransparentColours {
 public:
  TransparentColours(png_structp png, png_infop info)
      : palette_(png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE) {
    png_bytep alpha = nullptr;
    int size = 0;
    png_color_16p colour = nullptr;
    if (png_get_tRNS(png, info, &alpha, &size, &colour) == 0) return;
    if (palette_ && alpha != nullptr) alpha_.assign(alpha, alpha + size);
    if (!palette_ && colour != nullptr) {
      const bool grey = png_get_channels(png, info) < 3;
      label_ = grey ? colour->gray : (colour->red & 0xff) << 16 | (colour->green & 0xff) << 8 | (colour->blue & 0xff);
    }
  }
  [[nodiscard]] bool has(std::int32_t label) const {
    const auto i = static_cast<std::size_t>(label);
    return palette_ ? i < alpha_.size() && alpha_[i] != 0xff : label == label_;
  }

 private:
  bool palette_;
  std::vector<png_byte> alpha_;  // of each entry of the palette
  std::int32_t label_ = -1;
};

std::int32_t label_of(const png_byte* pixel, std::size_t channels, std::size_t bytes_per_channel) {
  if (channels >= 3) return pixel[0] << 16 | pixel[1] << 8 | pixel[2];
  return bytes_per_channel == 2 ? pixel[0] << 8 | pixel[1] : pixel[0];
}

}  // namespace
}  // namespace picture

LabelImage read_label_image(const std::string& path) {
  const detail::InputFile file(path);
  const auto fail = [&](const std::string& message) { throw FileError(file.name(), 0, message); };
  if (file.bytes().empty()) fail("is empty");
  const auto signature = file.bytes().substr(0, 8);
  if (signature.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(signature.data()), 0, 8) != 0) {
    fail("is no PNG; convert it, without loss, to one");
  }
  picture::PngReader reader(file.bytes());
  if (!reader.read_header()) fail(std::string("is malformed: ") + reader.message);
  LabelImage image;
  image.width = png_get_image_width(reader.png, reader.info);
  image.height = png_get_image_height(reader.png, reader.info);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  const std::size_t channels = png_get_channels(reader.png, reader.info);
  const std::size_t bytes_per_channel = png_get_bit_depth(reader.png, reader.info) == 16 ? 2 : 1;
  constexpr std::size_t most_per_byte = 1032;  // what a byte of Deflate can stand for
  if (row_bytes > most_per_byte * file.bytes().size() / image.height)
    fail("the image is larger than its file can hold");
  if (channels >= 3 && bytes_per_channel == 2) fail("has colours of 16 bits; convert it to 8 bits, or to grey values");

  std::vector<png_byte> pixels(row_bytes * image.height);
  std::vector<png_bytep> rows(image.height);
  for (std::size_t y = 0; y < image.height; ++y) rows[y] = pixels.data() + y * row_bytes;
  if (!reader.read_rows(rows.data())) fail(std::string("is malformed: ") + reader.message);

  const picture::TransparentColours transparent(reader.png, reader.info);
  image.labels.reserve(image.width * image.height);
  const std::size_t pixel_bytes = channels * bytes_per_channel;
  const bool alpha = channels == 2 || channels == 4;
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      const png_byte* pixel = rows[y] + x * pixel_bytes;
      const std::int32_t label = picture::label_of(pixel, channels, bytes_per_channel);
      bool clear = transparent.has(label);
      for (std::size_t b = pixel_bytes - bytes_per_channel; alpha && b < pixel_bytes; ++b)
        clear = clear || pixel[b] != 0xff;
      if (clear) {
        fail("the pixel in column " + std::to_string(x) + ", row " + std::to_string(y) +
             " is transparent; put the image on a background first");
      }
      image.labels.push_back(label);
    }
  }
  return image;
}

}  // namespace cadt::io
