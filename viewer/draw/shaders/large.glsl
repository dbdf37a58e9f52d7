// Sixteen groups for each large triangle: eight rows at a time, 32 samples of a row at a time.
layout(local_size_x = 32, local_size_y = 8) in;
layout(std430, binding = 5) readonly buffer Commands { uint command[]; };

void main() {
  const uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * 32768u;
  if (slot >= min(command[7], large_capacity)) return;
  const uint word = large[slot], t = (word & ~SUMMED) - 1u;
  const Corners p = corners_of(t);
  const Rows rows = rows_of(p);
  for (int row = rows.low + int(gl_WorkGroupID.z * 8u + gl_LocalInvocationID.y); row < rows.high; row += 128) {
    const Rows columns = columns_of(p, row);
    for (int column = columns.low + int(gl_LocalInvocationID.x); column < columns.high; column += 32) own(word, row, column);
  }
}
