# SPDX-License-Identifier: Apache-2.0
# clang with the C++ library of macOS, for scripts/check_portability: version 16, about that of Xcode 15.
set(CMAKE_C_COMPILER clang-16)
set(CMAKE_CXX_COMPILER clang++-16)
set(CMAKE_CXX_FLAGS_INIT -stdlib=libc++)
