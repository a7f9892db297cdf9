// view.hpp: depth and intensity images prepared for alignment with one another.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct ViewConfig {
  int finest_width_px = 320;  ///< images wider than this are halved until they are not
  int levels = 3;             ///< of the pyramid, each half the size of the one before
  float min_depth_m = 0.3F;
  float max_depth_m = 6.0F;  ///< beyond this a Kinect v1 is off by more than 6 cm
  /// A reference's planes are fitted to 5 x 5 samples this far to each side (finest level).
  int normal_reach_px = 4;
  bool noisy = true;  ///< false, for rendered depth: 3 x 3 neighbours do, at a third of the time
};

/// An image's depth and intensity at several resolutions, from fine to coarse.
/// Inverse depth is what is averaged: of a plane it is linear over the image, and its noise is the same
/// everywhere.
struct ViewPyramid {
  struct Level {
    Intrinsics camera;
    Image<float> inverse_depth_per_m;  ///< 0: none
    Image<float> intensity;            ///< 0..255, -1: none; empty: no colour at all
  };
  std::vector<Level> levels;
  /// Scratch: the colour image's intensity, averaged down to about the finest level's size.
  Image<float> grey;
};

/// Depth halved until it is at most finest_width_px wide, and colour as seen from the depth camera, in
/// `levels` sizes. Depths outside min_depth_m..max_depth_m and pixels whose colour the colour camera does not
/// see are left out. The frame's images must have their cameras' sizes. Reuses what `pyramid` has allocated.
void make_pyramid(const Frame& frame, const ViewConfig& config, ViewPyramid& pyramid);

/// The same without colour, for rendered depth.
void make_pyramid(const DepthImage& depth_m, const Intrinsics& camera, const ViewConfig& config,
                  ViewPyramid& pyramid);

/// Makes the depth of all levels but the finest anew from the finest's.
void halve_depth(ViewPyramid& pyramid);

/// The same of the intensity, where the finest level has any; the depth of all levels must be there.
void halve_intensity(ViewPyramid& pyramid);

/// What a reference pixel says about points near it. 32 bytes: looking one up touches one cache line.
struct alignas(32) ReferencePixel {
  Eigen::Vector3f normal;        ///< unit, towards the camera; zero: no surface here
  float offset_m;                ///< normal . p for the points p of the surface's plane; < 0
  float inverse_sigma_per_m;     ///< of the distance to the plane that one measurement of the surface has
  float intensity;               ///< 0..255, or -1
  float gradient_u, gradient_v;  ///< of the intensity, per pixel; 0 where the intensity is not known
};

struct ReferenceLevel {
  Intrinsics camera;
  Image<ReferencePixel> pixels;
};

/// A view whose pose is known, levels from fine to coarse.
struct ReferenceView {
  std::vector<ReferenceLevel> levels;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Fits a plane to each pixel's surroundings; holes stay where there is no surface or it is not flat within
/// the noise.
void make_reference(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                    const ViewConfig& config, ReferenceView& reference);

struct LivePoint {
  Eigen::Vector3f p_camera;  ///< m
  float intensity;           ///< 0..255, or -1
};

/// The points of an image to be aligned, levels from fine to coarse; the finest may be thinned.
struct LiveView {
  std::vector<std::vector<LivePoint>> levels;
};

/// `ignore`, unless empty, has the depth image's size; pixels that it has at 255 are left out.
/// Of the finest level every `finest_step_px`-th pixel of every such row is taken.
void make_live(const ViewPyramid& pyramid, LiveView& live, const MaskImage& ignore = {},
               int finest_step_px = 2);

}  // namespace roomradar
