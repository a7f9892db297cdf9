// cell_faces.hpp: faces of a grid's cells as a mesh of few triangles.
#pragma once
#include "mapping/surface/bit_grid.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A box of cubes that stand on a lattice in the world.
struct CellGrid {
  Eigen::Vector3i first_cell = Eigen::Vector3i::Zero();  ///< its lowest corner is at first_cell * cell_m
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  double cell_m = 0.0;
};

/// The cells that have a face towards their neighbour `step` (-1 or 1) along the axis.
struct CellFaces {
  VoxelBits cells;
  int axis = 0;
  int step = 1;
};

/// Faces of one plane are joined to rectangles: each as long as it can be, then as broad. Triangles look the
/// way of their faces' step; no normals, no colours. Where rectangles of different length meet, a corner of
/// one lies within a side of the other, exactly: both have the same two coordinates, so nothing passes
/// between.
Mesh mesh_of(const std::vector<CellFaces>& faces, const CellGrid& grid);

}  // namespace roomradar
