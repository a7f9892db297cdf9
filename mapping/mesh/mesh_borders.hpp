// mesh_borders.hpp: extracts border loops of a mesh, with their centre, size and orientation.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A closed loop of edges that have only one triangle.
struct BorderLoop {
  std::vector<std::uint32_t> vertices;  ///< mesh vertices in order; surface on the left seen from outside
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();  ///< length-weighted mean of the edges
  /// Unit mean normal of the triangles along the border, towards the side the surface was observed from. A
  /// camera that observes the missing surface looks along the opposite direction. Zero if the normals cancel.
  Eigen::Vector3d outward_world = Eigen::Vector3d::Zero();
  double length_m = 0.0;  ///< perimeter
  double size_m = 0.0;    ///< extent along the loop's longest principal axis
  double area_m2 = 0.0;   ///< norm of the loop's vector area, i.e. area of the flattest surface closing it
  /// True for the outer rim of a connected component, false for a hole in it; decided by the loop's winding
  /// about outward_world.
  bool encloses_surface = false;
};

/// Extracts all border loops, longest first, ties by their lowest vertex. A loop visits each of its vertices
/// once: holes that touch at a vertex are two loops. Each border edge is in exactly one loop. An edge used
/// twice in one direction (impossible on an orientable surface) is not a border.
std::vector<BorderLoop> border_loops(const Mesh& mesh);

}  // namespace roomradar
