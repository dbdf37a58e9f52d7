# SPDX-License-Identifier: Apache-2.0
# The program cadt-bench, at its smallest scale. One entry for each class, found by name.
set(test_file ${CMAKE_CURRENT_LIST_DIR}/bench_test.py)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${test_file})
file(STRINGS ${test_file} classes REGEX "^class [A-Za-z]+\\(BenchTest\\):")
foreach(line IN LISTS classes)
  string(REGEX REPLACE "^class ([A-Za-z]+).*" "\\1" class "${line}")
  add_test(NAME bench.${class}
    COMMAND ${CMAKE_COMMAND} -E env CADT_BENCH_PROGRAM=$<TARGET_FILE:cadt-bench> PYTHONDONTWRITEBYTECODE=1
            ${Python3_EXECUTABLE} ${test_file} -v ${class})
  set_tests_properties(bench.${class} PROPERTIES LABELS bench TIMEOUT 300)
endforeach()
