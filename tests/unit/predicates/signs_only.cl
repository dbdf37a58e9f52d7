/* SPDX-License-Identifier: Apache-2.0
 *
 * The predicates and the self-test alone: a program that is built in no time, once for each planted fault.
 */
#include "common/device/selftest.h"
#include "common/device/signs.h"
