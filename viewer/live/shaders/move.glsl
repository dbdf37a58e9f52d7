// A step of all points.
layout(std430, binding = 2) readonly buffer Pushes { ivec2 push[]; };
layout(location = 5) uniform int motion;  // Motion of live_points.hpp
layout(location = 6) uniform float dt;    // seconds
layout(location = 7) uniform float time;
layout(location = 8) uniform float diameter;  // of particles, in box lengths

const int FLOW = 0, BOUNCE = 1, ORBIT = 2, PARTICLES = 3;
const float PI = 3.14159265;
const float PUSH_UNIT = 65536.0;  // of a diameter

/// A field without sources that leaves the box as it is and turns round every eight seconds.
vec2 flow(vec2 at) {
  const vec2 s = sin(PI * at);
  return 0.5 * cos(PI * time / 8.0) * vec2(s.x * s.x * sin(2.0 * PI * at.y), -s.y * s.y * sin(2.0 * PI * at.x));
}

/// Back into [0, limit] as if its ends were mirrors; `turned` says whether an odd number of times.
double fold(double u, double most, out bool turned) {
  turned = false;
  if (most <= 0.0LF) return 0.0LF;
  double v = u - 2.0LF * most * floor(u / (2.0LF * most));
  if (v > most) {
    v = 2.0LF * most - v;
    turned = true;
  }
  return v;
}

void main() {
  const uint i = item();
  if (i >= count) return;
  dvec2 u = (point[i] - low) / scale;
  vec2 v = velocity[i];
  if (motion == FLOW) {
    const vec2 size = max(vec2(limit), vec2(1e-20));
    u += dvec2(flow(vec2(u) / size) * size * dt);
  } else {
    if (motion == ORBIT) {
      const vec2 from = vec2(u - 0.5LF * limit);
      const float r2 = dot(from, from) + 0.01;
      v -= dt * 0.02 * from / (r2 * sqrt(r2));
    } else if (motion == PARTICLES) {
      // Brownian: random kicks, with friction that keeps the mean speed.
      const float turn = 2.0 * PI * random_float(i, 0u), length_ = sqrt(-2.0 * log(1.0 - random_float(i, 1u)));
      v = v * exp(-4.0 * dt) + 0.2 * sqrt(dt) * length_ * vec2(cos(turn), sin(turn));
      u += dvec2(vec2(push[i]) * (diameter / PUSH_UNIT));
    }
    u += dvec2(v * dt);
  }
  bool left, below;
  u = dvec2(fold(u.x, limit.x, left), fold(u.y, limit.y, below));
  if (left) v.x = -v.x;
  if (below) v.y = -v.y;
  velocity[i] = v;
  point[i] = low + u * scale;
}
