// SPDX-License-Identifier: Apache-2.0
// OpenCL's functions, resolved in the loader (libOpenCL.so.1) at their first call. Nothing is linked, so a program
// starts on a machine without the loader, and no symbol clashes with a libOpenCL that its user links.
//
// Include this before CL/opencl.hpp, whose calls of the functions named below then arrive here. If the bindings begin
// to call another function, it is an undefined symbol: add its line. tests/architecture/check_linking.py finds that
// out.
#pragma once

#define CL_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/opencl.h>

#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

namespace cadt::opencl {

/// Why this process has no OpenCL loader, the same at every call; empty if it has one.
[[nodiscard]] const std::string& loader_failure();

namespace loader {

/// A function of the loader; null without a loader, or if the loader is too old for it.
[[nodiscard]] void* find(const char* name);

/// The error code of a function that cannot be called.
[[nodiscard]] cl_int missing_code();

/// A string as a template argument.
template <std::size_t Size>
struct Name {
  char text[Size];
  consteval Name(const char (&from)[Size]) {
    for (std::size_t i = 0; i < Size; ++i) text[i] = from[i];
  }
};

// `declared` is named for its type only and never used: a use would need the linker.
template <auto* declared, class = decltype(declared)>
struct Function;
template <auto* declared, class Result, class... Parameters>
struct Function<declared, Result(CL_API_CALL*)(Parameters...)> {
  template <Name name>
  static Result CL_API_CALL call(Parameters... values) {
    static const auto found = reinterpret_cast<Result(CL_API_CALL*)(Parameters...)>(find(name.text));
    if (found != nullptr) return found(values...);
    if constexpr (std::is_same_v<Result, cl_int>) {
      return missing_code();
    } else {  // they return an object, and the error code through the last parameter
      cl_int* const code = std::get<sizeof...(values) - 1>(std::tuple(values...));
      if (code != nullptr) *code = missing_code();
      return nullptr;
    }
  }
};

}  // namespace loader
}  // namespace cadt::opencl

// Within its own expansion a macro's name is not replaced, so it still means OpenCL's declaration. It contains no
// comma, which would split an argument of another macro.
#define CADT_CL(name) cadt::opencl::loader::Function<::name>::call<#name>

// What the bindings call for us when compiled without optimisation, where nothing is left out.
#define clBuildProgram CADT_CL(clBuildProgram)
#define clCreateBuffer CADT_CL(clCreateBuffer)
#define clCreateCommandQueue CADT_CL(clCreateCommandQueue)
#define clCreateCommandQueueWithProperties CADT_CL(clCreateCommandQueueWithProperties)
#define clCreateContext CADT_CL(clCreateContext)
#define clCreateKernel CADT_CL(clCreateKernel)
#define clCreateProgramWithBinary CADT_CL(clCreateProgramWithBinary)
#define clCreateProgramWithSource CADT_CL(clCreateProgramWithSource)
#define clCreateSubBuffer CADT_CL(clCreateSubBuffer)
#define clEnqueueFillBuffer CADT_CL(clEnqueueFillBuffer)
#define clEnqueueNDRangeKernel CADT_CL(clEnqueueNDRangeKernel)
#define clEnqueueReadBuffer CADT_CL(clEnqueueReadBuffer)
#define clEnqueueWriteBuffer CADT_CL(clEnqueueWriteBuffer)
#define clFinish CADT_CL(clFinish)
#define clGetCommandQueueInfo CADT_CL(clGetCommandQueueInfo)
#define clGetContextInfo CADT_CL(clGetContextInfo)
#define clGetDeviceIDs CADT_CL(clGetDeviceIDs)
#define clGetDeviceInfo CADT_CL(clGetDeviceInfo)
#define clGetEventProfilingInfo CADT_CL(clGetEventProfilingInfo)
#define clGetKernelInfo CADT_CL(clGetKernelInfo)
#define clGetKernelWorkGroupInfo CADT_CL(clGetKernelWorkGroupInfo)
#define clGetMemObjectInfo CADT_CL(clGetMemObjectInfo)
#define clGetPlatformIDs CADT_CL(clGetPlatformIDs)
#define clGetPlatformInfo CADT_CL(clGetPlatformInfo)
#define clGetProgramBuildInfo CADT_CL(clGetProgramBuildInfo)
#define clGetProgramInfo CADT_CL(clGetProgramInfo)
#define clReleaseCommandQueue CADT_CL(clReleaseCommandQueue)
#define clReleaseContext CADT_CL(clReleaseContext)
#define clReleaseDevice CADT_CL(clReleaseDevice)
#define clReleaseEvent CADT_CL(clReleaseEvent)
#define clReleaseKernel CADT_CL(clReleaseKernel)
#define clReleaseMemObject CADT_CL(clReleaseMemObject)
#define clReleaseProgram CADT_CL(clReleaseProgram)
#define clRetainCommandQueue CADT_CL(clRetainCommandQueue)
#define clRetainContext CADT_CL(clRetainContext)
#define clRetainDevice CADT_CL(clRetainDevice)
#define clRetainMemObject CADT_CL(clRetainMemObject)
#define clRetainProgram CADT_CL(clRetainProgram)
#define clSetKernelArg CADT_CL(clSetKernelArg)
#define clWaitForEvents CADT_CL(clWaitForEvents)
