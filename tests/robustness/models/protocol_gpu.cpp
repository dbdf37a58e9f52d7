// SPDX-License-Identifier: Apache-2.0
#define CADT_CONTIGUOUS 0
#define CADT_MODEL_SEARCH search_gpu
#include "tests/robustness/models/protocol_model.ipp"
