/* SPDX-License-Identifier: Apache-2.0
 *
 * What kernels and driver share in memory: layouts, sizes and the meaning of words.
 */
#ifndef CADT_PORTABLE_LAYOUT_H
#define CADT_PORTABLE_LAYOUT_H

#include "common/portable/dialect.dev.h"

#define CADT_GHOST 0xFFFFFFFFu

/* A half-edge: a triangle and one of its edges. */
#define CADT_HALF_EDGE(triangle, edge) (((triangle) << 2) | (edge))
#define CADT_TRIANGLE_OF(half_edge) ((half_edge) >> 2)
#define CADT_EDGE_OF(half_edge) ((half_edge)&3u)

typedef struct {
  cadt_u32 word[8]; /* v0 v1 v2 lock n0 n1 n2 flips */
} __attribute__((aligned(32))) cadt_locked_triangle;

/* Points of the sample for the point profile (spatial_sort.dev.h). */
enum { CADT_POINT_SAMPLES = 1024, CADT_HULL_PROBES = 16 /* others that each of them is compared with */ };

/* What sorting the points finds: 1 if a cell is over-full; how many points equal the one before; and how many of the
 * sample lie beside a line, on one circle, on a circle with the next three, the same by a cheap test, on a line with
 * them, on the hull. */
enum {
  CADT_OVERFULL,
  CADT_EQUAL,
  CADT_SHAPE_BESIDE,
  CADT_SHAPE_ONE_CIRCLE,
  CADT_SHAPE_CIRCLE,
  CADT_SHAPE_MIRRORED,
  CADT_SHAPE_LINE,
  CADT_SHAPE_HULL,
  CADT_ORDER_WORDS
};

enum { CADT_WORD_LOCK = 3, CADT_WORD_HALF_EDGE = 4, CADT_WORD_FLIPS = 7 };

/* The star stage: tiles (tiles.dev.h) and stars (local_star.dev.h). */
typedef struct {
  cadt_u32 begin; /* first position; the tile ends where the next one begins */
  cadt_i32 level;
} cadt_tile;

enum {
  CADT_TILE_POINTS = 704,  /* at most, but for squares that cannot be divided */
  CADT_TILE_OVERFULL = 64, /* if one square CADT_OVERFULL_LEVELS below holds so many points, */
  CADT_OVERFULL_LEVELS = 3,
  CADT_TILE_FEW = 128,   /* the tile has at most so many */
  CADT_STAR_DEGREE = 12, /* neighbours of a proven star at most */
  CADT_STAR_LANES = 128, /* lanes of a team that make stars */
  /* Vertices whose triangles a team writes, and how many triangles it collects (more are written at once). */
  CADT_ASSEMBLY_LANES = 128,
  CADT_TRIANGLES_OF_TEAM = 320,
  /* Words for the stars of a tile: 6 a vertex on average, and these as some tiles have more. */
  CADT_STAR_SPARE = 8,
  /* Words before the stars of the first tile, so that vertices of triangles can overwrite stars in order. */
  CADT_STAR_LEAD = 8192,
  /* What a sample says: few have stars, many have many candidates. */
  CADT_SAMPLE_FEW_PROVEN = 1,
  CADT_SAMPLE_MANY = 2
};

/* Counts of cadt_prove_stars (StarCounters of local_stars.hpp). */
enum {
  CADT_STARS_POINTS,
  CADT_STARS_UNPROVEN, /* points without a proven star */
  CADT_STARS_EXACT_ORIENTATIONS,
  CADT_STARS_EXACT_INCIRCLES,
  CADT_STARS_TIES,
  CADT_STARS_AGAIN,         /* points that were tried a second time */
  CADT_STARS_OVERFLOWED,    /* words of stars that their tiles had no room for */
  CADT_STARS_SAMPLED_TILES, /* of the sample: tiles, points, points without a proven star, points with too many
                               candidates at first */
  CADT_STARS_SAMPLED_POINTS,
  CADT_STARS_SAMPLED_UNPROVEN,
  CADT_STARS_SAMPLED_OVERFULL,
  CADT_STARS_SKIPPED_TILES, /* by the verdict of the sample */
  CADT_STARS_WORDS
};

/* Counts of the kernels of gift wrapping. */
enum {
  CADT_WRAP_OVERFLOWED, /* words of stars behind the rows */
  CADT_WRAP_FAILED,     /* vertices without a star */
  CADT_WRAP_WORK,       /* leaves tested plus exact tests */
  CADT_WRAP_EXACT_ORIENTATIONS,
  CADT_WRAP_EXACT_INCIRCLES,
  CADT_WRAP_TIES,
  CADT_WRAP_DRIVER_WORDS,                        /* those before go to the driver with the triangles */
  CADT_WRAP_OPEN_EDGES = CADT_WRAP_DRIVER_WORDS, /* half-edges between two vertices without stars */
  CADT_WRAP_TODO,                                /* vertices that cadt_wrap_near leaves to cadt_wrap_stars, */
  CADT_WRAP_TODO_OPEN,                           /* of these those whose partial star does not go all the way round, */
  CADT_WRAP_TODO_ON_CIRCLE,                      /* of these those that are cocircular with far points */
  CADT_WRAP_WORDS
};

/* Gift wrapping (wrap_exact.dev.h). */
typedef struct {
  cadt_point low, high;
} cadt_aabb;

typedef struct {
  cadt_u32 from, to, left; /* counterclockwise */
} cadt_wrap_edge;

enum {
  CADT_AABB_LEAF = 32,   /* points of a leaf node */
  CADT_AABB_FANOUT = 32, /* leaf nodes of an inner node */
  CADT_WRAP_PART = 4,    /* points that a lane adds to a leaf node at a time */
  CADT_WRAP_PARTS = CADT_AABB_LEAF / CADT_WRAP_PART,
  CADT_WRAP_NEAR = 3,         /* leaf nodes that are searched for a first neighbour */
  CADT_WRAP_NODES = 64,       /* inner nodes that are compared with a disc at a time, */
  CADT_WRAP_OPENED = 4,       /* of these opened */
  CADT_WRAP_WIDE = 8,         /* with more leaf nodes, the floating-point filter chooses before exact tests */
  CADT_WRAP_DEGREE = 40,      /* neighbours of a star at most, the ghost included; more make a high-degree vertex */
  CADT_WRAP_DOUBTFUL = 3,     /* points found first that are tested for being neighbours */
  CADT_MOST_HIGH_DEGREE = 64, /* vertices without a star at most, */
  CADT_WRAP_EDGES = 256,      /* half-edges between two of them */
  CADT_WRAP_LANES = 128,      /* lanes of a team that search */
  CADT_WRAP_HULL = 3000,      /* points that are wrapped even if nearly all are on the hull, */
  CADT_WRAP_HULL_EXACT = 400, /* and if all are on a circle, which takes exact tests */
  CADT_WRAP_MANY = 32768,     /* points that are wrapped even if some of the hull take exact tests */
  CADT_WRAP_SHARES = 8,       /* work-items that write the triangles of a vertex */
  CADT_WRAP_ROW = 24,         /* half-words of the known neighbours of a vertex, for fewer than so many */
  CADT_NEAR_PLACE = 127,      /* bits of a place among */
  CADT_NEAR_POINTS = 96,      /* the points known to be near a vertex (wrap_fast.dev.h), */
  CADT_NEAR_FEW = 8,          /* how many there should be, */
  CADT_NEAR_LEAVES = 128      /* and from how many leaf nodes at most */
};

/* Points of a wrapped mesh at most: 65,536. */
#define CADT_WRAP_MOST (CADT_WRAP_NODES * CADT_AABB_FANOUT * CADT_AABB_LEAF)

/* Two counts in a word: real triangles in the upper 17 bits, which CADT_WRAP_MOST points cannot exceed, and ghost
 * triangles in the lower 15. With more hull edges they do not add up to 2n - 2: the mesh is not wrapped. */
#define CADT_WRAP_ONE_REAL (1u << 15)
#define CADT_WRAP_REAL(sum) ((sum) / CADT_WRAP_ONE_REAL)
#define CADT_WRAP_GHOSTS(sum) ((sum) % CADT_WRAP_ONE_REAL)

/* One set of a batch (batch.dev.h). Its points are multiplied by both factors, powers of two, then halved and counted
 * in cells. */
typedef struct {
  cadt_real factor, factor_again;
  cadt_real half_min_x, half_min_y, scale; /* its square of the key grid, as in cadt_key_grid */
  cadt_real most_x, most_y;                /* the largest coordinates of its points, in cells */
} cadt_set;

/* The state of a set, in the lowest bits of a word; above them the number of its vertices without a proven star. */
enum {
  CADT_SET_BATCHED,     /* it is triangulated together with others */
  CADT_SET_FLAT,        /* there are no triangles */
  CADT_SET_INDIVIDUAL,  /* by itself */
  CADT_SET_WIDE,        /* by itself, in wide arithmetic */
  CADT_SET_FAILURE = 4, /* one vertex: a bit above the states */
  CADT_SET_LANES = 32   /* lanes of a team for a set */
};

/* What cadt_bounds finds. */
typedef struct {
  cadt_real min_x, max_x, min_y, max_y;
  cadt_u32 low, high; /* lowest exponent, highest exponent, + 4096 */
  cadt_u32 bad;       /* first point with a coordinate that is not finite */
  cadt_u32 rows;      /* number of rows of partial results */
} cadt_bounds_row;

enum {
  CADT_BOUNDS_LANES = 128 /* lanes of a team that merge */
};

/* Counters of work and conflicts (counters.dev.h). Where points are inserted, those before CADT_COUNTERS_COMMON are
 * hardly ever 0. */
enum {
  CADT_COUNT_WALK_STEPS,
  CADT_COUNT_LOCK_ATTEMPTS,
  CADT_COUNT_SPLITS,
  CADT_COUNT_FLIPS,
  CADT_COUNT_INCIRCLE_TESTS,
  CADT_COUNT_ORIENTATION_TESTS,
  CADT_COUNTERS_COMMON,
  CADT_COUNT_LOCK_FAILURES = CADT_COUNTERS_COMMON,
  CADT_COUNT_INVALIDATED,
  CADT_COUNT_INSERT_RETRIES,
  CADT_COUNT_STALE_EDGES,
  CADT_COUNT_DEFERRED_POINTS,
  CADT_COUNT_DEFERRED_EDGES,
  CADT_COUNT_EDGE_SPLITS,
  CADT_COUNT_STABILIZED,
  CADT_COUNT_EXACT_ORIENTATIONS, /* cadt_flush_exact takes these three together */
  CADT_COUNT_EXACT_INCIRCLES,
  CADT_COUNT_TIES,
  CADT_COUNTERS
};

/* Timers: what a work-item spends its time on (counters.dev.h). */
enum {
  CADT_TIME_LOCATE,
  CADT_TIME_LOCK, /* locks and unlocks */
  CADT_TIME_SPLIT,
  CADT_TIME_TEST, /* reading both triangles of an edge, incircle */
  CADT_TIME_FLIP,
  CADT_TIME_NEIGHBORS, /* neighbours' half-edges back */
  CADT_TIME_OTHER,     /* worklist, choice of the point */
  CADT_TIME_WAIT,      /* for other lanes of the warp */
  CADT_TIMERS,
  /* A row has 32 bits for each timer. On a GPU a timer is full after 1e15 ticks, seconds of all its lanes; a lane and a
   * group drop up to 2^4 and 2^12 of them. */
  CADT_TIME_LANE_SHIFT = 4,
  CADT_TIME_GROUP_SHIFT = 8,
  CADT_TIME_ITEM_SHIFT = 8 /* CPUs: hours of a core */
};

/* A row of counters: counts, then times. The flip histogram has rows of its own (flip_histogram.dev.h). */
enum {
  CADT_ROW_TIMES = 20,
  CADT_ROW_LOST_LOCKS = 31, /* lost_locks.dev.h */
  CADT_FLIP_BINS = 16,
  CADT_COUNTER_STRIDE = 32, /* words a row, so rows do not share cache lines */
  CADT_COUNTER_ROWS = 64,
  CADT_CERTIFY_REAL = 4 /* place of the number of real triangles among the words of cadt_certify */
};

enum {
  CADT_DEFERRED_COUNTS = 3 /* points, edges, work-items that changed the mesh (legalize.dev.h) */
};

/* cadt_locked_mesh.stabilize (stabilized_flips.dev.h) */
enum { CADT_STABILIZE_OFF, CADT_STABILIZE_DEFER, CADT_STABILIZE_PAPER };

#endif
