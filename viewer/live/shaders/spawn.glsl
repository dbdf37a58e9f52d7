// New points [first, first + count) in the box or in a disc, and their velocities.
layout(location = 5) uniform uint first;
layout(location = 6) uniform int where;  // Where of live_points.cpp
layout(location = 7) uniform dvec2 centre;
layout(location = 8) uniform double radius;

const int WHERE_THEY_ARE = 0, BOX = 1, DISC = 2;

void main() {
  if (item() >= count) return;
  const uint i = first + item();
  if (where == BOX) {
    point[i] = low + dvec2(random_double(i, 0u), random_double(i, 1u)) * limit * scale;
  } else if (where == DISC) {
    const float turn = 6.2831853 * random_float(i, 2u);
    const double r = radius * sqrt(random_double(i, 0u));
    point[i] = centre + r * dvec2(cos(turn), sin(turn));
  }
  const float angle = 6.2831853 * random_float(i, 16u), speed = 0.05 + 0.1 * random_float(i, 17u);
  velocity[i] = speed * vec2(cos(angle), sin(angle));
}
