// view_pyramid.hpp: depth and intensity of an image at several resolutions.
#pragma once
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Two depths belong to one surface if they differ by less than this fraction. It equals 5 cm at 1 m, or a
/// plane seen at 75 degrees over four pixels of a 320 pixel wide image.
inline constexpr float kSameSurface = 0.05F;

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

}  // namespace roomradar
