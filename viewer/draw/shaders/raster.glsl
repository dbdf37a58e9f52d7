// Which triangle each sample belongs to, and the sums of the triangles that are smaller than a pixel.
//
// A row of samples at height y cuts two edges of a triangle, each taken as half open, [lower end, upper end). Its samples
// are those in [left cut, right cut). A cut is computed from the lower end of the edge, whatever the triangle, so that
// two triangles that share an edge cut it at the same number: each sample within the hull belongs to one triangle.

layout(std430, binding = 6) buffer Owners { uint owner[]; };  // triangle + 1, 0: none; the highest bit: summed
layout(std430, binding = 7) buffer Sums { uint sum[]; };      // red, green, blue times area, area: four words a pixel
layout(std430, binding = 8) buffer Large { uint large[]; };

const uint SUMMED = 0x80000000u;
const float UNIT = 16777216.0;  // of the sums: one pixel's area

struct Rows {
  int low, high;
};
Rows rows_of(Corners p) {
  const double lo = min(p.a.y, min(p.b.y, p.c.y)), hi = max(p.a.y, max(p.b.y, p.c.y));
  // The first centre (row + 0.5) at or above lo, and the first one at or above hi.
  return Rows(int(ceil(clamp(lo - 0.5LF, 0.0LF, double(samples.y)))), int(ceil(clamp(hi - 0.5LF, 0.0LF, double(samples.y)))));
}

/// Where the row at y cuts the edge. \pre the row lies between the ends
double cut(dvec2 p, dvec2 q, double y) {
  const bool up = p.y < q.y;
  const dvec2 lo = up ? p : q, hi = up ? q : p;
  precise double x = lo.x + (y - lo.y) * ((hi.x - lo.x) / (hi.y - lo.y));
  return x;
}

/// Samples [low, high) of a row.
Rows columns_of(Corners p, int row) {
  const double y = double(row) + 0.5LF;
  const bool a = p.a.y <= y, b = p.b.y <= y, c = p.c.y <= y;
  if (a == b && b == c) return Rows(0, 0);
  // The corner that is alone on its side of the row.
  const dvec2 alone = a == b ? p.c : (a == c ? p.b : p.a);
  const dvec2 next = a == b ? p.a : (a == c ? p.c : p.b), last = a == b ? p.b : (a == c ? p.a : p.c);
  const double u = cut(alone, next, y), v = cut(alone, last, y);
  const double lo = min(u, v), hi = max(u, v), width = double(samples.x);
  return Rows(int(ceil(clamp(lo - 0.5LF, 0.0LF, width))), int(ceil(clamp(hi - 0.5LF, 0.0LF, width))));
}

void own(uint word, int row, int column) { owner[uint(row) * uint(samples.x) + uint(column)] = word; }
