// mass_properties.hpp: mass, centre of mass and inertia of a body, from its mesh.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Mass, centre of mass and inertia. Inertia is per kg of body mass, since falling, sliding and rolling do
/// not depend on mass. mass_kg matters only for contacts between bodies.
struct MassProperties {
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();  ///< centre of mass in the mesh's frame, m
  /// Inertia about the centre of mass, in the mesh's axes, m^2 (per kg of body mass). Positive definite.
  Eigen::Matrix3d inertia_m2 = 0.0025 * Eigen::Matrix3d::Identity();
  double radius_m = 0.1;  ///< distance from the centre of mass to the farthest vertex
  /// Mass, at least 1 g. A closed mesh is a solid of 1,000 kg/m^3. An open mesh is a shell of 5 kg/m^2.
  double mass_kg = 1.0;
  double volume_m3 = 0.0;  ///< of a closed mesh; 0: open
};

/// Computes the properties of a uniform solid if the mesh is closed (TriangleTree::is_closed()). Otherwise
/// computes those of a thin shell of uniform thickness. A mesh with negligible area is treated as point
/// masses at its vertices. A mesh without usable triangles yields the default values.
///
/// Each principal moment is raised to at least 1/10,000 of the largest, so that a thin rod has inertia about
/// its own axis. Source: Eberly, Polyhedral mass properties (revisited), 2002.
MassProperties mass_properties(const Mesh& mesh, bool is_closed);

}  // namespace roomradar
