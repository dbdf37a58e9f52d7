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
if(TARGET cadt_app)
  install(TARGETS cadt_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT cadt_program)
endif()
if(TARGET cadt_mpi_app)
  install(TARGETS cadt_mpi_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT cadt_program)
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
  string(APPEND cadt_private_libraries " -lcudart_static -lrt")
endif()
file(RELATIVE_PATH cadt_pc_to_include /${CMAKE_INSTALL_LIBDIR}/pkgconfig /${CMAKE_INSTALL_INCLUDEDIR})
configure_file(cmake/cadt.pc.in ${CMAKE_CURRENT_BINARY_DIR}/cadt.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cadt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT cadt_development)
