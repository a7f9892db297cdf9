// foreground_config.hpp: thresholds for pixels that differ from the static model.
#pragma once
#include "mapping/types/depth_noise.hpp"

namespace roomradar {

/// One "sigma" is the standard deviation of measured minus expected depth. Sigma combines sensor noise at
/// this depth and incidence angle, the model's error, and the pose error's effect on a sloped surface. A
/// pixel is strong if measured and expected depth differ by more than strong_sigmas. A pixel is weak if the
/// depths differ by more than weak_sigmas. Strong pixels seed a region. Weak pixels only join a region.
struct ForegroundConfig {
  DepthNoise noise = {};           ///< of the sensor
  float model_sigma_m = 0.003F;    ///< error of the expected depth; typical of a map with 1 cm cells
  float pose_sigma_m = 0.003F;     ///< position error of the pose; affects sloped surfaces
  float pose_sigma_rad = 0.0015F;  ///< rotation error of the pose
  float strong_sigmas = 4.0F;
  float weak_sigmas = 2.0F;
  /// Factor on strong_sigmas and weak_sigmas where the previous frame had a region. A region thus persists
  /// until it is clearly gone.
  float hysteresis = 0.75F;
  /// Max lateral shift of a model edge by the pose's position error and the map's distortion.
  float edge_error_m = 0.02F;
  float edge_error_rad = 0.005F;  ///< additional shift by rotation error, 0.3 degrees
  int hole_reach_px = 16;         ///< hole pixels farther than this from the hole's edge stay kNotKnown
  /// Max distance of a weak pixel from a strong pixel. Weak pixels farther away are dropped. The distance is
  /// large enough for a region's contour, but smaller than a misplaced table or chair that touches the
  /// region. All weak pixels of the table would count against the region.
  int weak_reach_px = 20;
  /// Pixels of a row or column on one surface are one region across a gap without depth of up to this angle:
  /// 16 pixels of a Kinect.
  float max_gap_rad = 0.0274F;
  int min_region_px = 60;         ///< min pixels of a region; smaller regions are noise
  float min_region_m2 = 0.0003F;  ///< min area of a region in the world: 3 cm2
  /// Min fraction of a region's pixels that are strong. In regions caused by a distorted map or a wrong pose,
  /// nearly all pixels are weak. In a real kitchen mapped with pose errors of 3 cm, the fraction is 0 to
  /// 0.25. Dynamic regions are strong except at their contour. Pixels that cannot be strong are not counted.
  /// Pixels cannot be strong in the model's holes or, in a revealed region (farther than the model), within
  /// the error of an edge.
  float min_strong_fraction = 0.6F;
  /// Min fraction of strong pixels among all pixels of a region, including those that min_strong_fraction
  /// does not count.
  float min_strong_of_all = 0.3F;
  /// Replaces min_strong_of_all for revealed regions (farther than the model). A removed object is in the
  /// model, so its own edges make pixels near its contour ambiguous. For an object 12 cm wide, a tenth of the
  /// pixels can be strong.
  float min_strong_of_all_revealed = 0.1F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ForegroundConfig& config);

}  // namespace roomradar
