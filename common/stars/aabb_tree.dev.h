/* SPDX-License-Identifier: Apache-2.0
 *
 * The AABB tree of gift wrapping (wrap_fast.dev.h, wrap_exact.dev.h), and discs to search it with. Its leaves are the
 * bounding boxes of CADT_AABB_LEAF points that follow one another in sorted order, its nodes those of CADT_AABB_FANOUT
 * leaves; leaves and nodes that a disc does not reach are skipped.
 */
#ifndef CADT_STARS_AABB_TREE_H
#define CADT_STARS_AABB_TREE_H

#include "common/batch/batch.dev.h"
#include "common/mesh/locked_mesh.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

/* Radius^2 up to which the points around a vertex are gathered, in squared spacings of the points. */
#define CADT_NEAR_SPACINGS 9.0
/* A circle whose arc is flatter than this is not known better in rounded arithmetic (cadt_disc_beside). */
#define CADT_WRAP_FLAT 65536.0

/* The points among which stars are searched: all, or those of one set (batch.dev.h). Each set begins a new leaf and a
 * new node, so some numbers of leaves and nodes are unused. */
typedef struct {
  cadt_u32 begin, count; /* positions in sorted order */
  cadt_u32 leaf, node;   /* the first of the set */
} cadt_wrap_span;

/* `starts`: null for all n points. */
CADT_FN cadt_wrap_span cadt_wrap_span_of(CADT_GLOBAL const cadt_u32* starts, cadt_u32 set, cadt_u32 n) {
  cadt_wrap_span r;
  r.begin = starts ? starts[set] : 0u;
  r.count = starts ? starts[set + 1u] - r.begin : n;
  r.leaf = starts ? r.begin / CADT_AABB_LEAF + set : 0u;
  r.node = starts ? r.begin / (CADT_AABB_LEAF * CADT_AABB_FANOUT) + set : 0u;
  return r;
}

/* The set of a node: the last one whose first node is not behind it. */
CADT_FN cadt_u32 cadt_wrap_set_of_node(CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count, cadt_u32 node) {
  cadt_u32 low = 0u, high = set_count;
  CADT_FIND_LAST(low, high, middle, cadt_wrap_span_of(starts, middle, 0u).node <= node);
  return low;
}

typedef struct {
  CADT_GLOBAL const cadt_point* points; /* of a span; vertices, leaves and nodes are counted in it */
  CADT_GLOBAL const cadt_aabb* leaves;  /* boxes of CADT_AABB_LEAF points */
  CADT_GLOBAL const cadt_aabb* nodes;   /* boxes of CADT_AABB_FANOUT leaves */
  cadt_u32 n, leaf_count, node_count;
} cadt_aabb_tree;

CADT_FN cadt_aabb_tree cadt_aabb_tree_of(const cadt_wrap_span span, CADT_GLOBAL const cadt_point* points,
                                         CADT_GLOBAL const cadt_aabb* leaves, CADT_GLOBAL const cadt_aabb* nodes) {
  const cadt_u32 leaf_count = (span.count - 1u) / CADT_AABB_LEAF + 1u;
  const cadt_u32 node_count = (leaf_count - 1u) / CADT_AABB_FANOUT + 1u;
  const cadt_aabb_tree in = {points + span.begin, leaves + span.leaf, nodes + span.node,
                             span.count,          leaf_count,         node_count};
  return in;
}

/* Point number `place` of those in the listed leaves. */
CADT_FN cadt_u32 cadt_wrap_in_leaves(CADT_TEAM_PTR const cadt_u32* leaves, cadt_u32 place) {
  return leaves[place / CADT_AABB_LEAF] * CADT_AABB_LEAF + place % CADT_AABB_LEAF;
}

CADT_FN void cadt_aabb_add(cadt_aabb* leaf, const cadt_aabb other) {
  if (other.low.x < leaf->low.x) leaf->low.x = other.low.x;
  if (other.low.y < leaf->low.y) leaf->low.y = other.low.y;
  if (other.high.x > leaf->high.x) leaf->high.x = other.high.x;
  if (other.high.y > leaf->high.y) leaf->high.y = other.high.y;
}

/* The bounding box of up to CADT_WRAP_PART points. \pre count > 0 */
CADT_FN cadt_aabb cadt_aabb_of_points(CADT_GLOBAL const cadt_point* points, cadt_u32 count) {
  cadt_aabb leaf, point[CADT_WRAP_PART];
  for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_WRAP_PART); ++i) /* all loads at once: each has a long latency */
    point[i].low = point[i].high = points[i < count ? i : 0u];
  leaf = point[0];
  for (cadt_u32 i = 1u; i < CADT_CAST(cadt_u32, CADT_WRAP_PART); ++i) cadt_aabb_add(&leaf, point[i]);
  return leaf;
}

CADT_FN cadt_aabb cadt_aabb_of_leaves(CADT_TEAM_PTR const cadt_aabb* leaves, cadt_u32 count) {
  cadt_aabb leaf = leaves[0];
  for (cadt_u32 i = 1u; i < count; ++i) cadt_aabb_add(&leaf, leaves[i]);
  return leaf;
}

/* Builds leaves and nodes, a team for each node. Also zeroes `sizes` and `counts` for the kernels of the stars, where
 * they are given. */
CADT_KERNEL(cadt_build_aabb_tree, CADT_GLOBAL const cadt_point* points, cadt_u32 n, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, cadt_u32 node_count, cadt_u32 grain, CADT_GLOBAL cadt_aabb* leaves,
            CADT_GLOBAL cadt_aabb* nodes, CADT_GLOBAL cadt_u32* sizes, CADT_GLOBAL cadt_u32* counts) {
  CADT_TEAM_MEMORY cadt_aabb part[CADT_AABB_FANOUT * CADT_WRAP_PARTS];
  CADT_TEAM_MEMORY cadt_aabb inside[CADT_AABB_FANOUT];
  if (counts && cadt_item == 0u)
    for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_WRAP_WORDS); ++k) counts[k] = 0u;
  CADT_FOR_TEAMS(node, node_count, grain) {
    const cadt_wrap_span r = cadt_wrap_span_of(starts, starts ? cadt_wrap_set_of_node(starts, set_count, node) : 0u, n);
    const cadt_u32 begin = cadt_min_u32(r.count, (node - r.node) * CADT_AABB_FANOUT * CADT_AABB_LEAF);
    const cadt_u32 count = cadt_min_u32(r.count - begin, CADT_AABB_FANOUT * CADT_AABB_LEAF);
    const cadt_u32 parts = (count + CADT_WRAP_PART - 1u) / CADT_WRAP_PART,
                   leaf_count = (count + CADT_AABB_LEAF - 1u) / CADT_AABB_LEAF;
    CADT_TEAM_FOR(k, parts) {
      part[k] = cadt_aabb_of_points(points + r.begin + begin + k * CADT_WRAP_PART, count - k * CADT_WRAP_PART);
    }
    CADT_TEAM_FOR(i, sizes ? count : 0u) { sizes[r.begin + begin + i] = 0u; }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(j, leaf_count) {
      inside[j] =
          cadt_aabb_of_leaves(part + j * CADT_WRAP_PARTS, cadt_min_u32(CADT_WRAP_PARTS, parts - j * CADT_WRAP_PARTS));
      leaves[r.leaf + begin / CADT_AABB_LEAF + j] = inside[j];
    }
    CADT_TEAM_SYNC();
    if (cadt_team_lane == 0u && count) nodes[node] = cadt_aabb_of_leaves(inside, leaf_count);
    CADT_TEAM_SYNC();
  }
}

/* A disc that certainly contains the circle through p, a and b; coordinates are relative to p. */
typedef struct {
  double x, y, square; /* centre, radius^2; if that is not finite, the disc may be the whole plane */
} cadt_disc;

/* With u = 2^-53 and K = |a| |b| / |a x b|, which is at least 1, centre and radius are off by less than E = 24 u K (1 +
 * K) (|a| + |b|) where K is well known, and that is at most 48 u (kk (1 + kk) (aa + bb))^(1/2). Tests whether a point
 * or a box is in the disc use coordinates that are off by 8 u r. The radius may be many times the distance of the
 * points that are tested, so it must not be larger than necessary. */
CADT_FN cadt_disc cadt_disc_around(cadt_point p, cadt_point a, cadt_point b) {
  const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
  const double aa = ax * ax + ay * ay, bb = bx * bx + by * by;
  const double scale = 0.5 / (ax * by - ay * bx), kk = 4.0 * (aa * scale) * (bb * scale); /* K^2 */
  cadt_disc d = {(by * aa - ay * bb) * scale, (ax * bb - bx * aa) * scale, 0.0};
  const double radius =
      cadt_sqrt(d.x * d.x + d.y * d.y) * (1.0 + 4e-15) + 1e-14 * cadt_sqrt(kk * (1.0 + kk) * (aa + bb));
  d.square = radius * radius;
  if (!(kk < 1e24)) d.square = CADT_CAST(double, CADT_INFINITY);
  return d;
}

/* The same for points on one side (1 left, -1 right) of the line from p to a, on which b lies. If p and a are seen from
 * b in nearly opposite directions, the circle is almost a line, and its centre is not known; but on that side it has
 * only a flat arc, and a flatter circle contains that: the one that sees p and a at an angle whose cotangent is
 * -CADT_WRAP_FLAT, half of what is certain of b. */
CADT_FN cadt_disc cadt_disc_beside(cadt_point p, cadt_point a, cadt_point b, cadt_i32 side) {
  const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
  const double left = ax * by, right = ay * bx, across = bx * (bx - ax), along = by * (by - ay);
  const double cross = cadt_fabs(left - right) + 1e-15 * (cadt_fabs(left) + cadt_fabs(right));
  const double dot = across + along + 1e-15 * (cadt_fabs(across) + cadt_fabs(along));
  if (!(-dot > 2.0 * CADT_WRAP_FLAT * cross)) return cadt_disc_around(p, a, b);
  const double away = 0.5 * CADT_WRAP_FLAT * CADT_CAST(double, side);
  const cadt_disc d = {0.5 * ax + away * ay, 0.5 * ay - away * ax,
                       0.25 * (ax * ax + ay * ay) * (1.0 + CADT_WRAP_FLAT * CADT_WRAP_FLAT) * (1.0 + 1e-14)};
  return d;
}

/* Whether points of the box can lie in the disc and to the side (1 left, -1 right, 0 either) of the line from p to p +
 * (ax, ay). A comparison with NaN does not exclude them. */
CADT_FN cadt_u32 cadt_aabb_matters(const cadt_aabb leaf, cadt_point p, double ax, double ay, double side,
                                   const cadt_disc* disc) {
  const double low_x = leaf.low.x - p.x, low_y = leaf.low.y - p.y, high_x = leaf.high.x - p.x,
               high_y = leaf.high.y - p.y;
  const double left = ax * (ax * side > 0.0 ? high_y : low_y), right = ay * (ay * side > 0.0 ? low_x : high_x);
  /* also none beyond an axis-parallel line: both are 0 */
  if (side != 0.0 && (left - right) * side <= -1e-15 * (cadt_fabs(left) + cadt_fabs(right))) return 0u;
  double x = low_x - disc->x, y = low_y - disc->y;
  if (x < 0.0) x = disc->x > high_x ? disc->x - high_x : 0.0;
  if (y < 0.0) y = disc->y > high_y ? disc->y - high_y : 0.0;
  return x * x + y * y > disc->square ? 0u : 1u;
}

typedef struct {
  double square; /* square of the distance up to which all points are known; negative: not known */
  double unit;   /* scale factor for single precision */
} cadt_reach_around;

/* How far the points around p are gathered: three times the spacing of the points, estimated from the leaf of p and
 * those beside it in sorted order, which may span a gap of the curve. */
CADT_FN cadt_reach_around cadt_wrap_reach(const cadt_aabb_tree* in, cadt_u32 p) {
  const cadt_u32 own = p / CADT_AABB_LEAF, end = cadt_min_u32(own + 2u, in->leaf_count);
  double spacing = CADT_CAST(double, CADT_INFINITY), longest = 0.0;
  for (cadt_u32 b = own ? own - 1u : 0u; b < end; ++b) {
    const cadt_aabb leaf = in->leaves[b];
    const double wide = leaf.high.x - leaf.low.x, high = leaf.high.y - leaf.low.y, longer = wide > high ? wide : high;
    const cadt_u32 count = cadt_min_u32(CADT_AABB_LEAF, in->n - b * CADT_AABB_LEAF);
    if (b && 2u * count < CADT_CAST(cadt_u32, CADT_AABB_LEAF)) continue; /* too few points for an estimate */
    const double inverse = 1.0 / CADT_CAST(double, count);
    const double area = wide * high * inverse, line = longer * longer * inverse * inverse;
    const double square = area > line ? area : line;
    spacing = square < spacing ? square : spacing;
    longest = longer > longest ? longer : longest;
  }
  const cadt_u32 all = in->n <= CADT_CAST(cadt_u32, CADT_NEAR_POINTS) ? 1u : 0u;
  const double square = all ? CADT_CAST(double, CADT_INFINITY) : CADT_NEAR_SPACINGS * spacing;
  const cadt_reach_around reach = {square, 1.0 / (all ? longest : cadt_sqrt(square))};
  return reach;
}

/* An integer in the same order as the float x. \pre x is not NaN */
CADT_FN cadt_u32 cadt_wrap_order(float x) {
  const cadt_u32 bits = cadt_bits_of_float(x);
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

/* Sort key of c as the next star vertex after a, both relative to p and scaled: the cotangent of the angle at which c
 * sees p and a. With `nearest`: its squared distance. CADT_NONE if c is not on that side. */
CADT_FN cadt_u32 cadt_wrap_key(float ax, float ay, float cx, float cy, cadt_i32 side, cadt_u32 nearest) {
  const float cross = side > 0 ? ax * cy - ay * cx : ay * cx - ax * cy, dot = cx * (cx - ax) + cy * (cy - ay);
  const float square = cx * cx + cy * cy, value = nearest ? square : dot * cadt_about_inverse(cross);
  if (!((nearest ? square : cross) > 0.0f && cadt_fabsf(value) < 3e38f))
    return CADT_NONE; /* excludes p and a as well */
  return cadt_wrap_order(value);
}

/* The cotangent from its key. */
CADT_FN float cadt_wrap_key_value(cadt_u32 key) { return cadt_float_of_bits(key >> 31 ? key & 0x7FFFFFFFu : ~key); }

/* Which of two points on one side of the line p, a has an empty circle with p and a among the two. */
CADT_FN cadt_u32 cadt_wrap_better_of(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a, cadt_i32 side,
                                     cadt_u32 b, cadt_u32 c, cadt_counters* counters) {
  return cadt_incircle(points[side > 0 ? p : a], points[side > 0 ? a : p], points[b], points[c], counters) > 0 ? c : b;
}

/* A reduction over the lanes of a team that takes one barrier: the least of their values, and how many they count. The
 * result can be read until the end of the next reduction. */
typedef struct {
  cadt_u32 least[3], count[3]; /* of this reduction, of the next one, of the one after it */
} cadt_reduction;

/* \pre a barrier follows, and no lane reads earlier results any more */
CADT_FN void cadt_begin_reductions(CADT_TEAM_PTR cadt_reduction* reductions) {
  if (cadt_team_lane != 0u) return;
  reductions->least[0] = CADT_NONE;
  reductions->count[0] = 0u;
}

/* Ends reduction `*now`, to which the lane contributes a value or CADT_NONE. */
CADT_FN cadt_u32 cadt_end_reduction(CADT_TEAM_PTR cadt_reduction* reductions, cadt_u32* now, cadt_u32 value,
                                    cadt_u32* count) {
  const cadt_u32 this_one = *now, next = this_one == 2u ? 0u : this_one + 1u;
  if (cadt_team_lane == 0u) {
    reductions->least[next] = CADT_NONE;
    reductions->count[next] = 0u;
  }
  cadt_team_least(&reductions->least[this_one], value);
  CADT_TEAM_SYNC();
  *now = next;
  *count = reductions->count[this_one];
  return reductions->least[this_one];
}

#endif
