// published_objects.hpp: virtual objects with the triangle counts of the published radar benchmarks.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns a closed box of 12 triangles, centred at the origin.
Mesh box_mesh(const Eigen::Vector3f& size_m);
/// Returns a closed torus with 2 * around * across triangles, centred at the origin, 25 cm in diameter.
Mesh bumpy_torus(int around, int across);

/// Returns a box of the torus's size (12 triangles), a coarse torus (6,256) and a fine torus (181,412). The
/// published benchmarks list the box with 6 polygons, since they count rectangles.
std::vector<Mesh> published_objects();

}  // namespace roomradar
