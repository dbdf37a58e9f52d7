# SPDX-License-Identifier: Apache-2.0
# The verifier of the host, which shares only its threads with the rest: one unit for the compiler, which takes a third of the time.
add_library(cadt_host_verifier OBJECT
  ${CMAKE_CURRENT_LIST_DIR}/delaunay.cpp
  ${CMAKE_CURRENT_LIST_DIR}/exact_sign.cpp
  ${CMAKE_CURRENT_LIST_DIR}/hull.cpp
  ${CMAKE_CURRENT_LIST_DIR}/neighbors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/own_result.cpp
  ${CMAKE_CURRENT_LIST_DIR}/predicates.cpp
  ${CMAKE_CURRENT_LIST_DIR}/report.cpp
  ${CMAKE_CURRENT_LIST_DIR}/structure.cpp
  ${CMAKE_CURRENT_LIST_DIR}/vertices.cpp)
target_include_directories(cadt_host_verifier PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR})
set_target_properties(cadt_host_verifier PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
cadt_compile_options(cadt_host_verifier)
cadt_library_options(cadt_host_verifier)
target_sources(cadt PRIVATE $<TARGET_OBJECTS:cadt_host_verifier>)
