// view.hpp: depth and intensity images prepared for alignment.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct ViewConfig {
  int finest_width_px = 320;  ///< wider images are halved until they fit
  int levels = 3;             ///< number of pyramid levels, each half the size of the one before
  float min_depth_m = 0.3F;
  float max_depth_m = 6.0F;  ///< beyond this a Kinect v1 is off by more than 6 cm
  /// Reference planes are fitted to 5 x 5 samples that extend this far to each side, at the finest level.
  int normal_reach_px = 4;
  bool noisy = true;  ///< false for rendered depth: 3 x 3 neighbours suffice, in a third of the time
};

/// Depth and intensity of an image at several resolutions, from fine to coarse. Inverse depth is stored and
/// averaged: over a plane it is linear in the image, and its noise is uniform.
struct ViewPyramid {
  struct Level {
    Intrinsics camera;
    Image<float> inverse_depth_per_m;  ///< 0: no depth
    Image<float> intensity;            ///< 0..255, -1: none; empty image: no colour
  };
  std::vector<Level> levels;
  /// Scratch: intensity of the colour image, averaged down to about the finest level's size.
  Image<float> grey;
};

/// Builds a pyramid of depth, its finest level at most finest_width_px wide, and of intensity registered to
/// the depth camera. Leaves out depths outside min_depth_m..max_depth_m, and intensity outside the colour
/// camera's view. The frame's images must have their cameras' sizes. Reuses memory allocated in `pyramid`.
void make_pyramid(const Frame& frame, const ViewConfig& config, ViewPyramid& pyramid);

/// Same without colour, for rendered depth.
void make_pyramid(const DepthImage& depth_m, const Intrinsics& camera, const ViewConfig& config,
                  ViewPyramid& pyramid);

/// Recomputes the depth of all coarser levels from the finest.
void halve_depth(ViewPyramid& pyramid);

/// Same for intensity, if the finest level has any; needs the depth of all levels.
void halve_intensity(ViewPyramid& pyramid);

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
