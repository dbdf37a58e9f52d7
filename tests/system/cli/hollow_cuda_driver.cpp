// SPDX-License-Identifier: Apache-2.0
// A CUDA driver that can tell its version and nothing else: that of CADT_CUDA_DRIVER, as in 11080 for 11.8.
#include <cstdlib>

extern "C" int cuInit(unsigned) { return 0; }

extern "C" int cuDriverGetVersion(int* version) {
  const char* text = std::getenv("CADT_CUDA_DRIVER");
  *version = text != nullptr ? std::atoi(text) : 0;
  return 0;
}
