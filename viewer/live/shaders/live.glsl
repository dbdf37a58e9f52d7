// SPDX-License-Identifier: Apache-2.0
// What all programs that change points know. Coordinates are taken relative to the box: (p - low) / scale, so the box is
// [0, limit] with the longer side 1.
layout(local_size_x = 256) in;
layout(std430, binding = 0) buffer Points { dvec2 point[]; };
layout(std430, binding = 1) buffer Velocities { vec2 velocity[]; };  // box lengths a second
layout(location = 0) uniform uint count;
layout(location = 1) uniform dvec2 low;
layout(location = 2) uniform dvec2 limit;
layout(location = 3) uniform double scale;
layout(location = 4) uniform uint seed;

uint item() { return gl_LocalInvocationID.x + 256u * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x); }

uint mix_bits(uint v) {
  v = (v ^ (v >> 16)) * 0x7feb352du;
  v = (v ^ (v >> 15)) * 0x846ca68bu;
  return v ^ (v >> 16);
}
/// 32 random bits for item i; `what` tells apart the numbers of one item.
uint random_bits(uint i, uint what) { return mix_bits(mix_bits(mix_bits(i) + what) + seed); }
/// In [0, 1), with 53 bits: floats would put points of a large set onto a grid.
double random_double(uint i, uint what) {
  const uint high = random_bits(i, 2u * what), lower = random_bits(i, 2u * what + 1u);
  return (double(high >> 6) * 134217728.0LF + double(lower >> 5)) / 9007199254740992.0LF;
}
float random_float(uint i, uint what) { return float(random_bits(i, what) >> 8) / 16777216.0; }
