// SPDX-License-Identifier: Apache-2.0
// Owners of OpenGL's objects. All calls are for the context that is current on the thread.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cadt::viewer::gl {

/// A name that is deleted once.
template <void (*destroy)(GLuint)>
class Name {
 public:
  Name() = default;
  explicit Name(GLuint id) : id_(id) {}
  Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Name() {
    if (id_ != 0) destroy(id_);
  }
  [[nodiscard]] GLuint id() const noexcept { return id_; }

 private:
  GLuint id_ = 0;
};

void delete_buffer(GLuint id);
void delete_texture(GLuint id);
void delete_program(GLuint id);
void delete_memory(GLuint id);

/// A buffer in the memory of the display's device.
class Buffer {
 public:
  Buffer() = default;
  /// Of so many bytes, which are undefined. \throws OutOfMemory
  explicit Buffer(std::size_t bytes);
  /// In memory of another interface to the same device, which `file` stands for (GL_EXT_memory_object_fd). Takes the
  /// file over. \throws DisplayError if the driver cannot do that
  Buffer(std::size_t bytes, int file);

  [[nodiscard]] GLuint id() const noexcept { return name_.id(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// Differs from that of each other buffer of this process, also if OpenGL gives an id away again.
  [[nodiscard]] std::uint64_t serial() const noexcept { return serial_; }
  void write(std::span<const std::byte> data, std::size_t offset = 0);
  template <class T>
  void write_values(std::span<const T> values, std::size_t offset = 0) {
    write(std::as_bytes(values), offset);
  }
  template <class T>
  [[nodiscard]] std::vector<T> read_values(std::size_t count, std::size_t offset = 0) const {
    std::vector<T> values(count);
    read(std::as_writable_bytes(std::span(values)), offset);
    return values;
  }
  /// Fills the first `bytes` bytes with a word. For a few: Fill is faster for many.
  void fill(GLuint word, std::size_t bytes);
  void bind(GLuint slot) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, slot, name_.id()); }

 private:
  void read(std::span<std::byte> data, std::size_t offset) const;
  Name<delete_memory> memory_;  // goes after the buffer
  Name<delete_buffer> name_;
  std::size_t bytes_ = 0;
  std::uint64_t serial_ = 0;
};

/// A compute program. `text` follows "#version 450 core". \throws DisplayError with the driver's log
class Program {
 public:
  Program() = default;
  Program(const std::string& name, const std::string& text);
  void use() const { glUseProgram(name_.id()); }
  [[nodiscard]] GLuint id() const noexcept { return name_.id(); }

 private:
  Name<delete_program> name_;
};

/// Runs the program in use: one group of work-items for each `size` elements. Along x at most 32,768, the others along
/// y: programs number them gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x.
void dispatch_for(std::size_t elements, std::size_t size);
/// What programs have written is there for programs, copies, and numbers of groups.
void wait_for_writes();

/// An image of 8 bits a channel, sRGB bytes as they are shown, that a compute program writes.
class Texture {
 public:
  Texture() = default;
  Texture(int width, int height);
  [[nodiscard]] GLuint id() const noexcept { return name_.id(); }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  Name<delete_texture> name_;
  int width_ = 0, height_ = 0;
};

}  // namespace cadt::viewer::gl
