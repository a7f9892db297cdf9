// foreground_config.hpp: how sure one must be that a pixel differs from the static model.
#pragma once

namespace roomradar {

/// All "sigmas" are of the total: sensor noise at this depth and incidence angle, the model's own error, and
/// what the pose's error makes of the surface's slope, added as variances. Strong pixels start a region, weak
/// pixels only join one.
struct ForegroundConfig {
  float model_sigma_m = 0.003F;  ///< error of the expected depth itself; a map with 1 cm cells has about this
  float pose_sigma_m = 0.003F;   ///< error of the pose's position, felt where the surface slopes
  float pose_sigma_rad = 0.0015F;  ///< and of its direction
  float strong_sigmas = 4.0F;
  float weak_sigmas = 2.0F;
  /// Where something was marked in the frame before, both are times this: what is there stays until it is
  /// clear that it left.
  float hysteresis = 0.75F;
  /// How far aside an edge of the model may stand, by an error of the pose and the map's distortion.
  float edge_error_m = 0.02F;
  float edge_error_rad = 0.005F;  ///< the same by a turn of the pose, 0.3 degrees
  int hole_reach_px = 16;  ///< how far from the model's edge a pixel without expected depth is still judged
  /// How far over weak pixels a region reaches from strong ones: to its rim, and not over all of a misplaced
  /// table or chair that it touches, whose weakness would then count against it.
  int weak_reach_px = 20;
  int min_region_px = 60;         ///< smaller regions are noise
  float min_region_m2 = 0.0003F;  ///< the same by size in the world: 3 cm2
  /// Of a region's pixels, those that are strong. Regions by a distorted map or a wrong pose are weak nearly
  /// everywhere (0 to 0.25 in a real kitchen mapped by poses 3 cm off); what moved is strong but for its rim.
  /// Pixels that cannot be strong do not count: those in the model's holes, and of a revealed region those
  /// within the reach of an edge.
  float min_strong_fraction = 0.6F;
  /// The same of all its pixels.
  float min_strong_of_all = 0.3F;
  /// The same of all pixels of a revealed region. What was taken away stands in the model, so the reach of
  /// its own edges eats into it: of a thing 12 cm wide, a tenth is left.
  float min_strong_of_all_revealed = 0.1F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ForegroundConfig& config);

}  // namespace roomradar
