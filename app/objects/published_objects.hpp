// published_objects.hpp: virtual objects with the triangle counts of the published radar benchmarks.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns a closed box of 12 triangles, centred at the origin.
Mesh box_mesh(const Eigen::Vector3f& size_m);
/// Returns a closed torus, centred at the origin, 25 cm in diameter, of 2 * around * across triangles.
Mesh bumpy_torus(int around, int across);

/// Returns objects of 12, 6,256 and 181,412 triangles: a box of the torus's size, a coarse and a fine torus.
/// The published benchmarks give 6 polygons for the box, since they count rectangles.
std::vector<Mesh> published_objects();

}  // namespace roomradar
