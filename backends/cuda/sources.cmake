# SPDX-License-Identifier: Apache-2.0
# The CUDA back end: sources of the target cadt if nvcc is there, else the reason in CADT_CUDA_ABSENT.

set(CADT_CUDA_ABSENT "")
if(CADT_CUDA STREQUAL "AUTO" OR CADT_CUDA STREQUAL "ON")
  include(CheckLanguage)
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    set(CADT_CUDA_ABSENT "no CUDA compiler (nvcc) found")
    if(CADT_CUDA STREQUAL "ON")
      message(FATAL_ERROR "CADT_CUDA is ON, but ${CADT_CUDA_ABSENT}. Install the CUDA toolkit, or set CADT_CUDA to AUTO or OFF.")
    endif()
  endif()
elseif(CADT_CUDA STREQUAL "OFF")
  set(CADT_CUDA_ABSENT "CADT_CUDA is OFF")
else()
  message(FATAL_ERROR "CADT_CUDA is '${CADT_CUDA}'; it can be AUTO, ON or OFF")
endif()

if(CADT_CUDA_ABSENT)
  cadt_backend(cuda out "${CADT_CUDA_ABSENT}")
  return()
endif()

# Real code for every generation the toolkit knows from 7.5 on, and PTX of the newest for those to come.
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  execute_process(COMMAND ${CMAKE_CUDA_COMPILER} --list-gpu-code OUTPUT_VARIABLE known ERROR_QUIET)
  set(architectures "")
  foreach(arch 75 80 86 89 90 100 120)
    if(known MATCHES "sm_${arch}\n")
      list(APPEND architectures ${arch}-real)
      set(newest ${arch})
    endif()
  endforeach()
  list(APPEND architectures ${newest}-virtual)
  set(CMAKE_CUDA_ARCHITECTURES ${architectures} CACHE STRING "CUDA architectures")
endif()
enable_language(CUDA)
find_package(CUDAToolkit REQUIRED)
string(REPLACE ";" " " cuda_architectures "${CMAKE_CUDA_ARCHITECTURES}")
cadt_backend(cuda in "nvcc ${CMAKE_CUDA_COMPILER_VERSION}: ${cuda_architectures}")

set(cadt_kernel_variants ${PROJECT_SOURCE_DIR}/kernels_cuda/narrow.cu ${PROJECT_SOURCE_DIR}/kernels_cuda/wide.cu
    ${PROJECT_SOURCE_DIR}/kernels_cuda/timed.cu)
add_library(cadt_cuda_kernels OBJECT ${cadt_kernel_variants} ${PROJECT_SOURCE_DIR}/kernels_cuda/primitives.cu)
target_include_directories(cadt_cuda_kernels PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_features(cadt_cuda_kernels PRIVATE cuda_std_17)
# No contraction: the filters' bounds count separate roundings, and all devices shall take the same path.
target_compile_options(cadt_cuda_kernels PRIVATE --fmad=false -Xcudafe --diag_suppress=177)
# The compiler takes 118 registers for the insertion; with 96 more work-items fit, 10M points take 6 % less time (H200).
set_source_files_properties(${cadt_kernel_variants} TARGET_DIRECTORY cadt_cuda_kernels PROPERTIES COMPILE_OPTIONS -maxrregcount=96)
set_target_properties(cadt_cuda_kernels PROPERTIES POSITION_INDEPENDENT_CODE ON CUDA_SEPARABLE_COMPILATION OFF)
target_sources(cadt PRIVATE ${CMAKE_CURRENT_LIST_DIR}/backend.cpp
  ${CMAKE_CURRENT_LIST_DIR}/clock.cpp ${CMAKE_CURRENT_LIST_DIR}/context.cpp ${CMAKE_CURRENT_LIST_DIR}/device.cpp
               $<TARGET_OBJECTS:cadt_cuda_kernels>)
# The static runtime looks for the driver when it is first called: a machine without one starts the program all the same.
target_include_directories(cadt SYSTEM PRIVATE ${CUDAToolkit_INCLUDE_DIRS})
target_link_libraries(cadt PRIVATE CUDA::cudart_static)
