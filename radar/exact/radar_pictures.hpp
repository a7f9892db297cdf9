// radar_pictures.hpp: what the radar sees: R, M and L as images, for whoever wants to look at them.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/image.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct RadarQuery;

/// Where the images of one query stand: pixel (i, j) is centred at
/// origin_world + (i + 0.5) * pixel_m * x_world + (j + 0.5) * pixel_m * y_world, and depth runs along
/// u_world.
struct RadarVolume {
  /// Corner of the rear plane, just behind the object.
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_world = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y_world = Eigen::Vector3d::UnitY();
  Eigen::Vector3d u_world = Eigen::Vector3d::UnitZ();  ///< unit, the direction of motion; x cross y = u
  double pixel_m = 0.0;
  double length_m = 0.0;  ///< of the object along u
  double depth_m = 0.0;   ///< d: the object's length plus the distance asked for
  int width_px = 0;
  int height_px = 0;

  /// Corners of the box, in the world.
  [[nodiscard]] Eigen::AlignedBox3d bounds_world() const;
};
/// R, M and L of one query, row by row, volume.width_px x height_px.
struct RadarPictures {
  RadarVolume volume;
  Image<float> range_m;   ///< R, volume.depth_m where there is nothing or L is undefined
  Image<float> mask_m;    ///< M, volume.depth_m where there is nothing
  Image<float> lookat_m;  ///< L, NaN where undefined
};

/// The pictures of a question to the processor's radar, sampled just off the middle of each pixel as GlRadar
/// samples them: the same depths but for its renderer's rounding, overlaps (L is not negative here) and
/// one-sided surfaces (which it does not know). R is the first surface that is not behind the object's front.
/// Everything is drawn in double; neither CyberRadar nor its answer needs these.
///
/// @param resolution_px  pixels along the longer side of the object's outline, 1 to 4096
/// @return everything empty for a question that CyberRadar answers with kInvalidInput
RadarPictures radar_pictures(const RadarQuery& query, const RadarScene& scene, int resolution_px);

/// Where in a pixel it is sampled: a little off its middle, so that edges along pixels do not fall onto
/// samples.
inline constexpr double kSampleX_px = 0.5 + 1.0 / 64.0, kSampleY_px = 0.5 + 1.0 / 97.0;

}  // namespace roomradar
