# SPDX-License-Identifier: Apache-2.0
target_sources(cadt PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/delaunay.cpp
  ${CMAKE_CURRENT_LIST_DIR}/exact_sign.cpp
  ${CMAKE_CURRENT_LIST_DIR}/hull.cpp
  ${CMAKE_CURRENT_LIST_DIR}/neighbors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/own_result.cpp
  ${CMAKE_CURRENT_LIST_DIR}/report.cpp
  ${CMAKE_CURRENT_LIST_DIR}/structure.cpp
  ${CMAKE_CURRENT_LIST_DIR}/vertices.cpp)
