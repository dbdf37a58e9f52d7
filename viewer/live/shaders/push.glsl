// Particles that overlap push each other apart, along the edges of the mesh: the nearest neighbours of a point are among
// its neighbours in a Delaunay triangulation. `count` is of triangles.
layout(std430, binding = 2) buffer Pushes { int push[]; };  // x and y of each point
layout(std430, binding = 3) readonly buffer Triangles { int corner[]; };
layout(location = 8) uniform float diameter;

const float PUSH_UNIT = 65536.0;  // of a diameter

void main() {
  const uint t = item();
  if (t >= count) return;
  for (uint k = 0u; k < 3u; ++k) {
    const int a = corner[3u * t + k], b = corner[3u * t + (k + 1u) % 3u];
    const vec2 apart = vec2((point[a] - point[b]) / scale);
    const float distance_ = length(apart);
    if (distance_ >= diameter || distance_ == 0.0) continue;
    // A quarter for each end: an edge within the hull is met twice.
    const ivec2 shift = ivec2(0.25 * (1.0 / distance_ - 1.0 / diameter) * apart * PUSH_UNIT);
    atomicAdd(push[2 * a], shift.x);
    atomicAdd(push[2 * a + 1], shift.y);
    atomicAdd(push[2 * b], -shift.x);
    atomicAdd(push[2 * b + 1], -shift.y);
  }
}
