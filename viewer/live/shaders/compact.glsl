// Copies the points that stay, in their order. `place` is scanned: a point stays if the next number is larger.
layout(std430, binding = 2) readonly buffer Places { uint place[]; };
layout(std430, binding = 3) writeonly buffer NewPoints { dvec2 new_point[]; };
layout(std430, binding = 4) writeonly buffer NewVelocities { vec2 new_velocity[]; };

void main() {
  const uint i = item();
  if (i >= count || place[i] == place[i + 1u]) return;
  new_point[place[i]] = point[i];
  new_velocity[place[i]] = velocity[i];
}
