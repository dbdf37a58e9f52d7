# SPDX-License-Identifier: Apache-2.0
target_sources(cadt PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/backend.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_narrow.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_timed.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_wide.cpp
  ${CMAKE_CURRENT_LIST_DIR}/thread_pool.cpp)
cadt_backend(host in "threads")
# The same text as narrow with a clock, which has the sanitizers; that of threads must see every access.
if(CADT_SANITIZE MATCHES "address")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernels_timed.cpp TARGET_DIRECTORY cadt PROPERTIES COMPILE_OPTIONS -fno-sanitize=all)
endif()
# Debug builds assert at every store to a record that the writer owns it.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernels_narrow.cpp ${CMAKE_CURRENT_LIST_DIR}/kernels_wide.cpp
  TARGET_DIRECTORY cadt PROPERTIES COMPILE_DEFINITIONS "$<$<CONFIG:Debug>:CADT_CHECKED>")
