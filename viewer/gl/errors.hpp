// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/errors.hpp>

#include <string>

namespace cadt::viewer {

/// No display, no OpenGL, one that is too old, or a context that is lost. `what()` says what to do.
class DisplayError : public Error {
 public:
  using Error::Error;
};

}  // namespace cadt::viewer
