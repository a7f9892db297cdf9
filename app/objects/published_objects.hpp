// published_objects.hpp: virtual objects with as many triangles as those that the published radar was timed
// with.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Closed, centred, 12 triangles.
Mesh box_mesh(const Eigen::Vector3f& size_m);
/// Closed, centred, 25 cm across: 2 * around * across triangles.
Mesh bumpy_torus(int around, int across);

/// 12 (the published 6 are a box's rectangles), 6,256 and 181,412 triangles: a box as large as the torus, the
/// torus coarse and fine.
std::vector<Mesh> published_objects();

}  // namespace roomradar
