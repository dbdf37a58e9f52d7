# SPDX-License-Identifier: Apache-2.0
# Compile options of every target, and the summary of back ends.

# Warnings, C++20, no contraction of a*b+c (it breaks error bounds that assume separate roundings), sanitizers.
function(cadt_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(WIN32)  # of <windows.h> what is needed, and no macros min and max
    target_compile_definitions(${target} PRIVATE WIN32_LEAN_AND_MEAN NOMINMAX)
  endif()
  if(MSVC)  # clang-cl: /W4 is clang's -Wall -Wextra. std::getenv and its like are no concern of Microsoft's
    target_compile_options(${target} PRIVATE /W4 -Wconversion -Wshadow /fp:precise /clang:-ffp-contract=off /EHsc /bigobj /utf-8)
    target_compile_definitions(${target} PRIVATE _CRT_SECURE_NO_WARNINGS _CRT_NONSTDC_NO_WARNINGS)
  else()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off -fno-fast-math)
  endif()
  if(CADT_SANITIZE)
    # A finding ends the process: undefined behaviour would else be a line of a test that passes.
    target_compile_options(${target} PRIVATE -fsanitize=${CADT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${CADT_SANITIZE})
  endif()
  if(CADT_BUILD_FUZZ)
    # Not the operands of comparisons (trace-cmp): in the kernels they take longer than the work. io has them.
    target_compile_options(${target} PRIVATE -fsanitize-coverage=inline-8bit-counters,pc-table)
  endif()
endfunction()

# cadt_library_options(TARGET): it may go into shared libraries of users; what is not marked CADT_API stays inside.
function(cadt_library_options target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden CUDA_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# cadt_sections(TARGET): the linker can leave out the functions and data that nobody uses, one by one, and with them the
# libraries that only they need.
function(cadt_sections target)
  if(NOT MSVC)
    target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections)
  endif()
endfunction()

# cadt_export_interface_alone(TARGET): of a shared library, what cmake/cadt.map lets out. The linkers of other systems than
# Linux read no such file; there it is what is marked CADT_API, for which Windows must know who builds and who uses it.
function(cadt_export_interface_alone target)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    target_compile_definitions(${target} PUBLIC CADT_SHARED PRIVATE CADT_BUILDS_SHARED)
  endif()
  if(type STREQUAL "SHARED_LIBRARY" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/cadt.map)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/cadt.map)
    if(NOT CADT_SANITIZE)
      target_link_options(${target} PRIVATE -Wl,-z,defs)  # nothing is left open, either
    endif()
  endif()
endfunction()

# cadt_library_of_same_objects(TARGET SHARED|STATIC): a second library of all that the target cadt is made of.
function(cadt_library_of_same_objects target kind)
  get_target_property(sources cadt SOURCES)
  list(FILTER sources INCLUDE REGEX "TARGET_OBJECTS")
  add_library(${target} ${kind} $<TARGET_OBJECTS:cadt> ${sources})
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${target} PRIVATE $<TARGET_PROPERTY:cadt,LINK_LIBRARIES>)
endfunction()

# cadt_shorten_build(): what each driver reads of the device text and of the library, precompiled for the target cadt:
# two of the three seconds that most of its files take. The kernels of the host do not see it. Without a
# compiler cache, which cannot look into it.
function(cadt_shorten_build)
  get_target_property(sources cadt SOURCES)
  # Short files behind the same long headers: one unit for the compiler, which takes a third or half of the time.
  set_target_properties(cadt PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set(groups "backends/opencl" "backends/cuda")
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    list(APPEND groups "common/driver" "common/points" "common/insertion" "common/stars" "common/batch" "common/queries"
      "common/c_interface" "common/finalization" "common/constraints")
  endif()
  foreach(group IN LISTS groups)
    set(files ${sources})
    list(FILTER files INCLUDE REGEX "${group}/")
    # macros, or device text, of their own; open_device(), which tests replace when they are linked
    list(FILTER files EXCLUDE REGEX "opencl/loader|point_profile|registry")
    string(REPLACE "/" "_" name ${group})
    set_source_files_properties(${files} TARGET_DIRECTORY cadt PROPERTIES UNITY_GROUP ${name})
  endforeach()
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  target_precompile_headers(cadt PRIVATE ${PROJECT_SOURCE_DIR}/common/driver/context.hpp
    ${PROJECT_SOURCE_DIR}/common/driver/kernel_signature.hpp <algorithm> <array> <atomic> <chrono> <functional> <memory>
    <mutex> <numeric> <optional> <span> <string> <vector>)
  list(FILTER sources INCLUDE REGEX "backends/host/kernels_|self_test/|point_profile\\.cpp")
  set_source_files_properties(${sources} TARGET_DIRECTORY cadt PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# cadt_on_off_auto(NAME): the variable becomes AUTO, ON or OFF, whatever CMake takes for true or false.
function(cadt_on_off_auto name)
  string(TOUPPER "${${name}}" value)
  if(value MATCHES "^(ON|YES|TRUE|Y|1)$")
    set(value ON)
  elseif(value MATCHES "^(OFF|NO|FALSE|N|0|)$")
    set(value OFF)
  elseif(NOT value STREQUAL "AUTO")
    message(FATAL_ERROR "${name} is '${${name}}'; it can be AUTO, ON or OFF")
  endif()
  set(${name} ${value} PARENT_SCOPE)
endfunction()

# cadt_packages_are_missing(NAMES): ends the configuration where the program, or the benchmarks, cannot be built.
function(cadt_packages_are_missing names)
  set(library_alone "-DCADT_BUILD_APPS=OFF -DCADT_BUILD_BENCH=OFF")
  if(SKBUILD)
    set(library_alone "pip's option -C cmake.define.CADT_BUILD_APPS=OFF")
  endif()
  message(FATAL_ERROR "the program cadt needs what is not here: ${names}. On Debian and Ubuntu, scripts/setup installs it: libcli11-dev "
                      "libfmt-dev libfast-float-dev nlohmann-json3-dev zlib1g-dev libpng-dev libcairo2-dev pkg-config. "
                      "For the library alone, configure with ${library_alone}")
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
