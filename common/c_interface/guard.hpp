// SPDX-License-Identifier: Apache-2.0
// What stands between C and C++: no exception passes, each becomes a status and the last error of the thread.
#pragma once

#include <cadt/cadt.h>
#include <cadt/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

namespace cadt::c_interface {

/// An argument that no function of C++ would be given.
class InvalidArgument : public Error {
 public:
  InvalidArgument(std::string argument, const std::string& what)
      : Error("argument '" + argument + "': " + what), argument_(std::move(argument)) {}
  [[nodiscard]] const std::string& argument() const noexcept { return argument_; }

 private:
  std::string argument_;
};

class BufferTooSmall : public Error {
 public:
  BufferTooSmall(std::size_t needed, std::size_t available)
      : Error("the array has room for " + std::to_string(available) + " elements, " + std::to_string(needed) +
              " are needed: ask for the count first, with NULL and 0"),
        needed_(needed),
        available_(available) {}
  [[nodiscard]] std::size_t needed() const noexcept { return needed_; }
  [[nodiscard]] std::size_t available() const noexcept { return available_; }

 private:
  std::size_t needed_, available_;
};

/// Keeps the exception that is being handled as the thread's last error. Needs no memory if there is none.
[[nodiscard]] cadt_status keep_exception() noexcept;

template <class Call>
[[nodiscard]] cadt_status guarded(const Call& call) noexcept {
  try {
    call();
    return CADT_OK;
  } catch (...) {
    return keep_exception();
  }
}

/// \throws InvalidArgument
inline void require(const void* argument, const char* name) {
  if (argument == nullptr) throw InvalidArgument(name, "it is NULL");
}
template <class T>
T& required(T* argument, const char* name) {
  require(argument, name);
  return *argument;
}

/// A struct of the caller's with its size first; those of later versions are longer. (Once one has grown, the size of
/// its first version is the least, and what a short one lacks is the default.) \throws InvalidArgument
template <class T>
void require_size_of(const T& given, const char* name) {
  if (given.size < sizeof(T))
    throw InvalidArgument(name, "its member size is " + std::to_string(given.size) + ", not " +
                                    std::to_string(sizeof(T)) + ": set it to the size of the struct");
}

/// Gives the caller a struct; what only a longer one has is zero.
template <class T>
void give(T* to, T value, const char* name) {
  T& out = required(to, name);
  require_size_of(out, name);
  value.size = out.size;
  std::memset(reinterpret_cast<std::byte*>(to) + sizeof(T), 0, out.size - sizeof(T));
  out = value;
}

/// Takes a struct from the caller. \throws InvalidArgument if a longer one says what this library does not know
template <class T>
T take(const T* from, const char* name) {
  const T& in = required(from, name);
  require_size_of(in, name);
  const auto* bytes = reinterpret_cast<const unsigned char*>(from);
  if (std::any_of(bytes + sizeof(T), bytes + in.size, [](unsigned char byte) { return byte != 0; }))
    throw InvalidArgument(name, "it has members that this version of the library, " CADT_VERSION ", does not know");
  return in;
}

/// Whether the caller's array takes so many elements; false if only their number is asked for. `count` is set in any
/// case. \throws InvalidArgument, BufferTooSmall
template <class T>
bool has_room(const T* array, std::size_t capacity, std::size_t needed, std::size_t* count) {
  std::size_t& number = required(count, "count");
  if (array == nullptr && capacity != 0) throw InvalidArgument("capacity", "there is no array for so many elements");
  number = needed;
  if (array == nullptr) return false;
  if (capacity < needed) throw BufferTooSmall(needed, capacity);
  return true;
}

}  // namespace cadt::c_interface
