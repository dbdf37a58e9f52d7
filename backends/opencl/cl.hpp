// SPDX-License-Identifier: Apache-2.0
// The Khronos C++ bindings, configured in one place, and the translation of their exceptions.
#pragma once

#include "backends/opencl/loader.hpp"

#define CL_HPP_TARGET_OPENCL_VERSION 300
// cadt needs 1.2, but with that minimum the bindings of 2022 and 2023 (v2023.02.06 among them) lack a function that
// they use.
#define CL_HPP_MINIMUM_OPENCL_VERSION 110
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>
#include <string>

namespace cadt::opencl {

/// "CL_OUT_OF_RESOURCES" etc.; "unknown code" for codes that OpenCL does not define.
[[nodiscard]] const char* code_name(int code) noexcept;

/// The context is unusable after these codes: an invalid access or a watchdog has destroyed it, and all later calls
/// fail too.
[[nodiscard]] bool is_fatal(int code) noexcept;

/// \throws DeviceError with the call that failed, the code and its name
[[noreturn]] void throw_device_error(const cl::Error& error, const std::string& device);

}  // namespace cadt::opencl
