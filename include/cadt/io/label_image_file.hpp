// SPDX-License-Identifier: Apache-2.0
// Reading images of labels.
#pragma once

#include <cadt/io/errors.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cadt::io {

/// Labels row by row from the top.
struct LabelImage {
  std::size_t width = 0, height = 0;
  std::vector<std::int32_t> labels;  ///< width x height
};

/// Reads a .png: the label of a pixel is its value where the image is grey (1 to 16 bits), its index where it has a
/// palette, else its colour as 0xRRGGBB. Anti-aliased images have labels of their own where colours mix: they need a
/// threshold first. "-" is standard input. Memory is bounded by a multiple of the file's size, whatever its header
/// claims. \throws FileError, also for colours of 16 bits and for transparent pixels
[[nodiscard]] LabelImage read_label_image(const std::string& path);

}  // namespace cadt::io
