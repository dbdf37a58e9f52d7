// Line segments of one colour and width over the mesh: the hull, Voronoi cells, constrained edges. An item each; long
// ones are drawn by the whole group.
layout(local_size_x = 32) in;
layout(std430, binding = 3) readonly buffer Segments { dvec4 segment[]; };
layout(std430, binding = 4) readonly buffer Edges { ivec2 edge[]; };  // between points of the mesh
layout(std430, binding = 9) buffer Overlay { uint over[]; };
layout(location = 0) uniform uint segment_count;
layout(location = 1) uniform uint ink;     // 0xRRGGBB
layout(location = 2) uniform float width;  // pixels
layout(location = 3) uniform bool edges;   // these, and not the segments

const int COLUMNS_OF_ONE = 8;  // more are left to the group

/// In pixels, its ends in the order of x; of a steep one x and y are exchanged.
struct Line {
  dvec2 p, q;
  bool steep;
};
shared Line long_line[32];
shared ivec2 columns_of_line[32];  // [begin, end)

Line line_of(uint mine) {
  const dvec2 a = edges ? place(edge[mine].x) : place_point(segment[mine].xy);
  const dvec2 b = edges ? place(edge[mine].y) : place_point(segment[mine].zw);
  Line line = Line(a / double(side), b / double(side), abs(b.y - a.y) > abs(b.x - a.x));
  if (line.steep) line = Line(line.p.yx, line.q.yx, true);
  return line.p.x > line.q.x ? Line(line.q, line.p, line.steep) : line;
}

ivec2 columns_of(Line line) {
  const ivec2 size = samples / side;
  const double along = double(line.steep ? size.y : size.x), half_width = 0.5LF * double(width);
  return ivec2(floor(clamp(line.p.x - half_width, 0.0LF, along)), ceil(clamp(line.q.x + half_width, 0.0LF, along)));
}

void draw(Line line, int u) {
  const ivec2 size = samples / side;
  const int across = line.steep ? size.x : size.y;
  const dvec2 d = line.q - line.p;
  const double slope = d.x > 0.0LF ? d.y / d.x : 0.0LF, stretch = sqrt(1.0LF + slope * slope);
  const double x = clamp(double(u) + 0.5LF, line.p.x, line.q.x);
  const double middle = line.p.y + (x - line.p.x) * slope, reach = 0.5LF * double(width) * stretch + 1.0LF;
  const int low_v = int(floor(clamp(middle - reach, 0.0LF, double(across)))), high_v = int(ceil(clamp(middle + reach, 0.0LF, double(across))));
  for (int v = low_v; v < high_v; ++v) {
    const vec2 off = vec2(double(u) + 0.5LF - x, double(v) + 0.5LF - middle);
    const float distance_ = off.x == 0.0 ? abs(off.y) / float(stretch) : length(off);
    const uint strength = uint(clamp(0.5 * width + 0.5 - distance_, 0.0, 1.0) * 255.0);
    const ivec2 pixel = line.steep ? ivec2(v, u) : ivec2(u, v);
    if (strength != 0u) atomicMax(over[uint(pixel.y) * uint(size.x) + uint(pixel.x)], (strength << 24) | (ink & 0xffffffu));
  }
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * 32768u;
  const uint me = gl_LocalInvocationID.x, mine = group * 32u + me;
  columns_of_line[me] = ivec2(0);
  if (mine < segment_count) {
    const Line line = line_of(mine);
    const ivec2 columns = columns_of(line);
    if (columns.y - columns.x <= COLUMNS_OF_ONE) {
      for (int u = columns.x; u < columns.y; ++u) draw(line, u);
    } else {
      long_line[me] = line;
      columns_of_line[me] = columns;
    }
  }
  barrier();
  for (int i = 0; i < 32; ++i)
    for (int u = columns_of_line[i].x + int(me); u < columns_of_line[i].y; u += 32) draw(long_line[i], u);
}
