// foreground_config.hpp: thresholds for pixels that differ from the static model.
#pragma once

namespace roomradar {

/// "Sigmas" combine, as variances, sensor noise at this depth and incidence angle, the model's error, and the
/// pose error's effect on a sloped surface. A pixel is strong (weak) if live and expected depth differ by
/// more than strong_sigmas (weak_sigmas). Strong pixels seed a region; weak pixels only join one.
struct ForegroundConfig {
  float model_sigma_m = 0.003F;    ///< error of the expected depth; typical of a map with 1 cm cells
  float pose_sigma_m = 0.003F;     ///< position error of the pose; matters where the surface slopes
  float pose_sigma_rad = 0.0015F;  ///< rotation error of the pose
  float strong_sigmas = 4.0F;
  float weak_sigmas = 2.0F;
  /// Factor on both thresholds where the previous frame had a region, so a region persists until it is
  /// clearly gone.
  float hysteresis = 0.75F;
  /// Max lateral shift of a model edge by position error and map distortion.
  float edge_error_m = 0.02F;
  float edge_error_rad = 0.005F;  ///< additional shift by rotation error, 0.3 degrees
  int hole_reach_px = 16;         ///< hole pixels farther than this from a modelled pixel stay kNotKnown
  /// Weak pixels farther than this from a strong pixel are dropped. The distance covers a region's rim, but
  /// not all of a misplaced table or chair that the region touches: its weak pixels would count against the
  /// region.
  int weak_reach_px = 20;
  int min_region_px = 60;         ///< min pixels of a region; smaller regions are noise
  float min_region_m2 = 0.0003F;  ///< min area of a region in the world: 3 cm2
  /// Min fraction of a region's pixels that are strong. Regions from a distorted map or a wrong pose are weak
  /// nearly everywhere (0 to 0.25 in a real kitchen mapped with poses 3 cm off); dynamic regions are strong
  /// except at their rim. Pixels that cannot be strong are not counted: those in the model's holes and, in a
  /// revealed region, those within an edge's error.
  float min_strong_fraction = 0.6F;
  /// Min fraction of strong pixels, with the uncounted pixels included.
  float min_strong_of_all = 0.3F;
  /// The same for revealed regions. A removed object is still in the model, so its own edges make its rim
  /// ambiguous: of an object 12 cm wide, a tenth can be strong.
  float min_strong_of_all_revealed = 0.1F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ForegroundConfig& config);

}  // namespace roomradar
