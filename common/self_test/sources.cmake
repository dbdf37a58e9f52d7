# SPDX-License-Identifier: Apache-2.0
include_guard(GLOBAL)
target_sources(cadt PRIVATE ${CMAKE_CURRENT_LIST_DIR}/arithmetic.cpp ${CMAKE_CURRENT_LIST_DIR}/locks.cpp)
