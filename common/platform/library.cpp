// SPDX-License-Identifier: Apache-2.0
#include "common/platform/library.hpp"

#if defined(_WIN32)
#include <windows.h>

#include <system_error>
#else
#include <dlfcn.h>
#endif

namespace cadt::platform {

void* open_library(const char* name, std::string& failure) {
#if defined(_WIN32)
  void* const library = reinterpret_cast<void*>(::LoadLibraryA(name));
  if (library == nullptr)
    failure = std::string(name) + ": " + std::system_category().message(static_cast<int>(::GetLastError()));
#else
  void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const text = ::dlerror();
    failure = text == nullptr ? "unknown error" : text;
  }
#endif
  return library;
}

void* find_function(void* library, const char* name) noexcept {
#if defined(_WIN32)
  return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
#else
  return ::dlsym(library, name);
#endif
}

}  // namespace cadt::platform
