# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` copies: headers, library, program, and how CMake (find_package) and pkg-config find them. The file
# formats are the component io of find_package. Components of the installation are cadt_library (what a linked program
# needs), cadt_development and cadt_program.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(cadt_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cadt)
install(DIRECTORY include/cadt DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT cadt_development PATTERN io EXCLUDE)
install(TARGETS cadt EXPORT cadtTargets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  LIBRARY COMPONENT cadt_library NAMELINK_COMPONENT cadt_development
  ARCHIVE COMPONENT cadt_development)
install(EXPORT cadtTargets NAMESPACE cadt:: DESTINATION ${cadt_cmake_dir} COMPONENT cadt_development)
if(TARGET cadt_io)
  install(DIRECTORY include/cadt/io DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cadt COMPONENT cadt_development)
  install(TARGETS cadt_io EXPORT cadtIoTargets ARCHIVE COMPONENT cadt_development)
  install(EXPORT cadtIoTargets NAMESPACE cadt:: DESTINATION ${cadt_cmake_dir} COMPONENT cadt_development)
endif()
# Programs find the shared library beside them, wherever the prefix is. Packages of a distribution have it where all look.
set(rpath "")
if(BUILD_SHARED_LIBS AND PROJECT_IS_TOP_LEVEL AND NOT CADT_DEB AND NOT DEFINED CMAKE_INSTALL_RPATH)
  set(rpath ${CMAKE_INSTALL_FULL_LIBDIR})
  if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_BINDIR}" AND NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
    file(RELATIVE_PATH rpath /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
    if(APPLE)
      string(PREPEND rpath "@loader_path/")
    else()
      string(PREPEND rpath "$ORIGIN/")
    endif()
  endif()
endif()
foreach(program IN ITEMS cadt_app cadt_mpi_app)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT cadt_program)
    if(rpath)
      set_target_properties(${program} PROPERTIES INSTALL_RPATH "${rpath}")
    endif()
  endif()
endforeach()
# The manual page says what --help says.
find_program(CADT_help2man help2man)
mark_as_advanced(CADT_help2man)
if(TARGET cadt_app AND CADT_help2man AND NOT CADT_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  set(cadt_manual_page ${CMAKE_CURRENT_BINARY_DIR}/cadt.1)
  add_custom_command(OUTPUT ${cadt_manual_page} DEPENDS cadt_app VERBATIM
    COMMAND ${CADT_help2man} --no-info --name "Delaunay triangulation of points of the plane" --output ${cadt_manual_page}
            $<TARGET_FILE:cadt_app>)
  add_custom_target(cadt_manual ALL DEPENDS ${cadt_manual_page})
  if(NOT CADT_DEB)  # which has it compressed
    install(FILES ${cadt_manual_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT cadt_program OPTIONAL)
  endif()
endif()

configure_package_config_file(cmake/cadtConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/cadtConfig.cmake
  INSTALL_DESTINATION ${cadt_cmake_dir} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/cadtConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cadtConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/cadtConfigVersion.cmake
  DESTINATION ${cadt_cmake_dir} COMPONENT cadt_development)

# A static library needs what it links itself: pkg-config --static.
set(cadt_private_libraries "-pthread ${CMAKE_DL_LIBS}")
string(REGEX REPLACE " ([a-z])" " -l\\1" cadt_private_libraries "${cadt_private_libraries}")
if(CADT_HAVE_CUDA)
  get_filename_component(cudart_folder "${CUDA_cudart_static_LIBRARY}" DIRECTORY)  # that FindCUDAToolkit has cached
  string(APPEND cadt_private_libraries " -L${cudart_folder} -lcudart_static -lrt")
endif()
file(RELATIVE_PATH cadt_pc_to_include ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(cmake/cadt.pc.in ${CMAKE_CURRENT_BINARY_DIR}/cadt.pc.in @ONLY)
# The name of the library is that of the configuration: CMAKE_DEBUG_POSTFIX.
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/pkgconfig/$<CONFIG>/cadt.pc INPUT ${CMAKE_CURRENT_BINARY_DIR}/cadt.pc.in)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pkgconfig/$<CONFIG>/cadt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT cadt_development)
