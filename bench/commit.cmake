# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=... -DOUTPUT=... [-DCOMMIT=...] -P commit.cmake : writes the header with the commit that is built,
# if it changed. Without git, or outside a repository of this project, the commit is empty.
cmake_minimum_required(VERSION 3.25)
if(NOT COMMIT)
  set(COMMIT "")
  find_program(GIT git)
  if(GIT)
    execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-toplevel
      OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(top)
      file(REAL_PATH "${top}" top)
      file(REAL_PATH "${SOURCE}" SOURCE)
    endif()
    # A copy without .git inside somebody's repository must not take that one's commit.
    if(top STREQUAL SOURCE)
      execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse HEAD
        OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
      execute_process(COMMAND ${GIT} -C ${SOURCE} diff --quiet HEAD RESULT_VARIABLE changed OUTPUT_QUIET ERROR_QUIET)
      if(COMMIT AND NOT changed EQUAL 0)
        string(APPEND COMMIT "-dirty")
      endif()
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define CADT_BENCH_COMMIT \"@COMMIT@\"\n" @ONLY)
