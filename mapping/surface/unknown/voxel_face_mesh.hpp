// voxel_face_mesh.hpp: meshes faces of grid cells with few triangles.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A box of cubic cells on a lattice in the world.
struct CellGrid {
  /// Lowest cell; its lower corner is at first_cell * cell_m.
  Eigen::Vector3i first_cell = Eigen::Vector3i::Zero();
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  double cell_m = 0.0;
};

/// Faces of cells towards the neighbour at `step` (-1 or 1) along an axis. Takes 8 bytes per face.
class VoxelFaces {
 public:
  VoxelFaces(int axis, int step) : axis_(axis), step_(step) {}
  /// Adds the face of a cell, relative to the grid's lowest cell. Each at most once.
  void add(const Eigen::Vector3i& cell);

 private:
  friend class VoxelFaceMesher;
  int axis_, step_;
  std::vector<std::uint64_t> codes_;  // plane along the axis, row, place in the row
};

/// Meshes faces by greedy meshing. Merges the faces of a plane into rectangles, extended first in length,
/// then in width. Triangles face in the direction of the faces' step. The mesh has no normals and no
/// colours. T-junctions between rectangles leave no gaps. The corner of one rectangle is exactly on the side
/// of the other, since both share two coordinates.
class VoxelFaceMesher {
 public:
  explicit VoxelFaceMesher(const CellGrid& grid);
  void add(VoxelFaces faces);
  /// Returns the mesh of all faces added.
  Mesh take() { return std::move(mesh_); }

 private:
  CellGrid grid_;
  Mesh mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_at_;  ///< index by position in cells

  void add_rectangle(const VoxelFaces& faces, int plane, int from_u, int to_u, int from_v, int to_v);
  std::uint32_t vertex(const Eigen::Vector3i& cell);
};

}  // namespace roomradar
