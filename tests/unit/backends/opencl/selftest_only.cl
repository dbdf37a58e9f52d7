/* SPDX-License-Identifier: Apache-2.0
 *
 * The smallest program that a device accepts: most tests of the back end need no more, and it builds in no time.
 */
#include "common/self_test/arithmetic.dev.h"
#include "common/self_test/locks.dev.h"
