// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a shared libcadt exports. Everything else is hidden. CMake's target cadt::cadt sets CADT_SHARED where the
/// library is shared; only Windows needs to know.
#if defined(_WIN32) && defined(CADT_SHARED)
#if defined(CADT_BUILDS_SHARED)
#define CADT_API __declspec(dllexport)
#else
#define CADT_API __declspec(dllimport)
#endif
#elif defined(__GNUC__) && !defined(_WIN32)
#define CADT_API __attribute__((visibility("default")))
#else
#define CADT_API
#endif
