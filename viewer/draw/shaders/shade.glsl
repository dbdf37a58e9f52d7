// Colour of a triangle.
layout(binding = 0) uniform sampler1D ramp;  // linear light

// ColourBy of style.hpp.
const int BY_NOTHING = 0, BY_ANGLE = 1, BY_AREA = 2, BY_ORDER = 3, BY_POINT = 4, BY_TRIANGLE = 5, BY_MEAN = 6;

struct Corners {
  dvec2 a, b, c;  // in samples
};

Corners corners_of(uint t) {
  return Corners(place(corner[3u * t]), place(corner[3u * t + 1u]), place(corner[3u * t + 2u]));
}

float smallest_angle(Corners t) {
  const vec2 ab = vec2(t.b - t.a), bc = vec2(t.c - t.b), ca = vec2(t.a - t.c);
  const float la = dot(bc, bc), lb = dot(ca, ca), lc = dot(ab, ab);
  const float area2 = abs(ab.x * ca.y - ab.y * ca.x);
  // The smallest angle lies opposite the shortest edge, between the two others.
  const float shortest = min(la, min(lb, lc));
  const float product = shortest == la ? lb * lc : shortest == lb ? la * lc : la * lb;
  return degrees(asin(clamp(area2 / sqrt(max(product, 1e-30)), 0.0, 1.0)));
}

double area2(Corners t) {
  precise double d = (t.b.x - t.a.x) * (t.c.y - t.a.y) - (t.b.y - t.a.y) * (t.c.x - t.a.x);
  return d < 0.0LF ? -d : d;
}

vec3 corner_values(uint t) {
  return vec3(value_of[corner[3u * t]], value_of[corner[3u * t + 1u]], value_of[corner[3u * t + 2u]]);
}

/// The value that decides the colour, at the barycentric coordinates `at`.
float raw_value(uint t, Corners p, vec3 at) {
  switch (colour_by) {
    case BY_ANGLE:
      return smallest_angle(p);
    case BY_AREA:  // in samples, whatever the unit: the ends of the ramp are scaled alike
      return float(area2(p)) * 0.5;
    case BY_ORDER:
      return float(t);
    case BY_POINT:
      return dot(corner_values(t), at);
    case BY_TRIANGLE:
      return value_of[t];
    case BY_MEAN:
      return dot(corner_values(t), vec3(1.0 / 3.0));
  }
  return 0.0;
}

/// Light from the upper left on the plane of a triangle, 1 for level ground.
float light(uint t, Corners p) {
  const vec3 h = corner_values(t) * relief;
  const vec2 u = vec2(p.b - p.a), v = vec2(p.c - p.a);
  const float det = u.x * v.y - u.y * v.x;
  if (abs(det) < 1e-12) return 1.0;
  const float du = h.y - h.x, dv = h.z - h.x;
  const vec2 g = vec2(du * v.y - dv * u.y, dv * u.x - du * v.x) / det;
  const float lambert = max(0.0, (0.5 * g.x + 0.5 * g.y + 0.7071) / sqrt(dot(g, g) + 1.0)) / 0.7071;
  return 0.28 + 0.72 * lambert;
}

vec3 ramp_colour(float value) {
  if (isnan(value)) return fill_colour.rgb;
  if ((flags & LOGARITHM) != 0) value = log2(max(value, 1e-30));
  return texture(ramp, clamp((value - low) / max(high - low, 1e-30), 0.0, 1.0) * (511.0 / 512.0) + 0.5 / 512.0).rgb;
}

/// How far a triangle counts as ground: 1, but less for large ones that fill bays of the outline.
float ground(uint t, Corners p) {
  const uint v = uint(corner[3u * t]);
  if ((outside[v >> 5u] >> (v & 31u) & 1u) == 0u) return 1.0;
  const float longest = float(sqrt(max(dot(p.b - p.a, p.b - p.a), max(dot(p.c - p.b, p.c - p.b), dot(p.a - p.c, p.a - p.c)))));
  return 1.0 - 0.8 * clamp((longest - fade_begin) / (2.0 * fade_begin), 0.0, 1.0);
}

vec3 colour_of(uint t, Corners p, vec3 at) {
  vec3 colour = colour_by == BY_NOTHING ? fill_colour.rgb : ramp_colour(raw_value(t, p, at));
  if ((flags & SHADE) != 0) colour *= light(t, p);
  if ((flags & FADE) != 0) colour = mix(background.rgb, colour, ground(t, p));
  return colour;
}
