// SPDX-License-Identifier: Apache-2.0
// Statements of Wavefront OBJ files.
#pragma once

#include "io/support/text_scanner.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace cadt::io::detail {

/// Keywords that may start a line of an OBJ file; anything else means that the file is something else.
[[nodiscard]] inline bool is_obj_keyword(std::string_view word) {
  static constexpr std::string_view keywords[] = {
      "v",    "vt",     "vn",     "vp",         "f",         "l",     "p",     "g",     "o",        "s",
      "mg",   "usemtl", "mtllib", "cstype",     "deg",       "bmat",  "step",  "curv",  "curv2",    "surf",
      "parm", "trim",   "hole",   "scrv",       "sp",        "end",   "con",   "bevel", "c_interp", "d_interp",
      "lod",  "maplib", "usemap", "shadow_obj", "trace_obj", "ctech", "stech", "call",  "csh",      "bsp",
      "bzp",  "cdc",    "cdp",    "res",        "fo",        "mtl"};
  return std::find(std::begin(keywords), std::end(keywords), word) != std::end(keywords);
}

/// Goes to the next line whose keyword is `wanted` and has read that keyword; false at the end of the text. Counts the
/// vertices (lines "v") on its way. Unknown keywords are errors.
[[nodiscard]] inline bool next_obj_statement(TextScanner& scanner, std::string_view wanted, std::size_t& vertices) {
  while (scanner.next_content_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "v") ++vertices;
    if (keyword == wanted) return true;
    if (!is_obj_keyword(keyword)) scanner.fail(quoted(keyword) + " is not a keyword of OBJ");
  }
  return false;
}

}  // namespace cadt::io::detail
