// SPDX-License-Identifier: Apache-2.0
// Shading of scans that have more than one height above a place.
#pragma once

#include "io/picture/scene.hpp"

#include <vector>

namespace cadt::io::picture {

/// A scan of a closed body, projected on the plane, has points of its front and of its back side by side: its heights
/// jump at every edge, and shading them shows noise. If the heights are like that almost everywhere, points below the
/// upper surface get the height of their neighbours on it, so that the picture shows the side that faces the viewer.
/// Terrain, also with trees and buildings on it, is left as it is. Only for the colours; the mesh stays.
void show_upper_sheet(const Scene& scene, std::vector<float>& relative_heights);

}  // namespace cadt::io::picture
