// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/loader.hpp"

#include "common/platform/library.hpp"

namespace cadt::opencl {
namespace {

struct Library {
  void* handle = nullptr;
  std::string failure;
};

#if defined(_WIN32)
constexpr const char* names[] = {"OpenCL.dll"};
constexpr const char* advice = "install the driver of the GPU, which brings it, or the OpenCL runtime of the processor";
#elif defined(__APPLE__)
constexpr const char* names[] = {"/System/Library/Frameworks/OpenCL.framework/OpenCL"};
constexpr const char* advice = "it is a part of macOS";
#else
constexpr const char* names[] = {"libOpenCL.so.1", "libOpenCL.so"};
constexpr const char* advice =
    "install it (package ocl-icd-libopencl1), and the driver of the GPU, or PoCL for the CPU";
#endif

Library open_library() {
  Library library;
  for (const char* name : names) {
    std::string why;
    library.handle = platform::open_library(name, why);
    // Report the first error: the other name belongs to a development package and rarely exists.
    if (library.handle == nullptr && library.failure.empty())
      library.failure = "the OpenCL loader cannot be loaded: " + why;
    if (library.handle != nullptr) break;
  }
  if (library.handle == nullptr) {
    library.failure += std::string("; ") + advice;
  } else if (platform::find_function(library.handle, "clGetPlatformIDs") == nullptr) {
    library.failure = std::string("the library ") + names[0] + " is no OpenCL loader: it has no clGetPlatformIDs";
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

void* find(const char* name) {
  return library().handle == nullptr ? nullptr : platform::find_function(library().handle, name);
}

cl_int missing_code() { return library().handle == nullptr ? no_platform : CL_INVALID_OPERATION; }

}  // namespace loader
}  // namespace cadt::opencl
