// kinect_depth.hpp: simulates a Kinect v1's depth measurement from exact depth.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/sensor/sensor_faults.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Position of the projector along the depth camera's +x.
inline constexpr double kKinectBaseline_m = 0.075;
inline constexpr double kKinectNearest_m = 0.5;
inline constexpr double kKinectFarthest_m = 8.0;

struct ExactView {
  DepthImage depth_m;   ///< of the first surface, at any range; 0 = nothing
  Image<int> solid;     ///< index of the solid; -1 = nothing
  Image<float> cosine;  ///< of the angle between ray and surface normal, 0 to 1
};

/// Renders exact depth, solid and angle along every pixel's centre ray.
/// @param rays  each pixel's viewing ray, in image coordinates of `camera`; empty: the pinhole camera's rays
void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, ExactView& exact);

/// Returns the step between adjacent measurable depths at depth_m: z^2 / (8 f b), for disparities in steps of
/// 1/8 px in a 640 px wide image. Source: Khoshelham and Elberink, Sensors 2012, equation (5).
double quantisation_step_m(const Intrinsics& camera, double depth_m);

/// Rounds a depth to the nearest disparity that the Kinect can represent.
double quantised_depth_m(const Intrinsics& camera, double depth_m);

/// Errors of the depth camera; empty images mean no error.
struct DepthFaults {
  PixelRays rays;
  Image<float> inverse_offset_per_m;
  double inverse_scale = 1.0;
};

/// Returns the viewing ray of pixel (x, y), in image coordinates.
PlanePoint<double> ray_of(const PixelRays& rays, int x, int y);

/// Returns the depth that a camera with these faults reports for a true depth > 0 at a pixel.
double reported_m(const DepthFaults& faults, int x, int y, double depth_m);

/// Scratch memory of measure_depth(), including its view from the projector.
struct KinectScratch {
  ViewCaster projector;
  std::vector<float> lattice;
};

/// Simulates the sensor's depth for frame `frame_index` in these steps:
/// - lateral noise: each ray deviates from its pixel's centre by
///   sigma_L = 0.8 + 0.035 theta / (pi/2 - theta) px;
/// - shadow: 0 where a solid blocks the line from projector to surface;
/// - dropouts: 0 where too little light returns (dark, grazing, far), with a ragged boundary;
/// - axial noise: sigma(z, theta) of depth_noise.hpp, minus the part due to quantisation, correlated over
///   some 3 pixels;
/// - quantisation of the disparity, and 0 outside 0.5 to 8 m.
/// @param infrared     reflected fraction of the light, per solid
/// @param exact        rendered with faults.rays
/// @param noise_scale  factor on both sigmas; > 0
/// @param depth_m      out: of the camera's size
/// Deterministic in (seed, frame_index), independent of other frames.
/// Source: Nguyen, Izadi, Lovell, 3DIMPVT 2012, equations (1) and (3).
void measure_depth(std::span<const Solid> solids, std::span<const float> infrared, const ViewCaster& view,
                   const ExactView& exact, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   const DepthFaults& faults, double noise_scale, std::uint64_t seed,
                   std::int64_t frame_index, KinectScratch& scratch, DepthImage& depth_m);

}  // namespace roomradar
