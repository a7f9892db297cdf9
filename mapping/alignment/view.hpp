// view.hpp: the two inputs of an alignment: planes of a target view, and points of a source view.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/alignment/view_pyramid.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/simd8f.hpp"

namespace roomradar {

/// Plane and intensity at one pixel of a target view. Takes 32 bytes, so a lookup touches one cache line.
struct alignas(32) TargetPixel {
  Eigen::Vector3f normal;        ///< unit, towards the camera; zero: no surface at this pixel
  float offset_m;                ///< m, < 0: normal . p = offset_m for all points p of the plane
  float inverse_sigma_per_m;     ///< 1 / standard deviation of one measurement's distance to the plane
  float intensity;               ///< 0..255; -1: unknown
  float gradient_u, gradient_v;  ///< intensity gradient along u and v, per pixel; 0: unknown
};

struct TargetLevel {
  Intrinsics camera;
  Image<TargetPixel> pixels;
};

/// View of known pose. `levels` are resolutions from fine to coarse.
struct TargetView {
  std::vector<TargetLevel> levels;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Fits a plane to each pixel's neighbourhood. A pixel has no plane (normal zero) if it has no depth or is at
/// the image's border. The same holds if its neighbourhood has too few samples or is not flat within the
/// noise.
/// @param arithmetic  results are bit-identical for all values
void make_target_view(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                      const ViewConfig& config, TargetView& reference,
                      Arithmetic arithmetic = Arithmetic::kFastest);

struct SourcePoint {
  Eigen::Vector3f p_camera;  ///< m
  float intensity;           ///< 0..255; -1: unknown
};

/// Points of an image that is to be aligned. `levels` are resolutions from fine to coarse. The finest level
/// may be subsampled.
struct SourcePoints {
  std::vector<std::vector<SourcePoint>> levels;
  std::vector<Intrinsics> cameras;  ///< camera of each level
};

/// Extracts the points of all levels. The finest level uses every `finest_step_px`-th pixel of every
/// `finest_step_px`-th row. `ignore` is empty or has the depth image's size; pixels where `ignore` is not 0
/// are left out.
void make_source_points(const ViewPyramid& pyramid, SourcePoints& live, const MaskImage& ignore = {},
                        int finest_step_px = 2);

}  // namespace roomradar
