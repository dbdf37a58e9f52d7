// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/objects.hpp"

#include "viewer/gl/errors.hpp"

#include <algorithm>
#include <atomic>

namespace cadt::viewer::gl {

void delete_buffer(GLuint id) { glDeleteBuffers(1, &id); }
void delete_texture(GLuint id) { glDeleteTextures(1, &id); }
void delete_program(GLuint id) {
  glUseProgram(0);  // one that is in use is kept until another is, and ImGui would use it again
  glDeleteProgram(id);
}

void delete_memory(GLuint id) { glDeleteMemoryObjectsEXT(1, &id); }

namespace {

std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> made{0};
  return ++made;
}

void forget_errors() {
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace

Buffer::Buffer(std::size_t bytes) : bytes_(bytes), serial_(next_serial()) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  name_ = Name<delete_buffer>(id);
  forget_errors();
  // A buffer without bytes cannot be bound.
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes == 0 ? 16 : bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw OutOfMemory("the display's device has no room for a buffer of " + std::to_string(bytes) +
                          " bytes: draw fewer points, or close other programs that use it",
                      bytes, 0);
}

Buffer::Buffer(std::size_t bytes, int file) : bytes_(bytes), serial_(next_serial()) {
  forget_errors();
  GLuint id = 0;
  glCreateMemoryObjectsEXT(1, &id);
  memory_ = Name<delete_memory>(id);
  const GLint dedicated = GL_TRUE;
  glMemoryObjectParameterivEXT(id, GL_DEDICATED_MEMORY_OBJECT_EXT, &dedicated);
  glImportMemoryFdEXT(id, bytes, GL_HANDLE_TYPE_OPAQUE_FD_EXT, file);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  name_ = Name<delete_buffer>(buffer);
  glNamedBufferStorageMemEXT(buffer, static_cast<GLsizeiptr>(bytes), id, 0);
  if (const GLenum code = glGetError(); code != GL_NO_ERROR)
    throw DisplayError("OpenGL cannot use memory of another interface (error " + std::to_string(code) +
                       "): update the driver");
}

void Buffer::write(std::span<const std::byte> data, std::size_t offset) {
  if (data.empty()) return;
  const auto bytes = static_cast<GLsizeiptr>(data.size());
  if (memory_.id() == 0) {
    glNamedBufferSubData(name_.id(), static_cast<GLintptr>(offset), bytes, data.data());
    return;
  }
  Buffer staging(data.size());  // memory of another interface takes copies alone
  staging.write(data);
  glCopyNamedBufferSubData(staging.id(), name_.id(), 0, static_cast<GLintptr>(offset), bytes);
}

void Buffer::read(std::span<std::byte> data, std::size_t offset) const {
  if (data.empty()) return;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  // NVIDIA's driver moves a buffer that is read to the memory of the host; and of memory that others write, too, it
  // would give what it read before.
  if (memory_.id() != 0 || data.size() < bytes_) {
    const Buffer staging(data.size());
    glCopyNamedBufferSubData(name_.id(), staging.id(), static_cast<GLintptr>(offset), 0,
                             static_cast<GLsizeiptr>(data.size()));
    staging.read(data, 0);
    return;
  }
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

void dispatch_for(std::size_t elements, std::size_t size) {
  constexpr std::size_t most_groups = 32768;
  const std::size_t groups = (elements + size - 1) / size;
  if (groups == 0) return;
  glDispatchCompute(static_cast<GLuint>(std::min(groups, most_groups)),
                    static_cast<GLuint>((groups + most_groups - 1) / most_groups), 1);
}

void wait_for_writes() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
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
