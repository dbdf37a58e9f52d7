// Box of each block of consecutive triangles, once a mesh.
layout(local_size_x = 256) in;
layout(std430, binding = 3) writeonly buffer Boxes { dvec4 box[]; };
shared dvec2 low_of[256], high_of[256];

void main() {
  const uint block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (block >= block_count) return;
  const uint me = gl_LocalInvocationID.x;
  dvec2 lo = dvec2(1.7e308LF), hi = dvec2(-1.7e308LF);
  const uint end = min((block + 1u) * BLOCK, triangle_count);
  for (uint t = block * BLOCK + me; t < end; t += 256u) {
    for (uint k = 0u; k < 3u; ++k) {
      const dvec2 p = point[corner[3u * t + k]];
      lo = min(lo, p);
      hi = max(hi, p);
    }
  }
  low_of[me] = lo;
  high_of[me] = hi;
  barrier();
  for (uint step = 128u; step != 0u; step >>= 1u) {
    if (me < step) {
      low_of[me] = min(low_of[me], low_of[me + step]);
      high_of[me] = max(high_of[me], high_of[me + step]);
    }
    barrier();
  }
  if (me == 0u) box[block] = dvec4(low_of[0], high_of[0]);
}
