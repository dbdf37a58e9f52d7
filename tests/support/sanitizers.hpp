// SPDX-License-Identifier: Apache-2.0
// Whether a sanitizer watches: programs are several times slower, and need addresses of their own for each thread.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CADT_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define CADT_SANITIZED 1
#endif
#endif
#ifndef CADT_SANITIZED
#define CADT_SANITIZED 0
#endif
