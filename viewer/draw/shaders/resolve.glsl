// The picture: each pixel from its samples, the sums of small triangles, and what is drawn over the mesh.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 9) readonly buffer Overlay { uint over[]; };  // strength << 24 | colour, one word a pixel
layout(rgba8, binding = 0) writeonly uniform image2D picture;

float decode(uint byte) {
  const float v = float(byte & 255u) / 255.0;
  return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}
vec3 encode(vec3 linear) {
  const vec3 v = clamp(linear, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, greaterThan(v, vec3(0.0031308)));
}

/// Distance of the origin from the line through a and b, in samples.
float distance_to(vec2 a, vec2 b) {
  const vec2 d = b - a;
  return abs(a.x * b.y - a.y * b.x) / max(length(d), 1e-20);
}

/// Without a fill, triangles too small for lines are shown by a tint of them.
vec3 veil(float strength) { return mix(background.rgb, line_colour.rgb, 0.5 * strength); }

/// Colour of one sample of a triangle, with its edges and vertices.
vec3 sample_colour(uint t, Corners p, dvec2 at) {
  const vec2 a = vec2(p.a - at), b = vec2(p.b - at), c = vec2(p.c - at);
  vec3 w = abs(vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x));
  const float whole = w.x + w.y + w.z;
  w = whole > 0.0 ? w / whole : vec3(1.0 / 3.0);
  // Of a mesh too fine for its lines they would be all that is seen.
  const float pixels = sqrt(whole) / float(side);
  const float near_enough = smoothstep(2.0, 12.0, pixels);
  vec3 colour = (flags & FILL) != 0 ? colour_of(t, p, w) : veil(1.0 - near_enough);
  if (line_width > 0.0) {
    const float d = min(distance_to(a, b), min(distance_to(b, c), distance_to(c, a))) / float(side);
    colour = mix(colour, line_colour.rgb, clamp(0.5 * line_width + 0.5 - d, 0.0, 1.0) * near_enough * line_colour.a);
  }
  if (point_radius > 0.0) {
    const float d = sqrt(min(dot(a, a), min(dot(b, b), dot(c, c)))) / float(side);
    colour = mix(colour, point_colour.rgb, clamp(point_radius + 0.5 - d, 0.0, 1.0) * near_enough * point_colour.a);
  }
  return colour;
}

/// Points alone: how many discs lie over a pixel, one in the colour of points, more along the ramp.
vec3 crowd_colour(uint at) {
  const float n = float(sum[4u * at]) / 255.0;
  return n <= 1.0 ? mix(background.rgb, point_colour.rgb, n) : mix(point_colour.rgb, ramp_colour(n), min(1.0, 0.25 * (n - 1.0)));
}

/// The mesh in a pixel over the background.
vec3 mesh_colour(ivec2 pixel, uint at) {
  const float share = 1.0 / float(side * side);
  vec3 colour = vec3(0.0);
  float weight = 0.0, covered = 0.0;
  uint some = 0u, placed = 0u;
  Corners p;  // of the triangle `placed` - 1: mostly that of the next sample, too
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const ivec2 spot = pixel * side + ivec2(i, j);
      const uint word = owner[uint(spot.y) * uint(samples.x) + uint(spot.x)];
      if (word == 0u) continue;
      covered += share;
      some = word;
      if ((word & SUMMED) != 0u) continue;
      if (word != placed) p = corners_of(word - 1u);
      placed = word;
      colour += share * sample_colour(word - 1u, p, dvec2(spot) + 0.5LF);
      weight += share;
    }
  }
  const vec4 sums = vec4(sum[4u * at], sum[4u * at + 1u], sum[4u * at + 2u], sum[4u * at + 3u]) / UNIT;
  const vec3 small = (flags & FILL) != 0 ? sums.rgb : sums.a * veil(1.0);
  colour += small;
  weight += sums.a;
  if (weight > 0.0) {
    colour /= weight;
  } else if (some != 0u) {
    const uint t = (some & ~SUMMED) - 1u;
    colour = sample_colour(t, corners_of(t), dvec2(pixel * side) + 0.5LF * double(side));
  }
  return mix(background.rgb, colour, covered);
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = samples / side;
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  const uint at = uint(pixel.y) * uint(size.x) + uint(pixel.x);
  vec3 result = (flags & POINTS) != 0 ? crowd_colour(at) : mesh_colour(pixel, at);
  const uint stroke = over[at];
  if (stroke != 0u) {
    const vec3 ink = vec3(decode(stroke >> 16), decode(stroke >> 8), decode(stroke));
    result = mix(result, ink, float(stroke >> 24) / 255.0);
  }
  imageStore(picture, pixel, vec4(encode(result), 1.0));
}
