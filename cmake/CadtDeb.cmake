# SPDX-License-Identifier: Apache-2.0
# What `cpack -G DEB` makes of a shared build: libcadt0 (the library), libcadt-dev (headers, both libraries to link with,
# file formats, find_package and pkg-config) and cadt (the program). scripts/package does it all (docs/packaging.md).
if(NOT BUILD_SHARED_LIBS OR NOT TARGET cadt_app)
  message(FATAL_ERROR "CADT_DEB makes packages of the shared library and the program: configure with -DBUILD_SHARED_LIBS=ON "
                      "-DCADT_BUILD_APPS=ON, or use scripts/package")
endif()
foreach(program dpkg-shlibdeps gzip help2man)
  find_program(CADT_${program} ${program})
  mark_as_advanced(CADT_${program})
  if(NOT CADT_${program})
    message(FATAL_ERROR "CADT_DEB needs ${program}: apt install dpkg-dev gzip help2man")
  endif()
endforeach()
if("$ENV{DEBFULLNAME}" STREQUAL "" OR "$ENV{DEBEMAIL}" STREQUAL "")
  message(FATAL_ERROR "CADT_DEB needs the name of who makes the packages: set DEBFULLNAME and DEBEMAIL, or use scripts/package")
endif()
set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
set(revision 1)

# The static library beside the shared one, of the same object files. Other installations have one of them.
cadt_library_of_same_objects(cadt_archive STATIC)
set_target_properties(cadt_archive PROPERTIES OUTPUT_NAME cadt)
install(TARGETS cadt_archive ARCHIVE COMPONENT cadt_development EXCLUDE_FROM_ALL)

set(folder ${CMAKE_CURRENT_BINARY_DIR}/deb)
set(page ${cadt_manual_page}.gz)
add_custom_command(OUTPUT ${page} DEPENDS ${cadt_manual_page} VERBATIM COMMAND ${CADT_gzip} -9nfk ${cadt_manual_page})
add_custom_target(cadt_compressed_manual ALL DEPENDS ${page})
add_dependencies(cadt_compressed_manual cadt_manual)
install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT cadt_program EXCLUDE_FROM_ALL)

# What each package says of itself.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH where it is set
file(WRITE ${folder}/changelog.Debian "cadt (${PROJECT_VERSION}-${revision}) unstable; urgency=medium\n\n"
  "  * Version ${PROJECT_VERSION}; changelog.gz says what is new.\n\n -- ${maintainer}  ${date}\n")
configure_file(CHANGELOG.md ${folder}/changelog COPYONLY)
execute_process(COMMAND ${CADT_gzip} -9nf changelog.Debian changelog WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)

set(CPACK_PACKAGE_NAME cadt)
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_COMPONENTS_ALL cadt_library cadt_development cadt_program)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SOURCE cadt)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${revision})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_CURRENT_BINARY_DIR})
# Before 1.0 a program needs the version that it was linked with.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(library libcadt${PROJECT_VERSION_MAJOR})
set(this_library "${library} (= ${PROJECT_VERSION}-${revision})")

# package(COMPONENT NAME SECTION DESCRIPTION): a macro, as CPack reads variables of this folder.
macro(cadt_deb component name section description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}
cadt computes the Delaunay triangulation of points of the plane on threads,
OpenCL devices and NVIDIA's graphics cards. It is exact, and the same on every
device, in every run.")
  install(FILES packaging/deb/copyright ${folder}/changelog.gz ${folder}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()
cadt_deb(cadt_library ${library} libs "exact parallel Delaunay triangulation - library")
cadt_deb(cadt_development libcadt-dev libdevel "exact parallel Delaunay triangulation - development files")
cadt_deb(cadt_program cadt math "exact parallel Delaunay triangulation - program")

set(CPACK_DEBIAN_CADT_LIBRARY_PACKAGE_SHLIBDEPS ON)
file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_CADT_LIBRARY_PACKAGE_CONTROL_EXTRA ${folder}/triggers)
file(WRITE ${folder}/${library} "# CPack adds these calls to each package with a library.\n${library}: maintscript-calls-ldconfig\n")
install(FILES ${folder}/${library} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT cadt_library EXCLUDE_FROM_ALL)
# Loaded where it is there, and a device for it.
set(CPACK_DEBIAN_CADT_LIBRARY_PACKAGE_RECOMMENDS "ocl-icd-libopencl1 | libopencl1")
set(CPACK_DEBIAN_CADT_LIBRARY_PACKAGE_SUGGESTS "pocl-opencl-icd | opencl-icd")
string(APPEND CPACK_DEBIAN_CADT_LIBRARY_DESCRIPTION "\n\nThis package has the shared library.")

set(CPACK_DEBIAN_CADT_DEVELOPMENT_PACKAGE_DEPENDS "${this_library}")
# What the file formats link: find_package(cadt COMPONENTS io).
set(CPACK_DEBIAN_CADT_DEVELOPMENT_PACKAGE_RECOMMENDS
  "libfmt-dev, libfast-float-dev, zlib1g-dev, libpng-dev, libcairo2-dev, pkg-config")
string(APPEND CPACK_DEBIAN_CADT_DEVELOPMENT_DESCRIPTION "

This package has the headers, the shared and the static library to link with,
the file formats (cadt::io) as a static library, and the files by which CMake
and pkg-config find them.")

set(CPACK_DEBIAN_CADT_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CADT_PROGRAM_PACKAGE_DEPENDS "${this_library}")
string(APPEND CPACK_DEBIAN_CADT_PROGRAM_DESCRIPTION "

This package has the program: it triangulates files of points, draws and writes
meshes, and verifies those of any other program.")
include(CPack)
