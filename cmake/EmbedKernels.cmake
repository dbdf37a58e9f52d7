# SPDX-License-Identifier: Apache-2.0
# Embeds OpenCL kernels in a C++ source file: each program as one text, with every #include "..." in place.
#
# Included by a CMakeLists.txt it defines cadt_embed_kernels() and cadt_embed_program(); run with `cmake -P` it does the work at build time. Pure
# CMake, so that building the library needs no further tool.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(CADT_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

  function(cadt_embed out_variable name root prefix)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} "-DENTRIES=${ARGN}" -DPREFIX=${prefix} -DROOT=${root} -DNAME=${name} -DOUTPUT=${output}
              -P ${CADT_EMBED_SCRIPT}
      DEPENDS ${ARGN} ${prefix} ${CADT_EMBED_SCRIPT}
      DEPFILE ${output}.d
      COMMENT "Embedding the OpenCL kernels"
      VERBATIM)
    set(${out_variable} ${output} PARENT_SCOPE)
  endfunction()

  # cadt_embed_kernels(OUT_VARIABLE ROOT [PREFIX]): the generated source file that defines
  # cadt::opencl::kernel_source(Stage): ROOT/kernels_cl/STAGE.cl, with what it includes from below ROOT. A change of any of
  # these files generates it again. PREFIX: a file that each text begins with.
  function(cadt_embed_kernels out_variable root)
    set(entries self_test predicates portable points insertion stars batch certify output verify queries
        finalization constraints crossings polygons)
    list(TRANSFORM entries REPLACE "(.+)" "${root}/kernels_cl/\\1.cl")
    cadt_embed(output kernel_source ${root} "${ARGN}" ${entries})
    set(${out_variable} ${output} PARENT_SCOPE)
  endfunction()

  # cadt_embed_program(OUT_VARIABLE ENTRY ROOT NAME): the same for a program of one entry, `std::string
  # cadt::opencl::NAME()`.
  function(cadt_embed_program out_variable entry root name)
    cadt_embed(output ${name} ${root} "" ${entry})
    set(${out_variable} ${output} PARENT_SCOPE)
  endfunction()
  return()
endif()

cmake_minimum_required(VERSION 3.25)

# Appends `path` with its includes to the global text. Each file goes in once, where it is included first, so no include
# may stand within a wider condition than its own. #line keeps the compiler's messages in terms of the original files.
function(append_file path shown)
  get_property(seen GLOBAL PROPERTY EMBED_FILES)
  if(path IN_LIST seen)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY EMBED_FILES ${path})
  file(READ ${path} rest)
  set(line 1)
  append_text("#line 1 \"${shown}\"\n")
  while(rest MATCHES "(^|\n)(#[ \t]*include[ \t]*\"([^\"\n]+)\"[^\n]*\n)")
    set(directive "${CMAKE_MATCH_2}")
    set(include "${CMAKE_MATCH_3}")
    # The position of the match itself: the same words may stand earlier, in the middle of a line.
    string(FIND "${rest}" "${CMAKE_MATCH_0}" at)
    string(LENGTH "${CMAKE_MATCH_1}" lead)
    math(EXPR at "${at} + ${lead}")
    string(SUBSTRING "${rest}" 0 ${at} before)
    append_text("${before}")
    string(REGEX REPLACE "[^\n]" "" newlines "${before}")
    string(LENGTH "${newlines}" newlines)
    math(EXPR line "${line} + ${newlines} + 1")
    if(NOT EXISTS ${ROOT}/${include})
      message(FATAL_ERROR "${shown}: cannot find \"${include}\" below ${ROOT}")
    endif()
    append_file(${ROOT}/${include} ${include})
    append_text("#line ${line} \"${shown}\"\n")
    string(LENGTH "${directive}" length)
    math(EXPR at "${at} + ${length}")
    string(SUBSTRING "${rest}" ${at} -1 rest)
  endwhile()
  append_text("${rest}")
endfunction()

function(append_text text)
  set_property(GLOBAL APPEND_STRING PROPERTY EMBED_TEXT "${text}")
endfunction()

# Sets `out` to the pieces of a text: compilers limit one literal (MSVC: 16380 bytes), so whole lines go into pieces below
# that.
function(make_pieces out text)
  if(text MATCHES "\\)cadt\"")
    message(FATAL_ERROR "the kernels contain the end mark of the raw string")
  endif()
  set(pieces "")
  while(NOT text STREQUAL "")
    string(LENGTH "${text}" length)
    if(length GREATER 12000)
      string(SUBSTRING "${text}" 0 12000 head)
      string(FIND "${head}" "\n" cut REVERSE)
      math(EXPR cut "${cut} + 1")
    else()
      set(cut ${length})
    endif()
    string(SUBSTRING "${text}" 0 ${cut} piece)
    string(SUBSTRING "${text}" ${cut} -1 text)
    string(APPEND pieces "    R\"cadt(${piece})cadt\",\n")
  endwhile()
  set(${out} "${pieces}" PARENT_SCOPE)
endfunction()

set(all_files "")
set(arrays "")
set(cases "")
foreach(entry IN LISTS ENTRIES)
  get_filename_component(stage ${entry} NAME_WE)
  set_property(GLOBAL PROPERTY EMBED_TEXT "")
  set_property(GLOBAL PROPERTY EMBED_FILES "")
  if(PREFIX)
    append_file(${PREFIX} ${PREFIX})
  endif()
  file(RELATIVE_PATH shown ${ROOT} ${entry})
  append_file(${entry} ${shown})
  get_property(text GLOBAL PROPERTY EMBED_TEXT)
  get_property(files GLOBAL PROPERTY EMBED_FILES)
  list(APPEND all_files ${files})
  make_pieces(pieces "${text}")
  string(APPEND arrays "constexpr const char* text_of_${stage}[] = {\n${pieces}};\n")
  string(APPEND cases "    case Stage::${stage}:\n      return joined(text_of_${stage});\n")
endforeach()
if(NAME STREQUAL "kernel_source")
  set(function "std::string kernel_source(Stage stage) {
  switch (stage) {
${cases}    case Stage::count:
      break;
  }
  return {};
}
")
else()
  set(function "std::string ${NAME}() { return joined(text_of_${stage}); }\n")
endif()

file(WRITE ${OUTPUT} "// Generated by cmake/EmbedKernels.cmake. Do not edit.
#include <span>
#include <string>

#include \"backends/opencl/kernel_source.hpp\"

namespace cadt::opencl {
namespace {
${arrays}
std::string joined(std::span<const char* const> pieces) {
  std::string text;
  for (const char* piece : pieces) text += piece;
  return text;
}
}  // namespace

${function}
}  // namespace cadt::opencl
")

list(REMOVE_DUPLICATES all_files)
set(depends "${OUTPUT}:")
foreach(file IN LISTS all_files)
  string(REPLACE " " "\\ " file "${file}")
  string(APPEND depends " \\\n  ${file}")
endforeach()
file(WRITE ${OUTPUT}.d "${depends}\n")
