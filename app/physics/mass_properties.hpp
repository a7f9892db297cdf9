// mass_properties.hpp: mass, centre of mass and inertia of a body, from its mesh.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Inertia is per kg, since falling, sliding and rolling do not depend on mass. mass_kg matters only in
/// contact with other bodies.
struct MassProperties {
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();  ///< centre of mass in the mesh's frame, m
  /// About the centre of mass, in the mesh's axes, m^2 (per kg). Positive definite.
  Eigen::Matrix3d inertia_m2 = 0.0025 * Eigen::Matrix3d::Identity();
  double radius_m = 0.1;  ///< distance from the centre of mass to the farthest vertex
  double mass_kg = 1.0;   ///< > 0; closed mesh: density of water; open: shell of 5 kg/m^2
};

/// Computes the properties of a solid if the mesh is closed (TriangleTree::is_closed()), else of a thin shell
/// of uniform thickness: an open mesh has no inside, and a pot or a sheet is a shell. A mesh without area is
/// treated as point masses at its vertices.
///
/// Each principal moment is at least 1/10,000 of the largest, as for a rod 100 times as long as thick; a line
/// would otherwise have no inertia about itself. Source: Eberly, Polyhedral mass properties (revisited),
/// 2002.
MassProperties mass_properties(const Mesh& mesh, bool is_closed);

}  // namespace roomradar
