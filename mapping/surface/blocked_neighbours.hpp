// barred_steps.hpp: the steps between neighbouring cells of a grid that a surface bars.
#pragma once
#include <array>

#include "mapping/surface/bit_grid.hpp"
#include "mapping/surface/voxel_face_mesh.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// By axis: a cell is set if the straight way from its middle to that of the next cell along the axis meets
/// the surface. Triangles count with their edges; one with a corner that is not finite does not count at all.
std::array<VoxelBits, 3> barred_steps(const Mesh& surface_world, const CellGrid& grid);

}  // namespace roomradar
