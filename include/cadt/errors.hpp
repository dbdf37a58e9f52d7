// SPDX-License-Identifier: Apache-2.0
// Exceptions of the library. Each carries the data that a program needs to react; `what()` says what to do.
#pragma once

#include <cadt/export.hpp>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cadt {

/// Base of all exceptions that the library throws on purpose, but for std::invalid_argument where a function names it:
/// a mistake in the calling program. Where the host has no memory for an array, std::bad_alloc is thrown instead of
/// OutOfMemory, which is about devices and Options::max_memory.
class CADT_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A coordinate that is NaN or infinite, or arrays whose sizes do not fit together.
class CADT_API InputError : public Error {
 public:
  InputError(const std::string& message, std::size_t index) : Error(message), index_(index) {}
  /// Index of the first offending point, or of what the message names: a segment, query, offset or pixel (0-based).
  [[nodiscard]] std::size_t index() const noexcept { return index_; }

 private:
  std::size_t index_;
};

/// A mesh of another program that is not a Delaunay triangulation of its points (Triangulation::adopt).
class CADT_API InvalidMesh : public Error {
 public:
  InvalidMesh(std::string check, std::int64_t first, const std::string& message)
      : Error("the mesh is invalid (" + check + "): " + message), check_(std::move(check)), first_(first) {}
  /// Name of the first check that failed, as in VerifyReport: "range", "neighbors", "delaunay", ...
  [[nodiscard]] const std::string& check() const noexcept { return check_; }
  /// First failing triangle, point or edge (3 * triangle + k), as the message says; -1: none in particular.
  [[nodiscard]] std::int64_t first() const noexcept { return first_; }

 private:
  std::string check_;
  std::int64_t first_;
};

/// More points than 32-bit indices allow (max_points()), or a larger DevicePoints::skip than they allow.
class CADT_API LimitError : public Error {
 public:
  LimitError(const std::string& message, std::size_t count, std::size_t limit)
      : Error(message), count_(count), limit_(limit) {}
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t limit() const noexcept { return limit_; }

 private:
  std::size_t count_, limit_;
};

/// A member of Options or ConstraintOptions that is out of range, or excluded by another; or an argument such as k.
class CADT_API OptionError : public Error {
 public:
  /// `of`: what it is a member of, for the message; an argument is none.
  OptionError(std::string option, const std::string& message, const char* of = "Options::")
      : Error(of + option + ": " + message), option_(std::move(option)) {}
  /// Name of the member, e.g. "queue" or "tuning.flip_threshold".
  [[nodiscard]] const std::string& option() const noexcept { return option_; }

 private:
  std::string option_;
};

/// The requested back end or device is not available; `reason()` says why. The library never falls back to another.
class CADT_API BackendUnavailable : public Error {
 public:
  BackendUnavailable(std::string backend, std::string reason)
      : Error("back end '" + backend + "' is not available: " + reason),
        backend_(std::move(backend)),
        reason_(std::move(reason)) {}
  [[nodiscard]] const std::string& backend() const noexcept { return backend_; }
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

 private:
  std::string backend_, reason_;
};

/// Not enough memory on the device or below `Options::max_memory`. The process can continue, with fewer points.
class CADT_API OutOfMemory : public Error {
  // Its numbers are planned in common/driver/memory_plan.cpp; step by step they are those of memory.cpp beside it and
  // of the allocations of the back ends.
 public:
  OutOfMemory(const std::string& message, std::size_t needed, std::size_t available)
      : Error(message), needed_(needed), available_(available) {}
  [[nodiscard]] std::size_t needed() const noexcept { return needed_; }        ///< bytes
  [[nodiscard]] std::size_t available() const noexcept { return available_; }  ///< bytes; 0 if unknown

 private:
  std::size_t needed_, available_;
};

/// A call of the device's runtime failed.
class CADT_API DeviceError : public Error {
 public:
  DeviceError(std::string call, int code, std::string device, const std::string& text)
      : Error(call + " failed on '" + device + "': " + text + " (" + std::to_string(code) + ")"),
        call_(std::move(call)),
        device_(std::move(device)),
        code_(code) {}
  [[nodiscard]] const std::string& call() const noexcept { return call_; }
  [[nodiscard]] const std::string& device() const noexcept { return device_; }
  [[nodiscard]] int code() const noexcept { return code_; }

 private:
  std::string call_, device_;
  int code_;
};

/// The device's compiler rejected the kernels, or its driver cannot create one. `log()` is the compiler's output.
/// OpenCL compiles the kernels of a stage when the first of them is launched, so a call may throw this too.
class CADT_API KernelBuildError : public Error {
 public:
  KernelBuildError(std::string device, std::string options, std::string log)
      : Error("the kernels could not be built for '" + device + "' with options '" + options + "':\n" + log),
        device_(std::move(device)),
        options_(std::move(options)),
        log_(std::move(log)) {}
  [[nodiscard]] const std::string& device() const noexcept { return device_; }
  [[nodiscard]] const std::string& options() const noexcept { return options_; }
  [[nodiscard]] const std::string& log() const noexcept { return log_; }

 private:
  std::string device_, options_, log_;
};

/// `Options::stop` was triggered. The call has no result, and its memory is released.
class CADT_API Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled by the caller") {}
};

/// The library has found an error of its own: please report it.
class CADT_API InternalError : public Error {
 public:
  using Error::Error;
};

}  // namespace cadt
