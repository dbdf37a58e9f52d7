// SPDX-License-Identifier: Apache-2.0
layout(local_size_x = 256) in;
layout(std430, binding = 0) writeonly buffer Words { uint word[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint value;

const uint GROUP = 4096u;

void main() {
  const uint first = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * GROUP;
  const uint end = min(first + GROUP, count);
  for (uint i = first + gl_LocalInvocationID.x; i < end; i += 256u) word[i] = value;
}
