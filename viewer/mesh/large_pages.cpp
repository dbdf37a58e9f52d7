// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh/large_pages.hpp"

#include <cadt/errors.hpp>

#include <cuda.h>
#include <cuda_runtime.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <utility>

namespace cadt::viewer {
namespace {

/// A function of the driver: it is not linked, so that the program starts without one.
template <class F>
F find_function(const char* name) {
  void* found = nullptr;
  cudaDriverEntryPointQueryResult state{};
#if CUDART_VERSION >= 12050
  const cudaError_t code = cudaGetDriverEntryPointByVersion(name, &found, 10020, cudaEnableDefault, &state);
#else
  const cudaError_t code = cudaGetDriverEntryPoint(name, &found, cudaEnableDefault, &state);
#endif
  if (code != cudaSuccess || found == nullptr) {
    (void)cudaGetLastError();
    throw DeviceError(name, static_cast<int>(code), "CUDA", "the driver has no such function");
  }
  return reinterpret_cast<F>(found);
}
#define CADT_DRIVER(name) const decltype(&::name) name = find_function<decltype(&::name)>(#name)

/// What is called of the driver.
struct Driver {
  CADT_DRIVER(cuMemGetAllocationGranularity);
  CADT_DRIVER(cuMemCreate);
  CADT_DRIVER(cuMemRelease);
  CADT_DRIVER(cuMemAddressReserve);
  CADT_DRIVER(cuMemAddressFree);
  CADT_DRIVER(cuMemMap);
  CADT_DRIVER(cuMemUnmap);
  CADT_DRIVER(cuMemSetAccess);
  CADT_DRIVER(cuMemExportToShareableHandle);
};
#undef CADT_DRIVER
const Driver& driver() {
  static const Driver functions;
  return functions;
}

void check(CUresult code, const char* call) {
  if (code != CUDA_SUCCESS)
    throw DeviceError(call, static_cast<int>(code), "CUDA",
                      code == CUDA_ERROR_OUT_OF_MEMORY ? "out of memory" : "see CUresult in cuda.h");
}

}  // namespace

LargePages::LargePages(int device, std::size_t wanted) {
  const Driver& cu = driver();
  const CUmemLocation where{CU_MEM_LOCATION_TYPE_DEVICE, {device}};
  CUmemAllocationProp properties{};
  properties.type = CU_MEM_ALLOCATION_TYPE_PINNED;
  properties.location = where;
  properties.requestedHandleTypes = CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR;
  std::size_t page = 0;
  check(cu.cuMemGetAllocationGranularity(&page, &properties, CU_MEM_ALLOC_GRANULARITY_RECOMMENDED),
        "cuMemGetAllocationGranularity");
  const std::size_t bytes = (wanted + page - 1) / page * page;
  CUdeviceptr address = 0;
  check(cu.cuMemAddressReserve(&address, bytes, 0, 0, 0), "cuMemAddressReserve");
  CUmemGenericAllocationHandle memory{};
  if (const CUresult code = cu.cuMemCreate(&memory, bytes, &properties, 0); code != CUDA_SUCCESS) {
    cu.cuMemAddressFree(address, bytes);
    check(code, "cuMemCreate");
  }
  CUresult code = cu.cuMemMap(address, bytes, 0, memory, 0);
  if (code != CUDA_SUCCESS) {
    cu.cuMemRelease(memory);
    cu.cuMemAddressFree(address, bytes);
    check(code, "cuMemMap");
  }
  address_ = address;  // from here on the destructor's
  bytes_ = bytes;
  const CUmemAccessDesc access{where, CU_MEM_ACCESS_FLAGS_PROT_READWRITE};
  code = cu.cuMemSetAccess(address, bytes, &access, 1);
  if (code == CUDA_SUCCESS)
    code = cu.cuMemExportToShareableHandle(&file_, memory, CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR, 0);
  cu.cuMemRelease(memory);  // the mapping and the file keep it
  if (code != CUDA_SUCCESS) {
    LargePages(std::move(*this));  // unmaps
    check(code, "cuMemExportToShareableHandle");
  }
}

LargePages::LargePages(LargePages&& other) noexcept
    : address_(std::exchange(other.address_, 0)),
      bytes_(std::exchange(other.bytes_, 0)),
      file_(std::exchange(other.file_, -1)) {}

LargePages& LargePages::operator=(LargePages&& other) noexcept {
  std::swap(address_, other.address_);
  std::swap(bytes_, other.bytes_);
  std::swap(file_, other.file_);
  return *this;
}

LargePages::~LargePages() {
#ifndef _WIN32  // which has no GL_EXT_memory_object_fd
  if (file_ >= 0) close(file_);
#endif
  if (address_ == 0) return;
  driver().cuMemUnmap(address_, bytes_);
  driver().cuMemAddressFree(address_, bytes_);
}

int LargePages::take_file() noexcept { return std::exchange(file_, -1); }

}  // namespace cadt::viewer
