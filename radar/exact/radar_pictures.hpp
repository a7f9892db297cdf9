// radar_pictures.hpp: the radar's R, M and L as images, for display.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/image.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct RadarQuery;

/// Placement of one query's images. Pixel (i, j) is centred at origin_world + (i + 0.5) * pixel_m * x_world +
/// (j + 0.5) * pixel_m * y_world. Depth is measured along u_world.
struct RadarVolume {
  /// Corner of the rear plane, just behind the object.
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_world = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y_world = Eigen::Vector3d::UnitY();
  Eigen::Vector3d u_world = Eigen::Vector3d::UnitZ();  ///< unit direction of motion; x cross y = u
  double pixel_m = 0.0;
  double length_m = 0.0;  ///< length of the object along u
  double depth_m = 0.0;   ///< d: the object's length plus the queried distance
  int width_px = 0;
  int height_px = 0;

  /// Bounding box in the world.
  [[nodiscard]] Eigen::AlignedBox3d bounds_world() const;
};
/// R, M and L of one query, row by row, volume.width_px x height_px.
struct RadarPictures {
  RadarVolume volume;
  Image<float> range_m;   ///< R; volume.depth_m if there is no surface or L is undefined
  Image<float> mask_m;    ///< M; volume.depth_m if the object does not cover the pixel
  Image<float> lookat_m;  ///< L, NaN where undefined
};

/// Computes the images of a CyberRadar query, sampled just off the middle of each pixel as GlRadar samples
/// them. Depths equal GlRadar's except for its renderer's rounding, overlaps (L is not negative here) and
/// one-sided surfaces (which GlRadar does not know). R is the first surface not behind the object's front.
/// Everything is drawn in double; neither CyberRadar nor its results need these images.
///
/// @param resolution_px  pixels along the longer side of the object's outline, 1 to 4096
/// @return all images empty for a query that CyberRadar rejects with kInvalidInput
RadarPictures radar_pictures(const RadarQuery& query, const RadarScene& scene, int resolution_px);

/// Sample position in a pixel: slightly off its middle, so edges along pixels do not fall onto samples.
inline constexpr double kSampleX_px = 0.5 + 1.0 / 64.0, kSampleY_px = 0.5 + 1.0 / 97.0;

}  // namespace roomradar
