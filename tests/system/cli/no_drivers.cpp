// SPDX-License-Identifier: Apache-2.0
// A dlopen for LD_PRELOAD that does not find OpenCL's loader and the CUDA driver, as on a machine that has neither.
#include <dlfcn.h>

#include <cstring>
#include <string>

extern "C" void* dlopen(const char* name, int mode) noexcept {
  static const auto real = reinterpret_cast<void* (*)(const char*, int)>(dlsym(RTLD_NEXT, "dlopen"));
  const bool driver = name != nullptr && (std::strstr(name, "libOpenCL") || std::strstr(name, "libcuda"));
  // The real one is asked for a file that is not there, and so leaves the message that it would have left.
  return driver ? real((std::string("/nonexistent/") + name).c_str(), mode) : real(name, mode);
}
