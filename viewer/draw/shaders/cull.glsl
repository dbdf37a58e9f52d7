// Lists the blocks whose box meets the picture.
layout(local_size_x = 256) in;
layout(std430, binding = 3) readonly buffer Boxes { dvec4 box[]; };
layout(std430, binding = 4) buffer Seen { uint seen[]; };
layout(std430, binding = 5) buffer Commands { uint command[]; };  // groups of blocks.glsl (3 words) and large.glsl (3)

void main() {
  const uint block = gl_GlobalInvocationID.x;
  if (block >= block_count) return;
  const dvec2 a = place_point(box[block].xy), b = place_point(box[block].zw);
  const dvec2 lo = min(a, b), hi = max(a, b);
  if (hi.x < 0.0LF || hi.y < 0.0LF || lo.x > double(samples.x) || lo.y > double(samples.y)) return;
  const uint slot = atomicAdd(command[6], 1u);
  seen[slot] = block;
  // At most 32,768 groups along x: 65,535 is all that each driver takes.
  atomicMax(command[0], min(slot + 1u, 32768u));
  atomicMax(command[1], slot / 32768u + 1u);
}
