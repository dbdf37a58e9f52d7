// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/fill.hpp"

#include "viewer/gl/shaders.hpp"

namespace cadt::viewer::gl {
namespace {

constexpr std::size_t words_filled_by_group = 4096;  // GROUP of fill.glsl

}  // namespace

Fill::Fill() : program_("fill", shaders::fill) {}

void Fill::operator()(const Buffer& buffer, std::size_t count, std::uint32_t word) const {
  program_.use();
  buffer.bind(0);
  glUniform1ui(0, static_cast<GLuint>(count));
  glUniform1ui(1, word);
  dispatch_for(count, words_filled_by_group);
  wait_for_writes();
}

}  // namespace cadt::viewer::gl
