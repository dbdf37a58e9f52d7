/* SPDX-License-Identifier: Apache-2.0
 *
 * All kernels. The host and CUDA compile this file, OpenCL a part of it for each stage (kernels_cl/); kernel_list.h has
 * the names. The variant for floats has no star stage,
 * no gift wrapping, no verifier and no queries: their error bounds are for doubles, and what they decide the other
 * kernels decide as well (docs/decisions/0004-exact-integers-and-floats.md).
 */
#ifndef CADT_PORTABLE_KERNELS_H
#define CADT_PORTABLE_KERNELS_H

#include "common/certify/certify.dev.h"
#include "common/constraints/domains/domains.dev.h"
#include "common/constraints/insert/few_pieces.dev.h"
#include "common/constraints/insert/random_insertion.dev.h"
#include "common/insertion/base_mesh.dev.h"
#include "common/insertion/drop_locks.dev.h"
#include "common/insertion/insert.dev.h"
#include "common/insertion/legality_sweep.dev.h"
#include "common/insertion/legalize.dev.h"
#include "common/insertion/partitioned.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#include "common/output/canonical_order.dev.h"
#include "common/output/hull.dev.h"
#include "common/output/renumber.dev.h"
#include "common/overlay/flip_histogram.dev.h"
#include "common/points/bounds.dev.h"
#include "common/points/duplicates.dev.h"
#include "common/points/hilbert_keys.dev.h"
#include "common/points/import.dev.h"
#include "common/points/key_refinement.dev.h"
#include "common/points/point_profile.dev.h"
#include "common/points/spatial_sort.dev.h"
#include "common/portable/dialect.dev.h"
#include "common/portable/radix_sort.dev.h"
#include "common/portable/scan.dev.h"
#include "common/predicates/predicate_probe.dev.h"
#include "common/self_test/arithmetic.dev.h"
#include "common/self_test/locks.dev.h"
#if !CADT_FLOAT
#include "common/batch/batch.dev.h"
#include "common/batch/batch_insertion.dev.h"
#include "common/constraints/crossings/exact_places.dev.h"
#include "common/constraints/crossings/segment_pairs.dev.h"
#include "common/constraints/polygons/polygons.dev.h"
#include "common/finalization/certain.dev.h"
#include "common/finalization/finish.dev.h"
#include "common/finalization/join.dev.h"
#include "common/finalization/uniform_cells.dev.h"
#include "common/queries/locate_queries.dev.h"
#include "common/queries/nearest.dev.h"
#include "common/queries/rasterize.dev.h"
#include "common/queries/voronoi.dev.h"
#include "common/stars/assemble.dev.h"
#include "common/stars/assemble_wrapped.dev.h"
#include "common/stars/high_degree.dev.h"
#include "common/stars/stitch.dev.h"
#include "common/stars/tile_stars.dev.h"
#include "common/stars/tiles.dev.h"
#include "common/stars/wrap_exact.dev.h"
#include "common/stars/wrap_fast.dev.h"
#include "common/verify/device/verify.dev.h"
#endif

#endif
