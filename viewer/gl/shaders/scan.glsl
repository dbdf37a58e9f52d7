// SPDX-License-Identifier: Apache-2.0
// Exclusive sums: each group scans 2,048 words and notes their sum; when the sums are scanned, they are added.
layout(local_size_x = 256) in;
layout(std430, binding = 0) buffer Words { uint word[]; };
layout(std430, binding = 1) buffer Sums { uint sum[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint pass;

const uint GROUP = 2048u, EACH = 8u;
shared uint of_item[256];

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, me = gl_LocalInvocationID.x;
  const uint first = group * GROUP + me * EACH;
  if (pass == 1u) {
    if (group * GROUP >= count) return;
    const uint before = sum[group];
    for (uint k = 0u; k < EACH; ++k)
      if (first + k < count) word[first + k] += before;
    return;
  }
  uint mine[EACH], total = 0u;
  for (uint k = 0u; k < EACH; ++k) {
    mine[k] = total;
    total += first + k < count ? word[first + k] : 0u;
  }
  of_item[me] = total;
  barrier();
  for (uint step = 1u; step < 256u; step <<= 1u) {
    const uint left = me >= step ? of_item[me - step] : 0u;
    barrier();
    of_item[me] += left;
    barrier();
  }
  const uint before = of_item[me] - total;
  for (uint k = 0u; k < EACH; ++k)
    if (first + k < count) word[first + k] = before + mine[k];
  if (me == 255u && group * GROUP < count) sum[group] = of_item[255];
}
