# SPDX-License-Identifier: Apache-2.0
target_sources(cadt PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/backend.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_narrow.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_timed.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_wide.cpp
  ${CMAKE_CURRENT_LIST_DIR}/thread_pool.cpp)
cadt_backend(host in "threads")
# Debug builds assert at every store to a record that the writer owns it.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernels_narrow.cpp ${CMAKE_CURRENT_LIST_DIR}/kernels_wide.cpp
  TARGET_DIRECTORY cadt PROPERTIES COMPILE_DEFINITIONS "$<$<CONFIG:Debug>:CADT_CHECKED>")
