// SPDX-License-Identifier: Apache-2.0
#define CADT_CONTIGUOUS 1
#define CADT_MODEL_SEARCH search_cpu
#include "tests/robustness/models/protocol_model.ipp"
