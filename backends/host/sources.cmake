# SPDX-License-Identifier: Apache-2.0
target_sources(cadt PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/backend.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_narrow.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kernels_wide.cpp
  ${CMAKE_CURRENT_LIST_DIR}/thread_pool.cpp)
cadt_backend(host in "threads")
