/* SPDX-License-Identifier: Apache-2.0
 *
 * Names of all kernels, for the tables of the back ends. A kernel is defined in the file named beside it.
 */
#ifndef CADT_PORTABLE_KERNEL_LIST_H
#define CADT_PORTABLE_KERNEL_LIST_H

#define CADT_KERNEL_LIST(X)                                                                     \
  X(cadt_selftest)             /* self_test.dev.h: arithmetic and atomics */                    \
  X(cadt_predicate_probe)      /* predicate_probe.dev.h: the predicates by themselves */        \
  X(cadt_import_doubles)       /* import.dev.h: points from the caller's memory */              \
  X(cadt_import_floats)        /* import.dev.h */                                               \
  X(cadt_bounds)               /* bounds.dev.h: box, exponents, first bad coordinate */         \
  X(cadt_merge_bounds)         /* bounds.dev.h */                                               \
  X(cadt_hilbert_keys)         /* hilbert_keys.dev.h: Hilbert keys */                           \
  X(cadt_fine_hilbert_keys)    /* hilbert_keys.dev.h: with two words */                         \
  X(cadt_radix_count)          /* radix_sort.dev.h */                                           \
  X(cadt_radix_scatter)        /* radix_sort.dev.h */                                           \
  X(cadt_scan_sums)            /* scan.dev.h */                                                 \
  X(cadt_scan_total)           /* scan.dev.h */                                                 \
  X(cadt_scan_apply)           /* scan.dev.h */                                                 \
  X(cadt_flag_overfull)        /* key_refinement.dev.h: runs of equal keys that are too long */ \
  X(cadt_pack_overfull)        /* key_refinement.dev.h */                                       \
  X(cadt_refined_keys)         /* key_refinement.dev.h */                                       \
  X(cadt_copy_words)           /* key_refinement.dev.h */                                       \
  X(cadt_identity)             /* key_refinement.dev.h */                                       \
  X(cadt_gather_words)         /* key_refinement.dev.h */                                       \
  X(cadt_run_tails)            /* key_refinement.dev.h */                                       \
  X(cadt_store_refined)        /* key_refinement.dev.h */                                       \
  X(cadt_sort_runs)            /* spatial_sort.dev.h: short runs, in place */                   \
  X(cadt_gather_points)        /* import.dev.h */                                               \
  X(cadt_unique_flags)         /* duplicates.dev.h */                                           \
  X(cadt_unique_pack)          /* duplicates.dev.h: distinct points */                          \
  X(cadt_duplicate_pairs)      /* duplicates.dev.h */                                           \
  X(cadt_find_seed_triangle)   /* seed_triangle.dev.h: three points not on a line */            \
  X(cadt_seed_mesh)            /* seed_triangle.dev.h */                                        \
  X(cadt_first_representative) /* insert.dev.h */                                               \
  X(cadt_by_level)             /* insert.dev.h */                                               \
  X(cadt_insert)               /* insert.dev.h: locate, claim, split, legalise */               \
  X(cadt_legalize_edges)       /* insert.dev.h: deferred edges */                               \
  X(cadt_insert_partitions)    /* partitioned.dev.h: without locks */                           \
  X(cadt_border_sweep)         /* partitioned.dev.h */                                          \
  X(cadt_cavity_candidates)    /* cavity.dev.h: a vertex and all its triangles */               \
  X(cadt_cavity_sizes)         /* cavity.dev.h */                                               \
  X(cadt_cavity_conflicts)     /* cavity.dev.h */                                               \
  X(cadt_cavity_star)          /* cavity.dev.h */                                               \
  X(cadt_cavity_roots)         /* cavity.dev.h */                                               \
  X(cadt_cavity_join)          /* cavity.dev.h */                                               \
  X(cadt_cavity_check)         /* cavity.dev.h */                                               \
  X(cadt_cavity_keep)          /* cavity.dev.h */                                               \
  X(cadt_cavity_boundary)      /* cavity.dev.h */                                               \
  X(cadt_cavity_fill)          /* cavity.dev.h */                                               \
  X(cadt_cavity_release)       /* cavity.dev.h */                                               \
  X(cadt_legality_sweep)       /* legality_sweep.dev.h */                                       \
  X(cadt_tile_flags)           /* tiles.dev.h */                                                \
  X(cadt_tile_pack)            /* tiles.dev.h */                                                \
  X(cadt_tile_overfull)        /* tiles.dev.h */                                                \
  X(cadt_prove_stars)          /* tile_stars.dev.h: proven stars of vertices */                 \
  X(cadt_pack_proven)          /* assemble.dev.h */                                             \
  X(cadt_star_counts)          /* assemble.dev.h: who owns which triangle */                    \
  X(cadt_star_half_edges)      /* assemble.dev.h */                                             \
  X(cadt_star_vertices)        /* assemble.dev.h */                                             \
  X(cadt_pack_residual)        /* stitch.dev.h: the other vertices */                           \
  X(cadt_stitch_enter)         /* stitch.dev.h: hash table of the edges between */              \
  X(cadt_stitch_cover)         /* stitch.dev.h */                                               \
  X(cadt_stitch_components)    /* stitch.dev.h */                                               \
  X(cadt_stitch_hide)          /* stitch.dev.h */                                               \
  X(cadt_stitch_flags)         /* stitch.dev.h */                                               \
  X(cadt_stitch_residual)      /* stitch.dev.h: the rest of the mesh */                         \
  X(cadt_certify)              /* certify.dev.h */                                              \
  X(cadt_build_aabb_tree)      /* aabb_tree.dev.h: stars of few points by gift wrapping */      \
  X(cadt_wrap_near)            /* wrap_fast.dev.h */                                            \
  X(cadt_wrap_stars)           /* wrap_exact.dev.h */                                           \
  X(cadt_wrap_counts)          /* assemble_wrapped.dev.h: who owns which triangle */            \
  X(cadt_wrap_arrays)          /* assemble_wrapped.dev.h */                                     \
  X(cadt_list_high_degree)     /* high_degree.dev.h */                                          \
  X(cadt_apex_of_high_degree)  /* high_degree.dev.h */                                          \
  X(cadt_wrap_locked)          /* assemble_wrapped.dev.h: of sets, and with hubs */             \
  X(cadt_batch_bounds)         /* batch.dev.h: many sets in one call */                         \
  X(cadt_batch_keys)           /* batch.dev.h */                                                \
  X(cadt_batch_gather)         /* batch.dev.h */                                                \
  X(cadt_batch_starts)         /* batch.dev.h: where sets begin */                              \
  X(cadt_batch_classify)       /* batch.dev.h: flat sets, large sets */                         \
  X(cadt_batch_unproven)       /* batch.dev.h: vertices to be wrapped */                        \
  X(cadt_batch_list)           /* batch.dev.h */                                                \
  X(cadt_batch_counts)         /* assemble_wrapped.dev.h */                                     \
  X(cadt_batch_insert)         /* batch_insertion.dev.h: sets without locks, on CPUs */         \
  X(cadt_batch_check)          /* batch.dev.h */                                                \
  X(cadt_batch_extract)        /* batch.dev.h: a set by itself */                               \
  X(cadt_batch_store)          /* batch.dev.h */                                                \
  X(cadt_batch_shift)          /* batch.dev.h: numbers in the set */                            \
  X(cadt_count_triangles)      /* renumber.dev.h */                                             \
  X(cadt_cut_buckets)          /* renumber.dev.h */                                             \
  X(cadt_bucket_triangles)     /* renumber.dev.h: canonical order */                            \
  X(cadt_sort_buckets)         /* renumber.dev.h */                                             \
  X(cadt_long_flags)           /* renumber.dev.h */                                             \
  X(cadt_long_pack)            /* renumber.dev.h */                                             \
  X(cadt_long_store)           /* renumber.dev.h */                                             \
  X(cadt_number_triangles)     /* renumber.dev.h */                                             \
  X(cadt_write_triangles)      /* renumber.dev.h */                                             \
  X(cadt_flag_triangles)       /* renumber.dev.h: order of the records */                       \
  X(cadt_write_ranked)         /* renumber.dev.h */                                             \
  X(cadt_write_arrays)         /* renumber.dev.h */                                             \
  X(cadt_move_words)           /* renumber.dev.h: in place, where memory is short */            \
  X(cadt_put_words)            /* renumber.dev.h */                                             \
  X(cadt_boundary_edges)       /* renumber.dev.h */                                             \
  X(cadt_verify_structure)     /* verify.dev.h: ranges, neighbours, used points */              \
  X(cadt_verify_points)        /* verify.dev.h */                                               \
  X(cadt_verify_duplicates)    /* verify.dev.h */                                               \
  X(cadt_verify_boundary)      /* verify.dev.h */                                               \
  X(cadt_verify_filter)        /* verify.dev.h: orientation and edges, three stages */          \
  X(cadt_verify_exact)         /* verify.dev.h */                                               \
  X(cadt_verify_gather)        /* verify.dev.h */

#endif
