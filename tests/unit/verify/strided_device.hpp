// SPDX-License-Identifier: Apache-2.0
// The kernels of the verifier as a GPU runs them, on the host: strided work-items, and more of them than were asked
// for.
#pragma once

#include "common/driver/device.hpp"

#include <memory>

/// Memory and all other kernels are those of `host`, which must outlive it.
std::unique_ptr<cadt::Device> strided_device(cadt::Device& host);
