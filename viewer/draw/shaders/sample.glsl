// Values of a sample of the triangles, for the ends of the ramp.
layout(local_size_x = 64) in;
layout(std430, binding = 6) writeonly buffer Out { float result[]; };
layout(location = 0) uniform uint step_;
layout(location = 1) uniform uint count;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint t = i * step_;
  const Corners p = corners_of(t);
  const vec2 e = vec2(p.b - p.a), f = vec2(p.c - p.a);
  result[3u * i] = raw_value(t, p, vec3(1.0 / 3.0));
  const vec3 h = colour_by == BY_POINT ? corner_values(t) : vec3(0.0);
  // Slope of a unit of height over a sample.
  const float det = e.x * f.y - e.y * f.x;
  const vec2 g = vec2((h.y - h.x) * f.y - (h.z - h.x) * e.y, (h.z - h.x) * e.x - (h.y - h.x) * f.x) / det;
  result[3u * i + 1u] = length(g);
  result[3u * i + 2u] = sqrt(float(area2(p)));
}
