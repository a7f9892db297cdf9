// dynamic_surface_config.hpp: tolerances of the dynamic surface's mesh, and the thickness of its back.
#pragma once
#include <Eigen/Core>

namespace roomradar {

/// "Sigmas" are of the sensor's noise at the surface's depth and angle.
struct DynamicSurfaceConfig {
  /// Max deviation, in depth, of the mesh from the pixels' average over 5 x 5.
  float deviation_sigmas = 0.8F;
  float flat_sigmas = 2.0F;  ///< max RMS of 5 x 5 pixels from a plane; above it they are a bend, not noise
  float cut_sigmas = 2.5F;  ///< max RMS of an outline cell's pixels from its triangles; else all are vertices
  float jump_sigmas = 4.0F;          ///< depths that differ by up to this much noise are one surface
  float jump_incidence_deg = 80.0F;  ///< and so is a plane seen at up to this angle from its normal
  bool has_back = true;              ///< false: no inferred mesh
  float least_thickness_m = 0.005F;  ///< at the outline
  float most_thickness_m = 0.3F;     ///< a person's chest
  float least_roundness = 0.3F;      ///< assumed of flat fronts; 1: as round as a ball
  float back_clearance_m = 0.005F;   ///< min distance of the back from the static model
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const DynamicSurfaceConfig& config);

/// A region, such as around a virtual object, where the mesh has the image's resolution.
struct FineRegion {
  Eigen::Vector3d centre_world;
  double radius_m;
};

}  // namespace roomradar
