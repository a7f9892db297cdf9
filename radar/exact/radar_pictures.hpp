// radar_pictures.hpp: the radar's R (scene), M (object) and L (gap) as images, for display.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/image.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct RadarQuery;

/// Box swept by the object, and the pixel grid of one query's images. Pixel (i, j) is centred at origin_world
/// + (i + 0.5) * pixel_m * x_world + (j + 0.5) * pixel_m * y_world. Depth is measured along u_world.
struct RadarVolume {
  /// Corner of the rear plane, which lies just behind the object.
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_world = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y_world = Eigen::Vector3d::UnitY();
  /// Unit direction of motion, x_world cross y_world.
  Eigen::Vector3d u_world = Eigen::Vector3d::UnitZ();
  /// Side of a pixel.
  double pixel_m = 0.0;
  /// Length of the object along u_world.
  double length_m = 0.0;
  /// Depth of the box, d: the object's length plus the queried distance.
  double depth_m = 0.0;
  int width_px = 0;
  int height_px = 0;

  /// Returns the axis-aligned bounding box in the world, m.
  [[nodiscard]] Eigen::AlignedBox3d bounds_world() const;
};
/// Images R, M and L of one query, row by row, volume.width_px x height_px.
struct RadarPictures {
  RadarVolume volume;
  /// R, m: distance from the rear plane to the scene; volume.depth_m where L is undefined.
  Image<float> range_m;
  /// M, m: distance from the far plane back to the object. volume.depth_m if the object does not cover the
  /// pixel.
  Image<float> mask_m;
  /// L = R + M - d, m: gap between object and scene; NaN where undefined.
  Image<float> lookat_m;
};

/// Computes the images of a CyberRadar query. Samples each pixel slightly off its centre, as GlRadar does.
/// Depths differ from GlRadar's by its renderer's rounding. Depths also differ in overlaps (L is never below
/// -touching_m() in these images) and at one-sided surfaces (GlRadar treats them as two-sided). R shows the
/// first surface that is not behind the object's leading surface. All depths are computed in double.
/// CyberRadar itself does not use the images.
///
/// @param resolution_px  pixels along the longer side of the object's bounding rectangle; clamped to 1..4096
/// @return the images; all empty if CyberRadar rejects the query with kInvalidInput
RadarPictures radar_pictures(const RadarQuery& query, const RadarScene& scene, int resolution_px);

/// Sample position in a pixel. It is slightly off the centre, so edges that run through pixel centres do not
/// pass through samples.
inline constexpr double kSampleX_px = 0.5 + 1.0 / 64.0, kSampleY_px = 0.5 + 1.0 / 97.0;

}  // namespace roomradar
