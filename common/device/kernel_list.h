/* SPDX-License-Identifier: Apache-2.0
 *
 * Names of all kernels, for the tables of the back ends. A kernel is defined in the file named beside it.
 */
#ifndef CADT_DEVICE_KERNEL_LIST_H
#define CADT_DEVICE_KERNEL_LIST_H

#define CADT_KERNEL_LIST(X)                                                          \
  X(cadt_selftest)          /* selftest.h: arithmetic and atomics */                 \
  X(cadt_signs)             /* signs.h: the predicates by themselves */              \
  X(cadt_import_doubles)    /* order.h: points from the caller's memory */           \
  X(cadt_import_floats)     /* order.h */                                            \
  X(cadt_bounds)            /* order.h: box, exponents, first bad coordinate */      \
  X(cadt_merge_bounds)      /* order.h */                                            \
  X(cadt_sort_keys)         /* order.h: Hilbert keys */                              \
  X(cadt_fine_keys)         /* order.h: with two words */                            \
  X(cadt_radix_count)       /* radix.h */                                            \
  X(cadt_radix_scatter)     /* radix.h */                                            \
  X(cadt_scan_sums)         /* scan.h */                                             \
  X(cadt_scan_total)        /* scan.h */                                             \
  X(cadt_scan_apply)        /* scan.h */                                             \
  X(cadt_crowded_flags)     /* refine.h: runs of equal keys that are too long */     \
  X(cadt_crowded_pack)      /* refine.h */                                           \
  X(cadt_crowded_keys)      /* refine.h */                                           \
  X(cadt_copy_words)        /* refine.h */                                           \
  X(cadt_identity)          /* refine.h */                                           \
  X(cadt_gather_words)      /* refine.h */                                           \
  X(cadt_run_tails)         /* refine.h */                                           \
  X(cadt_crowded_store)     /* refine.h */                                           \
  X(cadt_sort_runs)         /* order.h: short runs, in place */                      \
  X(cadt_gather_points)     /* order.h */                                            \
  X(cadt_unique_flags)      /* order.h */                                            \
  X(cadt_unique_pack)       /* order.h: distinct points */                           \
  X(cadt_duplicate_pairs)   /* order.h */                                            \
  X(cadt_find_triangle)     /* start.h: three points not on a line */                \
  X(cadt_start_mesh)        /* start.h */                                            \
  X(cadt_root)              /* insert.h */                                           \
  X(cadt_by_level)          /* insert.h */                                           \
  X(cadt_insert)            /* insert.h: locate, claim, split, legalise */           \
  X(cadt_legalize_edges)    /* insert.h: deferred edges */                           \
  X(cadt_insert_ranges)     /* range.h: without locks */                             \
  X(cadt_border_pass)       /* range.h */                                            \
  X(cadt_cavity_candidates) /* cavity.h: a vertex and all its triangles */           \
  X(cadt_cavity_sizes)      /* cavity.h */                                           \
  X(cadt_cavity_conflicts)  /* cavity.h */                                           \
  X(cadt_cavity_star)       /* cavity.h */                                           \
  X(cadt_cavity_roots)      /* cavity.h */                                           \
  X(cadt_cavity_join)       /* cavity.h */                                           \
  X(cadt_cavity_check)      /* cavity.h */                                           \
  X(cadt_cavity_keep)       /* cavity.h */                                           \
  X(cadt_cavity_boundary)   /* cavity.h */                                           \
  X(cadt_cavity_fill)       /* cavity.h */                                           \
  X(cadt_cavity_release)    /* cavity.h */                                           \
  X(cadt_closing_pass)      /* closing.h */                                          \
  X(cadt_tile_flags)        /* tiles.h */                                            \
  X(cadt_tile_pack)         /* tiles.h */                                            \
  X(cadt_tile_crowds)       /* tiles.h */                                            \
  X(cadt_stars)             /* star_tiles.h: proven stars of vertices */             \
  X(cadt_star_proven)       /* star_mesh.h */                                        \
  X(cadt_star_counts)       /* star_mesh.h: who owns which triangle */               \
  X(cadt_star_links)        /* star_mesh.h */                                        \
  X(cadt_star_vertices)     /* star_mesh.h */                                        \
  X(cadt_unproven_pack)     /* join.h: the other vertices */                         \
  X(cadt_join_enter)        /* join.h: hash table of the edges between */            \
  X(cadt_join_cover)        /* join.h */                                             \
  X(cadt_join_components)   /* join.h */                                             \
  X(cadt_join_hide)         /* join.h */                                             \
  X(cadt_join_flags)        /* join.h */                                             \
  X(cadt_join_rest)         /* join.h: the rest of the mesh */                       \
  X(cadt_certify)           /* array_mesh.h */                                       \
  X(cadt_wrap_boxes)        /* wrap_boxes.h: stars of few points by gift wrapping */ \
  X(cadt_wrap_near)         /* wrap_near.h */                                        \
  X(cadt_wrap_stars)        /* wrap.h */                                             \
  X(cadt_wrap_counts)       /* wrap_mesh.h: who owns which triangle */               \
  X(cadt_wrap_arrays)       /* wrap_mesh.h */                                        \
  X(cadt_hub_list)          /* wrap_hubs.h */                                        \
  X(cadt_hub_behind)        /* wrap_hubs.h */                                        \
  X(cadt_wrap_records)      /* wrap_mesh.h: of sets, and with hubs */                \
  X(cadt_set_bounds)        /* sets.h: many sets in one call */                      \
  X(cadt_set_keys)          /* sets.h */                                             \
  X(cadt_set_gather)        /* sets.h */                                             \
  X(cadt_set_starts)        /* sets.h: where sets begin */                           \
  X(cadt_set_kinds)         /* sets.h: flat sets, large sets */                      \
  X(cadt_set_unproven)      /* sets.h: vertices to be wrapped */                     \
  X(cadt_set_list)          /* sets.h */                                             \
  X(cadt_set_counts)        /* wrap_mesh.h */                                        \
  X(cadt_set_insert)        /* set_insert.h: sets without locks, on CPUs */          \
  X(cadt_set_check)         /* sets.h */                                             \
  X(cadt_set_points)        /* sets.h: a set by itself */                            \
  X(cadt_set_records)       /* sets.h */                                             \
  X(cadt_set_shift)         /* sets.h: numbers in the set */                         \
  X(cadt_count_triangles)   /* emit.h */                                             \
  X(cadt_cut_buckets)       /* emit.h */                                             \
  X(cadt_bucket_triangles)  /* emit.h: canonical order */                            \
  X(cadt_sort_buckets)      /* emit.h */                                             \
  X(cadt_long_flags)        /* emit.h */                                             \
  X(cadt_long_pack)         /* emit.h */                                             \
  X(cadt_long_store)        /* emit.h */                                             \
  X(cadt_number_triangles)  /* emit.h */                                             \
  X(cadt_emit_triangles)    /* emit.h */                                             \
  X(cadt_flag_triangles)    /* emit.h: order of the records */                       \
  X(cadt_emit_ranked)       /* emit.h */                                             \
  X(cadt_emit_arrays)       /* emit.h */                                             \
  X(cadt_move_words)        /* emit.h: in place, where memory is short */            \
  X(cadt_put_words)         /* emit.h */                                             \
  X(cadt_boundary_edges)    /* emit.h */                                             \
  X(cadt_verify_structure)  /* verify.h: ranges, neighbours, used points */          \
  X(cadt_verify_points)     /* verify.h */                                           \
  X(cadt_verify_duplicates) /* verify.h */                                           \
  X(cadt_verify_boundary)   /* verify.h */                                           \
  X(cadt_verify_filter)     /* verify.h: orientation and edges, three stages */      \
  X(cadt_verify_exact)      /* verify.h */                                           \
  X(cadt_verify_gather)     /* verify.h */

#endif
