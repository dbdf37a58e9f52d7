/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_CERTIFY
#include "common/certify/certify.dev.h"
