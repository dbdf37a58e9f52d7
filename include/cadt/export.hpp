// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a shared libcadt exports. Everything else is hidden.
#if defined(__GNUC__)
#define CADT_API __attribute__((visibility("default")))
#else
#define CADT_API
#endif
