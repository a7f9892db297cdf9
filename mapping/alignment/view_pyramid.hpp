// view_pyramid.hpp: depth and intensity of an image at several resolutions.
#pragma once
#include <vector>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Max relative difference between two depths that count as one surface: 5 cm at 1 m. On a plane seen at 75
/// degrees from its normal, the depths of two pixels differ by this much if the pixels are four apart in a
/// 320 px wide image.
inline constexpr float kSameSurface = 0.05F;

struct ViewConfig {
  int finest_width_px = 320;  ///< wider images are halved until they are at most this wide
  int levels = 3;             ///< number of pyramid levels, each half the width and height of the previous
  float min_depth_m = 0.3F;
  float max_depth_m = 6.0F;  ///< larger depths are not used: there, a Kinect v1's noise exceeds 6 cm
  /// Half the side of the square around a pixel to which the pixel's plane is fitted, at the finest level.
  /// The square is sampled at 5 x 5 pixels.
  int normal_reach_px = 4;
  /// Set to false for rendered depth. Planes are then fitted to 3 x 3 neighbouring pixels, in a third of the
  /// time.
  bool noisy = true;
};

/// Depth and intensity of an image at several resolutions, from fine to coarse. Depth is stored and averaged
/// as inverse depth, which is linear in the image over a plane and has uniform noise.
struct ViewPyramid {
  struct Level {
    Intrinsics camera;
    Image<float> inverse_depth_per_m;  ///< 0: no depth
    Image<float> intensity;            ///< 0..255; -1: unknown; empty image: no colour
  };
  std::vector<Level> levels;
  DepthNoise noise;  ///< noise model of the depth sensor
  /// Scratch: the colour image in grey levels, averaged down to about the finest level's size.
  Image<float> grey;
};

/// Motion of the camera during a frame, and the times at which the sensor reads the frame's images.
struct FrameMotion {
  CameraVelocity velocity;
  SensorTiming timing;
};

/// Builds the pyramid of a frame: its depth, and its intensity registered to the depth camera. The finest
/// level is at most finest_width_px wide. Leaves out depths outside min_depth_m..max_depth_m, and intensity
/// outside the colour camera's view. The frame's images must have their cameras' sizes. Reuses memory
/// allocated in `pyramid`.
/// @param motion  used to compensate the time between depth and colour when a point's intensity is looked up.
///                Depth is not moved
void make_pyramid(const Frame& frame, const ViewConfig& config, ViewPyramid& pyramid,
                  const FrameMotion& motion = {});

/// Averages a colour image to grey levels (0..255) of at most max_width_px columns, by halving. Empty for an
/// empty image.
void make_grey(const ColourImage& colour, int max_width_px, Image<float>& grey);

/// Builds a pyramid without intensity.
/// @param noise  noise model of the sensor; for rendered depth, of the sensor whose images are compared with
///               the rendered depth
void make_pyramid(const DepthImage& depth_m, const Intrinsics& camera, const ViewConfig& config,
                  ViewPyramid& pyramid, const DepthNoise& noise = {});

/// Recomputes the depth of all coarser levels from the finest level.
void halve_depth(ViewPyramid& pyramid);

/// Applies deskew() to the finest level, unless its points move by less than a quarter of a pixel, and
/// recomputes the coarser levels.
void deskew(ViewPyramid& pyramid, const CameraVelocity& velocity, double readout_s);

/// Recomputes the intensity of all coarser levels from the finest level, if the finest level has intensity.
/// Precondition: all levels have their depth.
void halve_intensity(ViewPyramid& pyramid);

}  // namespace roomradar
