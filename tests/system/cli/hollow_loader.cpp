// SPDX-License-Identifier: Apache-2.0
// An OpenCL loader that lacks every function but one: it has a platform, about which nothing can be asked.
extern "C" int clGetPlatformIDs(unsigned int entries, void** platforms, unsigned int* count) {
  static int platform;
  if (platforms != nullptr && entries > 0) *platforms = &platform;
  if (count != nullptr) *count = 1;
  return 0;
}
