/* SPDX-License-Identifier: Apache-2.0
 *
 * The smallest program that a device accepts: most tests of the back end need no more, and it builds in no time.
 */
#include "common/predicates/self_test.dev.h"
