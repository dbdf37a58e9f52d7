// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/loader.hpp"

#include <dlfcn.h>

namespace cadt::opencl {
namespace {

struct Library {
  void* handle = nullptr;
  std::string failure;
};

std::string last_error() {
  const char* text = dlerror();
  return text == nullptr ? "unknown error" : text;
}

Library open_library() {
  Library library;
  const char* const soname = "libOpenCL.so.1";
  library.handle = dlopen(soname, RTLD_NOW | RTLD_LOCAL);
  // Report the first error: the other name belongs to a development package and rarely exists.
  if (library.handle == nullptr) library.failure = "the OpenCL loader cannot be loaded: " + last_error();
  if (library.handle == nullptr) library.handle = dlopen("libOpenCL.so", RTLD_NOW | RTLD_LOCAL);
  if (library.handle == nullptr) {
    library.failure += "; install it (package ocl-icd-libopencl1), and the driver of the GPU, or PoCL for the CPU";
  } else if (dlsym(library.handle, "clGetPlatformIDs") == nullptr) {
    library.failure = std::string("the library ") + soname + " is no OpenCL loader: " + last_error();
    library.handle = nullptr;
  } else {
    library.failure.clear();
  }
  return library;
}

// Never closed and never destroyed: contexts live as long as the process, and drivers start threads.
const Library& library() {
  static const auto* const opened = new Library(open_library());
  return *opened;
}

constexpr cl_int no_platform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR, which not all headers have

}  // namespace

const std::string& loader_failure() { return library().failure; }

namespace loader {

void* find(const char* name) { return library().handle == nullptr ? nullptr : dlsym(library().handle, name); }

cl_int missing_code() { return library().handle == nullptr ? no_platform : CL_INVALID_OPERATION; }

}  // namespace loader
}  // namespace cadt::opencl
