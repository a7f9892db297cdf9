// view.hpp: planes of a target view and points of a source view, prepared for alignment.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/alignment/view_pyramid.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Plane and intensity at one reference pixel. 32 bytes, so one lookup touches one cache line.
struct alignas(32) TargetPixel {
  Eigen::Vector3f normal;        ///< unit, towards the camera; zero: no surface
  float offset_m;                ///< normal . p for points p on the plane, m; < 0
  float inverse_sigma_per_m;     ///< 1 / standard deviation of a single measurement's distance to the plane
  float intensity;               ///< 0..255; -1: none
  float gradient_u, gradient_v;  ///< intensity gradient, per pixel; 0: unknown
};

struct TargetLevel {
  Intrinsics camera;
  Image<TargetPixel> pixels;
};

/// View of known pose, levels from fine to coarse.
struct TargetView {
  std::vector<TargetLevel> levels;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Fits a plane to each pixel's neighbourhood. Pixels without depth, or not flat within the noise, get no
/// surface.
void make_target_view(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                      const ViewConfig& config, TargetView& reference);

struct SourcePoint {
  Eigen::Vector3f p_camera;  ///< m
  float intensity;           ///< 0..255; -1: none
};

/// Points of an image to be aligned, levels from fine to coarse; the finest may be subsampled.
struct SourcePoints {
  std::vector<std::vector<SourcePoint>> levels;
};

/// `ignore` is empty or has the depth image's size; its non-zero pixels are left out. The finest level uses
/// every `finest_step_px`-th pixel of every `finest_step_px`-th row.
void make_source_points(const ViewPyramid& pyramid, SourcePoints& live, const MaskImage& ignore = {},
                        int finest_step_px = 2);

}  // namespace roomradar
