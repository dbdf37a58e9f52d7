/* SPDX-License-Identifier: Apache-2.0
 *
 * The predicates and the self-test alone: a program that is built in no time, once for each planted fault.
 */
#include "common/predicates/predicate_probe.dev.h"
#include "common/self_test/arithmetic.dev.h"
#include "common/self_test/locks.dev.h"
