// SPDX-License-Identifier: Apache-2.0
// The library's public interface but for meshes by tiles (finalization.hpp, uniform_cells.hpp) and the file formats
// (cadt/io).
#pragma once

#include <cadt/batch.hpp>
#include <cadt/constrained.hpp>
#include <cadt/devices.hpp>
#include <cadt/errors.hpp>
#include <cadt/label_image.hpp>
#include <cadt/options.hpp>
#include <cadt/points.hpp>
#include <cadt/polygons.hpp>
#include <cadt/queries.hpp>
#include <cadt/statistics.hpp>
#include <cadt/topology.hpp>
#include <cadt/triangle.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/triangulator.hpp>
#include <cadt/verify.hpp>
#include <cadt/version.hpp>
