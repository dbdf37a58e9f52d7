// SPDX-License-Identifier: Apache-2.0
// Labels in PNG files: of each kind of pixels, malformed, and those of other projects (CADT_DATA_DIR).
#include <cadt/io/label_image_file.hpp>
#include <cadt/label_image.hpp>

#include <png.h>

#include <cstdlib>
#include <set>

#include "tests/unit/io/io_test_support.hpp"
#include "tests/unit/labels/label_checks.hpp"

namespace cadt::io::test {
namespace {

namespace fs = std::filesystem;
using Labels = std::vector<std::int32_t>;
using Bytes = std::vector<png_byte>;

struct Kind {
  int bits, type;
  bool interlaced = false;
};

/// A PNG of the bytes of its rows.
std::string png_of(std::size_t width, std::size_t height, Kind kind, Bytes rows) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_write_fn(
      png, &file,
      [](png_structp to, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(to))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.bits, kind.type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[4] = {{9, 9, 9}, {9, 9, 9}, {1, 2, 3}, {4, 5, 6}};
  if (kind.type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 4);
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (std::size_t y = 0; y < height; ++y) pointers.push_back(rows.data() + y * (rows.size() / height));
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

TEST(LabelFiles, OfGreyValuesAndIndicesHaveThese) {
  const Folder folder;
  const auto labels = [&](Kind kind, std::size_t width, std::size_t height, const Bytes& rows) {
    const LabelImage image = read_label_image(folder.file("a.png", png_of(width, height, kind, rows)));
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    return image.labels;
  };
  EXPECT_EQ(labels({8, PNG_COLOR_TYPE_GRAY}, 3, 2, {0, 1, 255, 7, 8, 9}), (Labels{0, 1, 255, 7, 8, 9}));
  EXPECT_EQ(labels({16, PNG_COLOR_TYPE_GRAY}, 2, 1, {1, 2, 255, 254}), (Labels{258, 65534}));
  EXPECT_EQ(labels({1, PNG_COLOR_TYPE_GRAY}, 8, 1, {0x65}), (Labels{0, 1, 1, 0, 0, 1, 0, 1}));
  EXPECT_EQ(labels({4, PNG_COLOR_TYPE_GRAY}, 3, 1, {0x1f, 0xa0}), (Labels{1, 15, 10}));
  EXPECT_EQ(labels({2, PNG_COLOR_TYPE_PALETTE}, 4, 1, {0x1b}), (Labels{0, 1, 2, 3}))
      << "the index, not the colour: two are equal";
  EXPECT_EQ(labels({8, PNG_COLOR_TYPE_RGB}, 2, 1, {1, 2, 3, 255, 254, 253}), (Labels{0x010203, 0xfffefd}));
  EXPECT_EQ(labels({8, PNG_COLOR_TYPE_RGB_ALPHA}, 2, 1, {1, 2, 3, 255, 4, 5, 6, 255}), (Labels{0x010203, 0x040506}));
  EXPECT_EQ(labels({8, PNG_COLOR_TYPE_GRAY_ALPHA}, 2, 1, {7, 255, 9, 255}), (Labels{7, 9}));
  EXPECT_EQ(labels({16, PNG_COLOR_TYPE_GRAY_ALPHA}, 1, 1, {1, 7, 255, 255}), (Labels{263}));
  EXPECT_EQ(labels({8, PNG_COLOR_TYPE_GRAY, true}, 3, 2, {0, 1, 255, 7, 8, 9}), (Labels{0, 1, 255, 7, 8, 9}));
}

TEST(LabelFiles, CanBeWiderThanAMillionPixels) {
  const Folder folder;
  const std::size_t width = 1000001;
  const LabelImage image =
      read_label_image(folder.file("a.png", png_of(width, 1, {8, PNG_COLOR_TYPE_GRAY}, Bytes(width, 3))));
  EXPECT_EQ(image.labels, Labels(width, 3));
}

TEST(LabelFiles, ThatAreNoneSayWhy) {
  const Folder folder;
  const auto expect = [&](const std::string& content, const char* message) {
    const std::string path = folder.file("a.png", content);
    expect_file_error([&] { static_cast<void>(read_label_image(path)); }, path, 0, message);
  };
  const std::string good = png_of(3, 2, {8, PNG_COLOR_TYPE_GRAY}, {0, 1, 255, 7, 8, 9});
  expect("", "is empty");
  expect("P5 3 2 255 ", "is no PNG");
  for (const std::size_t size : {std::size_t{9}, std::size_t{20}, std::size_t{35}, good.size() - 14}) {
    expect(good.substr(0, size), "is malformed: the file ends too early");
  }
  std::string damaged = good;
  damaged[20] = 1;  // of the width
  expect(damaged, "is malformed: ");
  expect(png_of(2, 1, {16, PNG_COLOR_TYPE_RGB}, Bytes(12, 1)), "has colours of 16 bits");
  expect(png_of(2, 1, {8, PNG_COLOR_TYPE_RGB_ALPHA}, {1, 2, 3, 255, 4, 5, 6, 254}), "column 1, row 0 is transparent");
  expect(png_of(1, 1, {16, PNG_COLOR_TYPE_GRAY_ALPHA}, {1, 7, 255, 254}), "column 0, row 0 is transparent");
  expect_file_error([&] { static_cast<void>(read_label_image(folder / "absent.png")); }, folder / "absent.png", 0, "");
}

struct Known {
  const char* name;
  std::size_t width, height, labels;
};

TEST(LabelImagesOfOthers, HaveEverySideOfTheirPixelsOnce) {
  const char* chosen = std::getenv("CADT_DATA_DIR");
  const fs::path data = fs::path(chosen != nullptr ? chosen : CADT_DEFAULT_DATA_DIR) / "pslg";
  if (!fs::exists(data)) GTEST_SKIP() << "no " << data;
  for (const Known& known : {Known{"nanomesh_segmented_image.png", 200, 200, 2},
                             Known{"oof2_composition.png", 100, 100, 6}, Known{"oof2_ellipses.png", 288, 288, 363},
                             Known{"oof2_small.png", 150, 150, 8}, Known{"stardist_mask2d.png", 512, 512, 126}}) {
    SCOPED_TRACE(known.name);
    const LabelImage image = read_label_image((data / known.name).string());
    EXPECT_EQ(image.width, known.width);
    EXPECT_EQ(image.height, known.height);
    EXPECT_EQ(std::set<std::int32_t>(image.labels.begin(), image.labels.end()).size(), known.labels);
    const LabelSegments found = label_segments(image.labels, image.width, image.height);
    EXPECT_EQ(cadt::test::why_wrong(image.labels, image.width, image.height, found), "");
  }
}

}  // namespace
}  // namespace cadt::io::test
