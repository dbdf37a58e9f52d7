# SPDX-License-Identifier: Apache-2.0
# The report of the benchmarks, from made-up measurements. Debian's matplotlib is that of /usr/bin/python3, which need
# not be the interpreter that CMake found; without any the test is skipped and says so.
set(report_python ${Python3_EXECUTABLE})
foreach(candidate IN ITEMS ${Python3_EXECUTABLE} /usr/bin/python3)
  execute_process(COMMAND ${candidate} -c "import matplotlib" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed EQUAL 0)
    set(report_python ${candidate})
    break()
  endif()
endforeach()
foreach(part IN ITEMS report report_faults)
  add_test(NAME bench.${part} COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
    ${report_python} ${CMAKE_CURRENT_LIST_DIR}/${part}_test.py -v)
  set_tests_properties(bench.${part} PROPERTIES LABELS bench TIMEOUT 900 SKIP_RETURN_CODE 77)
endforeach()
