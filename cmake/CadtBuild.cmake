# SPDX-License-Identifier: Apache-2.0
# Compile options of every target, and the summary of back ends.

# Warnings, C++20, no contraction of a*b+c (it breaks error bounds that assume separate roundings), sanitizers.
function(cadt_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off -fno-fast-math)
  if(CADT_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${CADT_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${CADT_SANITIZE})
  endif()
  if(CADT_BUILD_FUZZ)
    # Not the operands of comparisons (trace-cmp): in the kernels they take longer than the work. io has them.
    target_compile_options(${target} PRIVATE -fsanitize-coverage=inline-8bit-counters,pc-table)
  endif()
endfunction()

# cadt_precompile_drivers(): what each driver reads of the device text and of the library, precompiled for the target cadt:
# two of the three seconds that most of its files take. Neither the kernels nor the verifier of the host see it. Without a
# compiler cache, which cannot look into it.
function(cadt_precompile_drivers)
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  target_precompile_headers(cadt PRIVATE ${PROJECT_SOURCE_DIR}/common/driver/context.hpp
    ${PROJECT_SOURCE_DIR}/common/driver/kernel_signature.hpp <algorithm> <array> <atomic> <chrono> <functional> <memory>
    <mutex> <numeric> <optional> <span> <string> <vector>)
  get_target_property(sources cadt SOURCES)
  list(FILTER sources INCLUDE REGEX "backends/host/kernels_|common/verify/host/|self_test\\.cpp|point_profile\\.cpp")
  set_source_files_properties(${sources} TARGET_DIRECTORY cadt PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# cadt_backend(NAME in|out REASON): one line of the summary.
set_property(GLOBAL PROPERTY CADT_BACKENDS "")
function(cadt_backend name state reason)
  set_property(GLOBAL APPEND PROPERTY CADT_BACKENDS "  ${name}: ${state} (${reason})")
endfunction()

function(cadt_print_summary)
  get_property(lines GLOBAL PROPERTY CADT_BACKENDS)
  message(STATUS "cadt ${PROJECT_VERSION} back ends:")
  foreach(line IN LISTS lines)
    message(STATUS "${line}")
  endforeach()
endfunction()
