# SPDX-License-Identifier: Apache-2.0
# The OpenCL back end: sources of the target cadt if it can be built, else the reason in CADT_OPENCL_ABSENT.
# Only headers are needed here: the loader is looked for at run time (loader.cpp).

set(CADT_OPENCL_ABSENT "")
if(CADT_OPENCL STREQUAL "OFF")
  set(CADT_OPENCL_ABSENT "CADT_OPENCL is OFF")
else()
  find_path(CADT_OPENCL_HPP CL/opencl.hpp)
  find_path(CADT_OPENCL_H CL/opencl.h HINTS ${CADT_OPENCL_HPP})
  mark_as_advanced(CADT_OPENCL_HPP CADT_OPENCL_H)
  if(NOT CADT_OPENCL_HPP)
    set(CADT_OPENCL_ABSENT "no header CL/opencl.hpp found, e.g. package opencl-clhpp-headers")
  elseif(NOT CADT_OPENCL_H)
    set(CADT_OPENCL_ABSENT "no header CL/opencl.h found, e.g. package opencl-headers")
  endif()
  if(CADT_OPENCL_ABSENT AND CADT_OPENCL STREQUAL "ON")
    message(FATAL_ERROR "CADT_OPENCL is ON, but: ${CADT_OPENCL_ABSENT}. On Debian and Ubuntu: "
                        "apt install opencl-headers opencl-clhpp-headers. Or set CADT_OPENCL to AUTO or OFF.")
  endif()
endif()

if(CADT_OPENCL_ABSENT)
  cadt_backend(opencl out "${CADT_OPENCL_ABSENT}")
  return()
endif()
cadt_backend(opencl in "headers in ${CADT_OPENCL_HPP}, loader at run time")

include(EmbedKernels)
cadt_embed_kernels(CADT_EMBEDDED_KERNELS ${PROJECT_SOURCE_DIR})

target_sources(cadt PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/backend.cpp
  ${CMAKE_CURRENT_LIST_DIR}/binary_cache.cpp
  ${CMAKE_CURRENT_LIST_DIR}/buffer_pool.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cl.cpp
  ${CMAKE_CURRENT_LIST_DIR}/clock.cpp
  ${CMAKE_CURRENT_LIST_DIR}/context.cpp
  ${CMAKE_CURRENT_LIST_DIR}/device.cpp
  ${CMAKE_CURRENT_LIST_DIR}/facts.cpp
  ${CMAKE_CURRENT_LIST_DIR}/loader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/platform.cpp
  ${CMAKE_CURRENT_LIST_DIR}/primitives.cpp
  ${CMAKE_CURRENT_LIST_DIR}/program.cpp)
# A generated file is known only to its own directory, where the target is not: a library carries it over.
add_library(cadt_opencl_kernels OBJECT ${CADT_EMBEDDED_KERNELS})
target_include_directories(cadt_opencl_kernels PRIVATE ${PROJECT_SOURCE_DIR})
cadt_compile_options(cadt_opencl_kernels)
cadt_library_options(cadt_opencl_kernels)
target_sources(cadt PRIVATE $<TARGET_OBJECTS:cadt_opencl_kernels>)
target_include_directories(cadt SYSTEM PRIVATE ${CADT_OPENCL_HPP} ${CADT_OPENCL_H})
