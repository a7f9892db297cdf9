// published_objects.hpp: virtual objects with the triangle counts of the published radar benchmarks.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A closed, centred box of 12 triangles.
Mesh box_mesh(const Eigen::Vector3f& size_m);
/// A closed, centred torus, 25 cm across, of 2 * around * across triangles.
Mesh bumpy_torus(int around, int across);

/// Objects of 12, 6,256 and 181,412 triangles: a box as large as the torus, then the torus coarse and fine.
/// The published count of 6 for a box counts rectangles.
std::vector<Mesh> published_objects();

}  // namespace roomradar
