/* SPDX-License-Identifier: Apache-2.0
 *
 * Union-find: connected components as trees of elements, each of which names its parent, or itself if it is the root.
 * One compare-and-swap of the higher root joins two trees, so the root of a component is its lowest element.
 */
#ifndef CADT_PORTABLE_UNION_FIND_H
#define CADT_PORTABLE_UNION_FIND_H

#include "common/portable/atomics.dev.h"

CADT_FN cadt_u32 cadt_find_root(CADT_GLOBAL cadt_u32* roots, cadt_u32 r) {
  cadt_u32 up = cadt_load_relaxed(roots + r);
  while (up != r) {
    const cadt_u32 further = cadt_load_relaxed(roots + up);
    if (further != up) cadt_store_relaxed(roots + r, further); /* path splitting: shorter for later searches */
    r = up;
    up = further;
  }
  return r;
}

/* Whether this call joined two trees: then `r` and `other` are an edge of a spanning forest. */
CADT_FN cadt_u32 cadt_unite(CADT_GLOBAL cadt_u32* roots, cadt_u32 r, cadt_u32 other) {
  cadt_u32 a = cadt_find_root(roots, r), b = cadt_find_root(roots, other);
  while (a != b) {
    const cadt_u32 high = a > b ? a : b, low = a > b ? b : a;
    if (cadt_cas_relaxed(roots + high, high, low)) return 1u;
    a = cadt_find_root(roots, high);
    b = cadt_find_root(roots, low);
  }
  return 0u;
}

#endif
