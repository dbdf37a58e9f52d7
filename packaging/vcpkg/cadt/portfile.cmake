# SPDX-License-Identifier: Apache-2.0
# scripts/package fills in URL and hash.
vcpkg_download_distfile(archive URLS "@url@" FILENAME "cadt-${VERSION}.tar.gz" SHA512 "@sha512@")
vcpkg_extract_source_archive(source ARCHIVE "${archive}")
vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES cuda CADT_CUDA opencl CADT_OPENCL)
if("cuda" IN_LIST FEATURES)
  list(APPEND options -DCADT_CUDA_ARCHITECTURES=all)
endif()
vcpkg_cmake_configure(SOURCE_PATH "${source}" OPTIONS ${options}
  -DCADT_BUILD_APPS=OFF -DCADT_BUILD_BENCH=OFF -DCADT_BUILD_EXAMPLES=OFF -DCADT_BUILD_TESTS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/cadt)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE")
