// Line segments of one colour and width over the mesh: the hull, Voronoi cells, constrained edges. 32 items a segment.
layout(local_size_x = 32) in;
layout(std430, binding = 3) readonly buffer Segments { dvec4 segment[]; };
layout(std430, binding = 4) readonly buffer Edges { ivec2 edge[]; };  // between points of the mesh
layout(std430, binding = 9) buffer Overlay { uint over[]; };
layout(location = 0) uniform uint segment_count;
layout(location = 1) uniform uint ink;  // 0xRRGGBB
layout(location = 2) uniform float width;  // pixels
layout(location = 3) uniform bool edges;   // these, and not the segments

void main() {
  const uint mine = gl_WorkGroupID.x + gl_WorkGroupID.y * 32768u;
  if (mine >= segment_count) return;
  const ivec2 size = samples / side;
  dvec2 p = (edges ? place(edge[mine].x) : place_point(segment[mine].xy)) / double(side);
  dvec2 q = (edges ? place(edge[mine].y) : place_point(segment[mine].zw)) / double(side);
  // Along the longer axis, one column (or row) of pixels after the other.
  const dvec2 d = q - p;
  const bool steep = abs(d.y) > abs(d.x);
  if (steep) {
    p = p.yx;
    q = q.yx;
  }
  if (p.x > q.x) {
    const dvec2 other = p;
    p = q;
    q = other;
  }
  const int along = steep ? size.y : size.x, across = steep ? size.x : size.y;
  const double half_width = 0.5LF * double(width);
  const int begin = int(floor(clamp(p.x - half_width, 0.0LF, double(along)))), end = int(ceil(clamp(q.x + half_width, 0.0LF, double(along))));
  const double length_x = q.x - p.x;
  const double slope = length_x > 0.0LF ? (q.y - p.y) / length_x : 0.0LF;
  const double stretch = sqrt(1.0LF + slope * slope);
  for (int u = begin + int(gl_LocalInvocationID.x); u < end; u += 32) {
    const double x = clamp(double(u) + 0.5LF, p.x, q.x);
    const double middle = p.y + (x - p.x) * slope, reach = half_width * stretch + 1.0LF;
    const int low_v = int(floor(clamp(middle - reach, 0.0LF, double(across)))), high_v = int(ceil(clamp(middle + reach, 0.0LF, double(across))));
    for (int v = low_v; v < high_v; ++v) {
      const vec2 off = vec2(double(u) + 0.5LF - x, double(v) + 0.5LF - middle);
      const float distance_ = off.x == 0.0 ? abs(off.y) / float(stretch) : length(off);
      const uint strength = uint(clamp(0.5 * width + 0.5 - distance_, 0.0, 1.0) * 255.0);
      const ivec2 pixel = steep ? ivec2(v, u) : ivec2(u, v);
      if (strength != 0u) atomicMax(over[uint(pixel.y) * uint(size.x) + uint(pixel.x)], (strength << 24) | (ink & 0xffffffu));
    }
  }
}
