// SPDX-License-Identifier: Apache-2.0
#pragma once

#define CADT_VERSION_MAJOR 0
#define CADT_VERSION_MINOR 2
#define CADT_VERSION_PATCH 0
#define CADT_VERSION "0.2.0"
