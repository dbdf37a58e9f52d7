# SPDX-License-Identifier: Apache-2.0
# scripts/compare_commits, with made-up programs and, if the program cadt is built too, with what is built here.
set(built "")
if(TARGET cadt_app)
  set(built CADT_BUILD_FOLDER=${PROJECT_BINARY_DIR})
endif()
add_test(NAME bench.compare_commits COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${built}
  ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/compare_commits_test.py -v)
set_tests_properties(bench.compare_commits PROPERTIES LABELS bench TIMEOUT 300)
