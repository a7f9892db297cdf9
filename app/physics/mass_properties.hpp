// mass_properties.hpp: how a body's mass lies in it, from its mesh.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Inertia is of 1 kg: what falls, slides and rolls does so alike, whatever it weighs. What the body weighs
/// matters to other bodies only.
struct MassProperties {
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();  ///< of mass, in the mesh's frame, m
  /// About the centre, along the mesh's axes, m^2. Positive definite.
  Eigen::Matrix3d inertia_m2 = 0.0025 * Eigen::Matrix3d::Identity();
  double radius_m = 0.1;  ///< from the centre to the farthest vertex
  double mass_kg = 1.0;   ///< of water where the mesh is solid, else of a shell of 5 kg/m^2; > 0
};

/// Of the solid inside where that is closed (TriangleTree::is_closed()), else of the surface as a thin shell
/// of even thickness: an open mesh has no inside, and a pot or a sheet is a shell. Of no area either: of the
/// vertices.
///
/// Each principal moment is at least a 10,000th of the largest, that of a rod 100 times as long as thick: a
/// line would turn about itself for nothing.
/// Source: Eberly, Polyhedral mass properties (revisited), 2002.
MassProperties mass_properties(const Mesh& mesh, bool is_closed);

}  // namespace roomradar
