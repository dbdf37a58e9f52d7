// 1 for each point that lies outside of a disc, 0 within.
layout(std430, binding = 2) writeonly buffer Kept { uint kept[]; };
layout(location = 7) uniform dvec2 centre;
layout(location = 8) uniform double radius;

void main() {
  const uint i = item();
  if (i >= count) return;
  const dvec2 d = (point[i] - centre) / scale;
  const double r = radius / scale;
  kept[i] = dot(d, d) > r * r ? 1u : 0u;
}
