// One group for each block that is seen.
layout(local_size_x = 256) in;
layout(std430, binding = 3) readonly buffer Boxes { dvec4 box[]; };
layout(std430, binding = 4) readonly buffer Seen { uint seen[]; };
layout(std430, binding = 5) buffer Commands { uint command[]; };

const int ROWS_OF_ONE = 16;       // a triangle of more rows, or wider than this,
const double WIDTH_OF_ONE = 64.0LF;  // is left to a group of its own (large.glsl)

// The sums of a block that covers few pixels are collected in the group: there may be hundreds of triangles in each.
const int MOST_LOCAL = 1024;  // pixels
shared uint local_sum[4 * MOST_LOCAL];
ivec2 local_low, local_size;  // pixels; local_size.x == 0: none, the sums of the picture are added to at once

void find_local_pixels(uint block) {
  const dvec2 a = place_point(box[block].xy), b = place_point(box[block].zw), most = dvec2(samples);
  local_low = ivec2(clamp(min(a, b), dvec2(0.0LF), most)) / side;
  local_size = min(ivec2(clamp(max(a, b), dvec2(0.0LF), most)) / side + 1, samples / side) - local_low;
  if (local_size.x <= 0 || local_size.y <= 0 || local_size.x > MOST_LOCAL || local_size.y > MOST_LOCAL ||
      local_size.x * local_size.y > MOST_LOCAL)
    local_size = ivec2(0);
}

/// A number in [0, 1) for each triangle: areas are rounded up or down by it, so that a million specks add up.
float dither(uint t) {
  t = (t ^ (t >> 16)) * 0x7feb352du;
  t = (t ^ (t >> 15)) * 0x846ca68bu;
  return float((t ^ (t >> 16)) >> 8) / 16777216.0;
}

void add(uint t, Corners p, float area) {
  const dvec2 centre = (p.a + p.b + p.c) / 3.0LF;
  if (centre.x < 0.0LF || centre.y < 0.0LF || centre.x >= double(samples.x) || centre.y >= double(samples.y)) return;
  const uvec2 pixel = uvec2(ivec2(centre) / side);
  const bool local = local_size.x != 0;
  const uvec2 inner = pixel - uvec2(local_low);
  const uint at = local ? 4u * (inner.y * uint(local_size.x) + inner.x) : 4u * (pixel.y * uint(samples.x / side) + pixel.x);
  const float noise = dither(t);
  const vec4 share = vec4(colour_of(t, p, vec3(1.0 / 3.0)), 1.0) * (area * UNIT) + noise;
  for (uint k = 0u; k < 4u; ++k) {
    const uint part = uint(share[k]);
    if (part == 0u) continue;
    if (local)
      atomicAdd(local_sum[at + k], part);
    else
      atomicAdd(sum[at + k], part);
  }
}

void draw(uint t) {
  const Corners p = corners_of(t);
  const dvec2 lo = min(p.a, min(p.b, p.c)), hi = max(p.a, max(p.b, p.c));
  if (!(hi.x >= 0.0LF && hi.y >= 0.0LF && lo.x <= double(samples.x) && lo.y <= double(samples.y))) return;
  const dvec2 extent = hi - lo;
  const double pixel = double(side);
  uint word = t + 1u;
  if (extent.x < 2.0LF * pixel && extent.y < 2.0LF * pixel) {
    const double area = area2(p) * 0.5LF / (pixel * pixel);
    if (area < 0.25LF) {
      word |= SUMMED;
      add(t, p, float(area));
    }
  }
  const Rows rows = rows_of(p);
  if (rows.high - rows.low > ROWS_OF_ONE || (rows.high > rows.low && extent.x > WIDTH_OF_ONE)) {
    const uint slot = atomicAdd(command[7], 1u);
    if (slot < large_capacity) {
      large[slot] = word;
      atomicMax(command[3], min(slot + 1u, 32768u));
      atomicMax(command[4], slot / 32768u + 1u);
      return;
    }
  }
  for (int row = rows.low; row < rows.high; ++row) {
    const Rows columns = columns_of(p, row);
    for (int column = columns.low; column < columns.high; ++column) own(word, row, column);
  }
}

void main() {
  const uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * 32768u;
  if (slot >= command[6]) return;
  const uint block = seen[slot];
  const uint end = min((block + 1u) * BLOCK, triangle_count);
  find_local_pixels(block);
  const uint me = gl_LocalInvocationID.x, words = 4u * uint(local_size.x * local_size.y);
  for (uint i = me; i < words; i += 256u) local_sum[i] = 0u;
  barrier();
  for (uint t = block * BLOCK + me; t < end; t += 256u) draw(t);
  barrier();
  for (uint i = me; i < words; i += 256u) {
    if (local_sum[i] == 0u) continue;
    const uint pixel = i / 4u, row = pixel / uint(local_size.x), column = pixel - row * uint(local_size.x);
    const uint at = (uint(local_low.y) + row) * uint(samples.x / side) + uint(local_low.x) + column;
    atomicAdd(sum[4u * at + i % 4u], local_sum[i]);
  }
}
