// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/objects.hpp"

#include "viewer/gl/errors.hpp"

#include <atomic>

namespace cadt::viewer::gl {

void delete_buffer(GLuint id) { glDeleteBuffers(1, &id); }
void delete_texture(GLuint id) { glDeleteTextures(1, &id); }
void delete_program(GLuint id) { glDeleteProgram(id); }
void delete_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }

Buffer::Buffer(std::size_t bytes) : bytes_(bytes) {
  static std::atomic<std::uint64_t> made{0};
  serial_ = ++made;
  GLuint id = 0;
  glCreateBuffers(1, &id);
  name_ = Name<delete_buffer>(id);
  while (glGetError() != GL_NO_ERROR) {
  }
  // A buffer without bytes cannot be bound.
  glNamedBufferData(id, static_cast<GLsizeiptr>(bytes == 0 ? 16 : bytes), nullptr, GL_DYNAMIC_COPY);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw OutOfMemory("the display's device has no room for a buffer of " + std::to_string(bytes) +
                          " bytes: draw fewer points, or close other programs that use it",
                      bytes, 0);
}

void Buffer::write(std::span<const std::byte> data, std::size_t offset) {
  if (!data.empty())
    glNamedBufferSubData(name_.id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
}

void Buffer::read(std::span<std::byte> data, std::size_t offset) const {
  if (data.empty()) return;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(name_.id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
}

void Buffer::fill(GLuint word, std::size_t bytes) {
  if (bytes == 0) return;
  glClearNamedBufferSubData(name_.id(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT,
                            &word);
}

Program::Program(const std::string& name, const std::string& text) {
  const std::string whole = "#version 450 core\n" + text;
  const char* source = whole.c_str();
  const GLuint id = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source);
  name_ = Name<delete_program>(id);
  GLint linked = GL_FALSE;
  glGetProgramiv(id, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  GLint size = 0;
  glGetProgramiv(id, GL_INFO_LOG_LENGTH, &size);
  std::string log(static_cast<std::size_t>(size > 0 ? size : 1), '\0');
  glGetProgramInfoLog(id, size, nullptr, log.data());
  throw DisplayError("the OpenGL driver cannot compile '" + name +
                     "': update the driver, or report this with its log:\n" + log);
}

Texture::Texture(int width, int height) : width_(width), height_(height) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  name_ = Name<delete_texture>(id);
  glTextureStorage2D(id, 1, GL_RGBA8, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

}  // namespace cadt::viewer::gl
