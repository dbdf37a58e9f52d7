// SPDX-License-Identifier: Apache-2.0
// Of the headers that CMakeLists.txt names.
