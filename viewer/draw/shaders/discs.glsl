// Points as discs over the picture, for sets without triangles and for the points alone. Where they are dense the
// strength grows with their number.
layout(local_size_x = 256) in;
layout(std430, binding = 7) buffer Sums { uint sum[]; };
layout(location = 0) uniform float radius;  // pixels

void main() {
  const uint v = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 256u;
  if (v >= point_count) return;
  const ivec2 size = samples / side;
  const dvec2 p = place(int(v)) / double(side);
  const double r = double(radius) + 0.5LF;
  if (!(p.x > -r && p.y > -r && p.x < double(size.x) + r && p.y < double(size.y) + r)) return;
  const ivec2 low_pixel = max(ivec2(floor(p - r)), ivec2(0)), high_pixel = min(ivec2(ceil(p + r)), size);
  for (int y = low_pixel.y; y < high_pixel.y; ++y) {
    for (int x = low_pixel.x; x < high_pixel.x; ++x) {
      const float d = float(length(dvec2(x, y) + 0.5LF - p));
      const uint strength = uint(clamp(radius + 0.5 - d, 0.0, 1.0) * 255.0);
      if (strength != 0u) atomicAdd(sum[4u * (uint(y) * uint(size.x) + uint(x))], strength);
    }
  }
}
