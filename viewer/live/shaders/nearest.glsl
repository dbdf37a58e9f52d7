// The nearest point: first the smallest distance, then the first point that has it.
layout(std430, binding = 2) buffer Best { uint best[2]; };
layout(location = 5) uniform int round_;
layout(location = 7) uniform dvec2 centre;

void main() {
  const uint i = item();
  if (i >= count) return;
  const dvec2 d = (point[i] - centre) / scale;
  // Bits of floats that are not negative are in the order of the floats.
  const uint distance_ = floatBitsToUint(float(dot(d, d)));
  if (round_ == 0)
    atomicMin(best[0], distance_);
  else if (distance_ == best[0])
    atomicMin(best[1], i);
}
