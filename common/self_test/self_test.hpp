// SPDX-License-Identifier: Apache-2.0
// Known answers from the actual device. A device that gives another one is refused before any work.
#pragma once

#include "common/driver/device.hpp"

namespace cadt {

/// The arithmetic and the atomics. Every back end runs it when it opens a device. \throws BackendUnavailable with the
/// name of the first probe that failed, the expected bits and those found
void run_selftest(Device& device, KernelVariant variant = KernelVariant::narrow);

/// The lock protocol on a few triangles that many work-items change, and a long loop: back ends whose compiler or
/// driver is not known when the library is built run it too, once a context. It takes milliseconds, and finds what
/// shows in tens of thousands of locks; what is rarer, the certification of each mesh finds. \throws BackendUnavailable
/// with what failed
void run_lock_test(Device& device);

}  // namespace cadt
