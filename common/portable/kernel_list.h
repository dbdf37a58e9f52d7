/* SPDX-License-Identifier: Apache-2.0
 *
 * Names of all kernels, stage by stage, for the tables of the back ends. A kernel is defined in the file named beside
 * it.
 */
#ifndef CADT_PORTABLE_KERNEL_LIST_H
#define CADT_PORTABLE_KERNEL_LIST_H

/* common/self_test: what is tried before any work */
#define CADT_SELF_TEST_KERNELS(X)                            \
  X(cadt_selftest)       /* arithmetic.dev.h: and atomics */ \
  X(cadt_selftest_locks) /* locks.dev.h: the lock protocol */

/* common/predicates: the predicates by themselves, for tests */
#define CADT_PREDICATES_KERNELS(X) X(cadt_predicate_probe) /* predicate_probe.dev.h */

/* common/portable: sort and scan where the device has none of its own */
#define CADT_PORTABLE_KERNELS(X)               \
  X(cadt_radix_count)   /* radix_sort.dev.h */ \
  X(cadt_radix_scatter) /* radix_sort.dev.h */ \
  X(cadt_scan_sums)     /* scan.dev.h */       \
  X(cadt_scan_total)    /* scan.dev.h */       \
  X(cadt_scan_apply)    /* scan.dev.h */

/* common/points: import, bounds, keys, sorted distinct points */
#define CADT_POINTS_KERNELS(X)                                                               \
  X(cadt_import_doubles)    /* import.dev.h: the caller's points */                          \
  X(cadt_import_floats)     /* import.dev.h */                                               \
  X(cadt_bounds)            /* bounds.dev.h: box, exponents, first bad coordinate */         \
  X(cadt_merge_bounds)      /* bounds.dev.h */                                               \
  X(cadt_hilbert_keys)      /* hilbert_keys.dev.h */                                         \
  X(cadt_fine_hilbert_keys) /* hilbert_keys.dev.h: of two words */                           \
  X(cadt_flag_overfull)     /* key_refinement.dev.h: runs of equal keys that are too long */ \
  X(cadt_pack_overfull)     /* key_refinement.dev.h */                                       \
  X(cadt_refined_keys)      /* key_refinement.dev.h */                                       \
  X(cadt_copy_words)        /* key_refinement.dev.h */                                       \
  X(cadt_identity)          /* key_refinement.dev.h */                                       \
  X(cadt_gather_words)      /* key_refinement.dev.h */                                       \
  X(cadt_run_tails)         /* key_refinement.dev.h */                                       \
  X(cadt_store_refined)     /* key_refinement.dev.h */                                       \
  X(cadt_sort_runs)         /* spatial_sort.dev.h: short runs, in place */                   \
  X(cadt_gather_points)     /* import.dev.h */                                               \
  X(cadt_unique_flags)      /* duplicates.dev.h */                                           \
  X(cadt_unique_pack)       /* duplicates.dev.h: distinct points */                          \
  X(cadt_duplicate_pairs)   /* duplicates.dev.h */

/* common/insertion */
#define CADT_INSERTION_KERNELS(X)                                                    \
  X(cadt_find_seed_triangle)   /* seed_triangle.dev.h: three points not on a line */ \
  X(cadt_seed_mesh)            /* seed_triangle.dev.h */                             \
  X(cadt_pick_base)            /* base_mesh.dev.h: points that are wrapped first */  \
  X(cadt_lock_base)            /* base_mesh.dev.h: their mesh gets locks */          \
  X(cadt_first_representative) /* insert.dev.h */                                    \
  X(cadt_by_level)             /* insert.dev.h: order of insertion on GPUs */        \
  X(cadt_insert)               /* insert.dev.h: locate, split, legalise */           \
  X(cadt_legalize_edges)       /* legalize.dev.h: deferred edges */                  \
  X(cadt_insert_partitions)    /* partitioned.dev.h: without locks */                \
  X(cadt_border_sweep)         /* partitioned.dev.h: edges between partitions */     \
  X(cadt_legality_sweep)       /* legality_sweep.dev.h: test and repair all edges */ \
  X(cadt_flag_triangles)       /* drop_locks.dev.h */                                \
  X(cadt_drop_locks)           /* drop_locks.dev.h: the mesh in arrays */

/* common/stars: proven local stars, gift wrapping, assembly, stitching */
#define CADT_STARS_KERNELS(X)                                                                    \
  X(cadt_tile_flags)          /* tiles.dev.h */                                                  \
  X(cadt_tile_pack)           /* tiles.dev.h */                                                  \
  X(cadt_tile_overfull)       /* tiles.dev.h */                                                  \
  X(cadt_prove_stars)         /* tile_stars.dev.h: proven stars of vertices */                   \
  X(cadt_pack_proven)         /* assemble.dev.h */                                               \
  X(cadt_star_counts)         /* assemble.dev.h: who owns which triangle */                      \
  X(cadt_star_half_edges)     /* assemble.dev.h */                                               \
  X(cadt_star_vertices)       /* assemble.dev.h */                                               \
  X(cadt_pack_residual)       /* stitch.dev.h: vertices without a proven star */                 \
  X(cadt_stitch_enter)        /* stitch.dev.h: hash table of the edges between the two meshes */ \
  X(cadt_stitch_cover)        /* stitch.dev.h */                                                 \
  X(cadt_stitch_components)   /* stitch.dev.h */                                                 \
  X(cadt_stitch_hide)         /* stitch.dev.h */                                                 \
  X(cadt_stitch_flags)        /* stitch.dev.h */                                                 \
  X(cadt_stitch_residual)     /* stitch.dev.h: triangles of the residual mesh */                 \
  X(cadt_build_aabb_tree)     /* aabb_tree.dev.h: gift wrapping: two-level AABB tree */          \
  X(cadt_wrap_near)           /* wrap_fast.dev.h */                                              \
  X(cadt_wrap_stars)          /* wrap_exact.dev.h */                                             \
  X(cadt_wrap_counts)         /* assemble_wrapped.dev.h: who owns which triangle */              \
  X(cadt_batch_counts)        /* assemble_wrapped.dev.h */                                       \
  X(cadt_wrap_arrays)         /* assemble_wrapped.dev.h */                                       \
  X(cadt_batch_locked)        /* assemble_wrapped.dev.h: as locked triangles */                  \
  X(cadt_list_high_degree)    /* high_degree.dev.h */                                            \
  X(cadt_apex_of_high_degree) /* high_degree.dev.h */

/* common/batch: many sets in one call */
#define CADT_BATCH_KERNELS(X)                                                \
  X(cadt_batch_bounds)   /* batch.dev.h */                                   \
  X(cadt_batch_keys)     /* batch.dev.h */                                   \
  X(cadt_batch_gather)   /* batch.dev.h */                                   \
  X(cadt_batch_starts)   /* batch.dev.h: where sets begin */                 \
  X(cadt_batch_classify) /* batch.dev.h: flat sets, large sets */            \
  X(cadt_batch_unproven) /* batch.dev.h: vertices to wrap */                 \
  X(cadt_batch_list)     /* batch.dev.h */                                   \
  X(cadt_batch_insert)   /* batch_insertion.dev.h: without locks, on CPUs */ \
  X(cadt_batch_check)    /* batch.dev.h */                                   \
  X(cadt_batch_extract)  /* batch.dev.h: a set by itself */                  \
  X(cadt_batch_store)    /* batch.dev.h */                                   \
  X(cadt_batch_shift)    /* batch.dev.h: numbers within the set */

/* common/certify */
#define CADT_CERTIFY_KERNELS(X) X(cadt_certify) /* certify.dev.h: examine all edges, repair nothing */

/* common/output: numbers, arrays of the result, hull */
#define CADT_OUTPUT_KERNELS(X)                                                       \
  X(cadt_count_triangles)  /* canonical_order.dev.h: buckets by smallest input id */ \
  X(cadt_sizes_by_input)   /* canonical_order.dev.h */                               \
  X(cadt_split_buckets)    /* canonical_order.dev.h: parts of the compact plan */    \
  X(cadt_bucket_triangles) /* canonical_order.dev.h */                               \
  X(cadt_number_buckets)   /* canonical_order.dev.h */                               \
  X(cadt_long_flags)       /* canonical_order.dev.h: long buckets as one list */     \
  X(cadt_long_pack)        /* canonical_order.dev.h */                               \
  X(cadt_long_numbers)     /* canonical_order.dev.h */                               \
  X(cadt_write_triangles)  /* renumber.dev.h */                                      \
  X(cadt_write_numbered)   /* renumber.dev.h: in canonical order on GPUs */          \
  X(cadt_move_words)       /* renumber.dev.h: in place, where memory is short */     \
  X(cadt_put_words)        /* renumber.dev.h */                                      \
  X(cadt_boundary_edges)   /* hull.dev.h: the hull */

/* common/verify/device */
#define CADT_VERIFY_KERNELS(X)                                                         \
  X(cadt_verify_structure)  /* verify.dev.h: ranges, neighbours, used points */        \
  X(cadt_verify_points)     /* verify.dev.h */                                         \
  X(cadt_verify_duplicates) /* verify.dev.h */                                         \
  X(cadt_verify_boundary)   /* verify.dev.h */                                         \
  X(cadt_verify_filter)     /* verify.dev.h: orientation and edges, in three stages */ \
  X(cadt_verify_exact)      /* verify.dev.h */                                         \
  X(cadt_verify_gather)     /* verify.dev.h */

/* common/queries */
#define CADT_QUERIES_KERNELS(X)                                                              \
  X(cadt_check_mesh)          /* locate_queries.dev.h: the caller's arrays */                \
  X(cadt_lowest_triangles)    /* locate_queries.dev.h: of each vertex */                     \
  X(cadt_curve_flags)         /* locate_queries.dev.h: vertices along Hilbert's curve */     \
  X(cadt_curve_pack)          /* locate_queries.dev.h */                                     \
  X(cadt_locate_queries)      /* locate_queries.dev.h */                                     \
  X(cadt_nearest_vertices)    /* nearest.dev.h */                                            \
  X(cadt_barycentric_of)      /* interpolate.dev.h */                                        \
  X(cadt_interpolate_linear)  /* interpolate.dev.h */                                        \
  X(cadt_interpolate_nearest) /* interpolate.dev.h */                                        \
  X(cadt_interpolate_natural) /* natural_neighbor.dev.h */                                   \
  X(cadt_clear_raster)        /* rasterize.dev.h */                                          \
  X(cadt_draw_small)          /* rasterize.dev.h: triangles of a few cells */                \
  X(cadt_large_rows)          /* rasterize.dev.h */                                          \
  X(cadt_draw_large)          /* rasterize.dev.h: row by row */                              \
  X(cadt_cell_centers)        /* rasterize.dev.h: as queries */                              \
  X(cadt_drop_long_edges)     /* rasterize.dev.h */                                          \
  X(cadt_circumcenters)       /* voronoi.dev.h */                                            \
  X(cadt_cell_sizes)          /* voronoi.dev.h: triangles around each vertex */              \
  X(cadt_cell_triangles)      /* voronoi.dev.h */                                            \
  X(cadt_edge_counts)         /* voronoi.dev.h: edges with both triangles */                 \
  X(cadt_list_edges)          /* voronoi.dev.h */                                            \
  X(cadt_clip_cells)          /* voronoi.dev.h: cells within a box */                        \
  X(cadt_pack_cells)          /* voronoi.dev.h */                                            \
  X(cadt_radius_keys)         /* voronoi.dev.h: largest circumcircles */                     \
  X(cadt_circles_of)          /* voronoi.dev.h */                                            \
  X(cadt_flag_compact)        /* voronoi.dev.h: triangles with short edges, small circles */ \
  X(cadt_pack_kept)           /* voronoi.dev.h */                                            \
  X(cadt_outline_counts)      /* voronoi.dev.h: their boundary */                            \
  X(cadt_outline_edges)       /* voronoi.dev.h */

/* common/finalization: the final part of a tile's mesh */
#define CADT_FINALIZATION_KERNELS(X)                                                \
  X(cadt_mark_open)      /* certain.dev.h: vertices that may still change */        \
  X(cadt_flag_final)     /* finish.dev.h: triangles that may not */                 \
  X(cadt_list_rows)      /* finish.dev.h: their edges to what is not in the part */ \
  X(cadt_pack_final)     /* finish.dev.h */                                         \
  X(cadt_pack_rows)      /* finish.dev.h */                                         \
  X(cadt_hash_triangles) /* finish.dev.h */                                         \
  X(cadt_merge_hashes)   /* finish.dev.h */                                         \
  X(cadt_number_ids)     /* finish.dev.h: ids of 64 bits */                         \
  X(cadt_check_ids)      /* finish.dev.h */                                         \
  X(cadt_gather_ids)     /* finish.dev.h */                                         \
  X(cadt_id_words)       /* finish.dev.h: keys for the sort */                      \
  X(cadt_half_edges_of)  /* join.dev.h */                                           \
  X(cadt_match_sides)    /* join.dev.h: what lies across the sides of children */   \
  X(cadt_uniform_cells)  /* uniform_cells.dev.h: points by counter */

/* common/constraints: segments become edges */
#define CADT_CONSTRAINTS_KERNELS(X)                                                                \
  X(cadt_vertex_triangles)       /* find_segments.dev.h: a triangle of each vertex */              \
  X(cadt_vertices_of_points)     /* find_segments.dev.h */                                         \
  X(cadt_vertices_of_duplicates) /* find_segments.dev.h */                                         \
  X(cadt_vertices_of_segments)   /* find_segments.dev.h: ends of segments as vertices */           \
  X(cadt_flag_segments)          /* find_segments.dev.h: segments that are edges */                \
  X(cadt_find_segments)          /* find_segments.dev.h: which pieces are no edges */              \
  X(cadt_shuffle_pairs)          /* find_segments.dev.h: pieces that wait, in a random order */    \
  X(cadt_trace_segments)         /* find_segments.dev.h: their chains, when all are edges */       \
  X(cadt_divide_pieces)          /* segment_strides.dev.h: long pieces */                          \
  X(cadt_probe_pieces)           /* segment_strides.dev.h: where their strides start */            \
  X(cadt_walk_strides)           /* segment_strides.dev.h */                                       \
  X(cadt_sum_strides)            /* segment_strides.dev.h */                                       \
  X(cadt_places_of_pieces)       /* segment_rings.dev.h */                                         \
  X(cadt_claim_cavities)         /* segment_rings.dev.h: rings, and who holds triangles */         \
  X(cadt_claim_strides)          /* segment_rings.dev.h: the same for long pieces */               \
  X(cadt_decide_cavities)        /* segment_rings.dev.h: which claims hold */                      \
  X(cadt_settle_cavities)        /* segment_rings.dev.h */                                         \
  X(cadt_keep_pieces)            /* segment_rings.dev.h: those that wait */                        \
  X(cadt_fill_cavities)          /* segment_cavity.dev.h: polygons on both sides */                \
  X(cadt_divide_chains)          /* segment_cavity.dev.h: long ones by teams */                    \
  X(cadt_fill_chains)            /* segment_cavity.dev.h */                                        \
  X(cadt_link_cavities)          /* segment_cavity.dev.h */                                        \
  X(cadt_release_cavities)       /* segment_cavity.dev.h */                                        \
  X(cadt_insert_few_pieces)      /* few_pieces.dev.h: all of these steps, for few short pieces */  \
  X(cadt_domain_unite)           /* domains.dev.h: triangles that no constrained edge separates */ \
  X(cadt_domain_roots)           /* domains.dev.h */                                               \
  X(cadt_domain_regions)         /* domains.dev.h */                                               \
  X(cadt_domain_ends)            /* domains.dev.h: how often segments begin and end at vertices */ \
  X(cadt_domain_open)            /* domains.dev.h: where they do not close */                      \
  X(cadt_domain_links)           /* domains.dev.h: which regions meet at constrained edges */      \
  X(cadt_domain_flags)           /* domains.dev.h: triangles inside */                             \
  X(cadt_domain_pack)            /* domains.dev.h */

/* common/constraints: many small polygons */
#define CADT_POLYGONS_KERNELS(X)                    \
  X(cadt_triangulate_polygons) /* polygons.dev.h */ \
  X(cadt_pack_polygons)        /* polygons.dev.h */

/* common/constraints: segments that cross */
#define CADT_CROSSINGS_KERNELS(X)                                                               \
  X(cadt_divide_segments) /* segment_pairs.dev.h: pieces, and the triangles they run through */ \
  X(cadt_count_pairs)     /* segment_pairs.dev.h: pairs of pieces in the same triangle */       \
  X(cadt_find_pairs)      /* segment_pairs.dev.h: those that cross */                           \
  X(cadt_list_partners)   /* segment_pairs.dev.h: what each segment crosses */                  \
  X(cadt_sort_partners)   /* segment_pairs.dev.h */                                             \
  X(cadt_order_pairs)     /* segment_pairs.dev.h */                                             \
  X(cadt_place_crossings) /* exact_places.dev.h: rounded coordinates */                         \
  X(cadt_count_chains)    /* exact_places.dev.h */                                              \
  X(cadt_write_chains)    /* exact_places.dev.h: vertices along segments */                     \
  X(cadt_certify_places)  /* exact_places.dev.h: what is not certainly right */

#define CADT_KERNEL_LIST(X)    \
  CADT_SELF_TEST_KERNELS(X)    \
  CADT_PREDICATES_KERNELS(X)   \
  CADT_PORTABLE_KERNELS(X)     \
  CADT_POINTS_KERNELS(X)       \
  CADT_INSERTION_KERNELS(X)    \
  CADT_STARS_KERNELS(X)        \
  CADT_BATCH_KERNELS(X)        \
  CADT_CERTIFY_KERNELS(X)      \
  CADT_OUTPUT_KERNELS(X)       \
  CADT_VERIFY_KERNELS(X)       \
  CADT_QUERIES_KERNELS(X)      \
  CADT_FINALIZATION_KERNELS(X) \
  CADT_CONSTRAINTS_KERNELS(X)  \
  CADT_CROSSINGS_KERNELS(X)    \
  CADT_POLYGONS_KERNELS(X)

/* The same by stage: a back end may compile a program for each (CADT_PROGRAM of language.dev.h). */
#define CADT_STAGE_LIST(S)                   \
  S(self_test, CADT_SELF_TEST_KERNELS)       \
  S(predicates, CADT_PREDICATES_KERNELS)     \
  S(portable, CADT_PORTABLE_KERNELS)         \
  S(points, CADT_POINTS_KERNELS)             \
  S(insertion, CADT_INSERTION_KERNELS)       \
  S(stars, CADT_STARS_KERNELS)               \
  S(batch, CADT_BATCH_KERNELS)               \
  S(certify, CADT_CERTIFY_KERNELS)           \
  S(output, CADT_OUTPUT_KERNELS)             \
  S(verify, CADT_VERIFY_KERNELS)             \
  S(queries, CADT_QUERIES_KERNELS)           \
  S(finalization, CADT_FINALIZATION_KERNELS) \
  S(constraints, CADT_CONSTRAINTS_KERNELS)   \
  S(crossings, CADT_CROSSINGS_KERNELS)       \
  S(polygons, CADT_POLYGONS_KERNELS)

#endif
