// dynamic_surface_config.hpp: tolerances of the dynamic surface's mesh, and the thickness of its back.
#pragma once
#include <Eigen/Core>

namespace roomradar {

/// "Sigmas" are of the sensor's noise at the surface's depth and angle.
struct DynamicSurfaceConfig {
  /// Max deviation of the mesh, in depth, from the average over 5 x 5 pixels.
  float deviation_sigmas = 0.8F;
  float flat_sigmas = 2.0F;  ///< max RMS of 5 x 5 pixels from a plane; more is a bend, not noise
  /// Max RMS of an outline cell's pixels from its triangles; beyond: all pixels are vertices.
  float cut_sigmas = 2.5F;
  float jump_sigmas = 4.0F;          ///< depths that differ by up to this much noise are one surface
  float jump_incidence_deg = 80.0F;  ///< planes seen at up to this angle from their normal are one surface
  bool has_back = true;              ///< false: no inferred mesh
  float least_thickness_m = 0.005F;  ///< thickness at the outline
  float most_thickness_m = 0.3F;     ///< the thickness of a person's chest
  float least_roundness = 0.3F;      ///< assumed of flat fronts; 1: as round as a ball
  float back_clearance_m = 0.005F;   ///< min distance of the back from the static model
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const DynamicSurfaceConfig& config);

/// A ball, such as around a virtual object, in which the mesh has the image's resolution.
struct FineRegion {
  Eigen::Vector3d centre_world;
  double radius_m;
};

}  // namespace roomradar
