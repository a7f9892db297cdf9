// mesh_borders.hpp: where a surface ends: its border edges as loops, with their place, size and side.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// One closed course of edges that have a triangle on one side only.
struct BorderLoop {
  std::vector<std::uint32_t> vertices;  ///< of the mesh, in order, the surface on the left seen from outside
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();  ///< mean of the border, by length
  /// Unit, mean normal of the triangles along the border: the side from which the surface round it was seen.
  /// Who wants to see what is missing looks along its opposite. Zero if the normals cancel.
  Eigen::Vector3d outward_world = Eigen::Vector3d::Zero();
  double length_m = 0.0;  ///< of the border
  double size_m = 0.0;    ///< of the border's box along its own longest side
  double area_m2 = 0.0;   ///< of the flattest surface that would close it (the loop's vector area)
  /// True for the outer rim of a piece of surface, false for a hole in it: told by which way the loop turns
  /// about outward_world.
  bool encloses_surface = false;
};

/// All border loops of a mesh, longest first, ties by their lowest vertex. A loop passes each of its vertices
/// once: holes that touch at a vertex are two loops. Each border edge is in exactly one. An edge used twice
/// in one direction (no orientable surface has one) counts as no border.
std::vector<BorderLoop> border_loops(const Mesh& mesh);

}  // namespace roomradar
