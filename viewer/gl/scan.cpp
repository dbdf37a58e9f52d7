// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/scan.hpp"

#include "viewer/gl/shaders.hpp"

namespace cadt::viewer::gl {
namespace {

constexpr std::size_t words_of_group = 2048;  // GROUP of scan.glsl
enum Pass : GLuint { scan_groups, add_sums };

}  // namespace

Scan::Scan() : program_("scan", shaders::scan) {}

void Scan::exclusive(const Buffer& words, std::size_t count) {
  const GLuint zero = 0;
  glClearNamedBufferSubData(words.id(), GL_R32UI, static_cast<GLintptr>(count * sizeof zero), sizeof zero,
                            GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  wait_for_writes();
  program_.use();
  level(words, count + 1, 0);
}

void Scan::level(const Buffer& words, std::size_t count, std::size_t depth) {
  const std::size_t groups = (count + words_of_group - 1) / words_of_group;
  if (depth == sums_.size()) sums_.emplace_back();
  if (sums_[depth].bytes() < groups * sizeof(GLuint)) sums_[depth] = Buffer(groups * sizeof(GLuint));
  const auto run = [&](Pass pass) {
    words.bind(0);
    sums_[depth].bind(1);
    glUniform1ui(0, static_cast<GLuint>(count));
    glUniform1ui(1, pass);
    dispatch_for(count, words_of_group);
    wait_for_writes();
  };
  run(scan_groups);
  if (groups == 1) return;
  level(sums_[depth], groups, depth + 1);
  run(add_sums);
}

}  // namespace cadt::viewer::gl
