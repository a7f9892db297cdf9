// kinect_depth.hpp: simulates the depth images of a Kinect v1 from exact depth.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/sensor/sensor_faults.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Distance of the projector from the depth camera, along the camera's +x.
inline constexpr double kKinectBaseline_m = 0.075;
/// Min measured depth.
inline constexpr double kKinectNearest_m = 0.5;
/// Max measured depth.
inline constexpr double kKinectFarthest_m = 8.0;

/// Exact images of a view.
struct ExactView {
  /// Depth of the first surface, m, not limited to the sensor's range; 0 if there is none.
  DepthImage depth_m;
  /// Index of the solid of the first surface; -1 if there is none.
  Image<int> solid;
  /// Cosine of the angle between ray and surface normal, 0 to 1.
  Image<float> cosine;
};

/// Rows of an image that are exposed at the same time.
struct RowBand {
  int begin = 0, end = 0;
  double t_s = 0.0;  ///< time relative to the middle of the image's readout
};
/// Divides an image into bands of four rows, read from top to bottom in readout_s; one band if readout_s is
/// 0.
std::vector<RowBand> row_bands(int height_px, double readout_s);

/// Renders exact depth, solid and cosine along each pixel's ray, in a band of rows.
/// @param[in,out] exact  images of the camera's size
/// @param rays  each pixel's viewing ray, as an image point of `camera`. Empty: rays through the pixels'
///              centres
void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, const RowBand& band, ExactView& exact);
/// The same for the whole image.
void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, ExactView& exact);
/// Resizes the images of `exact` to the camera's size and clears them.
void clear(const Intrinsics& camera, ExactView& exact);

/// Returns the difference between adjacent measurable depths near depth_m, m. It is z^2 / (8 f b), where z is
/// the depth, f the focal length and b the baseline. Disparities have steps of 1/8 px in an image of 640 px
/// width. Source: Khoshelham and Elberink, Sensors 2012, equation (5).
double quantisation_step_m(const Intrinsics& camera, double depth_m);

/// Calibration errors of the depth camera, see SensorFaults. Empty images: no errors.
struct DepthFaults {
  PixelRays rays;
  Image<float> inverse_offset_per_m;
  double inverse_scale = 1.0;
};

/// Returns the viewing ray of pixel (x, y), as an image point of the declared camera.
PlanePoint<double> ray_of(const PixelRays& rays, int x, int y);

/// Returns the depth that a camera with these errors reports at a pixel for a true depth > 0, m.
double reported_m(const DepthFaults& faults, int x, int y, double depth_m);

/// Solids and what they return of the projector's light.
struct InfraredSolids {
  std::span<const Solid> solids;
  std::span<const float> infrared;  ///< reflected fraction of the infrared light, per solid
};

/// The view of the depth camera on the solids. Refers to its parts, which must outlive it.
struct DepthCameraView {
  const ViewCaster& caster;  ///< prepared for camera and pose
  const ExactView& exact;    ///< exact images, rendered with the camera's DepthFaults::rays
  const Intrinsics& camera;
  const Eigen::Isometry3d& T_world_camera;
};

/// Errors of one frame's measured depth. Refers to the faults, which must outlive it.
struct DepthErrors {
  const DepthFaults& faults;
  double noise_scale = 1.0;  ///< factor on both standard deviations of the noise; > 0
  std::uint64_t seed = 0;
  std::int64_t frame_index = 0;
};

/// Buffers of measure_depth().
struct KinectScratch {
  ViewCaster projector;
  std::vector<float> lattice;
  std::uint64_t lattice_key = 0;  ///< key of the frame whose noise is in `lattice`; 0: none
};

/// Simulates the sensor's depth image of a frame by the steps below. z is the depth, theta the
/// angle between ray and surface normal.
/// - Lateral noise: each ray deviates from its pixel's centre, with standard deviation
///   sigma_L = 0.8 + 0.035 theta / (pi/2 - theta) px.
/// - Shadow: depth 0 if a solid blocks the line from the projector to the surface.
/// - Dropouts: depth 0 if too little light returns from a dark, grazing or far surface. The boundary of such
///   areas is ragged.
/// - Axial noise: standard deviation sigma(z, theta) of depth_noise.hpp without the contribution of
///   quantisation. Correlated over about 3 pixels.
/// - Quantisation of the disparity. Depth is 0 outside 0.5 to 8 m.
///
/// The result is deterministic in (errors.seed, errors.frame_index) and independent of other frames. Source:
/// Nguyen, Izadi, Lovell, 3DIMPVT 2012, equations (1) and (3).
/// @param band  rows to be measured; view.T_world_camera is the camera pose at the time of these rows
/// @param[in,out] depth_m  image of the camera's size, 0 in these rows
void measure_depth(const InfraredSolids& lit, const DepthCameraView& view, const DepthErrors& errors,
                   const RowBand& band, KinectScratch& scratch, DepthImage& depth_m);
/// The same for the whole image, which is resized to the camera's size.
void measure_depth(const InfraredSolids& lit, const DepthCameraView& view, const DepthErrors& errors,
                   KinectScratch& scratch, DepthImage& depth_m);

}  // namespace roomradar
