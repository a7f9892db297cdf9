// foreground_config.hpp: thresholds for pixels that differ from the static model.
#pragma once

namespace roomradar {

/// All "sigmas" are of the total: sensor noise at this depth and incidence angle, the model's error, and the
/// pose error's effect on a sloped surface, added as variances. Strong pixels seed a region, weak pixels only
/// join one.
struct ForegroundConfig {
  float model_sigma_m = 0.003F;    ///< error of the expected depth; typical of a map with 1 cm cells
  float pose_sigma_m = 0.003F;     ///< position error of the pose, effective where the surface slopes
  float pose_sigma_rad = 0.0015F;  ///< rotation error of the pose
  float strong_sigmas = 4.0F;
  float weak_sigmas = 2.0F;
  /// Factor on both thresholds where the previous frame had a label, so a region persists until it is clearly
  /// gone.
  float hysteresis = 0.75F;
  /// Max lateral shift of a model edge by the pose error and the map's distortion.
  float edge_error_m = 0.02F;
  float edge_error_rad = 0.005F;  ///< the same by the pose's rotation error, 0.3 degrees
  int hole_reach_px = 16;         ///< hole pixels farther than this from the model's edge are not judged
  /// Max distance that a region reaches over weak pixels from strong ones. Covers the region's rim, but not
  /// all of a misplaced table or chair that it touches, whose weak pixels would then count against it.
  int weak_reach_px = 20;
  int min_region_px = 60;         ///< smaller regions are noise
  float min_region_m2 = 0.0003F;  ///< the same as area in the world: 3 cm2
  /// Min fraction of a region's pixels that are strong. Regions from a distorted map or a wrong pose are weak
  /// nearly everywhere (0 to 0.25 in a real kitchen mapped with poses 3 cm off); dynamic regions are strong
  /// except at their rim. Pixels that cannot be strong do not count: those in the model's holes and, in a
  /// revealed region, those within reach of an edge.
  float min_strong_fraction = 0.6F;
  /// Min fraction of all its pixels that are strong.
  float min_strong_of_all = 0.3F;
  /// The same for revealed regions. A removed object is in the model, so the reach of its own edges covers
  /// its rim: of an object 12 cm wide, a tenth remains.
  float min_strong_of_all_revealed = 0.1F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ForegroundConfig& config);

}  // namespace roomradar
