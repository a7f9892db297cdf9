// mesh_borders.hpp: extracts border loops of a mesh, with their centre, size and orientation.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A closed loop of edges that have only one triangle.
struct BorderLoop {
  std::vector<std::uint32_t> vertices;  ///< in order; the surface is on the left, seen from outside
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();  ///< length-weighted mean of the edges
  /// Unit mean normal of the triangles along the border, towards the side from which the surface was
  /// observed. A camera that faces the missing surface looks along -outward_world. Zero if the normals cancel
  /// each other.
  Eigen::Vector3d outward_world = Eigen::Vector3d::Zero();
  double length_m = 0.0;  ///< perimeter
  double size_m = 0.0;    ///< extent along the loop's longest principal axis
  double area_m2 = 0.0;   ///< norm of the loop's vector area; for a flat loop, the enclosed area
  /// True for the outer border of a connected component, false for a hole in the component. The loop's
  /// winding about outward_world decides.
  bool encloses_surface = false;
};

/// Extracts all border loops, longest first. Loops of equal length are sorted by their lowest vertex index. A
/// loop visits each of its vertices once, so holes that touch at a vertex are two loops. Each border edge is
/// in exactly one loop. Two triangles may use an edge in the same direction, if the surface is not
/// orientable. If no triangle uses the opposite direction, the edge is a border edge of the first triangle
/// only.
std::vector<BorderLoop> border_loops(const Mesh& mesh);

}  // namespace roomradar
