// blocked_neighbours.hpp: finds pairs of neighbouring grid cells that a surface separates.
#pragma once
#include <array>

#include "mapping/surface/unknown/sparse_bit_grid.hpp"
#include "mapping/surface/unknown/voxel_face_mesh.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns one grid per axis. A cell is set if the segment from its centre to the centre of the next cell
/// along that axis intersects the surface. Triangles include their edges. Triangles with a non-finite vertex
/// are ignored.
std::array<SparseBitGrid, 3> blocked_neighbours(const Mesh& surface_world, const CellGrid& grid);

}  // namespace roomradar
