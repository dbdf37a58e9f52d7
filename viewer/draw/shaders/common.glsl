// SPDX-License-Identifier: Apache-2.0
// What all drawing programs know: the mesh as the library's arrays, and where it is seen from.

layout(std140, binding = 0) uniform Frame {
  dvec2 origin, first, second;  // of the plane to samples: (p * before - origin) * first * second, from the upper left
  ivec2 samples;                // of the whole picture
  uint triangle_count, point_count, block_count, large_capacity;
  int side;          // samples along the side of a pixel
  int colour_by;     // ColourBy of style.hpp
  int flags;         // SHADE, ...
  float before;
  float low, high;   // values of the ends of the ramp
  float line_width;  // pixels; 0: no edges
  float point_radius;
  float relief;      // heights to samples, for light
  float fade_begin;  // samples: longest edge of a triangle outside of the ground; from three times that on it is almost gone
  vec4 background, fill_colour, line_colour, point_colour;  // linear light; the alpha of a line is its strength
};
const int SHADE = 1, FILL = 2, LOGARITHM = 4, POINTS = 8, FADE = 16;

layout(std430, binding = 0) readonly buffer Points { dvec2 point[]; };
layout(std430, binding = 1) readonly buffer Triangles { int corner[]; };
layout(std430, binding = 2) readonly buffer Values { float value_of[]; };  // one a point, or one a triangle
layout(std430, binding = 10) readonly buffer Outside { uint outside[]; };  // a bit a point, see Renderer::set_outside

const uint BLOCK = 4096u;  // consecutive triangles that are culled together

dvec2 place_point(dvec2 p) {
  precise dvec2 q = (p * double(before) - origin) * first * second;
  return q;
}
dvec2 place(int v) { return place_point(point[v]); }
