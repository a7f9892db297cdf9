// dynamic_surface_config.hpp: tolerances of the dynamic surface's mesh, and the thickness of its back.
#pragma once
#include <Eigen/Core>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {

/// One "sigma" is the standard deviation of the sensor's noise at the surface's depth and angle.
struct DynamicSurfaceConfig {
  DepthNoise noise = {};  ///< of the sensor
  /// Max deviation of the mesh, in depth, from the average over 5 x 5 pixels.
  float deviation_sigmas = 0.8F;
  float flat_sigmas = 2.0F;  ///< max RMS distance of 5 x 5 pixels from a plane; above it: a bend
  /// Max RMS distance of a cut cell's pixels from the cell's triangles. Above it, the cell is full: every
  /// pixel becomes a vertex.
  float cut_sigmas = 2.5F;
  float jump_sigmas = 4.0F;          ///< max noise, in sigmas, between the depths of one surface
  float jump_incidence_deg = 80.0F;  ///< max angle between view ray and normal of one surface
  bool has_back = true;              ///< false: no inferred mesh
  float least_thickness_m = 0.005F;  ///< thickness at the outline
  float most_thickness_m = 0.3F;     ///< the thickness of a person's chest
  float least_roundness = 0.3F;      ///< roundness assumed for flat fronts; 1: as round as a ball
  float back_clearance_m = 0.005F;   ///< min distance of the back from the static model
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const DynamicSurfaceConfig& config);

/// A ball in which the mesh has the image's resolution, such as around a virtual object.
struct FineRegion {
  Eigen::Vector3d centre_world;
  double radius_m;
};

}  // namespace roomradar
